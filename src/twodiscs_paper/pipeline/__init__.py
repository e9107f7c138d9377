"""What the workflow needs: configuration, jobs, sources, forecast, verify, manuscript."""
