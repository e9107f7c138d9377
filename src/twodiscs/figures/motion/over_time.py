"""Curves over time: averages of an observable, and κ(t) of a hop."""

import numpy as np

from twodiscs.comparison.measured.transmission import box_time
from twodiscs.figures.kit import panels
from twodiscs.figures.kit.looks import LOOKS, name_of
from twodiscs.figures.kit.style import BLACK, SERIES, new_figure
from twodiscs.model.box import Box
from twodiscs.model.checks import InputError
from twodiscs.theory import tails

#: Inches: the height of the figure.
HEIGHT = 2.5


def _panel(scene, more=""):
    """Return (figure, axes); the heading has the box, the radius, ``more`` and effects."""
    figure = new_figure(HEIGHT, layout="constrained")
    axes = figure.subplots()
    panels.title(axes, "", Box.of(scene), panels.of_radius(scene.radius) + more)
    return figure, axes


def _points(axes, times, values, errors, look, label=None, full=False):
    style = panels.open_symbol(*look) | ({"markerfacecolor": look[0]} if full else {})
    axes.errorbar(times, values, errors, lw=0.5, elinewidth=0.6, label=label, **style)


def observed(result):
    """Draw the averages of an ``Observed``, numbered as in its frame, with their errors.

    Raises ``InputError`` for more averages than there are different symbols, open and full.
    """
    flat = (values.reshape(result.times.size, -1).T for values in (result.mean, result.stderr))
    series, most = [*zip(*flat, strict=True)], 2 * len(SERIES)
    if len(series) > most:
        raise InputError(
            f"result must have at most {most} averages at a time to be drawn, not {len(series)}; "
            "frame() has all of them"
        )
    figure, axes = _panel(result.scene)
    for k, (mean, error) in enumerate(series):
        full, look = divmod(k, len(SERIES))
        name = result.names[k].replace("_", " ") if result.names else f"mean {k}"
        _points(axes, result.times, mean, error, SERIES[look], name, full)
    if len(series) > 1:
        axes.legend()
    axes.set(xlabel="time $t$", ylabel="average")
    axes.ticklabel_format(axis="y", scilimits=(-1, 3))  # short numbers leave space for the label
    return figure


def transmission(result):
    """Draw κ(t) of a ``Transmission`` with errors, its exact start and its plateau from clusters.

    Crosses have too few hops for an error. The start is known in plain scenes, the plateau if hops
    are rare enough for a coefficient. With more than two discs τ is the mean time between hops of
    two neighbours.
    """
    scene, hop = result.scene, result.hop
    figure, axes = _panel(scene, f",  {name_of(hop)}")
    times, values, errors = result.frame().reset_index().to_numpy().T
    known = np.isfinite(errors)
    _points(axes, times[known], values[known], errors[known], LOOKS[hop])
    axes.plot(times[~known], values[~known], "x", color=LOOKS[hop][0], zorder=3)
    if scene.is_plain:
        early = np.geomspace(result.times[0], 0.3 * box_time(scene, hop), 20)
        start = 1 - 2 * tails.density_at_zero(scene, hop) * early
        axes.plot(early, start, color=BLACK, ls=(0, (3, 1.5)), zorder=5, label="exact slope at 0")
    if result.coefficient is not None:
        kappa, name = result.coefficient.value, r"$\kappa\,e^{-2\kappa t/\tau}$, by clusters"
        late = np.geomspace(0.5 * box_time(scene, hop), result.times[-1], 30)
        end = kappa * np.exp(-2 * kappa * late / result.neighbour_mean)
        axes.plot(late, end, color=BLACK, zorder=5, label=name)
    axes.set(xscale="log", xlabel="time $t$", ylabel=r"transmission $\kappa(t)$")
    axes.xaxis.set_major_formatter("{x:g}")
    if axes.get_legend_handles_labels()[0]:
        axes.legend()
    return figure
