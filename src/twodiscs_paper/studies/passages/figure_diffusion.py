"""How fast discs diffuse by hops: on a ring, and in a single file."""

from twodiscs.figures.kit import panels
from twodiscs.figures.kit.style import BLACK, GREEN, PURPLE, SKY, new_figure
from twodiscs_paper.studies.passages.figure import (
    LOOKS,
    columns,
    first_scene,
    points,
    residuals,
    select,
)
from twodiscs_paper.studies.passages.measure import ONE_INERTIA

#: Inches: heights of the panels of the ring, its residuals and the lattice; the gap, the margin.
RING, RESIDUALS, LATTICE, GAP, TOP = 1.9, 0.75, 1.2, 0.42, 0.22

#: Files of more than two discs.
FILES = {4: (SKY, "P"), 8: (BLACK, "D")}

#: The line of a random walk, at 1.
RANDOM_WALK = {"color": BLACK, "lw": 0.7, "ls": (0, (4, 2))}

#: {quantity: colour, marker, name} of residuals.
RESIDUAL_LOOKS = {
    "rate": (GREEN, "^", "rate of hops"),
    "diffusion": (PURPLE, "D", "$D$, both methods"),
}


def draw(box, tables):
    """Draw the rows of passages.csv on diffusion; the ring has the box of the first scene."""
    rows = tables["passages"]
    middle = panels.BOTTOM + LATTICE + GAP
    upper = middle + RESIDUALS + panels.GAP
    figure = new_figure(upper + RING + TOP)
    ring = panels.add_panel(figure, upper, RING, name="ring")
    lower = panels.add_panel(figure, middle, RESIDUALS, name="residuals")
    lattice = panels.add_panel(figure, panels.BOTTOM, LATTICE, name="lattice")
    for axes, name in zip(figure.axes, "abc", strict=True):
        panels.letter(axes, name)
    if not rows:
        panels.name_box(ring, box, ": no hop becomes blocked")
        for axes in figure.axes:
            axes.set_axis_off()
        return figure
    panels.name_box(ring, first_scene(rows, box)[0])
    _ring(ring, rows)
    residuals(lower, rows, RESIDUAL_LOOKS)
    swaps = select(rows, quantity="diffusion", method="lattice")
    x, y, error = columns(swaps, "swap", "estimate", "stderr")
    points(lattice, x, y, error, (GREEN, "^"), "single file on a lattice")
    lattice.axhline(1, **RANDOM_WALK)
    lattice.set(xscale="log", xlim=(0.005, 1.4), ylim=(0, None))
    lattice.xaxis.set_major_formatter("{x:g}")
    lattice.set(xlabel="probability $p$ of a swap", ylabel=r"$D/(\nu\,\ell^2)$")
    lattice.legend(loc="lower left")
    for axes in (ring, lower):
        axes.set(xlim=(0.01, 0.2))
    ring.tick_params(which="both", labelbottom=False)
    lower.xaxis.set_major_formatter("{x:g}")
    lower.xaxis.set_minor_formatter(lambda x, _: f"{x:g}" if f"{x:e}"[0] in "25" else "")
    return figure


def caption(shown):
    """Return the caption."""
    return """
    Diffusion by hops. (a) Coefficient D of diffusion of two discs on a ring, divided by its value
    for a random walk with ν hops per time in either direction, each by ℓ (dashed): by correlations
    of hops (open symbols) and by displacements (dots); and the same for discs in a file of four and
    of eight, by displacements; at distances δ = (r_c − r)/r_c from the radius r_c at which hops
    become blocked.
    (b) Residuals z in standard errors, from the exact rate or between two estimators. (c) The same
    ratio for a tagged particle of a single file on a lattice, whose neighbours swap with the
    probability p. Error bars are one standard error.
    """


def _ring(axes, rows):
    """Draw D/(ν ℓ²) on the ring, by both methods."""
    of_two = select(rows, quantity="diffusion", discs=2)
    for inertia, name in (
        (None, "2 smooth discs"),
        (ONE_INERTIA, f"2 rough discs, $I={ONE_INERTIA:g}$"),
    ):
        for method, filled in (("hops", False), ("states", True)):
            own = select(of_two, method=method, moment_of_inertia=inertia)
            if own:
                x, y, error = columns(own, "distance", "estimate", "stderr")
                points(axes, x, y, error, LOOKS[inertia], None if filled else name, filled)
    for discs, look in FILES.items():
        own = select(rows, quantity="diffusion", discs=discs)
        if own:
            x, y, error = columns(own, "distance", "estimate", "stderr")
            points(axes, x, y, error, look, f"{discs} smooth discs", True)
    axes.plot([], [], ls="", marker=".", color=BLACK, markersize=3, label="by displacements")
    axes.axhline(1, **RANDOM_WALK)
    axes.set(xscale="log", ylim=(0, None), ylabel=r"diffusion $D/(\nu\,\ell^2)$")
    axes.legend(loc="center right")
