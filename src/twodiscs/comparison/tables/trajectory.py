"""One trajectory, event by event: trajectory.csv."""

from twodiscs.comparison.tables.base import COUNT, LENGTH, TEXT, TIME, Table


class Trajectory(Table):
    """
    One row an event of one trajectory, in order: the state at the event. More than two discs have x
    and y of each, and then first and second, the discs that the event is of.
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
    """what happens"""
    z1: LENGTH
    """ball 1; empty in the plane"""
    z2: LENGTH
    """ball 2; empty in the plane"""

    @classmethod
    def of(cls, names):
        """Return the table whose columns have these ``names``: of more discs, where they are more.

        It has x1, y1, …, xN, yN, and ``first`` and ``second``, the discs that the event is of.
        """
        if "first" not in names:
            return cls
        kinds = {"time": TIME, "event": TEXT, "first": COUNT, "second": COUNT}
        texts = cls.meanings() | {
            n: f"the {n} disc that the event is of" for n in ("first", "second")
        }
        meanings = {n: texts.get(n, f"disc {n[1:]}, from the centre of the box") for n in names}
        content = {
            "__annotations__": {name: kinds.get(name, LENGTH) for name in names},
            "__doc__": cls.__doc__,
            "meanings": classmethod(lambda table: meanings),
        }
        return type(cls.__name__, (Table,), content)

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
        names = columns(scene)
        return [dict(zip(names, row, strict=True)) for row in trajectory(scene, seed)]
