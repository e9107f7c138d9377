"""Every figure of a scene: what it reads, what it takes to be of use, and what it shows.

A figure is a module with a function ``draw(box, tables, **options)`` that returns a matplotlib
figure. Standard library only: the Snakefile imports this.
"""

from dataclasses import dataclass, field

from twodiscs.figures.kit.captions import (
    Sentence,
    Shown,
    along_ring,
    any_row,
    both,
    cross,
    hops_shown,
    in_plane,
    is_judged,
    keeps_side,
    known,
    longer_than,
    marked,
    marked_alone,
    of_many,
    of_two,
    other,
    plain,
    said,
    sentences,
    shows,
    shows_any,
    square,
    walled,
    with_effect,
    with_effects,
)
from twodiscs.figures.kit.limits import ACROSS_X, ACROSS_Y, HORIZONTAL, TOP, VERTICAL
from twodiscs.model.events import HOPS


@dataclass(frozen=True)
class Entry:
    """A figure: its ``title`` and ``category`` in a report, and what the ``caption`` says of it.

    A caption is plain text: a text, or several, each of which may be a ``Sentence`` with a
    condition. ``note`` names what is explained as in other figures, one of ``NOTES``.

    ``module`` is where the figure is drawn, with ``options``. ``tables`` are the names of the
    tables that it reads; ``main_tables`` are those of the first scene without effects that a figure
    of no scene reads where they are. ``needs`` are quantities, named as those of theory.csv or
    ``hop_histogram`` and ``trajectory``: the figure shows whichever of them are watched, and is of
    use if any is. A drawing needs nothing: it takes the sides of the box alone, and shows equal
    discs between walls. ``without`` are effects in which a figure says nothing. Among the effects
    of a scene is ``discs`` if they are more than two.
    """

    title: str
    category: str
    caption: str | tuple
    module: str
    note: str | None = None
    tables: tuple = ()
    main_tables: tuple = ()
    needs: frozenset = field(default_factory=frozenset)
    without: frozenset = field(default_factory=frozenset)
    options: dict = field(default_factory=dict)

    def is_called(self, watched, effects=()):
        """Say whether a scene that watches the quantities ``watched`` calls for the figure.

        ``effects`` are those of the scene, if it has any.
        """
        if effects and (not self.needs or not self.without.isdisjoint(effects)):
            return False
        return not self.needs or not self.needs.isdisjoint(watched)

    def said(self, shown):
        """Return what the caption says of this figure alone, and what it says as others do.

        ``shown`` is a ``Shown``. Marks are explained where they are seen, so by each figure.
        """
        note = NOTES[self.note] if self.note else ()
        own = [*self.caption, *(sentence for sentence in note if sentence.mark)]
        return said(own, shown), said([s for s in note if not s.mark], shown)

    def full_caption(self, shown=None):
        """Return the whole caption of what is ``shown``, or of a plain scene."""
        return " ".join(filter(None, self.said(shown or Shown())))

    def __post_init__(self):
        object.__setattr__(self, "caption", sentences(self.caption))

    @property
    def labels(self):
        """What names the figure in a report, as a dict."""
        return {"figure": self.title}


# A report lists categories by the alphabet.
GEOMETRY, SPACE, DYNAMICS = "1 Geometry", "2 Volume and areas", "3 Mean times and hopping"

SYMBOLS = "Error bars are one standard error, and hidden where smaller than the symbols."


def _in_bursts(row):
    """Say whether no law is known for the counts of a row of mean_times.csv."""
    few = row.get("status") == "too-few"
    return few and "replicas" in row and row["exact"] is not None and row["z"] is None


CROSSES = Sentence(
    "Crosses are estimates from too few events for an error bar.",
    mark=lambda row: row.get("status") == "too-few" and not _in_bursts(row),
)
BURSTS = Sentence(
    """
    Crosses are estimates without an error bar where events come in bursts, of which the largest
    may be yet to come.
    """,
    mark=_in_bursts,
)
ARROWS = Sentence(
    "Arrows start at 95 % lower bounds where no event was seen.",
    mark=lambda row: row.get("bound") is not None,
)
STRIPS = Sentence(
    """
    Full symbols are from starts in a strip around the hop's surface: there the flux is measured,
    and no waiting time.
    """,
    mark=lambda row: row.get("starts") == "strip",
)


def _of_other(name):
    """Return the condition that a line is marked with a ``name`` that plain scenes do not have."""
    return both(other, marked(name))


LINES = (
    Sentence(
        "Vertical lines mark h/4 and w/4, where hops become blocked, and the largest radius.",
        both(plain, marked("h/4", "w/4")),
    ),
    *(
        Sentence(
            f"""
            Vertical lines mark {name}, where {hops} hops become blocked, and the largest radius.
            """,
            both(plain, marked_alone(name)),
        )
        for name, hops in (("h/4", "horizontal"), ("w/4", "vertical"))
    ),
    Sentence("The vertical line marks the largest radius, r_max.", both(other, marked_alone())),
    Sentence(
        "Vertical lines mark the largest radius, r_max, and those at which something changes.",
        both(other, lambda shown: not marked_alone()(shown)),
    ),
    Sentence("Vertical hops end at r_v.", _of_other(VERTICAL)),
    Sentence("Horizontal hops end at r_h.", _of_other(HORIZONTAL)),
    Sentence("From r_x on disc 1 keeps to its side of disc 2 along x.", _of_other(ACROSS_X)),
    Sentence("From r_y on disc 1 keeps to its side of disc 2 along y.", _of_other(ACROSS_Y)),
    Sentence("From r_t on disc 1 has the energy to reach the top wall.", _of_other(TOP)),
    *(
        sentence
        for side, axis, place in (("h/2", "x", "above"), ("w/2", "y", "beside"))
        for sentence in (
            Sentence(
                f"From σ = r1 + r2 = {side} on discs do not pass each other along {axis}.",
                both(_of_other(side), in_plane),
            ),
            Sentence(
                f"From σ = r1 + r2 = {side} on no ball has room straight {place} the other one.",
                both(_of_other(side), with_effect("depth")),
            ),
        )
    ),
    Sentence("The radius r is that of disc 1.", with_effect("radius_ratio")),
    Sentence("The discs are balls.", with_effect("depth")),
    Sentence(
        "Of larger discs no arrangement is known.", lambda shown: shown.effects.get("discs", 2) > 3
    ),
    Sentence(
        "Where no exact value is known there is no line and no residual.",
        both(
            of_many,
            any_row(lambda row: row.get("exact") is None and row.get("estimate") is not None),
        ),
    ),
)
#: What is said of volumes and areas.
WEIGHTED = Sentence(
    "In a field volumes and areas are weighted with the invariant density.", with_effect("field")
)
RESIDUALS = "Residuals z beneath are in standard errors, with guide lines at ±2 and ±5"
JUDGED = any_row(is_judged)

#: What captions of several figures say alike, {name: sentences}.
NOTES = {
    "sampled": sentences((SYMBOLS, CROSSES, *LINES, WEIGHTED, Sentence(f"{RESIDUALS}.", JUDGED))),
    "shells": sentences(
        (
            SYMBOLS,
            CROSSES,
            *LINES,
            WEIGHTED,
            Sentence(
                f"""
                {RESIDUALS}; they are taken against the exact expectation of the shell, whose
                thickness shifts the estimate slightly off the line.
                """,
                JUDGED,
            ),
        )
    ),
    "simulated": sentences(
        (SYMBOLS, CROSSES, BURSTS, ARROWS, *LINES, Sentence(f"{RESIDUALS}.", JUDGED))
    ),
}


def _over_radius(title, category, caption, table, names, **options):
    """Return the entry of quantities ``names``, {quantity: name in the legend}, over the radius."""
    note = options.pop("note")
    return Entry(
        title, category, caption, "twodiscs.figures.radius", note, tables=(table,),
        needs=frozenset(names), options={"names": names, **options},
    )  # fmt: skip


def _hop_area(hop, order, symbol):
    direction, coordinate = order
    return _over_radius(
        f"Area of {direction} hops",
        SPACE,
        (
            Sentence(
                f"""
                Area of the surface {coordinate}1 = {coordinate}2, which is crossed when the discs
                exchange their {direction} order: exact (line) and from a thin shell around it
                (symbols).
                """,
                of_two,
            ),
            Sentence(
                f"""
                Area of the surfaces on which two discs have the same {coordinate}, of all pairs
                together: exact (line) and from thin shells around them (symbols).
                """,
                of_many,
            ),
            Sentence(
                """
                Where the hop is blocked, symbols at zero say that no sample fell into the shell.
                """,
                any_row(lambda row: row["exact"] == 0 and row["hits"] == 0),
            ),
            "The ordinate grows as the square root, so that a quadratic end is straight.",
        ),
        "areas",
        {f"{hop}_area": f"{direction} hops"},
        note="shells",
        label=rf"{direction}-hop area $S_{{\mathrm{{{symbol}}}}}$",
        loc="lower left",
        single="Monte Carlo",
        rooted=True,
    )


WALLS = {
    "right_wall": "disc 1, right wall",
    "top_wall": "disc 1, top wall",
    "any_wall": "any disc, any wall",
}

FIGURES = {
    "model": Entry(
        "The billiard",
        GEOMETRY,
        (
            """
            Two hard discs of radius r in a box of width w and height h. Coordinates start from the
            centre of the box. The centres of the discs keep to the dashed rectangle, of half-sides
            a = w/2 − r and b = h/2 − r.
            """,
            Sentence("Boxes longer than 4:1 are drawn shorter.", longer_than(4)),
        ),
        "twodiscs.figures.geometry.model",
    ),
    "hopping_trajectory": Entry(
        "Hopping dynamics",
        DYNAMICS,
        (
            Sentence(
                """
                (a) One trajectory: the separation of the discs in one direction against time. (b)
                The shaded stretch of time enlarged.
                """,
                of_two,
            ),
            Sentence(
                """
                Dots in (a) and bars in (b) mark the hops, at which it changes sign: a hop is often
                undone soon, before collisions have scrambled the motion.
                """,
                hops_shown,
            ),
            Sentence(
                """
                (a) The beginning of one trajectory: where the discs are along the longer side
                against time, coloured by the order in which they start. (b) The first part of it
                enlarged.
                """,
                of_many,
            ),
            Sentence("Where lines cross, discs hop.", cross),
            Sentence("On the periodic axis places go on beyond the box.", along_ring),
        ),
        "twodiscs.figures.motion.hopping_trajectory",
        tables=("trajectory",),
        needs=frozenset({"trajectory"}),
    ),
    "configuration_space": Entry(
        "Configuration space",
        GEOMETRY,
        """
        Configuration space is a product of two squares, one for x1 and x2 and one for y1 and y2,
        less the overlaps of the discs. With x = (x1 − x2)/√2, X = (x1 + x2)/√2 and likewise y and
        Y, discs overlap if x² + y² < 2r²: the dotted band of each square is what the point shown
        in the other one excludes, and dashed lines are its widest bounds, at ±√2 r. The hatched
        quarters, where all four coordinates are positive, hold a sixteenth of the volume. Each
        square is drawn to a scale of its own.
        """,
        "twodiscs.figures.geometry.configuration_space",
    ),
    "volume": _over_radius(
        "Volume of configuration space",
        SPACE,
        """
        Volume of configuration space against the radius of the discs: exact (line) and by Monte
        Carlo sampling (symbols).
        """,
        "volume",
        {"volume": "volume"},
        note="sampled",
        label="volume $V$",
        loc="lower left",
        single="Monte Carlo",
    ),
    "vertical_hop_area": _hop_area("vertical_hop", ("vertical", "y"), "v"),
    "horizontal_hop_area": _hop_area("horizontal_hop", ("horizontal", "x"), "h"),
    "collision_area": _over_radius(
        "Area of disc collisions",
        SPACE,
        (
            """
            Area of the surface on which the discs touch: exact (line) and from a thin shell outside
            it (symbols).
            """,
            Sentence("It is that of all pairs of discs together.", of_many),
        ),
        "areas",
        {"disc_collision_area": "disc collisions"},
        note="shells",
        label=r"collision area $S_{\mathrm{coll}}$",
        loc="lower left",
        single="Monte Carlo",
    ),
    "wall_area": _over_radius(
        "Areas of wall hits",
        SPACE,
        (
            """
            Areas of the surfaces on which discs touch walls: exact (lines) and from thin shells
            (symbols).
            """,
            Sentence(
                "In a square box the areas of both walls are the same.",
                both(square, shows("right_wall_area", "top_wall_area")),
            ),
            Sentence(
                "The whole is four times the sum of the two others.",
                both(plain, shows(*(f"{event}_area" for event in WALLS))),
            ),
        ),
        "areas",
        {f"{event}_area": name for event, name in WALLS.items()},
        note="shells",
        label="wall area $S$",
        loc="lower left",
    ),
    "mean_hop_time": _over_radius(
        "Mean times between hops",
        DYNAMICS,
        (
            """
            Mean times between successive hops: exact (lines) and by event-driven molecular dynamics
            (symbols).
            """,
            Sentence("In (b) the same times approach the radius r_c at which the hop ends.", known),
            Sentence(
                """
                Dashed lines in (a) are the laws for small discs, to first order in r, and in (b)
                the leading laws: where a hop becomes blocked before the discs jam its time diverges
                as (r_c − r)⁻².
                """,
                plain,
            ),
            Sentence(
                "In a square box both hops have the same mean time.",
                both(square, shows("vertical_hop_time", "horizontal_hop_time")),
            ),
            Sentence("Hops are those of any pair of discs.", of_many),
            STRIPS,
        ),
        "mean_times",
        {"vertical_hop_time": "vertical hops", "horizontal_hop_time": "horizontal hops"},
        note="simulated",
        label=r"mean time between hops $\tau$",
        loc="upper left",
        laws=("small",),
        approach=True,
    ),
    "mean_collision_time": _over_radius(
        "Mean time between disc collisions",
        DYNAMICS,
        (
            """
            Mean time between collisions of the discs: exact (line) and by event-driven molecular
            dynamics (symbols).
            """,
            Sentence("Collisions are those of any pair.", of_many),
            Sentence(
                """
                Dashed lines are the first two orders of the law for small discs, which starts as
                3wh/(8√2 r), and the leading law below the largest radius.
                """,
                plain,
            ),
        ),
        "mean_times",
        {"disc_collision_time": "disc collisions"},
        note="simulated",
        label=r"mean time between collisions $\tau_{\mathrm{coll}}$",
        loc="best",
        single="MD",
        laws=("small", "last"),
    ),
    "mean_wall_time": _over_radius(
        "Mean times between wall hits",
        DYNAMICS,
        (
            """
            Mean times between hits of walls: exact (lines) and by event-driven molecular dynamics
            (symbols).
            """,
            Sentence(
                "Those of disc 1 are over trajectories that can reach the wall.",
                both(of_two, shows_any("right_wall_time", "top_wall_time")),
            ),
            Sentence("Those of disc 1 are averages over all initial conditions.", of_many),
            Sentence(
                "In a square box the mean times of both walls are the same.",
                both(square, shows("right_wall_time", "top_wall_time")),
            ),
            Sentence(
                """
                The mean time of the right wall halves at r = h/4, where configuration space falls
                apart and disc 1 keeps to one side.
                """,
                both(plain, shows("right_wall_time"), marked("h/4")),
            ),
            Sentence(
                """
                The mean time of the top wall halves at r = w/4, where disc 1 begins to keep to one
                side along y.
                """,
                both(plain, shows("top_wall_time"), marked("w/4")),
            ),
            Sentence(
                "Dashed lines are the laws for small discs and below the largest radius.", plain
            ),
            Sentence(
                "The mean time of a wall halves where disc 1 begins to keep to its side.",
                both(with_effects, keeps_side),
            ),
        ),
        "mean_times",
        {f"{event}_time": name for event, name in WALLS.items()},
        note="simulated",
        label=r"mean time between wall hits $\tau$",
        loc="lower left",
        laws=("small", "last"),
    ),
    "pressure": Entry(
        "Pressures and virials",
        DYNAMICS,
        (
            """
            Force of disc 1 on a wall, over that of an ideal gas of one particle (dotted): exact
            (lines) and from the hits that dynamics counted (symbols), each of which hands over the
            same momentum in the mean.
            """,
            Sentence(
                "In a square box both pressures are the same.",
                both(square, shows("right_wall_time", "top_wall_time")),
            ),
            Sentence("Dashed lines in (a) are the leading laws below the largest radius.", plain),
            Sentence(
                """
                (b) The virials of the walls and of the collisions of the discs, over twice the mean
                kinetic energy: those of the walls less that of collisions are one at every radius.
                """,
                walled,
            ),
        ),
        "twodiscs.figures.motion.pressure",
        note="simulated",
        tables=("mean_times",),
        needs=frozenset({"right_wall_time", "top_wall_time"}),
        without=frozenset({"field"}),
    ),
    "hop_histogram": Entry(
        "Times between hops",
        DYNAMICS,
        (
            """
            Density of the time t between successive hops, both in units of the mean time τ; the
            dashed line is the exponential of that mean. Bins in (a) widen with t, and (b) enlarges
            short times in equal bins. Symbols tell the radii apart; error bars are one standard
            error.
            """,
            Sentence("Hops are those of any pair of discs.", of_many),
            Sentence("The mean time is exact.", any_row(lambda row: row["exact_mean"] is not None)),
            Sentence(
                "Where no exact mean time is known it is measured.",
                both(of_many, any_row(lambda row: row["exact_mean"] is None)),
            ),
            Sentence(
                """
                Thick dashes on the axis of (b) are the exact densities at t = 0, of a hop that is
                undone after one bounce: 3√2/16 over h − 2r for vertical hops, over w − 2r for
                horizontal ones.
                """,
                plain,
            ),
        ),
        "twodiscs.figures.motion.hop_histogram",
        tables=("hop_histogram",),
        needs=frozenset({"hop_histogram"}),
    ),
    "largest_radius": Entry(
        "The largest radius",
        GEOMETRY,
        """
        (a) The largest discs that fit the box. They jam along a diagonal, where w − 2r, h − 2r
        and 2r are the sides of a right triangle, unless one side of the box is at least twice the
        other: then each disc spans the shorter one. (b) Which hops are possible in boxes of any
        shape, with this box marked.
        """,
        "twodiscs.figures.geometry.largest_radius",
    ),
    "integration_regimes": Entry(
        "Regimes of the integration",
        GEOMETRY,
        """
        The separations u = |x1 − x2| and v = |y1 − y2| fill a rectangle of sides A = w − 2r and B
        = h − 2r but for the quarter circle of radius σ = 2r in which the discs overlap. The arc
        is the surface of collisions; coloured pieces of the axes are those of vertical hops
        (below) and horizontal hops (on the left). Where σ exceeds B horizontal hops are blocked,
        where it exceeds A vertical ones, and the overlaps are a sector (hatched) and triangles
        (dotted).
        """,
        "twodiscs.figures.geometry.integration_regimes",
    ),
    "surface_shell": Entry(
        "Shells around surfaces",
        GEOMETRY,
        (
            """
            The area of a surface is measured by the samples within a distance ε of it. (a) The
            surface of vertical hops can be crossed from both sides: its shell is 2ε thick, and
            extends √2 ε to either side along y1. (b) The surface of collisions, with x = |x1 −
            x2|/√2 and y = |y1 − y2|/√2, has a shell on its outer side only.
            """,
            Sentence("Boxes longer than 1.8:1 are drawn shorter.", longer_than(1.8)),
        ),
        "twodiscs.figures.geometry.surface_shell",
    ),
}

#: Not a figure for paper, and so none that the manuscript or the rule of figures knows.
ANIMATION = Entry(
    "The discs, animated",
    DYNAMICS,
    (
        Sentence(
            """
            The discs as they move. Traces are the latest paths of the centres. Beneath, the
            separation of the discs against time.
            """,
            of_two,
        ),
        Sentence(
            """
            The picture stops at a hop, of the rarer kind where there are two, which changes the
            sign of the separation.
            """,
            both(of_two, any_row(lambda row: row["event"] in HOPS)),
        ),
        Sentence(
            """
            The discs as they move, coloured by the order in which they start along the longer side.
            Traces are the latest paths of the centres. Beneath, where they are along that side.
            """,
            of_many,
        ),
        Sentence(
            """
            What leaves at a dotted end comes in at the opposite one; beneath, places go on beyond
            the box.
            """,
            along_ring,
        ),
        Sentence(
            "What leaves at a dotted end comes in at the opposite one.", with_effect("periodic")
        ),
        Sentence(
            "Balls are seen along z, so that they may cover each other.", with_effect("depth")
        ),
        Sentence("The spin of rough discs is not shown.", with_effect("moment_of_inertia")),
    ),
    "twodiscs.figures.motion.animation",
    tables=("trajectory",),
    needs=frozenset({"trajectory"}),
)
