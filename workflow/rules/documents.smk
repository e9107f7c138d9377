# Documents from all results: the manuscript, the report, the manifest and the comparison with expected
# results; and measurements of this machine: a forecast and the speed of the engines.
from twodiscs_paper.pipeline.results.manifest import is_reproducible


rule configuration:
    """The complete configuration, from all its files and options."""
    output:
        json=f"{RESULTS}/configuration.json",
    log:
        f"{RESULTS}/logs/configuration.log",
    localrule: True
    params:
        configuration=json.dumps(config, indent=1, sort_keys=True),
    shell:
        "printf '%s\\n' {params.configuration:q} > {output.json:q} 2> {log:q}"


if MAIN:

    rule paper:
        """The manuscript; every number in it is read from these results."""
        input:
            template=source("paper/paper.typ"),
            texts=[
                source("paper/results.typ"),
                source("paper/numbers.typ"),
                source("paper/read.typ"),
                source("paper/references.bib"),
                source("paper/published.yaml"),
                source("paper/long_run/far/mean_times.csv"),
                source("paper/long_run/passages/passages.csv"),
                source("paper/long_run/tails/tails.csv"),
                source("CITATION.cff"),
            ],
            figures=[
                files[0]
                for scene in CONFIGURATION.plain
                for files in CONFIGURATION.figures(scene.name).values()
            ],
            drawn=CONFIGURATION.studied("figures"),
            tables=[
                path
                for scene in CONFIGURATION.plain
                for path in CONFIGURATION.tables(scene.name).values()
            ],
            studied=CONFIGURATION.studied("tables"),
        output:
            pdf=report(
                f"{RESULTS}/paper.pdf",
                caption="../report/paper.rst",
                category="Manuscript",
                labels={"document": "manuscript"},
            ),
            numbers=CONFIGURATION.table("paper_numbers"),
        log:
            f"{RESULTS}/logs/paper.log",
        benchmark:
            f"{RESULTS}/benchmarks/paper.tsv"
        localrule: True
        params:
            scenes=CONFIGURATION.described(),
            seed=CONFIGURATION.seed,
            configuration=CONFIGURATION.configuration_hash(),
            code=code("twodiscs_paper.pipeline.documents.manuscript"),
        script:
            "../scripts/paper.py"


# Snakemake's own report is written after a build: profiles/default/config.yaml.


report: "../report/workflow.rst"


rule report:
    """The report: verdict, agreement and key figures, with links to everything else."""
    input:
        results=[
            rules.check.output,
            [
                CONFIGURATION.study(name) if name in STUDIES else rules.paper.output
                for name in CONFIGURATION.shared
                if name != "report"
            ],
            [list(CONFIGURATION.tables(scene).values()) for scene in CONFIGURED],
            [CONFIGURATION.shown(scene) for scene in CONFIGURED],
            [list(CONFIGURATION.animation(scene)) for scene in CONFIGURED],
        ],
        configuration=rules.configuration.output.json,
        front=source("workflow/report/front.html"),
    output:
        html=f"{RESULTS}/report.html",
    log:
        f"{RESULTS}/logs/report.log",
    benchmark:
        f"{RESULTS}/benchmarks/report.tsv"
    localrule: True
    params:
        scenes=CONFIGURATION.described(),
        code=code("twodiscs_paper.pipeline.documents.report"),
    script:
        "../scripts/report.py"


rule manifest:
    """The SHA-256 of everything that holds no run times."""
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
        "python -P -m twodiscs_paper.pipeline.results.manifest {input.files:q} --output {output.manifest:q} > {log:q} 2>&1"


rule provenance:
    """The origin of the results: all that differs between two runs of the same configuration."""
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
        "python -P -m twodiscs_paper.pipeline.results.provenance {input.files:q} --sources {params.sources:q}"
        " --output {output.json:q} > {log:q} 2>&1"


rule explorer:
    """The explorer: moving discs with counts of their events, beside exact values and built points."""
    input:
        # The page needs no points: it takes the built ones, and is renewed with them.
        tables=[
            path
            for scene in CONFIGURATION.scenes
            for name, path in CONFIGURATION.tables(scene.name).items()
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
        scenes=CONFIGURATION.described(),
        seed=CONFIGURATION.seed,
        code=code("twodiscs_paper.pipeline.documents.explorer"),
    script:
        "../scripts/explorer.py"


rule audit:
    """Name every result that is no longer what its job wrote. Without output, it runs on every request."""
    input:
        configuration=rules.configuration.output.json,
    log:
        f"{RESULTS}/logs/audit.log",
    localrule: True
    shell:
        "python -P -m twodiscs_paper.pipeline.results.audit --configuration {input.configuration:q} 2> {log:q}"


rule verify:
    """Compare the results with the expected results of the default configuration."""
    input:
        configuration=rules.configuration.output.json,
    log:
        f"{RESULTS}/logs/verify.log",
    localrule: True
    params:
        expected=os.path.join(os.path.dirname(source("paper/paper.typ")), "expected"),
    script:
        "../scripts/verify.py"


use rule verify as renew with:
    input:
        configuration=rules.configuration.output.json,
        tables=[p for p in rules.manifest.input.files if str(p).endswith(".csv")],
    log:
        f"{RESULTS}/logs/renew.log",
    params:
        expected=rules.verify.params.expected,
        points=[
            path
            for scene in CONFIGURED
            for stage in STAGES
            for path in CONFIGURATION.points(scene, "cost", stage)
        ],


rule forecast:
    """The time of the configuration on this machine; tables of costs are compared with it."""
    input:
        configuration=rules.configuration.output.json,
    output:
        table=f"{RESULTS}/forecast.csv",
    log:
        f"{RESULTS}/logs/forecast.log",
    localrule: True
    threads: ALL_CORES
    shell:
        "python -P -m twodiscs_paper.pipeline.forecast --configuration @{input.configuration:q} --cores {threads}"
        " --output {output.table:q} 2> {log:q}"


# Costs are compared with a forecast if there is one; a table of costs does not require it.
FORECAST = rules.forecast.output if exists(rules.forecast.output.table) else []


rule benchmark:
    """How fast the engines are on this machine."""
    input:
        scenes=EFFECT_FILES,
    output:
        table=f"{RESULTS}/benchmark.csv",
    log:
        f"{RESULTS}/logs/benchmark.log",
    benchmark:
        f"{RESULTS}/benchmarks/benchmark.tsv"
    localrule: True
    threads: ALL_CORES
    params:
        code=code("twodiscs_paper.benchmark"),
    shell:
        "python -P -m twodiscs_paper.benchmark --scenes {input.scenes:q} --output {output.table:q} > {log:q} 2>&1"
