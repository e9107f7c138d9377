"""The log of a build: a line for each job, and errors unless the user ended it."""

import logging
from threading import Event
from types import SimpleNamespace

from snakemake_interface_logger_plugins.common import LogEvent

from twodiscs_paper.pipeline.jobs import lines


def logger(dry_run=False):
    """Return a logger with our handler alone."""
    made = logging.Logger("a build", logging.INFO)
    settings = SimpleNamespace(show_failed_logs=True, dryrun=dry_run)
    made.addHandler(lines.LogHandler(settings, None))
    return made


def test_a_job_is_a_line_when_it_ends(capsys):
    build = logger()
    job = {"jobid": 7, "rule_name": "dynamics", "wildcards": {"scene": "a", "radius": "0.2"}}
    build.info("begun", extra={"event": LogEvent.JOB_INFO} | job)
    build.info("Building DAG of jobs...")
    assert capsys.readouterr() == ("", "")
    build.info("done", extra={"event": LogEvent.JOB_FINISHED, "job_id": 7})
    build.info(None, extra={"event": LogEvent.PROGRESS, "done": 1, "total": 3})
    assert capsys.readouterr().err == "1 of 3: dynamics scene=a, radius=0.2\n"


def test_errors_are_written_unless_the_user_ends_the_build(capsys, monkeypatch):
    monkeypatch.setattr(lines, "INTERRUPTED", Event())
    build = logger()
    build.warning("little space")
    build.error("no rule")
    assert capsys.readouterr().err == "little space\nno rule\n"
    lines.INTERRUPTED.set()
    build.error("a job failed")
    assert capsys.readouterr().err == ""


def test_jobs_of_a_dry_run_are_counted_once(capsys):
    for dry_run, printed in ((True, "Job stats\n"), (False, "")):
        build = logger(dry_run)
        for _ in range(2):
            build.info("Job stats", extra={"event": LogEvent.RUN_INFO, "stats": {}})
        assert capsys.readouterr().err == printed
