"""How accurate each method is in numerically hard cases."""

from twodiscs.analysis.columns import COUNT, NUMBER, RADIUS, TEXT, TRUTH, Table, Z
from twodiscs.figures.scene_figures import Figure
from twodiscs_paper.study import SEE_QUANTITY, Study, main_box, scaled


class StabilityTable(Table):
    """
    One row per number that says how a method behaves in a numerically hard case, for the box of the
    first scene.
    """

    columns = {
        "part": TEXT(
            "theory: relative errors against 50 digits; sampling: accepted share of the "
            "proposals; estimates: conditioned Monte Carlo; times: errors of predicted times; "
            "dynamics: worst of a run; extremes: mean times in extreme scenes; reversal: reversed "
            "velocities, and the Lyapunov exponent"
        ),
        "quantity": TEXT(
            "the measured quantity. theory: for areas and mean_times the worst of them. times: "
            "error in units of 2⁻⁵² × conditioning. dynamics: energy_error, the largest |E − "
            "1/2|; smallest_gap, the smallest |Δx| − 2r, and excess, the largest distance of a "
            "centre beyond its range, both in units of the largest power of two in the side of "
            "the box; lanes_lost, trajectories that became infinite or stuck. reversal: exponent, "
            "per event; return_error, after count events and back; events_retraced, the number of "
            "events at which it is 2⁻²⁶. extremes: <event>_time, or virial, "
            "the sum rule"
        ),
        "method": TEXT(
            "stable, or closed-form in plain doubles, or the textbook's quadratic formula; "
            "conditioned draws, or rejection from the prism; dynamics, or initial states in a strip"
        ),
        "case": TEXT(
            "ordinary, tiny (1e-9 of the shorter side), or the limit nearby: h/4, w/4, largest "
            "radius. times: how the discs approach. extremes: the scene. reversal: by the way out "
            "and back (return), or by a small separation"
        ),
        "radius": RADIUS,
        "distance": NUMBER(
            "radius/limit − 1, for the limit named in case; in extremes for the largest radius"
        ),
        "count": COUNT("samples, cases, events or repetitions behind the value"),
        "value": SEE_QUANTITY("the measured value; empty if there is none (see status)"),
        "exact": SEE_QUANTITY("its expected value, apart from random and rounding errors"),
        "stderr": SEE_QUANTITY("standard error of the value"),
        "z": Z,
        "low": SEE_QUANTITY("smallest value that passes"),
        "high": SEE_QUANTITY("largest value that passes"),
        "status": TEXT(
            "estimates: as in areas.csv; extremes: as in check.csv; reversal: long if the path "
            "stays exact for more than 2000 events"
        ),
        "passed": TRUTH(
            "whether low ≤ value ≤ high and |z| ≤ 5, as far as these are given; empty without them"
        ),
    }

    @staticmethod
    def rows(box, seed, ordinary, hard):
        """Return all rows of a plain ``Box`` (see ``measure.rows``)."""
        from twodiscs_paper.studies.stability import measure

        return measure.rows(box, seed, ordinary, hard)


class CalibrationTable(Table):
    """One row per scene, call, size and quantity: scatter over seeds beside printed errors."""

    columns = {
        "case": TEXT("the scene, by its name in ``calibration.SCENES``; of a study the kind"),
        "kind": TEXT("plain discs; effects; more discs: more than two"),
        "call": TEXT("the function of the face, or the study"),
        "size": TEXT(
            "least: the smallest that the call accepts; usual; long; small and dense: of a budget; "
            "error; study"
        ),
        "quantity": TEXT(
            "the quantity with an error; of a study the cells that tell its rows apart, the first "
            "of ``calibration.TABLE_NAMES`` first"
        ),
        "test": TEXT("its test or status of the last seed"),
        "seeds": COUNT("seeds: fewer for long calls and for more than eight discs"),
        "scores": COUNT("values with an error"),
        "withheld": COUNT("values without an error"),
        "mean": NUMBER("mean of the scores; a positive one is a value that is too large"),
        "mean_square": NUMBER("mean of their squares"),
        "stderr": NUMBER("standard error of the mean square"),
        "beyond_three": COUNT("scores beyond ±3"),
    }

    @staticmethod
    def rows(seeds, first):
        """Return all rows, of ``seeds`` seeds from ``first`` on (see ``calibration.rows``)."""
        from twodiscs_paper.studies.stability import calibration

        return calibration.rows(seeds, first)

    part = rows  # as a long run is made


def _parameters(configuration):
    ordinary = scaled(configuration.study_events, 8, 10**7, 25 * 10**7)
    return {**main_box(configuration), "hard": ordinary // 10, "ordinary": ordinary}


STUDY = Study(
    "stability",
    builds="how accurate each method is in numerically hard cases",
    tables=(StabilityTable,),
    long_runs=(CalibrationTable,),
    seconds=20.0,
    order=3,
    figures={
        "stability": Figure(
            "Numerically hard cases",
            "5 Numerical stability",
            """Theory and sampling at hard radii; dashed lines are the required bounds. (a) Relative
            error of closed forms in double precision, and of the worst of volume, areas and mean
            times as computed here, below the largest radius. (b) The same on both sides of the
            radii where a hop becomes blocked. (c) Accepted share of proposed configurations, by
            rejection from the prism and by the conditioned sampler of initial states. (d) Number of
            residuals z of each size: of volume and areas by this sampler at hard radii, and of mean
            times in extreme scenes, beside the normal law.""",
            tables=("stability",),
        ),
        "stability_of_runs": Figure(
            "Numerically hard cases of the dynamics",
            "5 Numerical stability",
            """The dynamics in hard cases; dashed lines are the required bounds. (a) Largest values
            in a long run, with the required bounds: error of the energy, overlap of the discs,
            distance of centres beyond their range. Zeros are exact. (b) Worst error of predicted
            times to a contact (circles) and to a wall (squares), against 50 digits, for many kinds
            of approach. Crosses are the quadratic formula of textbooks. (c) Velocities are reversed
            after n events: error of return after n more events, against the binary digits that the
            Lyapunov exponent λ per event costs. The line is one rounding that grows at this rate.
            The legend has the number of events after which half of the digits are lost, and in
            brackets the number that λ predicts. (d) Residuals of mean times, and of the virial
            theorem, in extreme scenes: each effect at its extremes, or discs that hardly fit. Rare
            events without an error bar are left out.""",
            tables=("stability",),
        ),
        "calibration": Figure(
            "Error bars, tested",
            "5 Numerical stability",
            """Mean square of scores over seeds, for each quantity with an error, of each call in
            each scene, and of each study at a small size. A score is the deviation over its own
            standard error, from the exact value or from the mean over all seeds if no exact value
            is known; the mean square is 1 if errors are right. Symbols are quantities of one scene:
            plain discs (circles), discs with effects (squares) and more than two discs (triangles).
            The grey band is five standard deviations of the mean square of as many normal scores.
            Symbols of the shortest runs that the call accepts are open; longer ones, with fewer
            seeds, are left out. No build repeats these counts.""",
            long_runs={"calibration": "paper/long_run/calibration/calibration.csv"},
        ),
    },
    parameters=_parameters,
)
