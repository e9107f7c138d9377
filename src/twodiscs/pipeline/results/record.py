"""What jobs say of the files they wrote: their hashes, and what made them.

    python -m twodiscs.pipeline.results.record results

holds all results against that record. It is a file ``.record/NAME.json`` beside each file, of bytes
that are the same on every run if those of the file are. Its time stamp is that of the file: so what
was touched since is found without reading anything.
"""

import json
import os
import sys
from base64 import urlsafe_b64encode
from collections import defaultdict
from contextlib import suppress
from hashlib import sha256
from pathlib import Path

from twodiscs.model.checks import InputError
from twodiscs.pipeline.arguments import Parser, run

FOLDER = ".record"

#: Where an RO-Crate of results has the texts of the workflow. No scene can be called like this.
WORKFLOW = "_workflow"

#: Whether Snakemake makes incomplete files again: the profile says so here, too.
AGAIN = False

#: What is written without a record: by Snakemake itself, or for one moment.
UNRECORDED = ("logs", "benchmarks", ".compiled", "needed", WORKFLOW, "configuration.json",
              "provenance.json", "forecast.csv", "report.html", "report-workflow.html",
              "README.md")  # fmt: skip


def digest(*paths):
    """Return the SHA-256 of files, one after the other, in hexadecimal digits."""
    found = sha256()
    for path in paths:
        found.update(Path(path).read_bytes())
    return found.hexdigest()


def short(text):
    """Return 16 hexadecimal digits of the SHA-256 of a text."""
    return sha256(text.encode()).hexdigest()[:16]


def record_of(path):
    """Return where the record of a file is."""
    return path.parent / FOLDER / f"{path.name}.json"


def write(paths, inputs, **made):
    """Record that files at ``paths`` come from ``inputs``, {name: paths}, and how they were made.

    Inputs are kept as hashes, with their paths from the folder of each file.
    """
    hashes = {name: (found, digest(*found)) for name, found in inputs.items()}
    for path in map(Path, paths):
        read = {
            name: {"files": [os.path.relpath(one, path.parent) for one in found], "sha256": digits}
            for name, (found, digits) in hashes.items()
        }
        record = record_of(path)
        record.parent.mkdir(exist_ok=True)
        content = {"inputs": read, "made_by": made, "sha256": digest(path)}
        content["seal"] = _seal(content)
        record.write_text(json.dumps(content, indent=1, sort_keys=True) + "\n", encoding="utf-8")
        _stamp(path, record)


def _stamp(path, record):
    times = path.stat()
    os.utime(record, ns=(times.st_atime_ns, times.st_mtime_ns))


def _seal(content):
    """Return the hash of what a record says."""
    return sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()


def read(path):
    """Return the record of a file, None if there is none or it is damaged."""
    with suppress(OSError, ValueError, TypeError, KeyError, AttributeError):
        content = json.loads(record_of(Path(path)).read_text(encoding="utf-8"))
        if content.pop("seal") == _seal(content):
            return content
    return None


def require(path):
    """Raise ``InputError`` for a file that is not what its job wrote."""
    record = read(path)
    if record is not None and digest(path) != record["sha256"]:
        raise InputError(f"{path} is not what its job wrote; delete it, and it is made again")


def is_made(paths, made):
    """Say whether the files at ``paths`` are what a job wrote that had the same ``made``."""
    records = [(path, read(path)) for path in paths if Path(path).is_file()]
    return len(records) == len(paths) and all(
        known is not None and known["made_by"] == made and known["sha256"] == digest(path)
        for path, known in records
    )


def file_of(record):
    """Return the file that a record is about."""
    return record.parents[1] / record.name.removesuffix(".json")


def _recorded(folder):
    """Yield (path, its record) of all files below ``folder`` that have one."""
    for place, folders, names in os.walk(folder):
        folders[:] = sorted(set(folders) - {"logs", "benchmarks"})
        if os.path.basename(place) == FOLDER:
            for name in sorted(names):
                yield file_of(Path(place, name)), Path(place, name)


def touched(folder):
    """Return the files below ``folder`` that are not what their jobs wrote.

    Files whose time stamps are those of their records are not read.
    """
    found = []
    for path, record in _recorded(folder):
        if not path.exists() or path.stat().st_mtime_ns == record.stat().st_mtime_ns:
            continue
        known = read(path)
        if known is None or digest(path) != known["sha256"]:
            found.append(path)
        else:
            _stamp(path, record)
    return found


def stale(folder, bundled):
    """Return pairs of a file below ``folder`` and why it is stale, for what Snakemake cannot see.

    That is what was made of a file below it that is gone, or of a point that was made again since,
    of which the time that it took is another one. A point is gone with its bundle, too; ``bundled``
    is what ``bundles`` returns. Points are not looked at: there are many, and they are made of
    nothing but shards.
    """
    found = []

    def is_gone(file):
        if not file.is_relative_to(folder):
            return False  # results may have been copied to another place
        return not file.exists() or (file not in bundled and (file.parent / "bundles").is_dir())

    for path, _ in _recorded(folder):
        if "points" in path.relative_to(folder).parts or not path.exists():
            continue
        if (known := read(path)) is None:
            continue
        made_of = [
            ([Path(os.path.normpath(path.parent / name)) for name in one["files"]], one["sha256"])
            for one in known["inputs"].values()
        ]
        if any(is_gone(file) for files, _ in made_of for file in files):
            found.append((path, "was made of a file that is gone"))
            continue
        written = path.stat().st_mtime_ns
        for files, digits in made_of:
            newer = (f for f in files if "points" in f.parts and f.stat().st_mtime_ns > written)
            if any(newer) and digest(*files) != digits:
                found.append((path, "was made of other points than are there now"))
                break
    return found


def notice(folder, snakemake=".snakemake"):
    """Have Snakemake make again what its jobs did not write like this, with a word for each file.

    To Snakemake these files are incomplete, as those that a killed job has left; of a point that
    was made in a bundle that bundle is. A bundle is removed with a point of it that is gone. What
    is ``stale`` is incomplete, too; but only if incomplete files are made ``AGAIN``, for else
    Snakemake would stop.
    """
    bundled = bundles(folder)
    found = [(path, "is not what its job wrote") for path in touched(folder)]
    if AGAIN:
        found += stale(folder, bundled)
    for path in _unrecorded(folder):
        # Else it is somebody's own, or of a job that went on writing after its shell was killed.
        known = os.path.exists(os.path.join(snakemake, "metadata", name_of(path)))
        found.append((path, "has lost its record" if known else None))
    for one in {one for path, some in bundled.items() if not path.exists() for one in some}:
        _remove(one)  # it holds no longer what it says
    for path, what in found:
        if what:
            print(f"{path} {what}; it is made again when needed.", file=sys.stderr)
        Path(snakemake, "incomplete").mkdir(parents=True, exist_ok=True)
        for one in bundled.get(path, [path]):
            with suppress(OSError):  # a name may be too long
                mark = Path(snakemake, "incomplete", name_of(one))
                mark.write_text('{"external_jobid": null}')


def points_of(bundle, key):
    """Return the two files of a point of a bundle: what was found, and what that took."""
    stage = bundle.parents[1]
    return stage / f"{key}.json", stage.parent / "cost" / f"{stage.name}-{key}.json"


def bundles(folder):
    """Return {file: the bundles that hold it} of the points below ``folder``.

    Those may be several: with another accuracy points are bundled otherwise. Results of another
    configuration may lie deeper.
    """
    found = defaultdict(list)
    for bundle in Path(folder).glob("**/points/*/bundles/*.json"):
        for key in _keys(bundle):
            for path in points_of(bundle, key):
                found[path].append(bundle)
    return found


def _keys(bundle):
    """Return the keys of the points in a bundle, as a set; none if it is damaged."""
    with suppress(OSError, ValueError, TypeError):
        return set(json.loads(bundle.read_text(encoding="utf-8")))
    return set()


def claim(bundle, keys):
    """Remove all bundles beside ``bundle`` that have a point of these ``keys``.

    With another accuracy points are bundled otherwise. Who goes back to the former one must not
    find a bundle of it whose points are no longer those it was made with.
    """
    for other in bundle.parent.glob("*.json"):
        if other != bundle and not _keys(other).isdisjoint(keys):
            _remove(other)


def _remove(bundle):
    with suppress(OSError):  # results may be read only
        bundle.unlink()
        record_of(bundle).unlink()


def name_of(path):
    """Return what Snakemake calls its own file about an output."""
    return urlsafe_b64encode(str(path).encode()).decode()


def _unrecorded(folder):
    """Return the files below ``folder`` that should have a record and have none, sorted."""
    found = []
    for place, folders, names in os.walk(folder):
        folders[:] = [name for name in folders if name not in (FOLDER, *UNRECORDED)]
        paths = [Path(place, name) for name in names if name not in UNRECORDED]
        found += [path for path in paths if not record_of(path).exists()]
    return sorted(found)


def audit(folder, without=()):
    """Yield a sentence for every file below ``folder`` that differs from the record of its job.

    Files at the paths ``without`` are left out.
    """
    for path, record in _recorded(folder):
        if path in without:
            continue
        content = read(path)
        if content is None:
            yield f"{record} is damaged"
        elif not path.exists():
            yield f"{path} is missing"
        elif digest(path) != content["sha256"]:
            yield f"{path} is not what its job wrote"
        else:
            for one in content["inputs"].values():
                inputs = [path.parent / name for name in one["files"]]
                gone = [name for name in inputs if not name.exists()]
                if gone or digest(*inputs) != one["sha256"]:
                    what = os.path.commonpath([os.path.normpath(name) for name in inputs])
                    yield f"{path} was made of another {what}"
    for path in sorted(set(_unrecorded(folder)) - set(without)):
        yield f"{path} was written by no job, or has lost its record"


def main():
    parser = Parser(prog="twodiscs.pipeline.results.record", description=__doc__.split("\n")[0])
    parser.add_argument("folder", type=Path, help="the folder of results")
    folder = parser.parse_args().folder
    if not folder.is_dir():
        raise InputError(f"{folder} holds no results: they are built by make")
    if not any(True for _ in _recorded(folder)):
        raise InputError(f"{folder} holds no results with a record: they are built by make")
    differences = list(audit(folder))
    print(*differences, f"differences from the record of the jobs: {len(differences)}", sep="\n")
    return bool(differences)


if __name__ == "__main__":
    run(main)
