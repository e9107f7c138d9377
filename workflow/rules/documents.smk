# What is made of all results: the manuscript, the report, fingerprints and the comparison with what is
# expected; and what is measured of this machine, a forecast and the speed of the engines.
from twodiscs_paper.pipeline.results.manifest import is_reproducible

if MAIN:

    rule paper:
        """Typeset the manuscript; every number in it is read from these results."""
        input:
            template=source("paper/paper.typ"),
            long_run=source("paper/long_run/mean_times.csv"),
            texts=[
                source(name)
                for name in (
                    "paper/results.typ",
                    "paper/references.bib",
                    "CITATION.cff",
                )
            ],
            figures=[
                files[0]
                for scene in CONFIGURATION.plain
                for files in FILES.figures(scene.name).values()
            ],
            drawn=FILES.studied("figures"),
            tables=[
                path
                for scene in CONFIGURATION.plain
                for path in FILES.tables(scene.name).values()
            ],
            studied=FILES.studied("tables"),
        output:
            pdf=report(
                f"{RESULTS}/paper.pdf",
                caption="../report/paper.rst",
                category="Manuscript",
                labels={"document": "manuscript"},
            ),
            numbers=FILES.table("paper_numbers"),
        log:
            f"{RESULTS}/logs/paper.log",
        benchmark:
            f"{RESULTS}/benchmarks/paper.tsv"
        localrule: True
        params:
            boxes=" ".join(
                f"{scene.name}={scene.box.width}x{scene.box.height}"
                for scene in CONFIGURATION.plain
            ),
            seed=CONFIGURATION.seed,
            configuration=FILES.configuration_hash(),
            code=code("twodiscs_paper.pipeline.documents.manuscript"),
        shell:
            "python -m twodiscs_paper.pipeline.documents.manuscript {input.figures} {input.drawn} {input.tables}"
            " {input.studied} --template {input.template} --boxes {params.boxes} --seed {params.seed}"
            " --long-run {input.long_run} --configuration {params.configuration} --numbers {output.numbers} --output {output.pdf}"
            " > {log} 2>&1"


# The report, and behind it Snakemake's own. That one is written by a second Snakemake while the first one
# still runs: it takes no lock, for it builds nothing, and finds the record of every job that has ended. It is
# given the whole configuration, however that was put together.


report: "../report/workflow.rst"


rule report:
    """Write the report: verdict, agreement and key figures, with links to everything else."""
    input:
        results=[
            rules.check.output,
            [
                FILES.study(name) if name in STUDIES else rules.paper.output
                for name in CONFIGURATION.shared
                if name != "report"
            ],
            [list(FILES.tables(scene).values()) for scene in CONFIGURED],
            [list(FILES.figures(scene).values()) for scene in CONFIGURED],
            rules.animation.input,
        ],
        style=source("workflow/report/style.css"),
        front=source("workflow/report/front.html"),
    output:
        html=f"{RESULTS}/report.html",
        workflow=f"{RESULTS}/report-workflow.html",
        configuration=f"{RESULTS}/configuration.json",
    log:
        f"{RESULTS}/logs/report.log",
    benchmark:
        f"{RESULTS}/benchmarks/report.tsv"
    localrule: True
    params:
        configuration=json.dumps(config, indent=1, sort_keys=True),
        scenes=json.dumps(FILES.report()),
        code=code("twodiscs_paper.pipeline.documents.report"),
    shell:
        "{{ printf '%s\\n' {params.configuration:q} > {output.configuration};"
        ' again() {{ snakemake --snakefile "$TWODISCS_SNAKEFILE" --nolock --workflow-profile none'
        ' "$@" --configfile {output.configuration} -- {input.results}; }};'
        " again --report {output.workflow} --report-stylesheet {input.style} & whole=$!;"
        " again --rulegraph dot | python -m twodiscs_paper.pipeline.documents.report {input.results}"
        " --template {input.front} --scenes {params.scenes:q} --workflow report-workflow.html"
        " --output {output.html} && wait $whole; }} > {log} 2>&1"


rule manifest:
    """List the SHA-256 of everything that holds no run times."""
    input:
        files=[path for path in rules.report.input.results if is_reproducible(path)],
    output:
        manifest=f"{RESULTS}/manifest.sha256",
    log:
        f"{RESULTS}/logs/manifest.log",
    benchmark:
        f"{RESULTS}/benchmarks/manifest.tsv"
    localrule: True
    params:
        code=code("twodiscs_paper.pipeline.results.manifest"),
    shell:
        "python -m twodiscs_paper.pipeline.results.manifest {input.files} --output {output.manifest}"
        " > {log} 2>&1"


rule provenance:
    """Say where and when the results came to be: all that differs between two runs of the same."""
    input:
        files=rules.report.input.results,
    output:
        json=f"{RESULTS}/provenance.json",
    log:
        f"{RESULTS}/logs/provenance.log",
    benchmark:
        f"{RESULTS}/benchmarks/provenance.tsv"
    localrule: True
    params:
        sources=os.path.dirname(source("CITATION.cff")) or ".",
        code=code("twodiscs_paper.pipeline.results.provenance"),
    shell:
        "python -m twodiscs_paper.pipeline.results.provenance {input.files} --sources {params.sources}"
        " --output {output.json} > {log} 2>&1"


rule explorer:
    """Write the explorer: the discs as they move and are counted, beside exact values and points that are built."""
    input:
        # The page does without points: it takes those that are built, and is renewed with them.
        tables=[
            path
            for scene in CONFIGURATION.plain
            for name, path in FILES.tables(scene.name).items()
            if name in ("volume", "areas", "mean_times") and os.path.exists(path)
        ],
        parts=[
            source(f"workflow/explorer/{name}")
            for name in (
                "explorer.html",
                "theory.js",
                "dynamics.js",
                "plot.js",
                "page.js",
            )
        ],
    output:
        html=f"{RESULTS}/explorer.html",
    log:
        f"{RESULTS}/logs/explorer.log",
    benchmark:
        f"{RESULTS}/benchmarks/explorer.tsv"
    localrule: True
    params:
        scenes=json.dumps(FILES.report()),
        seed=CONFIGURATION.seed,
        code=code("twodiscs_paper.pipeline.documents.explorer"),
    shell:
        "python -m twodiscs_paper.pipeline.documents.explorer {input.tables} --parts {input.parts}"
        " --scenes {params.scenes:q} --seed {params.seed} --output {output.html} > {log} 2>&1"


rule crate:
    """Describe the results as an RO-Crate, to be published."""
    input:
        files=[
            rules.report.input.results,
            rules.report.output if "report" in CONFIGURATION.shared else [],
            rules.manifest.output,
        ],
        provenance=rules.provenance.output,
        citation=source("CITATION.cff"),
        texts=[
            source("workflow/Snakefile"),
            *(source(f"workflow/rules/{name}.smk") for name in RULES),
        ],
    output:
        json=f"{RESULTS}/ro-crate-metadata.json",
        texts=directory(f"{RESULTS}/_workflow"),
    log:
        f"{RESULTS}/logs/crate.log",
    benchmark:
        f"{RESULTS}/benchmarks/crate.tsv"
    localrule: True
    params:
        code=code("twodiscs_paper.pipeline.documents.crate"),
    shell:
        "python -m twodiscs_paper.pipeline.documents.crate {input.files} {input.provenance} --provenance {input.provenance}"
        " --citation {input.citation} --texts {input.texts} --output {output.json} > {log} 2>&1"


# What builds nothing has no output, so that it is done whenever it is asked for. Where the results are, the
# path of its log says: a module of another workflow may prefix it.


rule audit:
    """Name every result that is no longer what its job wrote."""
    log:
        f"{RESULTS}/logs/audit.log",
    localrule: True
    params:
        configuration=json.dumps(config, sort_keys=True),
    shell:
        "python -m twodiscs_paper.pipeline.results.audit --results $(dirname $(dirname {log}))"
        " --configuration {params.configuration:q} 2> {log}"


rule verify:
    """Compare the results with those that are expected of the default configuration."""
    log:
        f"{RESULTS}/logs/verify.log",
    localrule: True
    params:
        configuration=json.dumps(config, sort_keys=True),
        # What is expected does not come with a wheel: there it says so.
        expected=os.path.join(os.path.dirname(source("paper/paper.typ")), "expected"),
    shell:
        "python -m twodiscs_paper.pipeline.results.verify --results $(dirname $(dirname {log}))"
        " --expected {params.expected} --configuration {params.configuration:q} 2> {log}"


rule forecast:
    """Forecast what the configuration takes on this machine."""
    log:
        f"{RESULTS}/logs/forecast.log",
    localrule: True
    threads: 64  # all that there are
    params:
        configuration=json.dumps(config, sort_keys=True),
    shell:
        "python -m twodiscs_paper.pipeline.forecast --configuration {params.configuration:q}"
        " --cores {threads} --output $(dirname $(dirname {log}))/forecast.csv 2> {log}"


rule benchmark:
    """Measure how fast the engines are on this machine."""
    input:
        scenes=rules.effects_cost.input.scenes,
    output:
        table=ensure(f"{RESULTS}/benchmark.csv", non_empty=True),
    log:
        f"{RESULTS}/logs/benchmark.log",
    benchmark:
        f"{RESULTS}/benchmarks/benchmark.tsv"
    localrule: True
    threads: 64  # all that there are: it must run alone
    params:
        code=code("twodiscs_paper.benchmark"),
    shell:
        "python -m twodiscs_paper.benchmark --scenes {input.scenes} --output {output.table} > {log} 2>&1"
