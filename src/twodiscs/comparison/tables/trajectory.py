"""One trajectory, event by event: trajectory.csv."""

from twodiscs.comparison.tables.base import COUNT, LENGTH, TEXT, TIME, Table


class Trajectory(Table):
    """
    One row per event of one trajectory, in order: the centres of all discs at the event. Along
    periodic axes centres go on beyond the cell.
    """

    time: TIME
    """time of the event"""
    x1: LENGTH
    """disc 1, from the centre of the box"""
    y1: LENGTH
    """disc 1, from the centre of the box"""
    x2: LENGTH
    """disc 2, from the centre of the box"""
    y2: LENGTH
    """disc 2, from the centre of the box"""
    event: TEXT
    """name of the event; a wall hit has the axis of the wall and the disc"""
    z1: LENGTH
    """ball 1; empty in the plane"""
    z2: LENGTH
    """ball 2; empty in the plane"""
    first: COUNT
    """the disc of the event, or the first of two; empty if the event has no disc"""
    second: COUNT
    """the second of the two discs of the event; empty if there is none"""

    @classmethod
    def of(cls, names):
        """Return the table whose columns have these ``names``, which say how many discs it has."""
        discs = sum(name[0] == "x" and name[1:].isdigit() for name in names)
        return cls if cls.columns().keys() >= {*names} else _of_discs(cls, discs)

    @classmethod
    def write(cls, path, rows):
        """Write ``rows``, of two discs or of more, as ``Table.write`` does."""
        rows = list(rows)
        Table.write.__func__(cls.of(rows[0] if rows else ()), path, rows)

    @classmethod
    def read(cls, path):
        """Return the rows of a file, of two discs or of more, as ``Table.read`` does."""
        with open(path, encoding="utf-8", errors="replace") as file:
            names = file.readline().rstrip("\n").split(",")
        return Table.read.__func__(cls.of(names), path)

    @staticmethod
    def rows(box, radius, seed):
        """Return the events of one trajectory in a ``Box``, in order."""
        from twodiscs.dynamics.trajectory import columns, trajectory  # which compiles

        scene = box.scene(radius)
        names = columns(scene.discs)
        return [dict(zip(names, row, strict=True)) for row in trajectory(scene, seed)]


def _of_discs(table, discs):
    """Return the ``table`` with columns for a number of ``discs``."""
    numbers, known, texts = range(1, discs + 1), table.columns(), table.meanings()
    centres = [f"{axis}{disc}" for disc in numbers for axis in "xy"]
    names = ["time", *centres, "event", *(f"z{disc}" for disc in numbers), "first", "second"]
    own = {n: texts[f"{n[0]}1"].replace("1", n[1:]) for n in names if n[0] in "xyz"}
    meanings = {name: texts.get(name) or own[name] for name in names}
    content = {
        "__annotations__": {name: known.get(name, LENGTH) for name in names},
        "__doc__": table.__doc__,
        "meanings": classmethod(lambda cls: meanings),
    }
    return type(table.__name__, (Table,), content)
