"""Find results that differ from the output of their jobs.

    python -m twodiscs_paper.pipeline.results.audit --configuration results/configuration.json

Files are compared with ``manifest.sha256``, points and shards with their own digests, and the
tables of a scene are made again from its points. An edited table is therefore found even if a later
build has accepted it. Files with run times are not in the manifest.
"""

from pathlib import Path

from twodiscs.arguments import Parser, parameters, run
from twodiscs.comparison.scene_tables import SCENE_TABLES
from twodiscs.model.checks import InputError
from twodiscs.points.digests import digest, read_json
from twodiscs_paper.configuration.load import load
from twodiscs_paper.configuration.request import GATHERED
from twodiscs_paper.pipeline.jobs.table import POINTS, rows_of

EDITED, MISSING = "is not what its job wrote", "is missing"


def of_manifest(path):
    """Yield (file, its fault or None) of the files in the manifest at ``path``.

    Raises ``InputError`` for a file that is no manifest.
    """
    for line in path.read_text(encoding="utf-8").splitlines():
        written, _, name = line.partition("  ")
        if len(written) != 64 or not name:
            raise InputError(f"{path} must have lines of a SHA-256 and a name, not {line[:80]!r}")
        file = path.parent / name
        same = file.is_file() and digest(file) == written
        yield file, None if same else EDITED if file.is_file() else MISSING


def of_points(folder):
    """Yield (file, its fault or None) of all points and shards below ``folder``."""
    for kind in ("points", "shards"):
        for file in sorted(folder.glob(f"**/{kind}/**/*.json")):
            try:
                read = read_json if kind == "shards" else POINTS[file.parent.name].read
                read(file)
            except (InputError, OSError):
                yield file, EDITED
            else:
                yield file, None


def of_tables(folder, scenes):
    """Yield (file, its fault or None) of the tables that are made of points.

    ``scenes`` are ``SceneRequest``s. If a table exists but its points do not, the missing points
    are yielded, too: the table cannot be made again without them.
    """
    for scene in scenes:
        own = folder / scene.name
        tables = [own / f"{name}.csv" for name in GATHERED if name != "cost"]
        if not (tables := [file for file in tables if file.is_file()]):
            continue
        files = {
            stage: [own / "points" / stage / f"{key}.json" for key in keys]
            for stage, keys in scene.keys.items()
        }
        gone = [file for some in files.values() for file in some if not file.exists()]
        yield from ((file, MISSING) for file in gone)
        try:
            points = {stage: [*map(POINTS[stage].read, some)] for stage, some in files.items()}
        except (OSError, InputError):
            continue
        exact = SCENE_TABLES["theory"].rows(scene.box, scene.exact_radii("theory"))
        given = {
            "box": scene.box,
            "areas": scene.quantities.areas,
            "theory": exact,
            "points": points,
        }
        for file in tables:
            table = SCENE_TABLES[file.stem]
            try:
                same = table.read(file) == [*rows_of(table, **given)]
            except InputError:
                same = False
            yield file, None if same else EDITED


def audit(folder, configuration):
    """Return (sentences on faults below ``folder``, the number of files that were read)."""
    differences = [*of_manifest(folder / "manifest.sha256"), *of_points(folder)]
    differences += of_tables(folder, configuration.scenes)
    wrong = dict.fromkeys(f"{file} {fault}" for file, fault in differences if fault)
    return [*wrong], len({file for file, _ in differences})


def main():
    parser = Parser(prog=__spec__.name, description=__doc__.split("\n")[0])
    parser.add_argument(
        "--configuration", required=True, type=Path, help="the file in the folder of results"
    )
    path = parser.parse_args().configuration
    results = path.parent
    if not (results / "manifest.sha256").exists():
        raise InputError(f"{results} has no manifest.sha256: results are built by make")
    wrong, files = audit(results.resolve(), load(parameters(f"@{path}")))
    summary = f"all {files} files are what their jobs wrote"
    if wrong:
        summary = f"{len(wrong)} of {files} files are not what their jobs wrote; "
        summary += "delete them, and they are made again"
    print(*wrong, summary, sep="\n")
    return bool(wrong)


if __name__ == "__main__":
    run(main)
