"""Every figure of a scene: the tables that it reads, its conditions, and its curves.

The functions that draw are in ``figures.draw``. This module needs the standard library only,
because the Snakefile imports it.
"""

from dataclasses import dataclass

from twodiscs.model.effects import EFFECTS
from twodiscs.model.events import HOPS


@dataclass(frozen=True)
class Curves:
    """A figure of quantities over the radius.

    ``names`` maps the quantities, as theory.csv names them, to their names in the legend; the ones
    in the table are drawn. ``label`` is that of the ordinate. It is logarithmic; if ``rooted``,
    square roots are drawn instead, from zero on. ``single`` is the name of the method if there is
    only one series. ``laws`` are limiting laws of plain scenes, "small" and "last". With
    ``approach`` a panel beneath shows times over the distance from the radius where they end.
    ``looks`` maps quantities to (colour, marker).
    """

    names: dict
    label: str
    single: str | None = None
    rooted: bool = False
    laws: tuple = ()
    approach: bool = False
    looks: dict | None = None


@dataclass(frozen=True, kw_only=True)
class Content:
    """The content of a figure.

    ``tables`` are the names of the tables that it reads. ``needs`` are quantities, named as in
    theory.csv, or ``hop_histogram`` or ``trajectory``. A figure over the radius has ``curves``. The
    figure shows those needs that the scene computes, and is made if there is at least one. A
    drawing needs nothing: it takes only the sides of the box, and shows equal discs between walls.
    The figure is not made for scenes with an effect in ``without``; ``discs`` counts as an effect
    if there are more than two.
    """

    tables: tuple = ()
    needs: frozenset = frozenset()
    curves: Curves | None = None
    without: frozenset = frozenset()

    def is_called(self, quantities, effects=()):
        """Return whether a scene that computes the ``quantities`` has the figure.

        ``effects`` are the effects of the scene, if it has any.
        """
        if effects and (not self.needs or not self.without.isdisjoint(effects)):
            return False
        return not self.needs or not self.needs.isdisjoint(quantities)


def _over_radius(table, names, label, **options):
    """Return the content of a figure over the radius, with ``options`` of its ``Curves``."""
    curves = Curves(names, label, **options)
    return Content(tables=(table,), needs=frozenset(names), curves=curves)


def _hop_area(hop):
    label = rf"root of the {hop}-hop area, $\sqrt{{S_{{\mathrm{{{hop[0]}}}}}}}$"
    names = {f"{hop}_hop_area": f"{hop} hops"}
    return _over_radius("areas", names, label, single=SAMPLING, rooted=True)


#: The name of the method of a single series.
SAMPLING = "Monte Carlo"

#: {wall: the name of its hits in a legend}
WALL_NAMES = {
    "right_wall": "disc 1, right wall",
    "top_wall": "disc 1, top wall",
    "any_wall": "any disc, any wall",
}

FIGURES = {
    "model": Content(),
    "hopping_trajectory": Content(tables=("trajectory",), needs=frozenset({"trajectory"})),
    "configuration_space": Content(),
    "volume": _over_radius("volume", {"volume": "volume"}, "volume $V$", single=SAMPLING),
    "vertical_hop_area": _hop_area("vertical"),
    "horizontal_hop_area": _hop_area("horizontal"),
    "collision_area": _over_radius(
        "areas",
        {"disc_collision_area": "disc collisions"},
        r"collision area $S_{\mathrm{coll}}$",
        single=SAMPLING,
    ),
    "wall_area": _over_radius(
        "areas", {f"{event}_area": name for event, name in WALL_NAMES.items()}, "wall area $S$"
    ),
    "all_areas": Content(
        tables=("areas",),
        needs=frozenset(f"{e}_area" for e in (*HOPS, "disc_collision", "right_wall", "top_wall")),
        without=frozenset({*EFFECTS, "discs"}),
    ),
    "mean_hop_time": _over_radius(
        "mean_times",
        {"vertical_hop_time": "vertical hops", "horizontal_hop_time": "horizontal hops"},
        r"mean time between hops $\tau$",
        laws=("small",),
        approach=True,
    ),
    "mean_collision_time": _over_radius(
        "mean_times",
        {"disc_collision_time": "disc collisions"},
        r"mean time between collisions $\tau_{\mathrm{coll}}$",
        single="MD",
        laws=("small", "last"),
    ),
    "mean_wall_time": _over_radius(
        "mean_times",
        {f"{event}_time": name for event, name in WALL_NAMES.items()},
        r"mean time between wall hits $\tau$",
        laws=("small", "last"),
    ),
    "pressure": Content(
        tables=("mean_times",),
        needs=frozenset({"right_wall_time", "top_wall_time"}),
        without=frozenset({"field"}),
    ),
    "hop_histogram": Content(tables=("hop_histogram",), needs=frozenset({"hop_histogram"})),
    "largest_radius": Content(),
    "integration_regimes": Content(),
    "surface_shell": Content(),
}
