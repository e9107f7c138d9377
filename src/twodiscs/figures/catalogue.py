"""Every figure of a scene: what it reads, what it takes to be of use, and what it shows.

A figure is a module with a function ``draw(box, tables, **options)`` that returns a matplotlib
figure. Standard library only: the Snakefile imports this.
"""

from dataclasses import dataclass, field

from twodiscs.figures.kit.captions import (
    Sentence,
    Shown,
    longer_than,
    of_many,
    of_two,
    on_ring,
    plain,
    plain_square,
    said,
    sentences,
    with_effect,
    with_effects,
)


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

    def full_caption(self, effects=()):
        """Return all that may be said of the figure in a scene with ``effects`` or without."""
        return " ".join(filter(None, self.said(Shown(effects))))

    def __post_init__(self):
        object.__setattr__(self, "caption", sentences(self.caption))

    @property
    def labels(self):
        """What names the figure in a report, as a dict."""
        return {"figure": self.title}


# A report lists categories by the alphabet.
GEOMETRY, SPACE, DYNAMICS = "1 Geometry", "2 Volume and areas", "3 Mean times and hopping"

SYMBOLS = "Error bars are one standard error, and hidden where smaller than the symbols."
CROSSES = Sentence(
    "Crosses are estimates from too few events for an error bar.",
    mark=lambda row: row.get("status") == "too-few",
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
LINES = (
    Sentence(
        "Vertical lines mark h/4 and w/4, where hops become blocked, and the largest radius.", plain
    ),
    Sentence(
        """
        Vertical lines mark the largest radius of disc 1 and, where they are named, radii at which
        the scene changes before: vertical hops end at r_v and horizontal ones at r_h, and from r_x
        or r_y on disc 1 keeps to its side.
        """,
        with_effects,
    ),
    Sentence(
        "Discs with σ = r1 + r2 of half a side do not pass each other along a periodic axis.",
        with_effect("periodic"),
    ),
    Sentence(
        """
        From r_t on discs reach the top wall. In a field volumes and areas are weighted with the
        invariant density.
        """,
        with_effect("field"),
    ),
    Sentence(
        """
        Vertical lines mark where vertical hops (r_v) and horizontal ones (r_h) of any pair of discs
        are excluded, and the largest radius at which an arrangement is known. A hit of a wall is
        that of one disc, averaged over all initial conditions. Where no exact value is known there
        is no line, and no residual.
        """,
        of_many,
    ),
)
RESIDUALS = "Residuals z beneath are in standard errors, with guide lines at ±2 and ±5"

#: What captions of several figures say alike, {name: sentences}.
NOTES = {
    "sampled": sentences((SYMBOLS, CROSSES, *LINES, f"{RESIDUALS}.")),
    "shells": sentences(
        (
            SYMBOLS,
            CROSSES,
            *LINES,
            f"""
            {RESIDUALS}; they are taken against the exact expectation of the shell, whose thickness
            shifts the estimate slightly off the line.
            """,
        )
    ),
    "simulated": sentences((SYMBOLS, CROSSES, ARROWS, *LINES, f"{RESIDUALS}.")),
}


def _over_radius(title, category, caption, table, names, **options):
    """Return the entry of quantities ``names``, {quantity: name in the legend}, over the radius."""
    note = options.pop("note")
    return Entry(
        title, category, caption, "figures.radius", note, tables=(table,), needs=frozenset(names),
        options={"names": names, **options},
    )  # fmt: skip


def _hop_area(hop, order, symbol):
    direction, coordinate = order
    return _over_radius(
        f"Area of {direction} hops",
        SPACE,
        f"""
        Area of the surface {coordinate}1 = {coordinate}2, which is crossed when the discs exchange
        their {direction} order: exact (line) and from a thin shell around it (symbols). Where the
        hop is blocked, symbols at zero say that no sample fell into the shell. The ordinate grows
        as the square root, so that a quadratic end is straight.
        """,
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
        "figures.geometry.model",
    ),
    "hopping_trajectory": Entry(
        "Hopping dynamics",
        DYNAMICS,
        (
            Sentence(
                """
                (a) One trajectory: the separation of the discs in one direction against time. Dots
                mark the hops, at which it changes sign. (b) The shaded stretch of time enlarged,
                with a bar for each hop: a hop is often undone soon, before collisions have
                scrambled the motion.
                """,
                of_two,
            ),
            Sentence(
                """
                (a) One trajectory: where all discs are along the longer side against time, coloured
                by the order in which they start. Lines that cross are hops. (b) The beginning,
                enlarged.
                """,
                of_many,
            ),
            Sentence("On the periodic axis places go on beyond the box.", on_ring),
        ),
        "figures.motion.hopping_trajectory",
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
        "figures.geometry.configuration_space",
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
        """
        Area of the surface on which the discs touch: exact (line) and from a thin shell outside
        it (symbols).
        """,
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
            Areas of the surfaces on which disc 1 touches the right or the top wall, and of all such
            surfaces of both discs together: exact (lines) and from thin shells (symbols).
            """,
            Sentence("The whole is four times the sum of the first two.", plain),
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
            (symbols). In (b) the same times approach the radius r_c at which the hop ends.
            """,
            Sentence(
                """
                Dashed lines in (a) are the laws for small discs, to first order in r, and in (b)
                the leading laws: where a hop becomes blocked before the discs jam its time diverges
                as (r_c − r)⁻².
                """,
                plain,
            ),
            Sentence("In a square box both hops have the same mean time.", plain_square),
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
            Mean times between hits of disc 1 on the right wall and on the top wall, over
            trajectories that can reach it, and between hits of any disc on any wall: exact (lines)
            and by event-driven molecular dynamics (symbols).
            """,
            Sentence(
                """
                The first halves at r = h/4 and the second at w/4, where configuration space falls
                apart and disc 1 keeps to one side. Dashed lines are the laws for small discs and
                below the largest radius.
                """,
                plain,
            ),
            Sentence("The mean time halves where disc 1 begins to keep to one side.", with_effects),
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
            Force of disc 1 on the right and the top wall, over that of an ideal gas of one particle
            (dotted): exact (lines) and from the hits that dynamics counted (symbols), each of which
            hands over the same momentum in the mean.
            """,
            Sentence(
                """
                Dashed lines in (a) are the leading laws below the largest radius. (b) The virials
                of the walls and of the collisions of the discs, over twice the mean kinetic energy:
                those of the walls less that of collisions are one at every radius.
                """,
                plain,
            ),
        ),
        "figures.motion.pressure",
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
            Density of the time t between successive hops for several radii, both in units of the
            exact mean time τ; the dashed line is the exponential of that mean. Bins in (a) widen
            with t, and (b) enlarges short times in equal bins. Symbols tell the radii apart; error
            bars are one standard error.
            """,
            Sentence("Hops are those of any pair; τ is measured where it is not known.", of_many),
            Sentence(
                """
                Thick dashes on the axis of (b) are the exact densities at t = 0, of a hop that is
                undone after one bounce: 3√2/16 over h − 2r for vertical hops, over w − 2r for
                horizontal ones.
                """,
                plain,
            ),
        ),
        "figures.motion.hop_histogram",
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
        "figures.geometry.largest_radius",
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
        "figures.geometry.integration_regimes",
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
        "figures.geometry.surface_shell",
    ),
}

#: Not a figure for paper, and so none that the manuscript or the rule of figures knows.
ANIMATION = Entry(
    "The two discs, animated",
    DYNAMICS,
    (
        Sentence(
            """
            The discs as they move, before and after a hop, of the rarer kind where there are two.
            Traces are the latest paths of the centres, and the picture stops at the moment of the
            hop. Beneath, the separation of the discs against time: the hop changes its sign.
            """,
            of_two,
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
            on_ring,
        ),
        Sentence(
            "What leaves at a dotted end comes in at the opposite one.", with_effect("periodic")
        ),
        Sentence(
            "Balls are seen along z, so that they may cover each other.", with_effect("depth")
        ),
        Sentence("The spin of rough discs is not shown.", with_effect("moment_of_inertia")),
    ),
    "figures.motion.animation",
    tables=("trajectory",),
    needs=frozenset({"trajectory"}),
)
