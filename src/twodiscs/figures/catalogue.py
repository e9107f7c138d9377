"""Every figure of a scene: its name, its module, the tables that it reads and its conditions.

A figure is a module with two functions: ``draw(box, tables, **options)`` returns a matplotlib
figure, and ``caption(shown)`` the text beneath it. This module needs the standard library only,
because the Snakefile imports it; it imports no module that draws.
"""

from dataclasses import dataclass, field
from importlib import import_module


@dataclass(frozen=True)
class Entry:
    """A figure: its ``title`` and ``category`` in a report, and the ``module`` that draws it.

    ``options`` are passed to the functions of the module. ``note`` names the common text of several
    captions, one of ``figures.kit.captions.NOTES``. ``tables`` are the names of the tables that the
    figure reads. A figure of no scene also reads the ``main_tables`` of the first scene without
    effects, if there are any. ``needs`` are quantities, named as in theory.csv, or
    ``hop_histogram`` or ``trajectory``. The figure shows the ones that the scene computes, and is
    made if there is at least one. A drawing needs nothing: it takes only the sides of the box, and
    shows equal discs between walls. The figure is not made for scenes with an effect in
    ``without``; ``discs`` counts as an effect if there are more than two.
    """

    title: str
    category: str
    module: str
    note: str | None = None
    tables: tuple = ()
    main_tables: tuple = ()
    needs: frozenset = field(default_factory=frozenset)
    without: frozenset = field(default_factory=frozenset)
    options: dict = field(default_factory=dict)

    def is_called(self, quantities, effects=()):
        """Return whether a scene that computes the ``quantities`` has the figure.

        ``effects`` are the effects of the scene, if it has any.
        """
        if effects and (not self.needs or not self.without.isdisjoint(effects)):
            return False
        return not self.needs or not self.needs.isdisjoint(quantities)

    def caption_parts(self, shown):
        """Return the caption of this figure, and the text that it has in common with others.

        ``shown`` is a ``Shown``. The first text also explains the symbols.
        """
        from twodiscs.figures.kit.captions import NOTES, symbols

        own = import_module(self.module).caption(shown, **self.options)
        note = NOTES[self.note](shown) if self.note else ""
        own += symbols(shown, self.note) if self.note else ""
        return " ".join(own.split()), " ".join(note.split())

    def caption(self, shown=None):
        """Return the whole caption for a ``Shown``, or for a plain scene.

        This imports the module that draws.
        """
        from twodiscs.figures.kit.captions import Shown

        return " ".join(filter(None, self.caption_parts(shown or Shown())))

    @property
    def labels(self):
        """The labels of the figure in a report, as a dict."""
        return {"figure": self.title}


# A report lists categories in alphabetical order.
GEOMETRY, SPACE, DYNAMICS = "1 Geometry", "2 Volume and areas", "3 Mean times and hopping"


def _sampled(title, module, table, *quantities, note="shells", **options):
    """Return the entry of a figure of ``quantities`` of a ``table`` over the radius."""
    return Entry(
        title, SPACE, f"twodiscs.figures.radius.{module}", note, tables=(table,),
        needs=frozenset(quantities), options=options,
    )  # fmt: skip


def _mean_times(title, module, *quantities, **more):
    """Return the entry of a figure of mean times over the radius."""
    return Entry(
        title, DYNAMICS, f"twodiscs.figures.{module}", "simulated", tables=("mean_times",),
        needs=frozenset(quantities), **more,
    )  # fmt: skip


FIGURES = {
    "model": Entry("The billiard", GEOMETRY, "twodiscs.figures.geometry.model"),
    "hopping_trajectory": Entry(
        "Hopping dynamics",
        DYNAMICS,
        "twodiscs.figures.motion.hopping_trajectory",
        tables=("trajectory",),
        needs=frozenset({"trajectory"}),
    ),
    "configuration_space": Entry(
        "Configuration space", GEOMETRY, "twodiscs.figures.geometry.configuration_space"
    ),
    "volume": _sampled(
        "Volume of configuration space", "volume", "volume", "volume", note="sampled"
    ),
    "vertical_hop_area": _sampled(
        "Area of vertical hops", "hop_area", "areas", "vertical_hop_area", hop="vertical_hop"
    ),
    "horizontal_hop_area": _sampled(
        "Area of horizontal hops", "hop_area", "areas", "horizontal_hop_area", hop="horizontal_hop"
    ),
    "collision_area": _sampled(
        "Area of disc collisions", "collision_area", "areas", "disc_collision_area"
    ),
    "wall_area": _sampled(
        "Areas of wall hits", "wall_area", "areas",
        "right_wall_area", "top_wall_area", "any_wall_area",
    ),
    "mean_hop_time": _mean_times(
        "Mean times between hops", "radius.hop_time", "vertical_hop_time", "horizontal_hop_time"
    ),
    "mean_collision_time": _mean_times(
        "Mean time between disc collisions", "radius.collision_time", "disc_collision_time"
    ),
    "mean_wall_time": _mean_times(
        "Mean times between wall hits", "radius.wall_time",
        "right_wall_time", "top_wall_time", "any_wall_time",
    ),
    "pressure": _mean_times(
        "Pressures and virials", "motion.pressure", "right_wall_time", "top_wall_time",
        without=frozenset({"field"}),
    ),
    "hop_histogram": Entry(
        "Times between hops",
        DYNAMICS,
        "twodiscs.figures.motion.hop_histogram",
        tables=("hop_histogram",),
        needs=frozenset({"hop_histogram"}),
    ),
    "largest_radius": Entry(
        "The largest radius", GEOMETRY, "twodiscs.figures.geometry.largest_radius"
    ),
    "integration_regimes": Entry(
        "Regimes of the integration", GEOMETRY, "twodiscs.figures.geometry.integration_regimes"
    ),
    "surface_shell": Entry(
        "Shells around surfaces", GEOMETRY, "twodiscs.figures.geometry.surface_shell"
    ),
}  # fmt: skip

#: Not for paper: neither the manuscript nor the rule of figures uses it.
ANIMATION = Entry(
    "The discs, animated",
    DYNAMICS,
    "twodiscs.figures.motion.animation",
    tables=("trajectory",),
    needs=frozenset({"trajectory"}),
)
