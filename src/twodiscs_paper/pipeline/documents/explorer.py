"""The explorer: one HTML file that moves the discs and counts events, beside exact mean times.

The file contains its own theory, dynamics and plots, in JavaScript, and the points of all built
scenes that it can show. It loads no other file.
"""

import json
import math
from pathlib import Path

from twodiscs.analysis.tables import AreasTable, MeanTimesTable, VolumeTable
from twodiscs.figures.style import EVENT_LOOKS
from twodiscs.model.events import EVENT_WAYS
from twodiscs.theory.flux import flux_constant

#: The scripts of the page in their order.
SCRIPTS = ("theory.js", "dynamics.js", "plot.js", "page.js")

#: The events that the page counts.
PAGE_EVENTS = ("vertical_hop", "horizontal_hop", "disc_collision", "any_wall")


def dynamics_times(rows):
    """Return {event: [[radius, mean time, standard error or None], …]} of rows of mean_times.csv.

    A time is a length over the speed √(v1² + v2²).
    """
    return {
        event: [
            [row["radius"], row["estimate"], row["stderr"]]
            for row in rows
            if row["event"] == event and row["estimate"] is not None
        ]
        for event in PAGE_EVENTS
    }


def monte_carlo_times(volumes, areas, components):
    """Return the same from rows of volume.csv and areas.csv: volume over area.

    ``components`` is the number of velocity components minus the number of conserved momenta.
    The bias of an area by the thickness of its shell is known exactly and subtracted. Errors of
    volume and area are added as if they were independent. They are not, because samples in a shell
    are also free samples; therefore the error is slightly too large.
    """
    volume = {row["radius"]: row for row in volumes if row["stderr"] is not None}
    times = {event: [] for event in PAGE_EVENTS}
    for row in areas:
        event, radius = row["quantity"].removesuffix("_area"), row["radius"]
        if event in times and radius in volume and row["stderr"] is not None and row["exact"]:
            free, area = volume[radius], row["estimate"] - row["bias"]
            time = 2 / (EVENT_WAYS[event] * flux_constant(components)) * free["estimate"] / area
            error = math.hypot(free["stderr"] / free["estimate"], row["stderr"] / area)
            times[event].append([radius, time, time * error])
    return times


def points(tables, periodic=""):
    """Return {event: {"dynamics": …, "monte_carlo": …}} of the tables of a scene, {name: path}.

    Values are as in ``dynamics_times``; a scene need not have every table. The momentum along its
    ``periodic`` axes is conserved.
    """
    volumes, areas, times = (
        table.read(tables[table.name()]) if table.name() in tables else []
        for table in (VolumeTable, AreasTable, MeanTimesTable)
    )
    dynamics, sampled = dynamics_times(times), monte_carlo_times(volumes, areas, 4 - len(periodic))
    return {
        event: {"dynamics": dynamics[event], "monte_carlo": sampled[event]} for event in PAGE_EVENTS
    }


def explorer(parts, tables, scenes, seed):
    """Return the page, with the points of all scenes that it can show; it names the others.

    ``parts`` are the paths of its files, and ``tables`` those of built tables. ``scenes`` are
    [{"name", "width", "height", "effects"}]. The page draws random numbers from ``seed``.
    """
    from jinja2 import Environment, StrictUndefined

    shown, left_out = [], []
    for scene in scenes:
        name, effects = scene["name"], scene["effects"]
        # The effects that the page can show.
        if not effects.keys() <= {"periodic", "field", "friction"}:
            left_out.append(name)
            continue
        own = {Path(path).stem: path for path in tables if Path(path).parent.name == name}
        kept = {key: scene[key] for key in ("name", "width", "height")}
        shown.append(kept | effects | {"points": points(own, effects.get("periodic", ""))})
    looks = {event: EVENT_LOOKS[event] for event in PAGE_EVENTS}
    data = {"looks": looks, "scenes": shown, "seed": seed}
    texts = {Path(path).name: Path(path).read_text(encoding="utf-8") for path in parts}
    environment = Environment(undefined=StrictUndefined, trim_blocks=True)
    return environment.from_string(texts["explorer.html"]).render(
        data=json.dumps(data, sort_keys=True).replace("<", "\\u003c"),  # "<" could end a script
        left_out=left_out,
        scripts=[texts[name] for name in SCRIPTS],
    )
