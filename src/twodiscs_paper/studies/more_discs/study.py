"""More than two discs: mean times against exact values if these are known, and the virial sum."""

from twodiscs.analysis.columns import COUNT, HEIGHT, NUMBER, RADIUS, TEXT, WIDTH, Column, Table
from twodiscs.figures.scene_figures import DYNAMICS, Figure
from twodiscs_paper.study import AS_EXACT, Study, scaled


class MoreDiscsTable(Table):
    """
    One row per number of discs, radius and event, in boxes whose width is in proportion to the
    number of discs, at the energy per disc of two discs. Six tori have a row each.
    """

    columns = {
        "discs": COUNT("number of discs"),
        "width": WIDTH,
        "height": HEIGHT,
        "radius": RADIUS,
        "periodic": TEXT("axes without walls: xy on a torus, otherwise empty"),
        "theory": TEXT(
            "the theory that gives exact values: plain, three, channel, or none if none is known; "
            "series: the virial series to the tenth coefficient, with the correction of the order "
            "1/N"
        ),
        "states": TEXT(
            "how initial states are drawn: rejection and channel are exact, chain is tested"
        ),
        "event": TEXT(
            "collisions and hops of any pair of discs, hits of one disc at one wall; virial: the "
            "sum of rates that is 1; compressibility_factor: Z = PA/(N kT) on a torus"
        ),
        "exact": Column(
            float,
            "time, 1 for virial and compressibility_factor",
            "exact mean time over all initial conditions, or Z; empty if none is known",
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


class ToriTable(Table):
    """
    One row per number of discs on a torus, packing fraction, start and reference: the
    compressibility factor Z = PA/(N kT) from collisions.
    """

    columns = {
        "discs": COUNT("number of discs"),
        "aspect": TEXT("width to height of the torus"),
        "packing_fraction": NUMBER("share of the area that discs cover"),
        "start": TEXT(
            "rows: initial states as all calls draw them, by event chains from rows of discs; "
            "compressed: by as many chains from a compressed liquid; both: the mean of the two"
        ),
        "replicas": COUNT("number of initial states"),
        "events": COUNT("number of collisions"),
        "estimate": NUMBER("Z"),
        "stderr": NUMBER("its standard error"),
        "reference": TEXT(
            "virial: the virial series to the tenth coefficient, with the correction of the order "
            "1/N; li-2022 and metropolis-1953: published pressures at the same N and aspect"
        ),
        "expected": NUMBER("Z of the reference"),
        "expected_stderr": NUMBER(
            "its standard error; of the virial series an estimate of the coefficients left out"
        ),
        "z": NUMBER("standard normal deviate of the estimate from the reference"),
        "starts_z": NUMBER("difference of the two starts in standard errors, 0 in equilibrium"),
    }

    @staticmethod
    def part(seed, points):
        """Return the rows of a long run (see ``tori.counted``)."""
        from twodiscs_paper.studies.more_discs import tori

        return tori.rows(tori.counted(seed, points))


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
    long_runs=(ToriTable,),
    seconds=10.0,
    order=8,
    figures={
        "more_discs": Figure(
            "More discs",
            DYNAMICS,
            """Mean times of N discs in a box of 0.75 N × 1, at the energy per disc of two discs:
            exact if a theory is known (lines), by Monte Carlo (dotted) and by event-driven
            molecular dynamics (symbols). Times are per pair of discs, per pair of neighbours or per
            disc, as the legend says, so that they depend little on N. Error bars are one standard
            error; they are hidden if they are smaller than the symbols. At r = 0.28 only neighbours
            touch, and a transfer operator gives every N. (d) Residuals z of the dynamics in
            standard errors, from exact values, or from Monte Carlo if no exact value is known;
            radii stand side by side. From 16 discs on, insertions take too long and only the virial
            theorem tests dynamics where no exact value is known.""",
            tables=("more_discs",),
        ),
        "tori": Figure(
            "Pressure on a torus",
            DYNAMICS,
            """(a) Compressibility factor Z = PA/(N kT) of N discs on a torus against the packing
            fraction φ, from the rate of collisions by the virial theorem (symbols): 256 discs
            beside the virial series to the tenth coefficient (line, dotted where the last terms
            matter), and 72 to 870 discs at the points of Metropolis and others (1953) and of Li and
            others (2022), with their values (crosses). (b) Their deviations in standard errors of
            both. Grey symbols: results from two sets of initial states, from rows and from a
            compressed liquid, differ by more than three standard errors, so the replicas are not in
            equilibrium. The pressures of 1953 are too low between φ = 0.5 and 0.7; those of 2022
            are met.""",
            long_runs={"tori": "paper/long_run/tori/tori.csv"},
        ),
    },
    parameters=_parameters,
    checked=True,
)
