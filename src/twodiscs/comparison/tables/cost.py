"""The seconds of jobs: cost.csv."""

from twodiscs.comparison.tables.base import COUNT, RADIUS, SECONDS, TEXT, Table, by_radius

#: The number of events in the points of a stage.
WORK = {"monte_carlo": "samples", "dynamics": "events", "intervals": "intervals"}


class Cost(Table):
    """One row per job: its time and work. It is the only table of a scene that no run repeats."""

    columns = {
        "stage": TEXT("monte_carlo, dynamics or intervals"),
        "radius": RADIUS,
        "events": COUNT("events simulated, configurations or intervals drawn"),
        "seconds": SECONDS("processor time of the job and of its shards; empty if it is not known"),
    }

    @staticmethod
    def rows(points, seconds):
        """Return the rows of the jobs by stage and radius.

        ``points`` is {stage: [point, …]}; ``seconds`` is {(stage, radius): time}, as far as known.
        """
        return [
            {
                "stage": stage,
                "radius": point.radius,
                "events": getattr(point, WORK[stage]),
                "seconds": seconds.get((stage, point.radius)),
            }
            for stage in sorted(points)
            for point in by_radius(points[stage])
        ]
