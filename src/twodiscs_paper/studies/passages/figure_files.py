"""How discs move in long files that are blocked, and in files where they can pass each other."""

import math

import numpy as np

from twodiscs.figures import panels
from twodiscs.figures.style import BLACK, BLUE, PURPLE, VERMILLION
from twodiscs.model.scene import Scene
from twodiscs_paper.studies.estimates import columns
from twodiscs_paper.studies.passages.figure import points
from twodiscs_paper.studies.passages.figure_diffusion import KICKED_FILE, SMOOTH_FILE
from twodiscs_paper.studies.passages.models import file
from twodiscs_paper.study import select

#: Rough discs in a long file.
ROUGH_FILE = (VERMILLION, "s")

#: Colour and marker of distances in a collapse.
COLLAPSE_LOOKS = ((BLUE, "o"), (VERMILLION, "s"), (PURPLE, "D"))

#: The symbols of the motion of places plus hops, which is measured at the same times.
SUM = {"ls": "", "marker": "_", "markersize": 6.5, "mew": 0.8}


def draw(box, tables):
    """Draw the rows of a long run of long files: displacements, and their collapse."""
    rows = tables["displacements"]
    figure, (moved, collapse) = panels.stacked(moved=2.7, collapse=2.0)
    # Quantities of long files over the time.
    _moved(moved, [row for row in rows if row["quantity"] in ("displacement", "file", "order")])
    _collapse(collapse, rows)
    return figure


def _scene(row):
    """Return the ``Scene`` of a ``row`` of a long file, without its friction."""
    return Scene(
        row["width"], row["height"], row["radius"], discs=row["discs"], periodic="x",
        moment_of_inertia=row["moment_of_inertia"],
    )  # fmt: skip


def _thermal(row):
    """Return the thermal speed over h of the discs of a ``row`` on a ring."""
    return file.thermal_speed(_scene(row)) / row["height"]


def _scaled_columns(rows, quantity, **wanted):
    """Return (times in units of h over the thermal speed, values, errors) of a ``quantity``."""
    own = select(rows, quantity=quantity, **wanted)
    time, value, error = columns(own, "time", "estimate", "stderr")
    return time * _thermal(own[0]), value, error


def _moved(axes, rows):
    """Draw displacements in long files, blocked at the first such radius and at the first open."""
    distances = [row["distance"] for row in rows]
    names = {}
    shown = [next((d for d in distances if (d > 0) == is_open), None) for is_open in (False, True)]
    for distance in filter(None, shown):
        here = select(rows, distance=distance)
        blocked = distance < 0
        kinds = dict.fromkeys((row["friction"], row["moment_of_inertia"]) for row in here)
        for friction, inertia in kinds:
            own = select(here, friction=friction, moment_of_inertia=inertia)
            look, kind = (SMOOTH_FILE, "smooth") if friction is None else (KICKED_FILE, "friction")
            if inertia is not None:
                look, kind = ROUGH_FILE, "rough"
            x, y, error = _scaled_columns(own, "displacement")
            points(axes, x, y, error, look, None, blocked)
            names[kind] = panels.open_symbol(*look)
            if blocked and inertia is None:
                scene = _scene(own[0])
                time = np.geomspace(x[0], x[-1], 120)
                due = [file.law(scene, friction, t / _thermal(own[0])) for t in time]
                axes.plot(time, np.array(due, float), color=BLACK, lw=0.8, zorder=5)
            elif not blocked:
                _, place, _ = _scaled_columns(own, "file")
                _, walk, _ = _scaled_columns(own, "order")
                axes.plot(x, place + walk, color=look[0], zorder=2, **SUM)
    names |= {
        "blocked": {"color": BLACK, "marker": "o", "markersize": 1.8},
        "theory, blocked": {"color": BLACK, "lw": 0.8, "ls": "-"},
        "motion of places, plus hops": {"color": BLACK} | SUM,
    }
    for name, style in names.items():
        axes.plot([], [], label=name, **{"ls": ""} | style)
    # The times that are shown, in units of h over the thermal speed.
    axes.set(xscale="log", yscale="log", xlim=(0.4, 60))
    axes.set(
        xlabel=r"time $t\,\sqrt{kT/m}\,/h$", ylabel=r"displacement $\langle x^2\rangle/\ell^2$"
    )
    axes.xaxis.set_major_formatter("{x:g}")
    axes.legend(loc="lower right")


def _collapse(axes, rows):
    """Draw displacements with friction over F √t×, against t/t×."""
    looks = iter(COLLAPSE_LOOKS)
    for row in select(rows, quantity="diffusion", method="order"):
        if row["friction"] is None:
            continue
        own = {name: row[name] for name in ("scene", "distance", "friction")}
        (single,) = select(rows, quantity="single_file", **own)
        (rate,) = select(rows, quantity="rate", discs=row["discs"], **own)
        d, f = row["estimate"] * rate["estimate"] / 2, single["estimate"]
        crossover = (f / (2 * d)) ** 2
        moved = select(rows, quantity="displacement", **own)
        time, value, error = columns(moved, "time", "estimate", "stderr")
        unit = f * math.sqrt(crossover)
        name = rf"$\delta=1/{round(1 / row['distance'])}$"
        points(axes, time / crossover, value / unit, error / unit, next(looks), name)
    s = np.geomspace(1e-3, 10, 60)
    axes.plot(
        s, np.sqrt(s) + s, color=BLACK, lw=0.8, zorder=5, label=r"$\sqrt{u}+u$,  $u=t/t_\times$"
    )
    axes.set(xscale="log", yscale="log", xlabel=r"time $t/t_\times$")
    axes.set_ylabel(r"$\langle x^2\rangle/F\sqrt{t_\times}$")
    axes.legend(loc="upper left")
