"""The tables of what each effect does and what it costs."""

from twodiscs.comparison.tables.base import COUNT, LENGTH, NUMBER, TEXT, TIME, Column, Table

AS_EXACT = Column(float, "as exact")


class Effects(Table):
    """One row per scene with effects, radius and quantity, beside discs without effects."""

    scene: TEXT
    """its name; that of its file in config/scenes"""
    width: LENGTH
    height: LENGTH
    effects: TEXT
    """
    all that makes it another scene than the plain one in this box, as a Python dict;
    never_met_share has rows of smooth discs, too
    """
    radius: LENGTH
    """radius of disc 1"""
    quantity: TEXT
    """<event>_time; never_met_share: of starts whose discs have not met within duration"""
    exact: TIME
    """exact mean time; empty where the event is impossible"""
    plain: AS_EXACT
    """
    exact mean time of plain discs of this radius, empty where it does not exist; for
    never_met_share 2[A²(B − 2r)₊⁴ + B²(A − 2r)₊⁴]/(πVt²), to which that of plain discs tends
    """
    estimate: AS_EXACT
    """as in mean_times.csv; for never_met_share count/replicas"""
    stderr: AS_EXACT
    """its standard error; empty when too few to be honest"""
    z: NUMBER
    count: COUNT
    """events counted, or starts that have not met"""
    replicas: COUNT
    """independent trajectories that can see the event"""
    duration: TIME
    """length T of a replica"""
    status: TEXT
    """
    reached, budget, too-few, none-seen, impossible: as in mean_times.csv; sampled: a share with its
    error
    """
    test: TEXT
    starts: TEXT
    """where they come from, as in mean_times.csv"""
    share: NUMBER
    """share of configuration space that starts come from"""
    copies: COUNT
    """events that count as one, as in mean_times.csv"""

    @staticmethod
    def rows(tables, scenes, seed):
        """Return the rows of ``scenes`` (see ``measure.rows``)."""
        from twodiscs_paper.studies.effects import measure

        return list(measure.rows(tables, scenes, seed))


class EffectsCurves(Table):
    """One row per scene with effects, radius and event: the exact curves that the figure shows.

    A row without a radius stands between two regimes, where a curve is broken.
    """

    scene: TEXT
    """its name; that of its file in config/scenes"""
    radius: LENGTH
    """radius of disc 1"""
    event: TEXT
    """the event"""
    ratio: NUMBER
    """
    exact mean time over that of plain discs of this radius in the same sides; empty where one of
    them does not exist
    """

    @staticmethod
    def rows(scenes):
        """Yield the rows of ``scenes``, {name: parameters of a box}."""
        from twodiscs_paper.studies.effects import curves

        yield from curves.rows(scenes)


class EffectsCost(Table):
    """As benchmark.csv, the rows on effects alone, from a short run."""

    benchmark: TEXT
    """what is measured"""
    variant: TEXT
    """
    which engine or method; in effects, which scene of config/scenes, and plain: the scene without
    effects, or plain_walls: with no hops detected
    """
    value: Column(float, "see unit")
    """median over the repetitions"""
    unit: TEXT
    """unit of the value"""
    ratio: NUMBER
    """how many times better than the baseline of the same run"""


class Benchmark(EffectsCost):
    """One row per benchmark and variant, all variants of a benchmark measured in one run."""
