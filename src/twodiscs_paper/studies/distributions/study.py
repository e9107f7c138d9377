"""How intervals between hops are distributed."""

from twodiscs.figures.catalogue import DYNAMICS, Entry
from twodiscs_paper.studies.distributions.table import Distributions
from twodiscs_paper.study import Study, scaled


def _parameters(configuration):
    return {
        "events": scaled(configuration.main.event_budget, 200, 2**16, 2**23),
        "scenes": [
            {
                "box": scene.box.parameters(),
                "event": scene.histogram["event"],
                "name": scene.name,
                "radii": list(scene.quantities.hop_histogram),
            }
            for scene in configuration.plain
        ],
        "seed": configuration.seed,
    }


STUDY = Study(
    "distributions",
    builds="how intervals between hops are distributed",
    tables=(Distributions,),
    seconds=20.0,
    order=5,
    figures={
        "distributions": Entry(
            "Rate of hops since the last one",
            DYNAMICS,
            """
            (a) How often a hop comes after a time t without one, in units of the exact mean
            time τ; an exponential law would be the dashed line. It starts from the exact
            density at 0 (thick dashes), of a hop undone after one bounce, and jumps where
            both discs may have bounced, from t = √2 (h − 2r) on for vertical hops. Bars are
            constant rates fitted to all that comes after four mean times, dotted where the
            rate is not constant there (by χ² or by a trend, at the level of 1e-3). Those of
            small discs fall on, towards the rate of a cubic tail, 3τ/t (dash-dotted). (b)
            Mean time from a random moment to the next hop (open symbols) and what intervals
            make of it, τ(1 + CV²)/2 (dots), with CV their coefficient of variation. Error
            bars are one standard error.
            """,
            "twodiscs_paper.studies.distributions.figure",
            tables=("distributions",),
        ),
    },
    parameters=_parameters,
)
