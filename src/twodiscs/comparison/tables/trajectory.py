"""One trajectory, event by event: trajectory.csv."""

from twodiscs.comparison.tables.base import LENGTH, TEXT, TIME, Table


class Trajectory(Table):
    """One row an event of one trajectory, in order: the state at the event."""

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

    @staticmethod
    def rows(box, radius, seed):
        """Return the events of one trajectory in a ``Box``, in order."""
        from twodiscs.dynamics.trajectory import COLUMNS, trajectory  # which compiles

        return [dict(zip(COLUMNS, row, strict=True)) for row in trajectory(box.scene(radius), seed)]
