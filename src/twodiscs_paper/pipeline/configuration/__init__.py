"""From configuration files to what each job depends on."""
