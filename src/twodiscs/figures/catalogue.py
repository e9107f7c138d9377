"""Every figure of a scene: what it reads, what it takes to be of use, and what it shows.

A figure is a module of this package with the same name and a function ``draw(scene, tables)``;
another one needs such a module and an entry here. Standard library only: the Snakefile imports it.
"""

from dataclasses import dataclass, field


@dataclass(frozen=True)
class Entry:
    """A figure: ``caption`` in plain text, ``category`` and ``title`` for a report.

    ``tables`` are the names of the tables that it reads. ``needs`` are quantities, named as those
    of theory.csv or ``hop_histogram`` and ``trajectory``: the figure shows whichever of them are
    watched, and is of use if any is. A drawing needs nothing: it takes the sides of the box alone,
    and shows equal discs between walls. ``of_plain`` figures are for such scenes only.
    """

    title: str
    category: str
    caption: str
    tables: tuple = ()
    needs: frozenset = field(default_factory=frozenset)
    of_plain: bool = False

    def is_called(self, watched, effects=()):
        """Say whether a scene that watches the quantities ``watched`` calls for the figure.

        ``effects`` are those of the scene, if it has any.
        """
        if effects and (self.of_plain or not self.needs):
            return False
        return not self.needs or not self.needs.isdisjoint(watched)

    def caption_with(self, effects):
        """Return the caption in a scene with ``effects``, or without any."""
        caption = self.caption
        for plain, instead in WITH_EFFECTS.items() if effects else ():
            caption = caption.replace(f" {plain}", f" {instead}" if instead else "")
        return caption

    @property
    def labels(self):
        """What names the figure in a report, as a dict."""
        return {"figure": self.title}


# A report lists categories by the alphabet.
GEOMETRY, SPACE, DYNAMICS = "1 Geometry", "2 Volume and areas", "3 Mean times and hopping"

SYMBOLS = (
    "Error bars are one standard error, and hidden where smaller than the symbols; crosses are "
    "estimates from too few events to give one."
)

#: What captions say of scenes without effects only.
LINES = "Vertical lines mark h/4 and w/4, where hops become blocked, and the largest radius."
WHOLE = "The whole is four times the sum of the first two."
HOP_LAWS = (
    "Dashed lines in (a) are the laws for small discs, to first order in r, and in (b) the leading "
    "laws: where a hop becomes blocked before the discs jam its time diverges as (r_c − r)⁻². In a "
    "square box both hops have the same mean time."
)
COLLISION_LAWS = (
    "Dashed lines are the first two orders of the law for small discs, which starts as "
    "3wh/(8√2 r), and the leading law below the largest radius."
)
WALL_LAWS = (
    "The first halves at r = h/4 and the second at w/4, where configuration space falls apart and "
    "disc 1 keeps to one side. Dashed lines are the laws for small discs and below the largest "
    "radius."
)
DASHES = (
    "Thick dashes on the axis of (b) are the exact densities at t = 0, of a hop that is undone "
    "after one bounce: 3√2/16 over h − 2r for vertical hops, over w − 2r for horizontal ones."
)

#: What stands in their place where there are effects.
WITH_EFFECTS = {
    LINES: "Vertical lines mark the largest radius of disc 1 and where the scene changes before: "
    "vertical hops end at r_v and horizontal ones at r_h; from r_t on discs reach the top wall, "
    "and from r_x or r_y on disc 1 keeps to its side; discs with σ = r1 + r2 of half a side do not "
    "pass each other in a channel or on a torus. In a field volumes and areas are weighted with "
    "the invariant density.",
    WHOLE: "",
    HOP_LAWS: "",
    COLLISION_LAWS: "",
    WALL_LAWS: "The mean time halves where disc 1 begins to keep to one side.",
    DASHES: "",
}

LIMITS = f"{LINES} Residuals z beneath are in standard errors, with guide lines at ±2 and ±5"

SAMPLED = f"{SYMBOLS} {LIMITS}."

SHELLS = (
    f"{SYMBOLS} {LIMITS}; they are taken against the exact expectation of the shell, whose "
    "thickness shifts the estimate slightly off the line."
)

SIMULATED = f"{SYMBOLS} Arrows start at 95 % lower bounds where no event was seen. {LIMITS}."


def _area(title, event, caption):
    return Entry(title, SPACE, f"{caption} {SHELLS}", ("areas",), frozenset({f"{event}_area"}))


def _walls(kind):
    return frozenset(f"{event}_{kind}" for event in ("right_wall", "top_wall", "any_wall"))


FIGURES = {
    "model": Entry(
        "The billiard",
        GEOMETRY,
        "Two hard discs of radius r in a box of width w and height h. Coordinates start from "
        "the centre of the box. The centres of the discs keep to the dashed rectangle, of "
        "half-sides a = w/2 − r and b = h/2 − r. Drawings shorten boxes longer than four to one.",
    ),
    "hopping_trajectory": Entry(
        "Hopping dynamics",
        DYNAMICS,
        "One trajectory: the separation of the discs along the longer side of the box that ends "
        "at walls (x in a square) against time. Dots mark the hops, at which it changes sign. (b) "
        "The shaded stretch of time enlarged: a hop is often undone soon, before collisions have "
        "scrambled the motion.",
        ("trajectory",),
        frozenset({"trajectory"}),
    ),
    "configuration_space": Entry(
        "Configuration space",
        GEOMETRY,
        "Configuration space is a product of two squares, one for x1 and x2 and one for y1 and "
        "y2, less the overlaps of the discs. With x = (x1 − x2)/√2, X = (x1 + x2)/√2 and "
        "likewise y and Y, discs overlap if x² + y² < 2r²: the dotted band of each square is "
        "what the point shown in the other one excludes, and dashed lines are its widest "
        "bounds, at ±√2 r. The hatched quarters, where all four coordinates are positive, hold "
        "a sixteenth of the volume. Each square is drawn to a scale of its own.",
    ),
    "volume": Entry(
        "Volume of configuration space",
        SPACE,
        "Volume of configuration space against the radius of the discs: exact (line) and by "
        f"Monte Carlo sampling (symbols). {SAMPLED}",
        ("volume",),
        frozenset({"volume"}),
    ),
    "vertical_hop_area": _area(
        "Area of vertical hops",
        "vertical_hop",
        "Area of the surface y1 = y2, which is crossed when the discs exchange their vertical "
        "order: exact (line) and from a thin shell around it (symbols). Where "
        "the hop is blocked, symbols at zero say that no sample fell into the shell.",
    ),
    "horizontal_hop_area": _area(
        "Area of horizontal hops",
        "horizontal_hop",
        "Area of the surface x1 = x2, which is crossed when the discs exchange their horizontal "
        "order: exact (line) and from a thin shell around it (symbols). Where "
        "the hop is blocked, symbols at zero say that no sample fell into the shell.",
    ),
    "collision_area": _area(
        "Area of disc collisions",
        "disc_collision",
        "Area of the surface on which the discs touch: exact (line) and from a thin shell "
        "outside it (symbols).",
    ),
    "wall_area": Entry(
        "Areas of wall hits",
        SPACE,
        "Areas of the surfaces on which disc 1 touches the right or the top wall, and of all "
        "such surfaces of both discs together: exact (lines) and from thin shells (symbols). "
        f"{WHOLE} {SHELLS}",
        ("areas",),
        _walls("area"),
    ),
    "mean_hop_time": Entry(
        "Mean times between hops",
        DYNAMICS,
        "Mean times between successive hops: exact (lines) and by event-driven molecular "
        "dynamics (symbols). In (b) the same times approach the radius r_c at which the hop "
        f"ends. {HOP_LAWS} {SIMULATED}",
        ("mean_times",),
        frozenset({"vertical_hop_time", "horizontal_hop_time"}),
    ),
    "mean_collision_time": Entry(
        "Mean time between disc collisions",
        DYNAMICS,
        "Mean time between collisions of the discs: exact (line) and by event-driven molecular "
        f"dynamics (symbols). {COLLISION_LAWS} {SIMULATED}",
        ("mean_times",),
        frozenset({"disc_collision_time"}),
    ),
    "mean_wall_time": Entry(
        "Mean times between wall hits",
        DYNAMICS,
        "Mean times between hits of disc 1 on the right wall and on the top wall, over "
        "trajectories that can reach it, and between hits of any disc on any wall: exact "
        f"(lines) and by event-driven molecular dynamics (symbols). {WALL_LAWS} {SIMULATED}",
        ("mean_times",),
        _walls("time"),
    ),
    "hop_histogram": Entry(
        "Times between hops",
        DYNAMICS,
        "Density of the time t between successive hops for several radii, both in units of the "
        "exact mean time τ; the dashed line is the exponential of that mean. Bins in (a) widen "
        f"with t, and (b) enlarges short times in equal bins. {DASHES} Symbols tell the radii "
        "apart; error bars are one standard error.",
        ("hop_histogram",),
        frozenset({"hop_histogram"}),
    ),
    "largest_radius": Entry(
        "The largest radius",
        GEOMETRY,
        "(a) The largest discs that fit the box. They jam along a diagonal, where w − 2r, h − "
        "2r and 2r are the sides of a right triangle, unless one side of the box is at least "
        "twice the other: then each disc spans the shorter one. (b) Which hops are possible in "
        "boxes of any shape, with this box marked.",
    ),
    "integration_regimes": Entry(
        "Regimes of the integration",
        GEOMETRY,
        "The separations u = |x1 − x2| and v = |y1 − y2| fill a rectangle of sides A = w − 2r "
        "and B = h − 2r but for the quarter circle of radius σ = 2r in which the discs overlap. "
        "The arc is the surface of collisions; coloured pieces of the axes are those of "
        "vertical hops (below) and horizontal hops (on the left). Where σ exceeds B horizontal "
        "hops are blocked, where it exceeds A vertical ones, and the overlaps are a sector "
        "(hatched) and triangles (dotted).",
    ),
    "surface_shell": Entry(
        "Shells around surfaces",
        GEOMETRY,
        "The area of a surface is measured by the samples within a distance ε of it. (a) The "
        "surface of vertical hops can be crossed from both sides: its shell is 2ε thick, and "
        "extends √2 ε to either side along y1. (b) The surface of collisions, with x = |x1 − "
        "x2|/√2 and y = |y1 − y2|/√2, has a shell on its outer side only.",
    ),
}

#: Not a figure for paper, and so none that the manuscript or the rule of figures knows.
ANIMATION = Entry(
    "The two discs, animated",
    DYNAMICS,
    "The discs as they move, before and after a hop of the rarer kind. Traces are the latest paths "
    "of the centres, and the picture stops at the moment of the hop. Beneath, the separation of "
    "the discs against time: the hop changes its sign.",
    ("trajectory",),
    frozenset({"trajectory"}),
    of_plain=True,
)

COST, NUMERICS = "4 What accuracy costs", "5 Numerical stability"

#: Figures that are made once, not for every scene.
SHARED = {
    "accuracy_cost": Entry(
        "Error against processor time",
        COST,
        "What a digit costs: true relative error against processor time on one core, root mean "
        "square over repeated runs; bars are its standard error, and powers in the legend are "
        "fitted. (a) Volume and (b) area of disc collisions by rejection sampling, by the "
        "conditioned sampler, by scrambled Sobol points, by shells of thickness ε, whose bias "
        "(dotted) no work removes, and of the ε at which bias and noise balance, by samples on the "
        "surface itself, by Gauss quadrature along the arc (numbers of nodes beside) and by exact "
        "evaluation; below 3e-5 the scale changes. (c) Mean time between vertical hops by "
        "event-driven dynamics, one trajectory at a time, many in lock step, and these in single "
        "precision; and by looking for overlaps every Δt, which leaves an error ∝ Δt (dotted). The "
        "dashed line is the least error that time steps reach, whatever Δt.",
        ("accuracy_cost",),
        frozenset({"accuracy_cost"}),
    ),
    "accuracy_cost_by_radius": Entry(
        "The price of a relative error of 1e-3",
        COST,
        "(a) Processor time for a relative error of 1e-3 in each mean time, against the radius: "
        "from the speed and the errors of a pilot (open symbols), by running to that error (full "
        "symbols), and predicted from the exact rates and one speed for the noise of a Poisson "
        "process (lines). Below its line an event comes more evenly than at random, "
        "above it in "
        "clusters; near h/4 a trajectory long keeps disc 1 to one side. (b) Error of "
        "the mean time between disc collisions where there is little room left, in double and in "
        "single precision: lengths rounded to 24 bits make another room (dashed).",
        ("accuracy_cost",),
        frozenset({"accuracy_cost"}),
    ),
    "stability": Entry(
        "Where arithmetic has it hard",
        NUMERICS,
        "How the methods behave at hard radii; dashed lines are what is asked for. (a) Relative "
        "error of volume and areas in double precision below the largest radius, and (b) on both "
        "sides of the radii where a hop becomes blocked: closed forms, and the worst of volume, "
        "areas and mean times as computed here. (c) Share of proposed configurations that is "
        "accepted, by rejection from the prism and by the draws that trajectories start from. (d) "
        "Residuals of volume and areas estimated by those draws. (e) Worst of a long run: error "
        "of the energy, overlap of the discs, centres beyond their range. (f) Worst error of "
        "predicted times to a contact (circles) and to a wall (squares), against 50 digits, for "
        "many ways to approach. (g) Velocities are reversed after n events: error of return after "
        "n more, over the binary digits that the Lyapunov exponent λ per event costs; the line is "
        "one rounding that grows at this rate. The legend says after how many events half of the "
        "digits are lost, and in brackets after how many they should be. (h) Share of 95 % "
        "intervals that cover the exact mean time, over independent repetitions; crosses mark "
        "events too rare for an interval.",
        ("stability",),
        frozenset({"stability"}),
    ),
    "tails": Entry(
        "Tails of the times between events",
        DYNAMICS,
        "(a) Probability that the next event takes longer than t, in units of the exact mean time "
        "τ: by starts drawn near the motions that last, with exact weights (open symbols), and by "
        "plain counting (dots). Discs that move almost along an axis pass clear of each other for "
        "a time ∝ 1/(their drift), so that the tail falls as C/t³, with the exact C (lines) and "
        "not exponentially (dashed). (b) Their ratio to C/t³. (c) Beyond h/4 no such motion avoids "
        "vertical hops: the tail looks exponential, but not with the rate 1/τ (dashed). Error bars "
        "are one standard error.",
        ("tails",),
        frozenset({"tails"}),
    ),
    "distributions": Entry(
        "Rate of hops since the last one",
        DYNAMICS,
        "(a) How often a hop comes after a time t without one, in units of the exact mean time τ; "
        "an exponential law would be the dashed line. It starts from the exact density at 0 (thick "
        "dashes), of a hop undone after one bounce, and jumps where both discs may have bounced, "
        "from t = √2 (h − 2r) on for vertical hops. Bars are rates of exponentials fitted from "
        "four mean times on, dotted where intervals are not exponential there (p < 1e-3). Those of "
        "small discs fall on, towards the rate of a cubic tail, 3τ/t (grey). (b) Mean time from a "
        "random moment to the next hop (open symbols) and what intervals make of it, τ(1 + CV²)/2 "
        "(dots), with CV their coefficient of variation. Error bars are one standard error.",
        ("distributions",),
        frozenset({"distributions"}),
    ),
    "thresholds": Entry(
        "Power laws where events die out",
        DYNAMICS,
        "Mean times near the radius at which their event ends, r = r_c − δ with r_c = w/4 for "
        "vertical hops, h/4 for horizontal ones and the largest radius for all else: event-driven "
        "molecular dynamics (symbols) and exact (lines). (a) Times between hops against their "
        "leading laws Cδ⁻² (dashed), and mean first passages from a random moment (crosses); "
        "slopes are those of inertial and of diffusive motion. (b) Times over their leading laws, "
        "with p = −2 for hops that become blocked and p = 1 for what vanishes: how near the limit "
        "these are reached. Error bars are one standard error.",
        ("distributions", "thresholds"),
        frozenset({"thresholds"}),
    ),
    "effects": Entry(
        "What each effect does",
        DYNAMICS,
        "Mean times of scenes with one effect or two, over those of plain discs in the same box "
        "at the same radius (of disc 1) and total energy, up to the largest radius of these: "
        "exact (lines) and by event-driven molecular dynamics (symbols; error bars of one "
        "standard error are hidden where smaller), for (a) vertical hops, (b) disc collisions and"
        " (c) hits of any disc on any wall. Vertical lines mark h/4 and w/4, where hops of plain "
        "discs become blocked, and their largest radius. The torus has neither hops nor walls. "
        "Residuals z beneath are in standard errors, with guide lines at ±2 and ±5. (d) Processor"
        " time per wall hit or disc collision at r = 0.2, relative to that of plain discs with "
        "all events watched; to leave a periodic cell takes as much time as an event, but is "
        "none.",
        ("effects", "effects_cost"),
        frozenset({"effects"}),
    ),
}


def caption(name):
    """Return the caption of the figure ``name`` as plain text; raise ``ValueError`` without."""
    entries = FIGURES | SHARED
    if name not in entries:
        raise ValueError(f"name must be one of {', '.join(entries)}, not {name!r}")
    return entries[name].caption
