"""The seconds of jobs, measured and forecast: cost.csv and forecast.csv."""

from twodiscs.comparison.points import by_radius
from twodiscs.comparison.tables.base import COUNT, LENGTH, NUMBER, SECONDS, TEXT, Table

#: The number of events in the points of a stage.
WORK = {"monte_carlo": "samples", "dynamics": "events", "intervals": "intervals"}


class Cost(Table):
    """One row per job: what it took. The only table of a scene that differs from run to run."""

    stage: TEXT
    """monte_carlo, dynamics or intervals; total of the jobs that were forecast"""
    radius: LENGTH
    events: COUNT
    """events simulated, configurations or intervals drawn"""
    seconds: SECONDS
    """processor time of the job and of its shards; empty where it is not known"""
    forecast_seconds: SECONDS
    """processor time that was forecast before the run; empty without a forecast"""
    ratio: NUMBER
    """seconds/forecast_seconds"""

    @staticmethod
    def rows(points, seconds, forecast):
        """Return the rows of the jobs by stage and radius.

        ``points`` is {stage: [point, …]}; ``seconds`` and ``forecast`` are {(stage, radius): time},
        as far as they are known. The last row is the total of what was forecast, if anything was.
        """
        jobs = [(stage, p) for stage in sorted(points) for p in by_radius(points[stage])]
        rows = []
        for stage, point in jobs:
            job = stage, point["radius"]
            rows.append(_row(*job, point[WORK[stage]], seconds.get(job), forecast.get(job)))
        known = [row for row in rows if row["forecast_seconds"] and row["seconds"] is not None]
        if known:
            columns = "events", "seconds", "forecast_seconds"
            rows.append(_row("total", None, *(sum(row[c] for row in known) for c in columns)))
        return rows


def _row(stage, radius, events, seconds, forecast):
    return {
        "stage": stage,
        "radius": radius,
        "events": events,
        "seconds": seconds,
        "forecast_seconds": forecast,
        "ratio": seconds / forecast if forecast and seconds is not None else None,
    }


class Forecast(Table):
    """One row per scene and stage: what the configuration is going to take on this machine."""

    scene: TEXT
    """the scene; all for what is made once, and for the total"""
    stage: TEXT
    """
    of a scene: monte_carlo, dynamics, intervals, tables, figures, total; of all: compile and what
    the key shared names, most of it as round figures, and the total
    """
    radius: LENGTH
    """radius of one job; empty for the sum over a stage"""
    jobs: COUNT
    """number of jobs"""
    events: COUNT
    """wall and disc events, samples, or intervals"""
    seconds: SECONDS
    """processor time of the work itself, compiled code loaded"""
    startup: SECONDS
    """time to start the jobs, and of those that only start"""
    cores: COUNT
    """cores to share the work"""
    wall_clock: SECONDS
    """(seconds + startup)/cores, or over the jobs if fewer"""
