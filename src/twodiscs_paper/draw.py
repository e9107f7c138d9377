"""The functions that draw the figures of the studies, by name."""

from twodiscs_paper.studies.accuracy_cost import figure as accuracy_cost
from twodiscs_paper.studies.accuracy_cost import figure_by_radius
from twodiscs_paper.studies.distributions import figure as distributions
from twodiscs_paper.studies.effects import figure as effects
from twodiscs_paper.studies.more_discs import figure as more_discs
from twodiscs_paper.studies.more_discs import figure_tori as tori
from twodiscs_paper.studies.passages import figure as passages
from twodiscs_paper.studies.passages import figure_brownian as brownian
from twodiscs_paper.studies.passages import figure_diffusion as diffusion
from twodiscs_paper.studies.passages import figure_files as files
from twodiscs_paper.studies.passages import figure_friction as friction
from twodiscs_paper.studies.passages import figure_transmission as transmission
from twodiscs_paper.studies.stability import figure as stability
from twodiscs_paper.studies.stability import figure_calibration as calibration
from twodiscs_paper.studies.stability import figure_runs as stability_of_runs
from twodiscs_paper.studies.tails import figure as tails
from twodiscs_paper.studies.thresholds import figure as thresholds

#: {figure: function of a ``Box``, None without a scene of two plain discs, and {table: its rows}}
DRAW = {
    "accuracy_cost": accuracy_cost.draw,
    "accuracy_cost_by_radius": figure_by_radius.draw,
    "distributions": distributions.draw,
    "effects": effects.draw,
    "more_discs": more_discs.draw,
    "tori": tori.draw,
    "passages": passages.draw,
    "brownian": brownian.draw,
    "diffusion": diffusion.draw,
    "files": files.draw,
    "friction": friction.draw,
    "transmission": transmission.draw,
    "stability": stability.draw,
    "calibration": calibration.draw,
    "stability_of_runs": stability_of_runs.draw,
    "tails": tails.draw,
    "thresholds": thresholds.draw,
}
