"""How fast discs diffuse by hops: two discs on a ring, and files."""

from twodiscs.figures import drawing, panels
from twodiscs.figures.style import BLACK, BLUE, GREEN, PURPLE, SKY
from twodiscs_paper.studies.passages.figure import (
    LOOKS,
    columns,
    first_scene,
    is_empty,
    points,
    residuals,
    select,
)
from twodiscs_paper.studies.passages.measure import ONE_INERTIA

#: The distances that are shown, from the threshold.
SHOWN = (0.01, 0.2)

#: Short files of more than two discs; long files of smooth discs, without friction and with it.
FILES = {4: (SKY, "P"), 8: (BLACK, "D")}
SMOOTH_FILE, KICKED_FILE = (GREEN, "^"), (PURPLE, "v")

#: {quantity: colour, marker, name} of residuals.
RESIDUAL_LOOKS = {
    "rate": (GREEN, "^", "rate of hops"),
    "diffusion": (BLUE, "o", "$D$, both methods"),
    "single_file": (PURPLE, "v", "$F$"),
}


def draw(box, tables):
    """Draw D/(ν ℓ²) of passages.csv: two discs on a ring of the first scene, files, residuals."""
    rows = tables["passages"]
    figure, (ring, files, lower) = panels.stacked(ring=1.9, files=1.6, residuals=1.4)
    if is_empty(figure, ring, rows, box):
        return figure
    panels.title(ring, "a", first_scene(rows, box)[0])
    _ring(ring, select(rows, quantity="diffusion", discs=2))
    _files(files, rows)
    for axes in (ring, files):
        axes.axhline(1, color=BLACK, lw=0.7, ls=(0, (4, 2)), zorder=1)
        axes.set(xscale="log", ylabel=r"diffusion $D/(\nu\,\ell^2)$")
        axes.tick_params(which="both", labelbottom=False)
    # Two discs with friction have a figure of their own.
    residuals(lower, [r for r in rows if not r["friction"] or r["discs"] > 2], RESIDUAL_LOOKS)
    for axes in (ring, files, lower):
        axes.set(xlim=SHOWN)
    lower.xaxis.set_major_formatter("{x:g}")
    lower.xaxis.set_minor_formatter(lambda x, _: f"{x:g}" if f"{x:e}"[0] in "25" else "")
    return figure


def _ring(axes, rows):
    """Draw two discs on the ring: by hops open symbols, by displacements full ones."""
    for inertia, name in ((None, "smooth"), (ONE_INERTIA, f"rough, $I={ONE_INERTIA:g}$")):
        for method, filled in (("hops", False), ("states", True)):
            own = select(rows, method=method, moment_of_inertia=inertia)
            if own:
                x, y, error = columns(own, "distance", "estimate", "stderr")
                points(axes, x, y, error, LOOKS[inertia], filled=filled)
                if not filled:
                    _name_beside(axes, name, own, LOOKS[inertia][0])
    for filled, name in ((False, "by hops"), (True, "by displacements")):
        style = panels.open_symbol(BLACK, "o", 0.85)
        if filled:
            style |= {"markerfacecolor": BLACK, "markersize": 1.8}
        axes.plot([], [], ls="", label=name, **style)
    axes.set(ylim=(0, 1.45))
    axes.legend(loc="center left")


def _name_beside(axes, name, rows, colour):
    """Write a ``name`` above the last symbols of a curve, at the largest distance."""
    end = max(rows, key=lambda row: row["distance"])
    at = (end["distance"], end["estimate"])
    drawing.label(axes, name, at, (-8, 8), ha="right", color=colour, fontsize=7.3)


def _files(axes, rows):
    """Draw short and long files: by displacements full symbols, by the order open ones."""
    for discs, look in FILES.items():
        own = select(rows, quantity="diffusion", discs=discs)
        if own:
            x, y, error = columns(own, "distance", "estimate", "stderr")
            points(axes, x, y, error, look, f"{discs} smooth discs", True)
    for kicked, look in ((False, SMOOTH_FILE), (True, KICKED_FILE)):
        own = [
            row for row in select(rows, quantity="diffusion", method="order")
            if (row["friction"] is not None) == kicked
        ]  # fmt: skip
        if own:
            x, y, error = columns(own, "distance", "estimate", "stderr")
            name = f"{own[0]['discs']} {'with friction' if kicked else 'smooth discs'}"
            points(axes, x, y, error, look, name)
    axes.set(ylim=(0.3, 1.15))
    if axes.get_legend_handles_labels()[1]:
        axes.legend(loc="lower left", ncols=2)
