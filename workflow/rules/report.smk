# Snakemake's own report. It is written by a second Snakemake while the first one still runs: that one
# takes no lock, for it builds nothing, and finds the record of every job that has ended. It is given
# the whole configuration, however that was put together.
import json
from glob import glob


report: "../report/workflow.rst"


rule report:
    input:
        results=[
            rules.check.output,
            shared_results(),
            [list(table_files(scene).values()) for scene in SCENES.values()],
            [list(figure_files(scene).values()) for scene in SCENES.values()],
            rules.animation.input,
        ],
        texts=sorted(glob("workflow/report/*.rst")),
        style="workflow/report/style.css",
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
        " snakemake --report {output.html:q} --report-stylesheet {input.style:q}"
        " --nolock --workflow-profile none"
        " --configfile {output.configuration:q} -- {input.results:q} > {log:q} 2>&1"
