"""From configuration files to the parameters of each job."""
