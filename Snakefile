# From one configuration file to every table, every figure, the manuscript and the report.
# The stages stand in workflow/rules, in the order in which data flows.
import os
from pathlib import Path

from snakemake.utils import min_version

from twodiscs.pipeline.configuration.load import check_results, load
from twodiscs.pipeline.configuration.reading import check, or_exit
from twodiscs.pipeline.results.locks import end_aside, release
from twodiscs.pipeline.results.record import notice

min_version("9.27")

# Where this workflow stands, whoever uses it and from wherever it is run. In its own folder paths are
# relative, so that the folder may be moved.
HERE = Path(str(workflow.current_basedir)).resolve()
HERE = Path() if HERE == Path.cwd() else HERE

# Read with limits before Snakemake reads it; the profile does so for what --configfile names.
if os.path.exists("config/config.yaml"):
    check(os.path.abspath("config/config.yaml"))

    configfile: "config/config.yaml"

else:

    configfile: str(HERE / "config/config.yaml")


# Any exception would be shown with its place in this file, but the mistake is in another one.
for path in workflow.configfiles:
    check(os.path.abspath(path))
CONFIGURATION = or_exit(load, config)
or_exit(check_results, CONFIGURATION.results, HERE)
# Where results are when jobs run: as a module of another workflow they may have a prefix.
BUILT = str(workflow.modifier.path_modifier.replace_prefix(CONFIGURATION.results))
if workflow.is_main_process:
    if release():
        notice(BUILT)
    if CONFIGURATION.days > 1:
        logger.warning(
            f"This configuration takes some {CONFIGURATION.days:.2g} days of processor time;"
            " snakemake forecast says it better."
        )


include: "workflow/rules/common.smk"
include: "workflow/rules/points.smk"
include: "workflow/rules/shards.smk"
include: "workflow/rules/tables.smk"
include: "workflow/rules/figures.smk"
include: "workflow/rules/studies.smk"
include: "workflow/rules/documents.smk"


# What takes a few seconds runs where Snakemake does, whatever runs the others; so does what measures this machine or
# starts a Snakemake of its own.
localrules:
    all,
    grid,
    theory,
    plan,
    shards,
    monte_carlo_merge,
    dynamics_merge,
    intervals_merge,
    table,
    check,
    figure,
    shared_figure,
    animate,
    report,
    manifest,
    provenance,
    crate,
    audit,
    verify,
    forecast,
    benchmark,


onstart:
    end_aside()
    # Whoever forces the jobs of points wants none of them kept.
    if workflow.dag_settings.forceall or {*STAGES} & {
        *workflow.dag_settings.forcerun
    }:
        os.environ.update(TWODISCS_ANEW="1")


rule all:
    input:
        rules.crate.input.files,
