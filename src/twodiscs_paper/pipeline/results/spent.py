"""The time of a build by kind of job, as Snakemake measured it.

    python -m twodiscs_paper.pipeline.results.spent results

Times are in seconds, memory in MiB.
"""

from pathlib import Path

from twodiscs.arguments import Parser, run
from twodiscs.model.checks import InputError

#: The columns of the table, and their names in Snakemake's files; memory is in MiB.
COLUMNS = {"seconds": "s", "processor": "cpu_time", "memory": "max_rss"}


def spent(folder):
    """Return a DataFrame of the jobs whose files are in ``folder``/benchmarks, a row for each kind.

    The kind of a job at one radius is the name of its folder. The kind of another job is its name
    up to the first hyphen. Columns are the number of jobs, their total wall-clock and processor
    time in seconds, and the largest memory of a job in MiB. The kind with the longest time comes
    first. Raises ``InputError`` for a folder without measured jobs.
    """
    import pandas

    paths = sorted(Path(folder, "benchmarks").rglob("*.tsv"))
    if not paths:
        raise InputError(f"{folder} must be a folder of results, with benchmarks/*.tsv in it")
    kinds = [p.parent.name if p.stem[0].isdigit() else p.stem.split("-")[0] for p in paths]
    # A job that ends before it is measured has "NA" there.
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
