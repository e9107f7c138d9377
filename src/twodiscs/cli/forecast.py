"""Say what a configuration will take on this machine, before it is run: the job of ``forecast``.

    python -m twodiscs.cli.forecast --configuration "$(cat configuration.json)" --cores 2 \\
        --output forecast.csv
"""

import json

from twodiscs import tables
from twodiscs.cli import arguments
from twodiscs.config import load


def duration(seconds):
    """Return ``seconds`` as people say it."""
    if seconds < 100:
        return f"{seconds:.1f} s"
    return f"{seconds / 60:.1f} min" if seconds < 6000 else f"{seconds / 3600:.1f} h"


def sentences(rows):
    """Return the lines to print: every stage of every scene, without its single jobs."""
    cores = rows[-1]["cores"]
    on = "1 core" if cores == 1 else f"{cores} cores"
    lines = [f"{'scene':<16}{'stage':<16}{'jobs':>6}{'events':>10}{'one core':>12}{on:>12}"]
    for row in rows:
        if row["radius"] is None:
            events = f"{row['events']:.2g}" if row["events"] is not None else ""
            alone = duration(row["seconds"] + row["startup"])
            lines.append(
                f"{row['scene']:<16}{row['stage']:<16}{row['jobs']:>6}{events:>10}{alone:>12}"
                f"{duration(row['wall_clock']):>12}"
            )
    return lines


def main():
    """Forecast, write the table and print its sums."""
    parser = arguments.Parser(prog="python -m twodiscs.cli.forecast", description=__doc__)
    parser.add_argument("--configuration", required=True, help="the configuration, as JSON")
    parser.add_argument("--cores", required=True, type=int, help="how many jobs run at once")
    parser.add_argument("--output", required=True, help="forecast.csv")
    options = parser.parse_args()
    from twodiscs import forecast

    rows = forecast.rows(load(json.loads(options.configuration)), options.cores)
    tables.write(options.output, "forecast", rows)
    print("\n".join(sentences(rows)))


if __name__ == "__main__":
    arguments.run(main)
