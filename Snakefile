# From one configuration file to every table, every figure, the manuscript and the report.
# The stages stand in workflow/rules, a file each, in the order in which data flows.
import os
import sys

from snakemake.utils import min_version

from twodiscs.config import ConfigError, load, read
from twodiscs.figures.catalogue import ANIMATION, FIGURES, SHARED
from twodiscs.sources import imported
from twodiscs.tables import TABLES

min_version("9.27")


configfile: "config/config.yaml"


try:
    for path in workflow.configfiles:
        read(
            path
        )  # finds the keys given twice, of which YAML keeps the last in silence
    CONFIGURATION = load(config)
except ConfigError as error:
    # Any exception would be shown with its place in this file, but the mistake is in another one.
    sys.exit(f"Configuration: {error}")


include: "workflow/rules/common.smk"
include: "workflow/rules/grid.smk"
include: "workflow/rules/theory.smk"
include: "workflow/rules/compile.smk"
include: "workflow/rules/forecast.smk"
include: "workflow/rules/monte_carlo.smk"
include: "workflow/rules/dynamics.smk"
include: "workflow/rules/tables.smk"
include: "workflow/rules/check.smk"
include: "workflow/rules/figures.smk"
include: "workflow/rules/animation.smk"
include: "workflow/rules/accuracy_cost.smk"
include: "workflow/rules/effects.smk"


if MAIN:  # these are about a scene without effects

    include: "workflow/rules/errata.smk"
    include: "workflow/rules/stability.smk"
    include: "workflow/rules/tails.smk"
    include: "workflow/rules/distributions.smk"
    include: "workflow/rules/thresholds.smk"
    include: "workflow/rules/manuscript.smk"


include: "workflow/rules/report.smk"
include: "workflow/rules/verify.smk"
include: "workflow/rules/benchmark.smk"


rule all:
    input:
        rules.report.input.results,
        rules.report.output if "report" in CONFIGURATION.shared else [],
        rules.manifest.output,
