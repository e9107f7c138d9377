"""Follow one trajectory and write its events: the job of rule ``trajectory``."""

from twodiscs.cli.arguments import run
from twodiscs.cli.points import arguments
from twodiscs.tables import TABLES, write


def main():
    """Read the parameters, simulate, write the table."""
    point, scene, output, _ = arguments(__doc__)
    from twodiscs import dynamics

    columns = TABLES["trajectory"].names
    rows = dynamics.trajectory(scene, point["seed"])
    write(output, "trajectory", [dict(zip(columns, row, strict=True)) for row in rows])


if __name__ == "__main__":
    run(main)
