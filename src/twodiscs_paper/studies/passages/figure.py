"""Which hops are passages, and diffusion by them."""

import numpy as np

from twodiscs.comparison.measured.transmission import box_time
from twodiscs.figures.kit import drawing, panels
from twodiscs.figures.kit.limits import QUARTERS
from twodiscs.figures.kit.looks import name_of
from twodiscs.figures.kit.style import (
    BLACK,
    BLUE,
    GREEN,
    GREY,
    ORANGE,
    PURPLE,
    SIZES,
    SKY,
    VERMILLION,
    new_figure,
)
from twodiscs.model.box import Box
from twodiscs.model.events import AXIS
from twodiscs.theory import exact, tails
from twodiscs_paper.studies.passages.measure import ONE_INERTIA, thresholds

#: Inches: the figure across, heights of the panels and of that of the residuals, gaps, room above.
WIDTH, HEIGHT, RESIDUALS, GAP, TOP = 7.0, 2.1, 0.8, 0.4, 0.22

#: Halvings of the distance whose κ(t) is shown: of smooth discs, and of rough ones.
SHOWN = {None: (3, 5, 7, 9, 12), ONE_INERTIA: (3, 5, 7)}

#: How smooth discs, and rough ones of each moment of inertia, look.
LOOKS = {
    None: (BLUE, "o"), 0.1: (ORANGE, "v"), 0.25: (GREEN, "^"), 0.5: (VERMILLION, "s"),
    1.0: (PURPLE, "D"),
}  # fmt: skip

#: Files of more than two discs.
FILES = {4: (SKY, "P"), 8: (BLACK, "D")}

#: Boxes and hops of smooth discs after the first one.
OTHERS = ((SKY, "P"), (BLACK, "D"))


def draw(box, tables):
    """Draw the rows of passages.csv; those of κ(t) and diffusion are in the first scene."""
    rows = tables["passages"]
    half = WIDTH / 2 - panels.LEFT - panels.RIGHT
    bottom, right = panels.BOTTOM + RESIDUALS + GAP, WIDTH / 2 + panels.LEFT
    upper = bottom + HEIGHT + GAP
    figure = new_figure(upper + HEIGHT + TOP, WIDTH)
    curves = panels.add_panel(figure, upper, HEIGHT, width=half)
    powers = panels.add_panel(figure, upper, HEIGHT, right, half)
    times = panels.add_panel(figure, bottom, HEIGHT, width=half)
    diffusion = panels.add_panel(figure, bottom, HEIGHT, right, half)
    whole = WIDTH - panels.LEFT - panels.RIGHT
    lower = panels.add_panel(figure, panels.BOTTOM, RESIDUALS, width=whole)
    all_axes = (curves, powers, times, diffusion, lower)
    for axes, name in zip(all_axes, "abcde", strict=True):
        panels.letter(axes, name)
    if not rows:
        panels.name_box(curves, box, ": no hop becomes blocked")
        for axes in all_axes:
            axes.set_axis_off()
        return figure
    first = next((row["scene"] for row in rows if row["scene"]), None)
    own = [row for row in rows if first and row["scene"] == first]
    main = Box(own[0]["width"], own[0]["height"]) if own else box
    hop, limit = [*thresholds(main).items()][-1]
    ours = _of(own, event=hop, periodic=None)
    _curves(curves, main, hop, limit, ours)
    _powers(powers, rows, first, hop)
    _times(times, main, hop, limit, ours)
    _diffusion(diffusion, rows)
    _residuals(lower, rows)
    panels.name_box(curves, main, f",  (a, c) {name_of(hop)}")
    return figure


def caption(shown):
    """Return the caption."""
    return """
    What becomes of hops near the radius r_c where they become blocked, at distances δ = (r_c −
    r)/r_c that are halved from one to the next. (a) Transmission coefficient κ(t): how the order
    of the discs at a time t after a hop is correlated with the direction of the hop, over states
    on the surface of the hop, for smooth discs (circles) and rough ones (squares). It starts with
    the exact slope −2p(0⁺) (dashed, in the limit δ → 0). Where hops are rare it has a plateau,
    which falls as passages follow one another (lines): κ is the fraction of odd clusters among all
    hops, from independent runs. (b) Smooth discs: 1 − κ falls about as ∛δ, so that transition
    state theory becomes exact; of rough discs it is κ that vanishes, and the power depends on
    their moment of inertia I, in units of mr². (c) Exact mean time τ between hops (lines, ∝ δ⁻² in
    the end) and mean time τ/κ between passages (symbols), with the powers fitted to all that is
    shown. (d) Coefficient D of diffusion of two discs on a ring, over that of a random walk with ν
    hops per time in either direction, each by ℓ, by correlations of hops (open symbols) and by
    displacements (dots); of discs in a file of four and of eight, by displacements; and of a
    tagged particle of a single file on a lattice, whose neighbours swap with the probability p.
    (e) Residuals z, in standard errors, against exact values or between two estimators. Error bars
    are one standard error.
    """


def _of(rows, **wanted):
    """Return those of ``rows`` that have these values."""
    return [row for row in rows if all(row[k] == v for k, v in wanted.items())]


def _columns(rows, *names):
    return np.array([[row[name] for row in rows] for name in names], float)


def _points(axes, x, y, error, look, label=None, filled=False):
    colour, marker = look
    style = panels.open_symbol(colour, marker, 0.85)
    if filled:
        style |= {"markerfacecolor": colour, "markersize": 0.5 * SIZES[marker]}
    axes.errorbar(x, y, error, ls="", elinewidth=0.6, label=label, zorder=3, **style)


# Panels -----------------------------------------------------------------------------------------


def _curves(axes, box, hop, limit, rows):
    """Draw κ(t), how it starts by the exact law, and what is left by the passages."""
    for inertia, halvings in SHOWN.items():
        colour, marker = LOOKS[inertia]
        for n in halvings:
            here = _of(rows, moment_of_inertia=inertia, distance=2.0**-n)
            seen = _of(here, quantity="correlation")
            if not seen:
                continue
            scene = box.scene(seen[0]["radius"])
            unit = box_time(scene, hop)
            time, value, error = _columns(seen, "time", "estimate", "stderr")
            axes.errorbar(
                time / unit, value, error, color=colour, marker=marker, markersize=1.6, lw=0.5,
                elinewidth=0.5, zorder=3,
            )  # fmt: skip
            drawing.label(
                axes, f"$2^{{-{n}}}$", (time[-1] / unit, value[-1]), (3, 0), ha="left",
                color=colour, fontsize=6.5,
            )  # fmt: skip
            for row in _of(here, quantity="coefficient"):
                late = np.geomspace(0.5, 10, 30)
                fall = np.exp(-2 * row["estimate"] * late * unit / row["exact_mean"])
                axes.plot(late, row["estimate"] * fall, color=BLACK, lw=0.7, zorder=5)
    early = np.geomspace(0.1, 0.6, 20)
    scene = box.scene(limit * (1 - 2.0**-12))
    slope = tails.density_at_zero(scene, hop) * box_time(scene, hop)
    axes.plot(early, 1 - 2 * slope * early, color=BLACK, lw=0.8, ls=(0, (3, 1.5)), zorder=6)
    for inertia, name in ((None, "smooth discs"), (ONE_INERTIA, f"rough, $I={ONE_INERTIA:g}$")):
        colour, marker = LOOKS[inertia]
        axes.plot([], [], color=colour, marker=marker, markersize=2.5, lw=0.6, label=name)
    axes.plot([], [], color=BLACK, lw=0.7, label=r"$\kappa\,e^{-2\kappa t/\tau}$, by clusters")
    axes.plot([], [], color=BLACK, lw=0.8, ls=(0, (3, 1.5)), label="exact slope at 0")
    axes.set(xscale="log", xlim=(0.09, 15), ylim=(-0.02, 1.32))
    axes.xaxis.set_major_formatter("{x:g}")
    axes.set(xlabel="time $t$ over the range along the hop", ylabel=r"transmission $\kappa(t)$")
    axes.set_yticks([0, 0.2, 0.4, 0.6, 0.8, 1])
    axes.legend(loc="upper left", ncols=2, fontsize=6.6)


def _powers(axes, rows, first, hop):
    """Draw 1 − κ of smooth discs and κ of rough ones."""
    seen = [row for row in rows if row["quantity"] == "coefficient"]
    others = iter(OTHERS)
    kinds = dict.fromkeys((r["scene"], r["event"], r["moment_of_inertia"]) for r in seen)
    for scene, event, inertia in sorted(kinds, key=lambda kind: kind[2] or 0):
        own = _of(seen, scene=scene, event=event, moment_of_inertia=inertia)
        if inertia is not None and (scene, event) != (first, hop):
            continue
        distance, value, error = _columns(own, "distance", "estimate", "stderr")
        if inertia is None:
            box = Box(own[0]["width"], own[0]["height"])
            where = f"${panels.sides(box)}$, ${QUARTERS[AXIS[event]]}$"
            look = LOOKS[None] if (scene, event) == (first, hop) else next(others)
            _points(axes, distance, 1 - value, error, look, rf"$1-\kappa$, {where}")
        else:
            name = rf"$\kappa$, $I={inertia:g}$"
            _points(axes, distance, value, error, LOOKS[inertia], name)
    for power, name, start, height in (
        (1 / 3, r"$\delta^{1/3}$", 5e-5, 0.05),
        (1 / 2, r"$\delta^{1/2}$", 2.5e-3, 0.009),
    ):
        x = np.array([start, 30 * start])
        axes.plot(x, height * (x / x[0]) ** power, color=GREY, lw=0.8, zorder=1)
        end = (x[1], height * 30**power)
        drawing.label(axes, name, end, (3, 0), ha="left", color=GREY)
    axes.set(xscale="log", yscale="log", xlim=(4e-5, 0.25), ylim=(0.005, 8))
    axes.set_xlabel(r"distance $\delta=(r_{\rm c}-r)/r_{\rm c}$")
    axes.set_ylabel(r"$1-\kappa$ (smooth),  $\kappa$ (rough)")
    if kinds:
        axes.legend(loc="upper left", fontsize=6.6, ncols=2, columnspacing=0.6)


def _times(axes, box, hop, limit, rows):
    """Draw the exact time between hops and the time between passages, with its fitted power."""
    distances = np.geomspace(4e-5, 0.2, 60)
    for inertia, style in ((None, "-"), (ONE_INERTIA, (0, (4, 2)))):
        effects = {} if inertia is None else {"moment_of_inertia": inertia}
        shaped = Box(box.width, box.height, effects)
        tau = [1 / exact.rate(shaped.scene(limit * (1 - d)), hop) for d in distances]
        name = "smooth" if inertia is None else "rough"
        axes.plot(distances, tau, color=BLACK, lw=0.8, ls=style, zorder=5,
                  label=rf"$\tau$, exact, {name}")  # fmt: skip
    for inertia, look in LOOKS.items():
        own = _of(rows, moment_of_inertia=inertia, quantity="passage_time")
        fit = _of(rows, moment_of_inertia=inertia, quantity="passage_exponent")
        if not own:
            continue
        name = "smooth" if inertia is None else f"$I={inertia:g}$"
        if fit:
            name += rf", $\delta^{{{fit[0]['estimate']:.2f}}}$"
        distance, value, error = _columns(own, "distance", "estimate", "stderr")
        _points(axes, distance, value, error, look, rf"$\tau/\kappa$, {name}")
    axes.set(xscale="log", yscale="log", xlim=(4e-5, 0.25))
    axes.set_xlabel(r"distance $\delta=(r_{\rm c}-r)/r_{\rm c}$")
    axes.set_ylabel(r"time $\tau$, time between passages $\tau/\kappa$")
    axes.legend(loc="upper right", fontsize=6.6)


def _diffusion(axes, rows):
    """Draw D/(ν ℓ²) on the ring, by either method, and on the lattice."""
    seen = _of(rows, quantity="diffusion", discs=2)
    for inertia, name in ((None, "smooth discs"), (ONE_INERTIA, f"rough, $I={ONE_INERTIA:g}$")):
        for method, filled in (("hops", False), ("states", True)):
            own = _of(seen, method=method, moment_of_inertia=inertia)
            if own:
                x, y, error = _columns(own, "distance", "estimate", "stderr")
                label = None if filled else f"{name} on a ring"
                _points(axes, x, y, error, LOOKS[inertia], label, filled)
    for discs, look in FILES.items():
        own = _of(rows, quantity="diffusion", discs=discs)
        if own:
            x, y, error = _columns(own, "distance", "estimate", "stderr")
            _points(axes, x, y, error, look, f"{discs} smooth discs on a ring", True)
    own = _of(rows, quantity="diffusion", method="lattice")
    x, y, error = _columns(own, "swap", "estimate", "stderr")
    _points(axes, x, y, error, (GREEN, "^"), "lattice, single file")
    axes.plot([], [], ls="", marker=".", color=BLACK, markersize=3, label="by displacements")
    axes.axhline(1, color=BLACK, lw=0.7, ls=(0, (4, 2)))
    axes.set(xscale="log", xlim=(0.005, 1.4), ylim=(0, None))
    axes.xaxis.set_major_formatter("{x:g}")
    axes.set_xlabel(r"distance $\delta$, or probability $p$ of a swap")
    axes.set_ylabel(r"diffusion $D/(\nu\,\ell^2)$")
    axes.legend(loc="lower right", fontsize=6.6)


def _residuals(axes, rows):
    """Draw z of all that has an exact value, or another estimate."""
    looks = {
        "slope": (BLUE, "o", r"$\kappa'(0)$, exact"),
        "rate": (GREEN, "^", r"rate on the ring"),
        "plateau": (VERMILLION, "s", r"$\kappa$ by $\kappa(t)$ and by clusters"),
        "diffusion": (PURPLE, "D", "$D$ by displacements and by hops"),
    }
    for quantity, (colour, marker, name) in looks.items():
        own = [
            r for r in rows if r["quantity"] == quantity and r["z"] is not None and r["distance"]
        ]
        if own:
            x, z = _columns(own, "distance", "z")
            style = panels.open_symbol(colour, marker, 0.75)
            axes.plot(x, z, ls="", label=name, **style)
    for size, dashes in panels.GUIDES.items():
        for z in (-size, size):
            axes.axhline(z, color=GREY, lw=0.5, ls=dashes, zorder=0)
    axes.axhline(0, color=GREY, lw=0.5, zorder=0)
    axes.set(xscale="log", xlim=(4e-5, 0.25), ylim=(-panels.LARGEST_RESIDUAL, 9.5))
    axes.set_yticks([-5, -2, 0, 2, 5])
    axes.set_xlabel(r"distance $\delta=(r_{\rm c}-r)/r_{\rm c}$")
    axes.set_ylabel("residual $z$")
    if axes.get_legend_handles_labels()[1]:
        axes.legend(loc="upper center", ncols=4, fontsize=6.6)
