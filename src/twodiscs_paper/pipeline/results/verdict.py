"""The verdict: do the check tables of all scenes, and the scores z of studies, show a disagreement?

    python -m twodiscs_paper.pipeline.results.verdict results/paper/check.csv … \\
        --studies results/passages.csv … --configuration @results/configuration.json \\
        --output check.passed

The verdict checks each table again. It counts the comparisons, computes the bound from their
number, and compares z with it. It also compares z with the deviation of the estimate in standard
errors. It computes the rows on all radii again, and requires every comparison of the configuration,
and every row that a study declares as due.
Without an error bar (few events, or none) z is taken from the table; so are the rows of a study.
"""

import math
import sys
from collections import Counter
from pathlib import Path

from twodiscs.arguments import Parser, parameters, run
from twodiscs.comparison.scene_tables import SCENE_TABLES
from twodiscs.model.checks import InputError
from twodiscs_paper.catalogue import STUDIES, STUDY_TABLES
from twodiscs_paper.configuration.load import load

#: The columns that identify a row of a study, as far as its table has them.
NAMES = (
    "scene", "discs", "event", "quantity", "method", "moment_of_inertia", "friction", "radius",
    "time",
)  # fmt: skip

#: The columns of an estimate and its error, and of its reference and its error: the first pair that
#: a row has.
ESTIMATES = ("estimate", "stderr"), ("dynamics", "dynamics_stderr")
REFERENCES = ("exact", ""), ("reference", "reference_stderr"), ("monte_carlo", "monte_carlo_stderr")

#: The values of the column ``passed`` in words.
ANSWERS = {True: "passed", False: "not passed", None: "not compared"}

#: The comparisons that combine the scores of others.
OF_SCORES = ("z_mean", "z_spread")


def named(row):
    """Return the name of a comparison of a scene for a sentence."""
    where = "over all radii" if row["radius"] is None else f"at radius {row['radius']!r}"
    return f"{row['comparison']} of {row['quantity']} {where} by {row['method']}"


def named_of_study(row):
    """Return the name of a row of a study for a sentence."""
    return ", ".join(f"{name} {row[name]}" for name in NAMES if row.get(name) is not None)


def summary(scene, rows):
    """Return the sentence on a scene that passed, with the number of weak comparisons.

    These are comparisons with too few events for an error bar, and rows that are not compared.
    """
    tested = [row for row in rows if row["z"] is not None]
    tests = sum(bool(row["independent"]) for row in tested)
    few = sum(row["status"] in ("too-few", "none-seen") for row in tested)
    largest = max((abs(row["z"]) for row in tested), default=0.0)
    return (
        f"{scene}: {len(tested)} comparisons passed, {tests} of them tests, "
        f"largest |z| {largest:.3g}; {few} had too few events for an error, "
        f"{len(rows) - len(tested)} more could not be compared"
    )


def study_summary(study, rows):
    """Return the sentence on a study that passed."""
    tested = [abs(row["z"]) for row in rows if row["z"] is not None]
    return f"{study}: {len(tested)} comparisons passed, largest |z| {max(tested):.3g}"


def deviation(row):
    """Return the deviation of the estimate of a row in standard errors; None without error bar."""
    (value, error), (reference, spread) = (
        next(
            ((row[value], row.get(error)) for value, error in pairs if row.get(value) is not None),
            (None, None),
        )
        for pairs in (ESTIMATES, REFERENCES)
    )
    if value is None or reference is None or not error:
        return None
    return (value - reference) / math.hypot(error, spread or 0.0)


def agrees(z, off, test):
    """Return whether a score z is consistent with an estimate that is ``off`` standard errors off.

    z uses the error of the exact value, not of the estimate, and Student's law. With the 100 events
    that an error bar needs, and the 1000 events of a normal test, the two differ by less than the
    margin here. A z by Chernoff's bound is conservative and may be much smaller.
    """
    least = min(abs(z), abs(off))
    margin = 0.2 + least**2 / 10 + least**3 / 300
    if test == "cluster-bound":
        return abs(z) <= abs(off) + margin and (z == 0 or (z > 0) == (off > 0))
    return abs(z - off) <= margin


def _of_parts(row):
    """Return whether z combines the parts of an area, two shells that overlap, each with a tail."""
    return row.get("quantity") == "any_wall_area" and row.get("test") == "exact-tail"


def judged(rows, alarm, name):
    """Yield a sentence on each of the comparisons ``rows`` that fails or contradicts itself.

    If nothing is wrong, a comparison fails with the probability ``alarm`` at most, by Bonferroni's
    bound. ``name`` is a function that returns the name of a row.
    """
    from twodiscs.comparison import scores  # which needs numpy and scipy

    tested = [row for row in rows if row["z"] is not None]
    common = scores.bonferroni_bound(len(tested), alarm) if tested else None
    answers, bounds = [], []
    for row in rows:
        z, off = row["z"], deviation(row)
        bound, passed = (None, None) if z is None else (common, abs(z) <= common)
        if passed is False:
            yield f"{name(row)} has z = {z:.3g}, beyond the bound {bound:.3g}"
        elif None not in (z, off) and not _of_parts(row) and not agrees(z, off, row.get("test")):
            yield f"{name(row)} has z = {z:.3g}, but its estimate is {off:.3g} standard errors off"
        if row.get("passed", passed) is not passed:
            printed, true = ANSWERS[row["passed"]], ANSWERS[passed]
            answers.append(f"{name(row)} is {true}, but the table says {printed}")
        if not _is_near(row.get("bound", bound), bound):
            correct = f"the bound of {len(tested)} comparisons is {bound}"
            bounds.append(f"{name(row)} has the bound {row['bound']}, but {correct}")
    for sentences in filter(None, (answers, bounds)):
        more = len(sentences) - 1
        yield sentences[0] + (f"; the same holds for {more} more" if more else "")


def _is_near(value, other):
    """Return whether two numbers, or None, are the same up to the last digits."""
    return value == other or (None not in (value, other) and math.isclose(value, other))


def due(scene):
    """Yield (comparison, quantity, radius) of all comparisons of a ``SceneRequest``."""
    from twodiscs.comparison.check import SUM_RULE
    from twodiscs.theory import virial

    quantities = scene.quantities
    for radius in scene.radii:
        if quantities.volume:
            yield "volume", "volume", radius
        yield from (("area", f"{event}_area", radius) for event in quantities.areas)
        yield from (("mean_time", f"{event}_time", radius) for event in quantities.mean_times)
        if {*SUM_RULE} <= {*quantities.mean_times} and virial.weights(scene.box.scene(radius)):
            yield "sum_rule", "mean_times", radius
    for radius in quantities.hop_histogram:
        yield "hop_interval", f"{scene.histogram['event']}_interval", radius


def scene_failures(rows, scene=None):
    """Yield a sentence on each fault in the ``rows`` of check.csv of a ``SceneRequest``.

    Without a ``scene`` no row is required.
    """
    from twodiscs.comparison import check, scores

    found = Counter((r["comparison"], r["quantity"], r["radius"], r["method"]) for r in rows)
    yield from _some("is duplicated", (key for key, n in found.items() if n > 1))
    there = {key[:3] for key in found if key[0] not in (*OF_SCORES, "flux")}
    asked = {*due(scene)} if scene else there
    # A hop that is measured in a strip is also counted from ordinary initial states.
    counted = {(*key[:3], "dynamics") for key in found if key[3] == "strip" and key[2] is not None}
    yield from _some("is missing", [*(asked - there), *(counted - found.keys())])
    yield from _some("is not requested", there - asked)

    local = [row for row in rows if row["comparison"] not in OF_SCORES]
    tested = [row for row in local if row["z"] is not None]
    over_radii = [row for row in rows if row["comparison"] in OF_SCORES]
    if not tested:
        yield "nothing is compared"
    yield from judged(local, scores.FALSE_ALARM / 2, named)
    yield from judged(over_radii, scores.FALSE_ALARM / 2, named)
    finite = [row for row in tested if math.isfinite(row["z"])]
    mine = {named(row): row["z"] for row in check.distributions(finite)}
    theirs = {named(row): row["z"] for row in over_radii}
    for name in {**mine, **theirs}:
        if not _is_near(mine.get(name), theirs.get(name)):
            yield f"{name} has z = {theirs.get(name)}, but by the other rows it is {mine.get(name)}"


def _some(what, keys):
    """Yield one sentence on the first of the ``keys`` and their number, if there is any."""
    if keys := sorted(keys, key=str):
        comparison, quantity, radius, *methods = keys[0]
        by = "".join(f" by {method}" for method in methods)
        more = f", and so are {len(keys) - 1} more" if len(keys) > 1 else ""
        yield f"{comparison} of {quantity} at radius {radius}{by} {what}{more}"


def study_failures(rows, due=()):
    """Yield a sentence on each fault of the ``rows`` of a study, which has at least those ``due``.

    Each row that is due, {column: value}, has a score z if it has an estimate and a reference. Each
    row with a test has a score.
    """
    from twodiscs.comparison import scores

    due = [tuple(row.items()) for row in due]
    names = [name for name, _ in due[0]] if due else []
    usable = (row for row in rows if row["z"] is not None or deviation(row) is None)
    there = Counter(tuple((name, row[name]) for name in names) for row in usable)
    if missing := sorted((Counter(due) - there).elements(), key=str):
        more = f", and so are {len(missing) - 1} more" if len(missing) > 1 else ""
        yield f"{named_of_study(dict(missing[0]))} is missing, or has no score{more}"
    if empty := [row for row in rows if row["z"] is None and row.get("test")]:
        more = f", and so have {len(empty) - 1} more" if len(empty) > 1 else ""
        yield f"{named_of_study(empty[0])} has a test, but no score{more}"
    found = Counter(tuple(row.items()) for row in rows if row["z"] is not None)
    if not found:
        yield "nothing is compared"
    for row, n in found.items():
        if n > 1:
            yield f"{named_of_study(dict(row))} is duplicated"
    yield from judged(rows, scores.FALSE_ALARM, named_of_study)


def verdict(tables, studies, scenes=None, due=None):
    """Return (failures, summary) of tables, each {name: rows}.

    ``tables`` are the check tables of scenes, and ``scenes`` the ``SceneRequest`` of each by its
    name. ``studies`` have scores z without verdicts: by Bonferroni's bound, the probability of a
    false alarm is the same for each study as for a scene. ``due``, {name: rows}, are the rows that
    a study must have.
    """
    failures = [
        f"{name}: {sentence}"
        for name, rows in tables.items()
        for sentence in scene_failures(rows, scenes and scenes[name])
    ]
    failures += [
        f"{name}: {sentence}"
        for name, rows in studies.items()
        for sentence in study_failures(rows, due[name] if due else ())
    ]
    if failures:
        return failures, ""
    lines = [summary(scene, rows) for scene, rows in tables.items()]
    lines += [study_summary(study, rows) for study, rows in studies.items()]
    lines = lines or ["nothing is compared, because the configuration asks for no measurement"]
    return [], "".join(f"{line}\n" for line in lines)


def main():
    parser = Parser(prog=__spec__.name, description=__doc__.split("\n")[0])
    parser.add_argument("tables", nargs="*", type=Path, metavar="CSV", help="check.csv of scenes")
    parser.add_argument(
        "--studies", nargs="*", default=[], type=Path, metavar="CSV", help="tables with scores z"
    )
    parser.add_argument("--configuration", required=True, metavar="JSON", help="JSON or @path")
    parser.add_argument("--output", required=True, type=Path, metavar="FILE")
    options = parser.parse_args()
    options.output.unlink(missing_ok=True)  # an old verdict is not about these tables
    configuration = load(parameters(options.configuration))
    scenes = {scene.name: scene for scene in configuration.scenes if "check" in scene.tables}
    tables = {path.parent.name: SCENE_TABLES["check"].read(path) for path in options.tables}
    studies = {path.stem: STUDY_TABLES[path.stem].read(path) for path in options.studies}
    checked = [STUDIES[name] for name in configuration.shared if name in STUDIES]
    checked = {study.tables[0].name(): study for study in checked if study.due}
    wanted = {*scenes, *checked}
    if odd := sorted(wanted ^ {*tables, *studies}):
        names = ", ".join(odd)
        raise InputError(f"tables must be given of {sorted(wanted)}; missing or surplus: {names}")
    due = {name: study.due(configuration) for name, study in checked.items()}
    failures, text = verdict(tables, studies, scenes, due)
    if failures:
        print("\n".join(failures), file=sys.stderr)
        return 1
    print(text, end="")
    options.output.write_text(text, encoding="utf-8", newline="\n")
    return 0


if __name__ == "__main__":
    run(main)
