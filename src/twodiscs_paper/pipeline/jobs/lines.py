"""A log of Snakemake with a line for each job, or of a dry run with a table of their counts."""

import logging
import sys
from threading import Event

from snakemake.logging import DefaultFormatter, format_wildcards
from snakemake_interface_logger_plugins.base import LogHandlerBase
from snakemake_interface_logger_plugins.common import LogEvent

#: Set when the user ends the build. Failed jobs are not reported then.
INTERRUPTED = Event()


class LogHandler(LogHandlerBase):
    """A handler that writes a line for each finished job, and all warnings and errors.

    Errors are written as Snakemake writes them, with the log of the failed job. In a dry run it
    writes only the table of counts.
    """

    writes_to_stream = has_filter = has_formatter = True
    writes_to_file = needs_rulegraph = False

    def __post_init__(self):
        self.setFormatter(DefaultFormatter(show_failed_logs=self.common_settings.show_failed_logs))
        self.names, self.finished, self.counted = {}, "", not self.common_settings.dryrun

    def emit(self, record):
        event = getattr(record, "event", None)
        if event == LogEvent.JOB_INFO:
            self.names[record.jobid] = f"{record.rule_name} {format_wildcards(record.wildcards)}"
        elif event == LogEvent.JOB_FINISHED:
            self.finished = self.names[record.job_id].strip()
        elif event == LogEvent.PROGRESS:
            self.write(f"{record.done} of {record.total}: {self.finished}")
        elif event == LogEvent.RUN_INFO and not self.counted:
            self.counted = True  # Snakemake counts the jobs of a dry run twice
            self.write(self.format(record))
        elif record.levelno >= logging.WARNING and not INTERRUPTED.is_set():
            self.write(self.format(record))

    def write(self, text):
        """Print a text on standard error."""
        print(text, file=sys.stderr, flush=True)
