# Documents from all results: the manuscript, the report, the manifest and the comparison with expected
# results.


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
    LONG_RUNS = (
        "displacements/passages",
        "files/passages",
        "accuracy_cost/accuracy_cost",
        "brownian/brownian",
        "calibration/calibration",
        "far/mean_times",
        "passages/passages",
        "tails/tails",
        "tori/tori",
    )

    rule paper:
        """The manuscript; every number in it is read from these results."""
        input:
            template=source("paper/paper.typ"),
            typst=[source(f"paper/{name}.typ") for name in ("results", "numbers", "read")],
            texts=[
                source("paper/references.bib"),
                source("paper/published.yaml"),
                source("CITATION.cff"),
            ],
            long_runs=[source(f"paper/long_run/{path}.csv") for path in LONG_RUNS],
            results=CONFIGURATION.printed(),
            drawn=CONFIGURATION.studied("figures"),
            code=code("paper", "physics", "tables", "documents"),
        output:
            pdf=report(f"{RESULTS}/paper.pdf", category="Manuscript"),
            numbers=CONFIGURATION.table("paper_numbers"),
        log:
            f"{RESULTS}/logs/paper.log",
            numbers=f"{RESULTS}/logs/paper_numbers.log",
        localrule: True
        params:
            scenes=CONFIGURATION.described(),
            seed=CONFIGURATION.seed,
            configuration=CONFIGURATION.configuration_hash(),
        script:
            "../scripts/paper.py"


report: "../report/workflow.rst"


rule report:
    """The report: verdict, agreement and key figures, with links to everything else."""
    input:
        results=[
            rules.check.output if rules.check.input.tables else [],
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
        code=code("report", "physics", "tables", "documents"),
    output:
        html=f"{RESULTS}/report.html",
    log:
        f"{RESULTS}/logs/report.log",
    localrule: True
    params:
        scenes=CONFIGURATION.described(),
        run=RUN,
    script:
        "../scripts/report.py"


rule manifest:
    """The SHA-256 of everything that holds no run times; `sha256sum --check` compares."""
    input:
        files=[path for path in rules.report.input.results if is_reproducible(path)],
        code=code("manifest", "physics"),
    output:
        manifest=f"{RESULTS}/manifest.sha256",
    log:
        f"{RESULTS}/logs/manifest.log",
    localrule: True
    script:
        "../scripts/manifest.py"


rule provenance:
    """The origin of the results: all that differs between two runs of the same configuration."""
    input:
        files=rules.report.input.results,
        code=code("provenance", "documents"),
    output:
        json=f"{RESULTS}/provenance.json",
    log:
        f"{RESULTS}/logs/provenance.log",
    localrule: True
    params:
        sources=os.path.relpath(PACKAGES),
    script:
        "../scripts/provenance.py"


PAGE = ("explorer.html", "theory.js", "dynamics.js", "plot.js", "page.js")


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
        parts=[source(f"workflow/explorer/{name}") for name in PAGE],
        code=code("explorer", "physics", "tables", "figures", "documents"),
    output:
        html=f"{RESULTS}/explorer.html",
    log:
        f"{RESULTS}/logs/explorer.log",
    localrule: True
    params:
        scenes=CONFIGURATION.described(),
        seed=CONFIGURATION.seed,
    script:
        "../scripts/explorer.py"


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
    """Replace the expected results by these, which must be complete."""
    input:
        configuration=rules.configuration.output.json,
        tables=[p for p in rules.manifest.input.files if str(p).endswith(".csv")],
    log:
        f"{RESULTS}/logs/renew.log",
    params:
        expected=rules.verify.params.expected,
        points=CONFIGURATION.all_points(),


rule forecast:
    """How long the jobs take on this machine, and the accuracy that they reach, from pilots."""
    log:
        f"{RESULTS}/logs/forecast.log",
    localrule: True
    script:
        "../scripts/forecast.py"


rule benchmark:
    """How fast the engines are on this machine."""
    input:
        code=code("benchmark", "physics", "tables", "benchmark", "effects", "accuracy_cost"),
    output:
        table=f"{RESULTS}/benchmark.csv",
    log:
        f"{RESULTS}/logs/benchmark.log",
    localrule: True
    threads: ALL_CORES
    params:
        scenes=boxes(CONFIGURATION),
    script:
        "../scripts/benchmark.py"
