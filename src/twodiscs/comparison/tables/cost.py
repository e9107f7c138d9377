"""The seconds of jobs, measured and forecast: cost.csv and forecast.csv."""

from twodiscs.comparison.tables.base import COUNT, LENGTH, NUMBER, RADIUS, SECONDS, TEXT, Table
from twodiscs.points.base import by_radius

#: The number of events in the points of a stage.
WORK = {"monte_carlo": "samples", "dynamics": "events", "intervals": "intervals"}


class Cost(Table):
    """One row per job: its time and work. It is the only table of a scene that no run repeats."""

    columns = {
        "stage": TEXT("monte_carlo, dynamics or intervals; total: all jobs with a forecast"),
        "radius": RADIUS,
        "events": COUNT("events simulated, configurations or intervals drawn"),
        "seconds": SECONDS("processor time of the job and of its shards; empty if it is not known"),
        "forecast_seconds": SECONDS(
            "forecast of the processor time, made before the run; empty without a forecast"
        ),
        "ratio": NUMBER("seconds/forecast_seconds"),
    }

    @staticmethod
    def rows(points, seconds, forecast):
        """Return the rows of the jobs by stage and radius.

        ``points`` is {stage: [point, …]}; ``seconds`` and ``forecast`` are {(stage, radius): time},
        as far as they are known. The last row is the total of the jobs with a forecast, if any.
        """
        jobs = [(stage, p) for stage in sorted(points) for p in by_radius(points[stage])]
        rows = []
        for stage, point in jobs:
            job, events = (stage, point.radius), getattr(point, WORK[stage])
            rows.append(_row(*job, events, seconds.get(job), forecast.get(job)))
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
    """One row per scene and stage: the time that the configuration needs on this machine."""

    columns = {
        "scene": TEXT("the scene; all: files of no single scene, and the total"),
        "stage": TEXT(
            "of a scene: monte_carlo, dynamics, intervals, tables, figures, total; of all: "
            "compile and the names in the key shared, most of them as round figures, and the "
            "total"
        ),
        "radius": LENGTH("radius of one job; empty for the sum over a stage"),
        "jobs": COUNT("number of jobs"),
        "events": COUNT("wall and disc events, samples, or intervals"),
        "seconds": SECONDS("processor time of the work itself, after compiled code is loaded"),
        "startup": SECONDS("processor time to start the jobs"),
        "cores": COUNT("cores that work"),
        "wall_clock": SECONDS("(seconds + startup)/cores, or over the jobs if fewer"),
    }
