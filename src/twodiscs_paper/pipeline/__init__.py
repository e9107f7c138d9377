"""The parts of the workflow: configuration, jobs, forecast, verify, manuscript."""
