"""Write thresholds.csv: power laws fitted to the times where an event dies out.

    python -m twodiscs.cli.thresholds --scenes "{'paper': (1.5, 1.0)}" \\
        --times paper=results/paper/mean_times.csv --distributions results/distributions.csv \\
        --output results/thresholds.csv
"""

from twodiscs import tables
from twodiscs.cli import arguments


def main():
    parser = arguments.Parser(prog="twodiscs.cli.thresholds", description="Fit power laws.")
    parser.add_argument("--scenes", required=True, help="dict {name: (width, height)}")
    parser.add_argument("--times", action="append", default=[], metavar="SCENE=CSV")
    parser.add_argument("--distributions", required=True, metavar="CSV")
    parser.add_argument("--output", required=True, metavar="CSV")
    options = parser.parse_args()
    scenes = arguments.parameters(options.scenes)
    times = {}
    for text in options.times:
        name, mark, path = text.partition("=")
        if not mark or name not in scenes:
            raise ValueError(f"times must be SCENE=PATH with one of the scenes, not {text!r}")
        times[name] = tables.read(path, "mean_times")
    passages = tables.read(options.distributions, "distributions")

    from twodiscs import thresholds

    tables.write(options.output, "thresholds", thresholds.rows(scenes, times, passages))


if __name__ == "__main__":
    arguments.run(main)
