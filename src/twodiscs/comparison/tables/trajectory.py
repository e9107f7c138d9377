"""One trajectory, event by event: trajectory.csv."""

from twodiscs.comparison.tables.base import COUNT, LENGTH, TEXT, TIME, Table


def _columns(discs):
    """Return the columns for a number of ``discs``."""
    numbers = range(1, discs + 1)
    return {
        "time": TIME("time of the event"),
        **{
            f"{axis}{disc}": LENGTH(f"disc {disc}, from the centre of the box")
            for disc in numbers
            for axis in "xy"
        },
        "event": TEXT("name of the event; a wall hit has the axis of the wall and the disc"),
        **{f"z{disc}": LENGTH(f"ball {disc}; empty in the plane") for disc in numbers},
        "first": COUNT(
            "the disc of the event, or the first of two; empty if the event has no disc"
        ),
        "second": COUNT("the second of the two discs of the event; empty if there is none"),
    }


class Trajectory(Table):
    """
    One row per event of one trajectory, in order: the centres of all discs at the event. Along
    periodic axes centres go on beyond the cell.
    """

    columns = _columns(2)

    @classmethod
    def columns_of(cls, names):
        """Return the columns; their ``names`` say how many discs there are."""
        discs = sum(name[0] == "x" and name[1:].isdigit() for name in names)
        return _columns(max(discs, 2))

    @staticmethod
    def rows(box, radius, seed):
        """Return the events of one trajectory in a ``Box``, in order."""
        from twodiscs.dynamics.trajectory import columns, trajectory  # which compiles

        scene = box.scene(radius)
        names = columns(scene.discs)
        return [dict(zip(names, row, strict=True)) for row in trajectory(scene, seed)]
