"""Every figure of a scene: its title, its caption, the tables that it reads, and its curves.

The functions that draw are in ``figures.draw``. This module imports no matplotlib, because the
Snakefile imports it.
"""

from dataclasses import dataclass, field, replace

from twodiscs.model.effects import EFFECTS
from twodiscs.model.events import HOPS

# A report lists categories in alphabetical order.
GEOMETRY, VOLUMES, DYNAMICS = "1 Geometry", "2 Volume and areas", "3 Mean times and hopping"


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


@dataclass(frozen=True)
class Caption:
    """The text beneath a figure, and sentences that are added for some scenes.

    These are scenes of two ``plain`` discs, those in a ``square``, all ``other`` scenes, scenes of
    ``many`` discs, more than two, and scenes with a ``field`` or a ``periodic`` axis. A caption
    with ``lines`` explains the vertical lines in the figure of these scenes, except plain ones.
    """

    text: str
    plain: str = ""
    square: str = ""
    other: str = ""
    many: str = ""
    field: str = ""
    periodic: str = ""
    lines: bool = False

    def full_text(self, box=None):
        """Return the text for the scenes in a ``Box``, for plain ones if it is None."""
        called = box.options if box else {}
        parts = [self.text, self.other if called else self.plain]
        if self.lines and called:
            parts.append(_name_lines(box))
        parts += [self.square] * bool(box and not called and box.width == box.height)
        parts += [self.many] * ("discs" in called) + [self.field] * ("field" in called)
        parts += [self.periodic] * ("periodic" in called)
        return " ".join(" ".join(parts).split())


@dataclass(frozen=True)
class Figure:
    """A figure: title and category in a report, its ``own`` caption, and its content.

    ``own`` is a ``Caption``, or a text that is the same for all scenes. ``note`` is a caption that
    several figures have in common. ``tables`` are the names of the tables that it reads. ``needs``
    are quantities, named as in theory.csv, or ``hop_histogram`` or ``trajectory``. The figure shows
    those needs that the scene computes, and is made if there is at least one. A drawing needs
    nothing: it takes only the sides of the box, and shows equal discs between walls. A figure over
    the radius has ``curves``. The figure is not made for scenes with an effect in ``without``;
    ``discs`` counts as an effect if there are more than two.

    A figure of a study, of no scene, also reads the ``main_tables`` of the first scene without
    effects, if there are any. ``long_runs`` are the long runs that it reads, {name: path of a table
    from the root of the sources}.
    """

    title: str
    category: str
    own: Caption | str
    note: Caption | None = None
    tables: tuple = ()
    needs: frozenset = frozenset()
    curves: Curves | None = None
    without: frozenset = frozenset()
    main_tables: tuple = ()
    long_runs: dict = field(default_factory=dict)

    def shown_for(self, quantities, effects=()):
        """Return whether a scene that computes the ``quantities`` has the figure.

        ``effects`` are the effects of the scene, if it has any.
        """
        if effects and (not self.needs or not self.without.isdisjoint(effects)):
            return False
        return not self.needs or not self.needs.isdisjoint(quantities)

    def captions(self, box):
        """Return (own caption, note or "") for the scenes in a ``Box``, for plain ones if None."""
        own = Caption(self.own) if isinstance(self.own, str) else self.own
        return own.full_text(box), self.note.full_text(box) if self.note else ""

    def caption(self, box=None):
        """Return the whole caption for the scenes in a ``Box``, for plain ones if it is None."""
        return " ".join(filter(None, self.captions(box)))


# The notes of figures over the radius -------------------------------------------------------------

_RESIDUALS = """Error bars are one standard error; they are hidden if they are smaller than the
symbols. Residuals z beneath are in standard errors, with guide lines at ±2 and ±5."""
_LINES = {
    "plain": """Vertical lines mark the radii at which hops become blocked, h/4 and w/4 as far as
    such discs fit, and the largest radius, r_max.""",
    "many": "If no exact value is known there is no line and no residual.",
    "lines": True,
}

#: {part of a name in mathtext of a vertical line: what the line marks}
_MARKED = {
    "{v}": "r_v, where vertical hops end",
    "{h}": "r_h, where horizontal hops end",
    "{x}": "r_x, from which on disc 1 stays on its side of disc 2 along x",
    "{y}": "r_y, from which on disc 1 stays on its side of disc 2 along y",
    "{t}": "r_t, from which on disc 1 has the energy to reach the top wall",
    "sigma=h/2": "σ = h/2, where σ is the sum of both radii",
    "sigma=w/2": "σ = w/2, where σ is the sum of both radii",
    "{f}": "r_f, beyond which the field allows no scene, although larger discs fit",
    "{max}": "r_max, the largest radius",
}


def _name_lines(box):
    """Return the sentence on the vertical lines of figures over the radius of a ``Box``."""
    from twodiscs.figures.curves import limits  # imports NumPy and more

    names = " ".join(name for _, name in limits(box)).replace(r"\mathrm", "")
    marked = "; ".join(text for part, text in _MARKED.items() if part in names)
    known = " of a known arrangement" * (box.discs > 3)
    which = " The radius r is that of disc 1." * ("radius_ratio" in box.options)
    return f"Vertical lines mark {marked}{known}.{which}"


DYNAMICS_CAPTION = Caption(_RESIDUALS, **_LINES)
SAMPLING_CAPTION = replace(
    DYNAMICS_CAPTION, field="In a field volumes and areas are weighted with the invariant density."
)
SHELL_CAPTION = replace(
    SAMPLING_CAPTION,
    text=f"""{_RESIDUALS} They are taken from the exact expectation of the shell. Its thickness
    shifts the estimate slightly off the line.""",
)


# The figures --------------------------------------------------------------------------------------


def _radius_fields(table, names, label, **options):
    """Return the fields of a figure over the radius, with ``options`` of its ``Curves``."""
    curves = Curves(names, label, **options)
    return {"tables": (table,), "needs": frozenset(names), "curves": curves}


#: The name of the method of a single series.
SAMPLING = "Monte Carlo"

#: {wall: the name of its hits in a legend}
WALL_NAMES = {
    "right_wall": "disc 1, right wall",
    "top_wall": "disc 1, top wall",
    "any_wall": "any disc, any wall",
}


def _hop_area(hop, q):
    """Return the figure of the area of a hop, a change of sign of the separation along ``q``."""
    own = Caption(
        f"""Square root of the area of the surface on which two discs have the same {q}, which they
        cross when they exchange their {hop} order: exact (line) and from a thin shell around it
        (symbols). A symbol at zero means that no sample was in the shell of a blocked hop. If an
        area ends quadratically, its square root ends as a straight line.""",
        many="It is the sum over all pairs of discs.",
    )
    label = rf"root of the hop area, $\sqrt{{S_{{\mathrm{{{hop[0]}}}}}}}$ (length$^{{3/2}}$)"
    names = {f"{hop}_hop_area": f"{hop} hops"}
    curves = _radius_fields("areas", names, label, single=SAMPLING, rooted=True)
    return Figure(f"Area of {hop} hops", VOLUMES, own, SHELL_CAPTION, **curves)


FIGURES = {
    "model": Figure(
        "The billiard",
        GEOMETRY,
        """Two hard discs of radius r in a box of width w and height h. The origin of the
        coordinates is the centre of the box. The centres of the discs stay in the dashed rectangle,
        of half-sides a = w/2 − r and b = h/2 − r. Boxes longer than 4:1 are drawn shorter.""",
    ),
    "hopping_trajectory": Figure(
        "Hopping dynamics",
        DYNAMICS,
        Caption(
            "(a) One trajectory from its beginning. (b) A part of it enlarged.",
            plain="""The ordinate is the separation of the discs along the longer side. Dots mark
            the hops, at which the separation changes sign. A hop is often undone soon, before
            collisions have scrambled the motion. (c) A hop that is not undone soon, where there is
            one, at the same scale.""",
            other="""With two discs the ordinate is their separation in one direction, and dots mark
            its changes of sign, the hops. With more discs it is their positions along the longer
            side, coloured by their order at the start.""",
            periodic="On a periodic axis positions go on beyond the box.",
        ),
        tables=("trajectory",),
        needs=frozenset({"trajectory"}),
    ),
    "configuration_space": Figure(
        "Configuration space",
        GEOMETRY,
        """(a) A prism without a cylinder, whose axis is the diagonal of x1 and x2: the section
        Y = 0, in which one centre is as far above the middle as the other one is below it. Here
        x = (x1 − x2)/√2, X = (x1 + x2)/√2, likewise y and Y, and the discs overlap if x² + y² <
        2r². (b) The whole is a product of two squares, one for x1 and x2 and one for y1 and y2,
        without the overlaps. The dotted band of each square is excluded by the point shown in the
        other one; dashed lines are its widest bounds, at ±√2 r. The hatched quarters, in which all
        four coordinates are positive, hold a sixteenth of the volume. Each square is drawn to its
        own scale.""",
    ),
    "volume": Figure(
        "Volume of configuration space",
        VOLUMES,
        """The volume V of all positions without overlap against the radius of the discs: exact
        (line) and by Monte Carlo sampling (symbols).""",
        SAMPLING_CAPTION,
        **_radius_fields(
            "volume", {"volume": "volume"}, "volume $V$ (length$^4$)", single=SAMPLING
        ),
    ),
    "vertical_hop_area": _hop_area("vertical", "y"),
    "horizontal_hop_area": _hop_area("horizontal", "x"),
    "collision_area": Figure(
        "Area of disc collisions",
        VOLUMES,
        Caption(
            """Area of the surface on which the discs touch: exact (line) and from a thin shell
            outside it (symbols).""",
            many="It is the sum over all pairs of discs.",
        ),
        SHELL_CAPTION,
        **_radius_fields(
            "areas",
            {"disc_collision_area": "disc collisions"},
            r"collision area $S_{\mathrm{coll}}$ (length$^3$)",
            single=SAMPLING,
        ),
    ),
    "wall_area": Figure(
        "Areas of wall hits",
        VOLUMES,
        Caption(
            """Areas of the surfaces on which discs touch walls: exact (lines) and from thin shells
            (symbols).""",
            plain="The area of any wall and any disc is four times the sum of the two others.",
            square="These are the same in a square box.",
        ),
        SHELL_CAPTION,
        **_radius_fields(
            "areas",
            {f"{event}_area": name for event, name in WALL_NAMES.items()},
            "wall area $S$ (length$^3$)",
        ),
    ),
    "all_areas": Figure(
        "Areas of all events",
        VOLUMES,
        """Areas of surfaces in configuration space: exact (lines) and from thin shells (symbols).
        (a) Collisions of the discs. (b) Hits of walls. (c), (d) Square roots of the areas of hops:
        if an area ends quadratically, its root ends as a straight line. A symbol at zero means that
        no sample was in the shell of a blocked hop.""",
        SHELL_CAPTION,
        tables=("areas",),
        needs=frozenset(f"{e}_area" for e in (*HOPS, "disc_collision", "right_wall", "top_wall")),
        without=frozenset({*EFFECTS, "discs"}),
    ),
    "mean_hop_time": Figure(
        "Mean times between hops",
        DYNAMICS,
        Caption(
            """Mean times from one hop to the next: exact (lines) and by event-driven molecular
            dynamics (symbols). Full symbols come from initial states in a strip around the surface
            of the hop, where the flux is measured and not the waiting time. In (b) the same times
            approach the radius r_c at which the hop ends.""",
            plain="""Dashed lines in (a) are the laws for small discs, to first order in r. In (b)
            they are the limiting laws: if a hop becomes blocked before the discs jam, its time
            diverges as (r_c − r)⁻².""",
            square="In a square box both hops have the same mean time.",
            many="Hops are those of any pair of discs. There is no (b) if no exact value is known.",
        ),
        DYNAMICS_CAPTION,
        **_radius_fields(
            "mean_times",
            {"vertical_hop_time": "vertical hops", "horizontal_hop_time": "horizontal hops"},
            r"mean time between hops $\tau$ (length/speed)",
            laws=("small",),
            approach=True,
        ),
    ),
    "mean_collision_time": Figure(
        "Mean time between disc collisions",
        DYNAMICS,
        Caption(
            """Mean time from one collision of the discs to the next: exact (line) and by
            event-driven molecular dynamics (symbols).""",
            plain="""Dashed lines are the first two orders of the law for small discs, which starts
            as 3wh/(8√2 r), and the limiting law below the largest radius.""",
            many="Collisions are those of any pair.",
        ),
        DYNAMICS_CAPTION,
        **_radius_fields(
            "mean_times",
            {"disc_collision_time": "disc collisions"},
            r"mean time $\tau_{\mathrm{coll}}$ (length/speed)",
            single="MD",
            laws=("small", "last"),
        ),
    ),
    "mean_wall_time": Figure(
        "Mean times between wall hits",
        DYNAMICS,
        Caption(
            """Mean times from one hit of a wall to the next: exact (lines) and by event-driven
            molecular dynamics (symbols).""",
            plain="""Times of disc 1 are averages over trajectories that can reach the wall. The
            time of the right wall halves at r = h/4 and that of the top wall at r = w/4:
            configuration space becomes disconnected there, and disc 1 keeps to one side. Dashed
            lines are the laws for small discs and below the largest radius.""",
            square="In a square box both times are the same.",
            other="""Times of disc 1 are averages over trajectories that can reach the wall, with
            more than two discs over all initial conditions. A time halves if disc 1 begins to keep
            to its side.""",
        ),
        DYNAMICS_CAPTION,
        **_radius_fields(
            "mean_times",
            {f"{event}_time": name for event, name in WALL_NAMES.items()},
            r"mean time $\tau$ (length/speed)",
            laws=("small", "last"),
        ),
    ),
    "pressure": Figure(
        "Pressures and virials",
        DYNAMICS,
        Caption(
            """Force of disc 1 on a wall, divided by the force in an ideal gas of one particle
            (dotted): exact (lines) and from the hits that dynamics counted (symbols). Hits transfer
            the same momentum on average at every radius. (b) If the virial theorem of the scene has
            a closed form: the virials of the walls and of the collisions of the discs, divided by
            twice the mean kinetic energy. The sum over the walls minus the virial of collisions is
            one at every radius.""",
            plain="Dashed lines in (a) are the limiting laws below the largest radius.",
        ),
        DYNAMICS_CAPTION,
        tables=("mean_times",),
        needs=frozenset({"right_wall_time", "top_wall_time"}),
        without=frozenset({"field"}),
    ),
    "hop_histogram": Figure(
        "Times between hops",
        DYNAMICS,
        Caption(
            """Density of the time t between successive hops, both in units of the mean time τ,
            which is exact where it is known and else measured. The dashed line is the exponential
            density of the same mean. Bins in (a) widen with t; (b) enlarges short times in equal
            bins. Symbols tell the radii apart; error bars are one standard error.""",
            plain="""Thick dashes on the axis of (b) are the exact densities at t = 0, of hops that
            are undone after one bounce. They are 3√2/16, divided by h − 2r for vertical hops and by
            w − 2r for horizontal ones.""",
            many="Hops are those of any pair of discs.",
        ),
        tables=("hop_histogram",),
        needs=frozenset({"hop_histogram"}),
    ),
    "largest_radius": Figure(
        "The largest radius",
        GEOMETRY,
        """(a) The largest discs that fit the box. They jam along a diagonal, where w − 2r, h − 2r
        and 2r are the sides of a right triangle. If one side of the box is at least twice the
        other, each disc spans the shorter one instead. (b) The hops that are possible in boxes of
        any shape; this box is marked.""",
    ),
    "integration_regimes": Figure(
        "Regimes of the integration",
        GEOMETRY,
        """The separations u = |x1 − x2| and v = |y1 − y2| fill a rectangle of sides A = w − 2r and
        B = h − 2r. The discs overlap in the quarter circle of radius σ = 2r, which is left out. The
        arc is the surface of collisions; the coloured parts of the axes are the surfaces of
        vertical hops (below) and horizontal hops (on the left). If σ exceeds B, horizontal hops are
        blocked; if it exceeds A, vertical hops are. The overlaps are then a sector (hatched) and
        triangles (dotted). Boxes longer than 2.5:1 are drawn shorter.""",
    ),
    "surface_shell": Figure(
        "Shells around surfaces",
        GEOMETRY,
        """The area of a surface is estimated from the samples within a distance ε of it. (a) The
        surface of vertical hops can be crossed from both sides: its shell is 2ε thick, and extends
        √2 ε to either side along y1. (b) The surface of collisions, with x = |x1 − x2|/√2 and
        y = |y1 − y2|/√2, has a shell on its outer side only. Boxes longer than 1.5:1 are drawn
        shorter.""",
    ),
}

#: Not for paper: neither the manuscript nor the rule of figures uses it.
ANIMATION = Figure(
    "The discs, animated",
    DYNAMICS,
    Caption(
        "Two or more discs move in their box. Traces are the latest paths of the centres.",
        plain="""Beneath is the separation of the discs against time. The picture stops at a hop, of
        the rarer kind if there are two, which changes the sign of the separation.""",
        other="""Beneath is the separation of two discs against time; the picture stops at a hop.
        With more discs it is their positions along the longer side, coloured by their order at the
        start. Balls are drawn as viewed along z, the nearer one in front; spins are not shown.""",
        periodic="Discs that leave at a dotted end come in at the opposite one.",
    ),
    tables=("trajectory",),
    needs=frozenset({"trajectory"}),
)
