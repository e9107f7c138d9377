# Snakemake's own report. It is written by a second Snakemake while the first one still runs: that one
# takes no lock, for it builds nothing, and finds the record of every job that has ended. It is given
# the whole configuration, however that was put together.
import json


report: "../report/workflow.rst"


rule report:
    input:
        results=[
            rules.check.output,
            rules.paper.output,
            rules.errata.output,
            rules.accuracy_cost.input,
            rules.stability.input,
            [list(table_files(scene).values()) for scene in SCENES.values()],
            [list(figure_files(scene).values()) for scene in SCENES.values()],
            rules.animation.input,
        ],
        texts=expand(
            "workflow/report/{text}.rst", text=["workflow", "table", "figure", "paper"]
        ),
    output:
        html=f"{RESULTS}/report.html",
        configuration=f"{RESULTS}/configuration.json",
    log:
        f"{RESULTS}/logs/report.log",
    benchmark:
        f"{RESULTS}/benchmarks/report.tsv"
    params:
        configuration=json.dumps(config, indent=1, sort_keys=True),
    shell:
        "printf '%s\\n' {params.configuration:q} > {output.configuration:q};"
        " snakemake --report {output.html:q} --nolock --workflow-profile none"
        " --configfile {output.configuration:q} -- {input.results:q} > {log:q} 2>&1"
