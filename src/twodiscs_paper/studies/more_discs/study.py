"""More than two discs: mean times against exact values if these are known, and the virial sum."""

from twodiscs.analysis.columns import COUNT, HEIGHT, NUMBER, RADIUS, TEXT, WIDTH, Column, Table
from twodiscs.figures.scene_figures import DYNAMICS, Caption, Figure
from twodiscs_paper.study import AS_EXACT, Study, scaled


class MoreDiscsTable(Table):
    """
    One row per number of discs, radius and event, in boxes whose width is in proportion to the
    number of discs, at the energy per disc of two discs.
    """

    columns = {
        "discs": COUNT("number of discs"),
        "width": WIDTH,
        "height": HEIGHT,
        "radius": RADIUS,
        "theory": TEXT(
            "the theory that gives exact values: plain, three, channel, or none if none is known"
        ),
        "states": TEXT(
            "how initial states are drawn: rejection and channel are exact, chain is tested"
        ),
        "event": TEXT(
            "collisions and hops of any pair of discs, hits of one disc at one wall; virial: the "
            "sum of rates that is 1"
        ),
        "exact": Column(
            float,
            "time, 1 for virial",
            "exact mean time over all initial conditions; empty if none is known",
        ),
        "monte_carlo": AS_EXACT(
            "mean time from volume and area by insertion; empty for 16 discs and more, for which "
            "it takes long"
        ),
        "monte_carlo_stderr": AS_EXACT("its standard error"),
        "monte_carlo_z": NUMBER(
            "its standard normal deviate from the exact value; empty where none is known"
        ),
        "dynamics": AS_EXACT("mean time from counts of events"),
        "dynamics_stderr": AS_EXACT("its standard error"),
        "z": NUMBER(
            "standard normal deviate of dynamics from the exact value, or from Monte Carlo if "
            "none is known"
        ),
    }

    @staticmethod
    def rows(events, samples, seed):
        """Return the rows from about ``events`` and ``samples`` for each scene."""
        from twodiscs_paper.studies.more_discs import measure

        return measure.rows(events, samples, seed)


def _parameters(configuration):
    budget = configuration.study_events
    return {
        "events": scaled(budget, 500, 10**5, 10**8),
        "samples": scaled(budget, 4000, 10**4, 10**7),
        "seed": configuration.seed,
    }


STUDY = Study(
    "more_discs",
    builds="mean times of three to 64 discs",
    tables=(MoreDiscsTable,),
    seconds=10.0,
    order=8,
    figures={
        "more_discs": Figure(
            "More discs",
            DYNAMICS,
            Caption(
                """
                Mean times of N discs in a box of 0.75 N × 1, at the energy per disc of two discs:
                exact if a theory is known (lines), by Monte Carlo (dotted) and by event-driven
                molecular dynamics (symbols). Times are per pair of discs, per pair of neighbours or
                per disc, as the legend says, so that they depend little on N. Error bars are one
                standard error; they are hidden if they are smaller than the symbols. At r = 0.28
                only neighbours touch, and a transfer operator gives every N. (d) Residuals z of the
                dynamics in standard errors, from exact values, or from Monte Carlo if no exact
                value is known; radii stand side by side. From 16 discs on, insertions take too long
                and only the virial theorem tests dynamics where no exact value is known.
                """
            ),
            tables=("more_discs",),
        ),
    },
    parameters=_parameters,
    checked=True,
)
