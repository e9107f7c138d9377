"""Figures and animations of results, the same as those of the workflow."""

from __future__ import annotations

import sys
from collections import Counter
from operator import attrgetter
from typing import TYPE_CHECKING

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends import backend_registry

from twodiscs.analysis.tables import SCENE_TABLES, row_quantity
from twodiscs.dynamics.transmission import box_time
from twodiscs.figures import animation, panels, style
from twodiscs.figures.draw import BOX_DRAWINGS, draw
from twodiscs.figures.radius import CURVES, add
from twodiscs.figures.scene_figures import FIGURES
from twodiscs.figures.style import BLACK, EVENT_LOOKS, SERIES, event_name, new_figure
from twodiscs.measure.intervals import Intervals
from twodiscs.measure.load import plugin
from twodiscs.measure.measurements import Measurements
from twodiscs.measure.observe import Observed
from twodiscs.measure.scan import Scan
from twodiscs.measure.trajectory import require_all_rows
from twodiscs.measure.transmission import Transmission
from twodiscs.model.calls import checked_call, warn
from twodiscs.model.checks import InputError, check_choice
from twodiscs.model.formats import quote
from twodiscs.model.scene import Box, Scene
from twodiscs.theory import laws

if TYPE_CHECKING:
    from os import PathLike

    import pandas as pd
    from matplotlib.figure import Figure

#: The results that can be drawn.
DRAWN_RESULTS = (
    "a scene, a trajectory, results of simulate, scan, sample, intervals, transmission or observe, "
    "a table of exact_table, or a loaded table"
)


@checked_call
def plot(
    result: object,
    path: str | PathLike[str] | None = None,
    *,
    figure: str | None = None,
    ax: Axes | None = None,
) -> Figure:
    """Draw a result, and write it to ``path`` if that is given.

    The first of ``figure.axes`` is the main panel; the others have labels:
    ``{a.get_label(): a for a in figure.axes}["residuals"]``. A notebook shows the returned figure,
    a plain prompt shows a window.

    Parameters
    ----------
    result : object
        A trajectory, a ``Scan``, a result of ``simulate``, ``sample``, ``intervals``,
        ``transmission``, ``observe`` or ``diffusion``, or a table from ``load``. A list
        of results of ``simulate``, ``sample`` or ``intervals`` at several radii of one box is drawn
        beside the exact curves. A table of ``exact_table`` gives the exact curves alone, over all
        radii of its box. A scene or box of two plain discs has drawings of its geometry.
    path : path-like, optional
        A file that ends in .pdf, .png or .svg.
    figure : str, optional
        The name of a figure, see Notes, if several can show the result. Without it all measured
        events are drawn; a warning names quantities that are not.
    ax : matplotlib Axes, optional
        Your axes: only the main panel of quantities over the radius is drawn there, with the
        settings of your figure. A second call with the same ``ax`` adds another result, which may
        be of another box.

    Returns
    -------
    matplotlib Figure
        The figure, which is the figure of ``ax`` if that is given.

    Raises
    ------
    InputError
        If no figure shows the result, and if the path cannot be written.

    Notes
    -----
    Names of figures:

    - mean times: ``mean_times`` (all events), ``mean_hop_time``, ``mean_collision_time``,
      ``mean_wall_time``, ``pressure``
    - volume and areas: ``volume``, ``areas`` (all events), ``all_areas`` (the same, a panel each),
      ``vertical_hop_area``, ``horizontal_hop_area``, ``collision_area``, ``wall_area``
    - a scene or a box: ``model``, ``configuration_space``, ``largest_radius``,
      ``integration_regimes``, ``surface_shell``
    - ``hop_histogram``, ``hopping_trajectory``, ``transmission`` and ``observed``

    Examples
    --------
    >>> figure = td.plot(scene, "model.png", figure="model")
    """
    if ax is not None:
        return _beside(result, path, figure, ax)
    with style.context():
        drawn = _draw(result, figure)
        drawn.settle()
        if path is not None:
            style.save(drawn, path)
    if hasattr(sys, "ps1") and "IPython" not in sys.modules:
        _show(drawn)
    return drawn


def _draw(result, figure):
    """Return the drawn figure of a result; ``figure`` is its name, None for the first that fits."""
    if type(result) in TIME_FIGURES:
        name, draw_over_time = TIME_FIGURES[type(result)]
        check_choice("figure", figure or name, [name])
        return draw_over_time(result)
    table = getattr(result, "attrs", {}).get("table")
    if table is not None and table not in SCENE_TABLES:
        if (draw_study := plugin("draw_study")) is None:
            raise InputError(f"result must be a table of a scene, not the study {table!r}")
        return draw_study(result, figure)
    box, rows, fitting = _read(result)
    if not fitting:
        if table is not None and "box" not in result.attrs:
            raise InputError(
                f"result must be a table beside the configuration.json of its build, but "
                f"{table!r} has none; the target report writes it"
            )
        raise InputError(
            f"result must be {DRAWN_RESULTS}, with a quantity of a figure, not {quote(result)}"
        )
    name = _chosen(figure, fitting, rows)
    if not box.is_plain and name in BOX_DRAWINGS:
        more = ", ".join(f"{name} {value}" for name, value in box.options.items())
        raise InputError(
            f"scene must be two plain discs for a drawing, but it has {more}; plot a trajectory"
        )
    return draw(name, box, rows, box.radius if isinstance(box, Scene) else None)


def _chosen(figure, fitting, rows):
    """Return the ``figure``, one of the names ``fitting``, or the first of them if it is None.

    A warning then names the quantities in ``rows`` that this figure does not show.
    """
    if figure is not None:
        return check_choice("figure", figure, fitting)
    if fitting[0] in CURVES:
        shown = CURVES[fitting[0]].names
        measured = [row_quantity(row) for row in rows if "estimate" in row]
        others = dict.fromkeys(q for q in measured if q not in shown)
        if others:
            warn(
                f"the figure {fitting[0]} does not show {', '.join(others)}; "
                f"figure= chooses one of {', '.join(fitting)}"
            )
    return fitting[0]


def _beside(result, path, name, axes):
    """Draw quantities over the radius into ``axes`` of another figure, which is returned."""
    if not isinstance(axes, Axes) or axes.name != "rectilinear":
        raise InputError(f"ax must be one plane Axes of matplotlib, not {quote(axes)}")
    box, rows, fitting = _read(result)
    fitting = [name for name in fitting if name in CURVES]
    if not fitting:
        raise InputError(f"result must be over the radius to be drawn in ax, not {quote(result)}")
    add(axes, box, rows, CURVES[_chosen(name, fitting, rows)].names)
    figure = axes.get_figure(root=True)
    if path is not None:
        style.save(figure, path)
    return figure


def _show(figure):
    """Show a ``figure`` in a window, if matplotlib has any here."""
    backend = backend_registry.load_backend_module(matplotlib.get_backend())
    if backend.FigureCanvas.required_interactive_framework is not None:
        backend.FigureCanvas.new_manager(figure, 1).show()


def _read(result):
    """Return (box, rows, names of the figures that show them); a trajectory has its scene.

    There are no names if no figure shows the ``result``. A scene and a box have no rows.
    """
    if isinstance(result, Box):
        return result, [], [*BOX_DRAWINGS]
    if scene := of_attrs(result, Scene):
        return scene, trajectory_rows(result), ["hopping_trajectory"]
    if box := of_attrs(result, Box):
        return box, *_read_table(result, box)
    results = result if isinstance(result, list | tuple) else [result]
    results = [one for item in results for one in (item if isinstance(item, Scan) else [item])]
    for kind in (Measurements, Intervals):
        if results and all(isinstance(one, kind) for one in results):
            return _read_results(results)
    return None, [], []


def _read_results(results):
    """Return (box, rows, names of figures) of results of one kind, each at one radius."""
    boxes = {item.scene.box for item in results}
    if len(boxes) > 1:
        raise InputError(
            "result must be of one box, with the same effects; for several boxes call plot with "
            "the same ax for each"
        )
    hops = sorted({item.hop for item in results if isinstance(item, Intervals)})
    if len(hops) > 1:
        raise InputError(f"result must be of one kind of hop, not {' and '.join(hops)}")
    rows = [row for item in sorted(results, key=attrgetter("scene.radius")) for row in item.rows]
    ((radius, number),) = Counter(item.scene.radius for item in results).most_common(1)
    if hops and number > 1:
        raise InputError(
            f"result must have one result of intervals at each radius, not {number} at {radius!r}"
        )
    (box,) = boxes
    return box, rows, _fitting_figures(rows, box)


def _read_table(result, box):
    """Return (rows, names of figures) of a table of exact values or a loaded table of a ``Box``."""
    table = result.attrs.get("table")
    # None stands for an empty cell.
    rows = result.astype(object).where(result.notna(), None)
    rows = _exact_rows(rows) if table is None else rows.to_dict("records")
    if not rows:
        return [], []
    if table in ("volume", "areas", "mean_times"):
        return rows, _fitting_figures(rows, box)
    if table in ("theory", None):
        return rows, [name for name in _fitting_figures(rows, box) if name in CURVES]
    return rows, [name for name, entry in FIGURES.items() if entry.tables == (table,)]


def _exact_rows(table):
    """Return rows of theory.csv from a ``table`` of ``exact_table``, whose index is the radius."""
    quantities = [name for name in table if name == "volume" or name.endswith(("_area", "_time"))]
    return [
        {"radius": radius, "quantity": quantity, "exact": exact}
        for quantity in quantities
        for radius, exact in table[quantity].items()
        if exact is not None
    ]


def _fitting_figures(rows, box):
    """Return the names of the figures that show quantities of these rows for a ``Box``."""
    if "left" in rows[0]:
        return ["hop_histogram"]
    shown, names = {*map(row_quantity, rows)}, []
    for table in ("mean_times", "volume", "areas"):
        entries = ((name, one) for name, one in FIGURES.items() if one.tables == (table,))
        own = [name for name, one in entries if one.shown_for(shown, box.options)]
        if own and table != "volume":
            several = sum(name in CURVES for name in own) > 1
            own.insert(0 if several else len(own), table)
        names += own
    return names


def trajectory_rows(trajectory):
    """Return the rows of a trajectory, at least two, whose scene is in its ``attrs``."""
    if "event" not in trajectory or len(trajectory) < 2:
        raise InputError(
            "trajectory must have at least two rows and the column event, but has "
            f"{len(trajectory)} rows and the columns {', '.join(map(str, trajectory))}"
        )
    require_all_rows(trajectory, of_attrs(trajectory, Scene))
    return trajectory.to_dict("records")


@checked_call
def animate(trajectory: pd.DataFrame, path: str | PathLike[str]) -> None:
    """Write an animation of a trajectory.

    It shows a hop of two discs, or the beginning of the trajectory. Balls are drawn as viewed along
    z, the nearer one in front. A mark at the edge of a rough disc turns with it.

    Parameters
    ----------
    trajectory : Trajectory
        The table that ``trajectory`` returns, with all rows.
    path : path-like
        A file that ends in .gif, .png (an animated PNG), .html (a page with a slider, which needs
        no network) or .mp4 (which needs the program ffmpeg).

    Raises
    ------
    InputError
        For anything but a trajectory, for one that does not last two frames, for a path that cannot
        be written, and for an .mp4 without ffmpeg.

    Examples
    --------
    >>> td.animate(td.trajectory(scene, 2, seed=1), "two.gif")
    """
    if not (scene := of_attrs(trajectory, Scene)):
        raise InputError(f"trajectory must be a result of trajectory(), not {quote(trajectory)}")
    with style.context():
        animation.animate(scene, scene.radius, trajectory_rows(trajectory), [path])


# Curves over time ---------------------------------------------------------------------------------


def _panels(scene, more="", rows=1):
    """Return (figure, [axes]); the heading has the box, the radius, ``more`` and effects."""
    figure = new_figure(2.5 * (1 + rows) / 2, layout="constrained")
    axes = figure.subplots(rows, sharex=True, squeeze=False)[:, 0]
    panels.title(axes[0], "", scene, panels.radius_text(scene.radius) + more)
    return figure, axes


def _points(axes, times, values, errors, look, label=None, full=False):
    style = panels.open_symbol(*look) | ({"markerfacecolor": look[0]} if full else {})
    axes.errorbar(times, values, errors, lw=0.5, elinewidth=0.6, label=label, **style)


def _draw_observed(result):
    """Draw the averages of an ``Observed`` with their errors, those of ``diffusion`` in two panels.

    Raises ``InputError`` for more averages than there are different symbols, open and full.
    """
    series, most = result.series, 2 * len(SERIES)
    if len(series) > most:
        raise InputError(
            f"result must have at most {most} averages at a time to be drawn, not {len(series)}; "
            "frame() has all of them"
        )
    apart = result.kind == "diffusion"
    figure, rows = _panels(result.scene, rows=len(series) if apart else 1)
    for k, (name, mean, error) in enumerate(series):
        full, look = divmod(k, len(SERIES))
        name, axes = name.replace("_", " "), rows[k if apart else 0]
        _points(axes, result.times, mean, error, SERIES[look], name, full)
        axes.set_ylabel(name if apart or (len(series) == 1 and result.names) else "average")
    if len(series) > 1 and not apart:
        axes.legend()
    rows[-1].set_xlabel("time $t$ (length/speed)")
    return figure


def _draw_transmission(result):
    """Draw κ(t) of a ``Transmission`` with errors, its exact start and its plateau from clusters.

    Crosses have too few hops for an error. The start is known in plain scenes, the plateau if hops
    are rare enough for a coefficient. With more than two discs τ is the mean time between hops of
    two neighbours.
    """
    scene, hop = result.scene, result.hop
    figure, (axes,) = _panels(scene, f",  {event_name(hop)}")
    times, values, errors = result.frame().reset_index().to_numpy().T
    known = np.isfinite(errors)
    _points(axes, times[known], values[known], errors[known], EVENT_LOOKS[hop])
    axes.plot(times[~known], values[~known], "x", color=EVENT_LOOKS[hop][0], zorder=3)
    if scene.is_plain:
        early = np.geomspace(result.times[0], 0.3 * box_time(scene, hop), 20)
        start = 1 - 2 * laws.density_at_zero(scene, hop) * early
        axes.plot(early, start, color=BLACK, ls=(0, (3, 1.5)), zorder=5, label="exact slope at 0")
    if result.coefficient is not None:
        kappa, name = result.coefficient.value, r"$\kappa\,e^{-2\kappa t/\tau}$, by clusters"
        late = np.geomspace(0.5 * box_time(scene, hop), result.times[-1], 30)
        end = kappa * np.exp(-2 * kappa * late / result.neighbour_mean)
        axes.plot(late, end, color=BLACK, zorder=5, label=name)
    axes.set(xscale="log", xlabel="time $t$ (length/speed)", ylabel=r"transmission $\kappa(t)$")
    axes.xaxis.set_major_formatter("{x:g}")
    if axes.get_legend_handles_labels()[0]:
        axes.legend()
    return figure


#: {type of a result: (the name of its only figure, the function that draws it)}
TIME_FIGURES = {
    Observed: ("observed", _draw_observed),
    Transmission: ("transmission", _draw_transmission),
}


def of_attrs(table, kind):
    """Return the ``Scene`` or ``Box``, as ``kind`` says, of a table with it in ``attrs``, or None.

    Trajectories have a scene, tables of exact values and loaded tables a box.
    """
    try:
        return kind(**table.attrs[kind.__name__.lower()])
    except (AttributeError, InputError, KeyError, TypeError):
        return None
