"""Figures and animations of what the face returns; what is drawn is what the workflow draws."""

import sys
from functools import partial
from importlib import import_module
from operator import attrgetter

from twodiscs.comparison.measured.measurements import Intervals, Measurements, the_scene
from twodiscs.comparison.measured.observe import Observed
from twodiscs.comparison.measured.scan import Scan
from twodiscs.comparison.measured.transmission import Transmission
from twodiscs.figures.catalogue import FIGURES
from twodiscs.figures.kit import style
from twodiscs.model.box import Box
from twodiscs.model.checks import InputError, check_choice

#: What can be drawn.
DRAWN = (
    "a scene, a trajectory, results of simulate, scan, sample, intervals, transmission or observe, "
    "or a loaded table"
)


def plot(result, path, figure):
    """Return the figure that shows ``result`` (see the face)."""
    draw = _over_time(result, figure) or _in_catalogue(result, figure)
    with style.context():
        drawn = draw()
        if path is not None:
            style.save(drawn, path)
    # A notebook shows it with the same settings.
    drawn._repr_png_ = lambda: _png(drawn)
    if hasattr(sys, "ps1") and "IPython" not in sys.modules:
        _show(drawn)
    return drawn


def _over_time(result, figure):
    """Return what draws a result that has a figure of its own, None for others."""
    for kind, name in ((Observed, "observed"), (Transmission, "transmission")):
        if isinstance(result, kind):
            from twodiscs.figures.motion import over_time

            check_choice("figure", name if figure is None else figure, [name])
            return partial(getattr(over_time, name), result)


def _in_catalogue(result, figure):
    """Return what draws a result in a figure of the workflow."""
    box, tables, fitting, options = _what(result)
    if not fitting:
        if "table" in getattr(result, "attrs", {}) and "box" not in result.attrs:
            raise InputError(
                "result must be a table with the configuration.json of its build beside it, which "
                f"the target report writes, not {result.attrs['table']!r} alone"
            )
        raise InputError(f"result must be {DRAWN}, of what a figure shows, not {result!r:.80}")
    name = check_choice("figure", fitting[0] if figure is None else figure, fitting)
    entry = FIGURES[name]
    if not box.is_plain and not entry.needs:
        more = ", ".join(f"{name} {value}" for name, value in box.calls_for.items())
        raise InputError(
            f"scene must be two plain discs to be sketched, but it has {more}; draw a trajectory"
        )
    draw = import_module(entry.module).draw
    return partial(draw, box, dict.fromkeys(entry.tables, tables), **entry.options, **options)


def _show(figure):
    """Show a ``figure`` in a window, if matplotlib has any here."""
    import matplotlib
    from matplotlib.backends import backend_registry

    backend = backend_registry.load_backend_module(matplotlib.get_backend())
    if backend.FigureCanvas.required_interactive_framework is not None:
        backend.FigureCanvas.new_manager(figure, 1).show()


def _png(figure):
    from io import BytesIO

    stream = BytesIO()
    with style.context():
        figure.savefig(stream, format="png", dpi=150)
    return stream.getvalue()


def _what(result):
    """Return (box, rows, names of the figures that show them, what else those take)."""
    scene = the_scene(result)
    if isinstance(result, Box) or result is scene is not None:
        return result if isinstance(result, Box) else Box.of(scene), [], _drawings(), {}
    results = [*result] if isinstance(result, list | tuple | Scan) else [result]
    for kind in (Measurements, Intervals):
        if results and all(isinstance(item, kind) for item in results):
            boxes = {Box.of(item.scene) for item in results}
            if len(boxes) > 1:
                raise InputError("result must be of one box, with the same effects")
            hops = sorted({item.hop for item in results if isinstance(item, Intervals)})
            if len(hops) > 1:
                raise InputError(f"result must be of one kind of hop, not {' and '.join(hops)}")
            results = sorted(results, key=attrgetter("scene.radius"))
            rows = [row for item in results for row in item.rows]
            return boxes.pop(), rows, _figures_of(rows), {}
    attributes = getattr(result, "attrs", {})
    if isinstance(attributes, dict) and isinstance(attributes.get("box"), Box):
        # A table that was loaded; what is absent is None in rows.
        rows = result.astype(object).where(result.notna(), None).to_dict("records")
        table = attributes.get("table")
        fitting = [name for name, entry in FIGURES.items() if entry.tables == (table,)]
        if rows and fitting:
            return attributes["box"], rows, fitting, {}
    if scene is not None and hasattr(result, "iterrows"):
        return Box.of(scene), rows_of(result), ["hopping_trajectory"], {"radius": scene.radius}
    return None, [], [], {}


def _drawings():
    return [name for name, entry in FIGURES.items() if not entry.needs]


def _figures_of(rows):
    """Return the names of the figures that show quantities of these rows."""
    if "left" in rows[0]:
        return ["hop_histogram"]
    shown = {row.get("quantity") or f"{row['event']}_time" for row in rows}
    over_radius = {n: e for n, e in FIGURES.items() if ".radius." in e.module}
    return [name for name, entry in over_radius.items() if entry.needs & shown]


def rows_of(trajectory):
    """Return the rows of a trajectory that ``the_scene`` knows; two are the least."""
    places = (
        f"{axis}{disc}" for disc in range(1, the_scene(trajectory).discs + 1) for axis in "xy"
    )
    missing = [n for n in ("time", *places, "event") if n not in trajectory]
    if missing or len(trajectory) < 2:
        raise InputError(
            f"trajectory must have two rows at least, and all of its columns, not {len(trajectory)}"
            f" rows without {', '.join(missing) or 'none'}"
        )
    from twodiscs.comparison.measured.trajectory import require_consecutive

    require_consecutive(trajectory)
    return trajectory.to_dict("records")


def animate(trajectory, path):
    """Write the animation of a trajectory (see the face)."""
    from twodiscs.figures.motion import animation

    scene = the_scene(trajectory)
    if scene is None or not hasattr(trajectory, "iterrows"):
        raise InputError(f"trajectory must be what trajectory() returns, not {trajectory!r:.80}")
    if scene.has_effects:
        raise InputError(f"scene must have no effects to be animated, not {scene}")
    with style.context():
        animation.animate(Box.of(scene), scene.radius, rows_of(trajectory), [path])
