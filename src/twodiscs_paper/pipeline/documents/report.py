"""The main report: verdict, mean times, agreement, and a section for each scene.

It is one HTML file with its pictures in it; tables and figures are also links to the files beside
it.
"""

import re
from base64 import b64encode
from datetime import date
from io import BytesIO
from itertools import groupby
from operator import itemgetter
from pathlib import Path, PurePosixPath

from markupsafe import Markup, escape
from PIL import Image, ImageSequence

from twodiscs.analysis.tables import (
    SCENE_TABLES,
    CheckTable,
    CostTable,
    GridTable,
    MeanTimesTable,
    row_quantity,
)
from twodiscs.figures.scene_figures import ANIMATION, GEOMETRY
from twodiscs.measure.measurements import measurement
from twodiscs.model.formats import format_seconds
from twodiscs.model.scene import Box
from twodiscs_paper.catalogue import ALL_FIGURES
from twodiscs_paper.pipeline.job_cost import missed, taken
from twodiscs_paper.pipeline.results.provenance import commit, versions

#: The large figures of the section of a scene, of which it has ``KEY_FIGURES_SHOWN``, and of the
#: section of all scenes. If a figure of a scene is missing, another one replaces it. All other
#: figures are thumbnails.
KEY_FIGURES, KEY_FIGURES_SHOWN = ("mean_hop_time", "mean_collision_time"), 2
KEY_OF_ALL = ("accuracy_cost", "tails", "distributions", "passages", "effects")

#: The tables that have an error for each radius, by the stage that makes them, and the errors whose
#: time the report has.
ERROR_TABLES = {"dynamics": "mean_times", "monte_carlo": "volume"}
TABULATED_ERRORS = (1e-3, 1e-4, 1e-5, 1e-6)

#: Pixels: the width of a thumbnail.
THUMBNAIL = 320

#: Pixels of a figure per pixel on the screen.
PIXEL_DENSITY = 2

#: The form of a symbol with a subscript in a caption: r_c.
SUBSCRIPT = re.compile(r"\b([A-Za-z])_(\w+)\b")

#: A number as Python prints it.
NUMBER = re.compile(r"(?P<digits>[-+]?[\d.]+)(?:e(?P<exponent>[-+]?\d+))?")

#: The first sentence of a caption: its full stop is no decimal point.
SENTENCE = re.compile(r".*?\.(?= [A-Z(]|$)|.+", re.DOTALL)


def described_box(scene):
    """Return the ``Box`` of a scene with "width", "height" and "effects", among these "discs"."""
    return Box(scene["width"], scene["height"], **scene.get("effects", {}))


def agreement(folder, scene):
    """Return how the estimates of a scene compare with the exact theory, None without check.csv."""
    own = Path(folder, scene["name"])
    if not (own / "check.csv").exists():
        return None
    check, cost = CheckTable.frame(own / "check.csv"), CostTable.frame(own / "cost.csv")
    check = check[check["passed"].notna()]
    return scene | {
        "comparisons": len(check),
        "events": int(cost["events"][cost["stage"] == "dynamics"].sum()),
        "tests": check["independent"].sum(),
        "failed": (~check["passed"]).sum(),
        "largest": check["z"].abs().max() if len(check) else 0.0,
        "radii": len(GridTable.frame(own / "grid.csv")),
    }


def mean_times(folder, scene):
    """Return {radius: [[event, estimate, error, exact, z], …]} of a scene as texts.

    Without an error it is the status of the estimate. Nothing is returned without mean_times.csv.
    """
    path, by_radius = Path(folder, scene["name"], "mean_times.csv"), {}
    for row in MeanTimesTable.read(path) if path.exists() else ():
        one = described_box(scene).scene(row["radius"])
        quantity, value, error, exact, _, z, _, status = measurement(one, row).cells()
        event = quantity.removesuffix("_time").replace("_", " ")
        by_radius.setdefault(row["radius"], []).append([event, value, error or status, exact, z])
    return by_radius


def accuracies(folder, scene):
    """Return the rows of the section on accuracy: what the jobs of a scene reached in what time.

    A row is a stage at a radius: the relative error asked for and the largest one that was reached,
    with its quantity, the processor time, and the times that ``TABULATED_ERRORS`` take at the same
    speed.
    """
    jobs_of, rows = taken(folder, scene), []
    for stage, name in ERROR_TABLES.items():
        path = Path(folder, scene["name"], f"{name}.csv")
        jobs, speed = jobs_of.get(stage, ({}, None))
        table = SCENE_TABLES[name].read(path) if path.exists() else ()
        for radius, of_radius in groupby(table, itemgetter("radius")):
            known = {row["stderr"] / row["estimate"]: row for row in of_radius if row["stderr"]}
            events, seconds = jobs.get(radius, (None, None))
            if known and events and speed:
                reached = max(known)
                times = [events / speed * (reached / error) ** 2 for error in TABULATED_ERRORS]
                rows.append(
                    {
                        "radius": radius,
                        "quantity": row_quantity(known[reached]),
                        "asked": known[reached].get("target"),
                        "reached": reached,
                        "seconds": format_seconds(seconds),
                        "times": [format_seconds(time) for time in times],
                    }
                )
    return rows


def figure(folder, path, scenes):
    """Return title, caption and picture of the figure at ``path``, relative to ``folder``.

    A figure without a scene is about the first scene without effects.
    """
    entry, scene = ALL_FIGURES[path.stem], scenes.get(path.parts[0])
    main = next((candidate for candidate in scenes.values() if not candidate["effects"]), None)
    about = scene or main
    text = entry.caption(about and described_box(about))
    if scene:
        text += f" The box is {scene['box']} (scene “{scene['name']}” of the configuration)."
    with Image.open(Path(folder, path)) as image:
        width = image.width // PIXEL_DENSITY
    return {
        "alt": SENTENCE.match(text)[0],
        "caption": Markup(SUBSCRIPT.sub(r"\1<sub>\2</sub>", str(escape(text)))),
        "file": path.with_suffix(".gif" if entry == ANIMATION else ".pdf"),
        "name": path.stem,
        "picture": path,
        "title": entry.title,
        "uri": _uri(Path(folder, path).read_bytes()),
        "width": width,
    }


def _uri(png):
    return f"data:image/png;base64,{b64encode(png).decode()}"


def _encoded(image, colours):
    """Return an ``image`` in some ``colours`` as an address that holds it."""
    png = BytesIO()
    image.quantize(colours).save(png, "PNG", optimize=True)
    return _uri(png.getvalue())


def thumbnail(folder, path, scenes):
    """Return the ``figure`` at ``path`` with a small picture of it."""
    with Image.open(Path(folder, path)) as image:
        small = image.convert("RGB")
    small.thumbnail((THUMBNAIL, 2 * THUMBNAIL))
    return figure(folder, path, scenes) | {"uri": _encoded(small, 32)}


def movie(folder, path, scenes):
    """Return the animation at ``path`` with its frame of the longest duration, the hop."""
    with Image.open(Path(folder, path)) as image:
        frames = (
            (one.info["duration"], one.convert("RGB")) for one in ImageSequence.Iterator(image)
        )
        _, longest = max(frames, key=itemgetter(0))
    return figure(folder, path, scenes) | {"still": _encoded(longest, 64)}


def key_figures(paths, of_scene):
    """Return the paths of the key figures among ``paths``, for one scene or for all scenes."""
    here = {path.stem: path for path in paths}
    if not of_scene:
        return [here[name] for name in KEY_OF_ALL if name in here]
    wanted = [
        *KEY_FIGURES,
        *(n for n, e in ALL_FIGURES.items() if e.category != GEOMETRY and e != ANIMATION),
    ]
    return [here[name] for name in dict.fromkeys(wanted) if name in here][:KEY_FIGURES_SHOWN]


def section(folder, paths, scenes, scene=None):
    """Return a section of the report: figures and tables at ``paths``, of a scene or of all."""
    pictures = [path for path in paths if path.suffix == ".png"]
    movies = [path for path in pictures if path.stem == "animation"]
    key = key_figures(pictures, scene is not None)
    others = [path for path in pictures if path not in key and path not in movies]
    effects = (scene or {}).get("effects") or {}
    return {
        "animation": movie(folder, movies[0], scenes) if movies else None,
        "box": scene and scene["box"],
        "compiled": [f"{n.replace('_', ' ')} {v}" for n, v in effects.items() if n != "discs"],
        "discs": scene and _discs(described_box(scene)),
        "detected": [event.replace("_", " ") for event in (scene or {}).get("detected", ())],
        "figures": [figure(folder, path, scenes) for path in key],
        "name": scene and scene["name"],
        "tables": [path for path in paths if path.suffix == ".csv"],
        "thumbnails": [thumbnail(folder, path, scenes) for path in others],
    }


def _discs(box):
    return f"{'two' if box.discs == 2 else box.discs} {box.noun}"


def contents(folder, files, scenes, run):
    """Return the values of the template for the ``files`` in ``folder``, relative to ``folder``.

    ``scenes`` are [{"name": …, "box": "1.5 × 1.0", "effects": {…}, "detected": [event, …]}], and
    ``run`` is the command that builds targets of this configuration, of Snakemake if it is that of
    the folder of the run.
    """
    by_name = {scene["name"]: scene for scene in scenes}
    paths = [path for path in map(PurePosixPath, files) if path.suffix in (".csv", ".png")]
    of_all = [path for path in paths if path.parts[0] not in by_name]
    sections = [
        section(folder, [path for path in paths if path.parts[0] == name], by_name, scene)
        for name, scene in by_name.items()
    ]
    sections += [section(folder, of_all, by_name)] if of_all else []
    measured = {scene["name"]: mean_times(folder, scene) for scene in scenes}
    return {
        # The report opens on all mean times if they have at most this number of rows.
        "few": sum(len(rows) for radii in measured.values() for rows in radii.values()) <= 60,
        "measured": {name: radii for name, radii in measured.items() if radii},
        "accuracies": {
            scene["name"]: rows for scene in scenes if (rows := accuracies(folder, scene))
        },
        "errors": TABULATED_ERRORS,
        "missed": [line for scene in scenes for line in missed(folder, scene)],
        "agreements": [agreed for scene in scenes if (agreed := agreement(folder, scene))],
        "commit": commit(Path(__file__).parent),
        "date": date.today(),
        "paper": "paper.pdf" in files,
        "run": run,
        "sections": sections,
        "versions": versions(),
    }


def typeset(text):
    """Return a text as HTML, a number with a minus sign and a power of ten: −4.4 × 10⁻⁵."""
    if not (found := NUMBER.fullmatch(text)):
        return text
    digits, exponent = found["digits"].replace("-", "−"), found["exponent"]
    if exponent is None:
        return digits
    power = Markup(f"10<sup>{str(int(exponent)).replace('-', '−')}</sup>")
    return power if digits == "1" else f"{digits} × " + power


def short(number):
    """Return a number of events as HTML, to two digits if it is large."""
    return str(number) if number < 1000 else typeset(f"{number:.1e}")


def relative_error(error):
    """Return a relative error as HTML, to two digits; None is a dash."""
    return "–" if error is None else typeset(f"{error:.1e}".replace(".0e", "e"))


def page(template, shown):
    """Return the report: the Jinja ``template``, a text, filled with ``shown``."""
    from jinja2 import Environment, StrictUndefined

    environment = Environment(
        autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True
    )
    environment.filters |= {"error": relative_error, "short": short, "typeset": typeset}
    environment.filters["three_digits"] = lambda x: f"{x:.3g}"  # as in check.passed
    return environment.from_string(template).render(shown)
