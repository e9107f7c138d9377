"""Which hops are passages: the transmission coefficient, and how it scales at the threshold."""

import numpy as np

from twodiscs.dynamics.transmission import box_time
from twodiscs.figures import drawing, panels
from twodiscs.figures.style import BLACK, BLUE, GREEN, PURPLE, SKY, VERMILLION, event_name
from twodiscs.model.scene import Box
from twodiscs.theory import exact, laws
from twodiscs_paper.studies.estimates import columns
from twodiscs_paper.studies.passages.near import ONE_INERTIA, thresholds
from twodiscs_paper.study import select

#: Halvings of the distance at which κ(t) is shown, for smooth discs and for rough discs.
SHOWN_HALVINGS = {None: (3, 5, 7, 9, 12), ONE_INERTIA: (3, 5, 7)}

#: Colour and marker of smooth discs, and of rough discs of each moment of inertia.
INERTIA_LOOKS = {
    None: (BLUE, "o"), 0.1: (SKY, "v"), 0.25: (GREEN, "^"), 0.5: (VERMILLION, "s"),
    1.0: (PURPLE, "D"),
}  # fmt: skip


#: The columns that rows of a build and of a long run have in common.
PLACE = ("width", "height", "event", "distance", "moment_of_inertia", "friction", "quantity")


def draw(box, tables):
    """Draw the rows of passages.csv: κ(t) and mean times, for the last hop of the first scene.

    ``kept`` rows are those of long runs.
    """
    rows = tables["passages"]
    kept = [row for row in tables["kept"] if row["scene"] != "pause"]
    figure, (curves, times) = panels.stacked(curves=2.9, times=2.3)
    main, hop, limit, ours = measured(at_places(rows, kept, False), box)
    ours += at_places(kept, measured(rows, box)[-1], True)
    _curves(curves, main, hop, limit, ours)
    _times(times, main, hop, limit, ours)
    panels.title(curves, "a", main, f",  {event_name(hop)}")
    return figure


def at_places(rows, others, inside):
    """Return the ``rows`` at the places of ``others``, or those elsewhere.

    A long run stands for a build at the places that both have.
    """
    own = {tuple(row[name] for name in PLACE) for row in others}
    return [row for row in rows if (tuple(row[name] for name in PLACE) in own) == inside]


def measured(rows, box):
    """Return (box, hop, radius where it becomes blocked, rows) of the last hop of one scene.

    It is the first scene with rows; those with friction or on a ring are left out.
    """
    main, own = first_scene(rows, box)
    hop, limit = [*thresholds(main).items()][-1]
    return main, hop, limit, select(own, event=hop, periodic=None, friction=None)


def first_scene(rows, box):
    """Return (box of the first scene, its rows); without such rows (``box``, [])."""
    first = next((row["scene"] for row in rows if row["scene"]), None)
    own = [row for row in rows if first and row["scene"] == first]
    return (Box(own[0]["width"], own[0]["height"]) if own else box), own


def points(axes, x, y, error, look, label=None, filled=False):
    """Draw symbols of one ``look`` with error bars."""
    colour, marker = look
    style = panels.open_symbol(colour, marker, 0.5 if filled else 0.85)
    if filled:
        style |= {"markerfacecolor": colour}
    axes.errorbar(x, y, error, ls="", elinewidth=0.6, label=label, zorder=3, **style)


# Panels -----------------------------------------------------------------------------------------


def _curves(axes, box, hop, limit, rows):
    """Draw κ(t), its exact slope at 0, and its decay by later passages."""
    for inertia, halvings in SHOWN_HALVINGS.items():
        colour, marker = INERTIA_LOOKS[inertia]
        for n in halvings:
            here = select(rows, moment_of_inertia=inertia, distance=2.0**-n)
            curve = select(here, quantity="correlation")
            if not curve:
                continue
            scene = box.scene(curve[0]["radius"])
            unit = box_time(scene, hop)
            time, value, error = columns(curve, "time", "estimate", "stderr")
            axes.errorbar(
                time / unit, value, error, color=colour, marker=marker, markersize=1.6, lw=0.5,
                elinewidth=0.5, zorder=3,
            )  # fmt: skip
            drawing.label(
                axes, rf"$\delta=2^{{-{n}}}$", (time[-1] / unit, value[-1]), (3, 1.5 * (n == 12)),
                ha="left", fontsize=6.5,
            )  # fmt: skip
            for row in select(here, quantity="coefficient"):
                late = np.geomspace(0.5, 10, 30)
                fall = np.exp(-2 * row["estimate"] * late * unit / row["exact_mean"])
                axes.plot(late, row["estimate"] * fall, color=BLACK, lw=0.7, zorder=5)
    early = np.geomspace(0.1, 0.6, 20)
    scene = box.scene(limit * (1 - 2.0**-12))
    slope = laws.density_at_zero(scene, hop) * box_time(scene, hop)
    axes.plot(early, 1 - 2 * slope * early, color=BLACK, lw=0.8, ls=(0, (3, 1.5)), zorder=6)
    for inertia, name in ((None, "smooth discs"), (ONE_INERTIA, f"rough, $I={ONE_INERTIA:g}$")):
        colour, marker = INERTIA_LOOKS[inertia]
        axes.plot([], [], color=colour, marker=marker, markersize=2.5, lw=0.6, label=name)
    axes.plot([], [], color=BLACK, lw=0.7, label=r"$\kappa\,e^{-2\kappa t/\tau}$, by clusters")
    axes.plot([], [], color=BLACK, lw=0.8, ls=(0, (3, 1.5)), label="exact slope at 0")
    axes.set(xscale="log", xlim=(0.095, 26), ylim=(0, 1.06))
    axes.xaxis.set_major_formatter("{x:g}")
    axes.set(xlabel="time $t$ / range along the hop", ylabel=r"transmission $\kappa(t)$")
    handles, names = axes.get_legend_handles_labels()
    axes.figure.legend(handles, names, loc="outside upper center", ncols=2)


def scale(axes, xlim, ylim, label, yscale="log", **legend):
    """Make the scales logarithmic, or one of them, between the limits, over the distance δ."""
    axes.set(xscale="log", yscale=yscale, xlim=xlim, ylim=ylim, ylabel=label)
    axes.set_xlabel(r"distance $\delta=(r_{\rm c}-r)/r_{\rm c}$")
    if axes.get_legend_handles_labels()[1]:
        axes.legend(**{"loc": "upper left"} | legend)


def _times(axes, box, hop, limit, rows):
    """Draw the exact time between hops and the time between passages."""
    distances = np.geomspace(4e-5, 0.2, 60)
    for inertia, style in ((None, "-"), (ONE_INERTIA, (0, (4, 2)))):
        effects = {} if inertia is None else {"moment_of_inertia": inertia}
        shaped = Box(box.width, box.height, **effects)
        tau = [1 / exact.rate(shaped.scene(limit * (1 - d)), hop) for d in distances]
        name = "smooth" if inertia is None else "rough"
        axes.plot(distances, tau, color=BLACK, lw=0.8, ls=style, zorder=5,
                  label=rf"$\tau$, {name}")  # fmt: skip
    for inertia, look in INERTIA_LOOKS.items():
        own = select(rows, moment_of_inertia=inertia, quantity="passage_time")
        if not own:
            continue
        name = "smooth" if inertia is None else f"$I={inertia:g}$"
        distance, value, error = columns(own, "distance", "estimate", "stderr")
        points(axes, distance, value, error, look, rf"$\tau/\kappa$, {name}")
    label = r"times $\tau$ and $\tau/\kappa$ (length/speed)"
    scale(axes, (4e-5, 0.25), (0.3, None), label, loc="lower left")


def residuals(axes, rows, looks):
    """Draw z of each quantity in ``looks`` that has an exact value or a second estimate."""
    for quantity, (colour, marker, name) in looks.items():
        judged = [
            r for r in select(rows, quantity=quantity) if r["z"] is not None and r["distance"]
        ]
        if judged:
            x, z = columns(judged, "distance", "z")
            axes.plot(x, z, ls="", label=name, **panels.open_symbol(colour, marker, 0.75))
    panels.scale_residuals(axes)
    # The legend stands above the guide lines.
    axes.set(xscale="log", xlim=(4e-5, 0.25), ylim=(-panels.LARGEST_RESIDUAL, 10))
    axes.set_ylabel("residual $z$")
    axes.set_xlabel(r"distance $\delta=(r_{\rm c}-r)/r_{\rm c}$")
    if axes.get_legend_handles_labels()[1]:
        axes.legend(loc="upper center", ncols=len(looks))
