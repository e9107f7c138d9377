"""Where the time of a build goes: what Snakemake measured of every job, by kind of job.

    python -m twodiscs_paper.pipeline.results.spent results

Times are in seconds, memory in MiB.
"""

from pathlib import Path

from twodiscs.arguments import Parser, run
from twodiscs.model.checks import InputError

#: The columns that are shown, and what Snakemake calls them; memory is in MiB.
COLUMNS = {"seconds": "s", "processor": "cpu_time", "memory": "max_rss"}


def spent(folder):
    """Return a DataFrame of the jobs whose files are in ``folder``/benchmarks, a row each kind.

    The kind of a radius is the folder, that of all else the name up to the first hyphen.
    Columns are the number of jobs, their seconds of wall-clock and of processor time in all, and
    the largest memory of one in MiB; what takes longest comes first. Raises ``InputError`` for a
    folder in which no job was measured.
    """
    import pandas

    paths = sorted(Path(folder, "benchmarks").rglob("*.tsv"))
    if not paths:
        raise InputError(f"{folder} must be a folder of results, with benchmarks/*.tsv in it")
    kinds = [p.parent.name if p.stem[0].isdigit() else p.stem.split("-")[0] for p in paths]
    # A job that is over before anything is measured has "NA" there.
    spent = pandas.concat(
        [
            pandas.read_csv(path, sep="\t").assign(kind=kind)
            for path, kind in zip(paths, kinds, strict=True)
        ]
    )
    spent = spent.rename(columns={theirs: ours for ours, theirs in COLUMNS.items()})
    kinds = spent.groupby("kind")
    table = kinds[["seconds", "processor"]].sum().assign(memory=kinds["memory"].max())
    table.insert(0, "jobs", kinds.size())
    return table.sort_values("seconds", ascending=False)


def main():
    parser = Parser(prog=__spec__.name, description=__doc__.split("\n")[0])
    parser.add_argument("folder", metavar="RESULTS")
    table = spent(parser.parse_args().folder)
    table.loc["all"] = [*table[["jobs", "seconds", "processor"]].sum(), table["memory"].max()]
    table = table.rename(columns={"memory": "memory (MiB)"})
    print(table.round(1).astype({"jobs": int}).to_string())


if __name__ == "__main__":
    run(main)
