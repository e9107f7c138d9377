"""How fast discs diffuse by hops: two discs on a ring, and files."""

from twodiscs.figures import panels
from twodiscs.figures.style import BLACK, BLUE, GREEN, PURPLE, SKY
from twodiscs_paper.studies.estimates import columns
from twodiscs_paper.studies.passages.figure import INERTIA_LOOKS, first_scene, points, residuals
from twodiscs_paper.studies.passages.near import ONE_INERTIA
from twodiscs_paper.study import select

#: Short files of smooth discs; long files of smooth discs, without friction and with it.
FILE_LOOKS = {4: (SKY, "P"), 8: (BLACK, "D")}
SMOOTH_FILE, KICKED_FILE = (GREEN, "^"), (PURPLE, "v")

#: {quantity: colour, marker, name} of residuals.
DIFFUSION_LOOKS = {
    "rate": (GREEN, "^", "rate of hops"),
    "diffusion": (BLUE, "o", "$D$, both methods"),
    "single_file": (PURPLE, "v", "$F$"),
}


def draw(box, tables):
    """Draw D/(ν ℓ²): two discs on a ring, in the first scene of passages.csv, files, residuals.

    Files are of long runs: ``files`` of several numbers of discs, and ``displacements``.
    """
    rows = tables["passages"]
    figure, (ring, files, lower) = panels.stacked(ring=1.9, files=1.6, residuals=1.4)
    panels.title(ring, "a", first_scene(rows, box)[0])
    _ring(ring, select(rows, quantity="diffusion", discs=2))
    _files(files, tables["files"], tables["displacements"])
    for axes in (ring, files):
        axes.axhline(1, color=BLACK, lw=0.7, ls=(0, (4, 2)), zorder=1)
        axes.set(xscale="log", ylabel=r"diffusion $D/(\nu\,\ell^2)$")
        axes.tick_params(which="both", labelbottom=False)
    # Two discs with friction have a figure of their own.
    rows = [*select(rows, friction=None), *tables["displacements"]]
    residuals(lower, rows, DIFFUSION_LOOKS)
    for axes in (ring, files, lower):
        # The distances that are shown, from the threshold.
        axes.set(xlim=(0.01, 0.2))
    lower.xaxis.set_major_formatter("{x:g}")
    lower.xaxis.set_minor_formatter(lambda x, _: f"{x:g}" if f"{x:e}"[0] in "25" else "")
    return figure


def _ring(axes, rows):
    """Draw two discs on the ring: by hops open symbols, by displacements full ones."""
    for inertia, name in ((None, "smooth"), (ONE_INERTIA, f"rough, $I={ONE_INERTIA:g}$")):
        for method, filled in (("hops", False), ("states", True)):
            own = select(rows, method=method, moment_of_inertia=inertia)
            if own:
                label = None if filled else f"{name}, by hops"
                points(axes, *_diffusion(own), INERTIA_LOOKS[inertia], label, filled)
    points(axes, [], [], [], (BLACK, "o"), "by displacements", True)
    axes.set(ylim=(0, 1.45))
    axes.legend(loc="center left")


def _files(axes, short, long):
    """Draw short files, with full symbols, and long ones."""
    for discs, look in FILE_LOOKS.items():
        own = select(short, quantity="diffusion", discs=discs)
        points(axes, *_diffusion(own), look, f"{discs} smooth discs", True)
    for kicked, look in ((False, SMOOTH_FILE), (True, KICKED_FILE)):
        own = select(long, quantity="diffusion")
        own = [row for row in own if (row["friction"] is not None) == kicked]
        name = f"{own[0]['discs']} {'with friction' if kicked else 'smooth discs'}"
        points(axes, *_diffusion(own), look, name)
    axes.set(ylim=(0.3, 1.15))
    axes.legend(loc="lower left", ncols=2)


def _diffusion(rows):
    return columns(rows, "distance", "estimate", "stderr")
