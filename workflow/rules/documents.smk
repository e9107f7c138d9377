# What is made of all results: the manuscript, the report, fingerprints and the comparison with what is
# expected; and what is measured of this machine, a forecast and the speed of the engines.
from twodiscs.pipeline.results.manifest import is_reproducible
from twodiscs.pipeline.results.record import WORKFLOW

if MAIN:

    localrules:
        paper,

    rule paper:
        input:
            template=str(HERE / "paper/paper.typ"),
            others=[
                str(HERE / "paper" / name)
                for name in ("results.typ", "references.bib", "../CITATION.cff")
            ],
            figures=[
                files[0]
                for scene in CONFIGURATION.plain
                for files in FILES.figures(scene).values()
            ],
            tables=[
                path
                for scene in CONFIGURATION.plain
                for path in FILES.tables(scene).values()
            ],
            shared=[FILES.table(name) for name in shared_tables()],
            drawn=[f"{RESULTS}/figures/{name}.pdf" for name in STUDY_FIGURES],
        output:
            pdf=report(
                f"{RESULTS}/paper.pdf",
                caption="../report/paper.rst",
                category="Manuscript",
                labels={"document": "manuscript"},
            ),
        log:
            log_of("paper"),
        benchmark:
            benchmark_of("paper")
        params:
            contents=lambda w, output: as_json(
                FILES.manuscript(os.path.dirname(output.pdf))
            ),
            texts=lambda w, input: contents(input.template, *input.others),
            code=code("pipeline.documents.manuscript"),
        shell:
            "python -m twodiscs.pipeline.documents.manuscript --template {input.template:q}"
            " --parameters {params.contents:q} --output {output.pdf:q} > {log:q} 2>&1"


# The report, and behind it Snakemake's own. That one is written by a second Snakemake while the first one still
# runs: it takes no lock, for it builds nothing, and finds the record of every job that has ended. It is given
# the whole configuration, however that was put together, and the folder in which results came to be.


report: "../report/workflow.rst"


rule report:
    input:
        results=[
            rules.check.output,
            [
                FILES.study(name) if name in STUDIES else rules.paper.output
                for name in CONFIGURATION.shared
                if name != "report"
            ],
            [list(FILES.tables(scene).values()) for scene in SCENES.values()],
            [list(FILES.figures(scene).values()) for scene in SCENES.values()],
            rules.animation.input,
        ],
        texts=sorted(map(str, HERE.glob("workflow/report/*.rst"))),
        style=str(HERE / "workflow/report/style.css"),
        front=str(HERE / "workflow/report/front.html"),
    output:
        html=f"{RESULTS}/report.html",
        workflow=f"{RESULTS}/report-workflow.html",
        configuration=f"{RESULTS}/configuration.json",
    log:
        log_of("report"),
    benchmark:
        benchmark_of("report")
    params:
        configuration=lambda w, output: kept(
            json.dumps(
                config | {"results": os.path.dirname(output.html)},
                indent=1,
                sort_keys=True,
            )
        ),
        snakefile=str(HERE / "Snakefile"),
        scenes=as_json(FILES.report()),
        files=lambda w, input: kept("\n".join(input.results)),
        texts=lambda w, input: contents(*input.texts, input.style, input.front),
        code=code("pipeline.documents.report"),
    shell:
        "{{ cp {params.configuration:q} {output.configuration:q}; mapfile -t files < {params.files:q};"
        " again() {{ snakemake --snakefile {params.snakefile:q} --nolock --workflow-profile none"
        ' "$@" --configfile {output.configuration:q} -- "${{files[@]}}"; }};'
        " again --report {output.workflow:q} --report-stylesheet {input.style:q};"
        ' again --rulegraph dot | python -m twodiscs.pipeline.documents.report "${{files[@]}}"'
        " --template {input.front:q} --parameters {params.scenes:q}"
        " --workflow report-workflow.html --output {output.html:q}; }} > {log:q} 2>&1"


rule manifest:
    input:
        files=[path for path in rules.report.input.results if is_reproducible(path)],
    output:
        manifest=f"{RESULTS}/manifest.sha256",
    log:
        log_of("manifest"),
    benchmark:
        benchmark_of("manifest")
    params:
        files=lambda w, input: f"@{kept(chr(10).join(input.files))}",
        code=code("pipeline.results.manifest"),
    shell:
        "python -m twodiscs.pipeline.results.manifest {params.files:q} --output {output.manifest:q}"
        " > {log:q} 2>&1"


# Where and when: this alone says what differs between two runs of the same.


rule provenance:
    input:
        files=rules.report.input.results,
    output:
        json=f"{RESULTS}/provenance.json",
    log:
        log_of("provenance"),
    benchmark:
        benchmark_of("provenance")
    params:
        sources=str(HERE),
        code=code("pipeline.results.provenance"),
    shell:
        "python -m twodiscs.pipeline.results.provenance --sources {params.sources:q}"
        " --output {output.json:q} > {log:q} 2>&1"


# An RO-Crate of it all, with the texts of the workflow in it. Not part of `all`.


rule crate:
    input:
        files=[
            rules.report.input.results,
            rules.report.output if "report" in CONFIGURATION.shared else [],
            rules.manifest.output,
            rules.provenance.output,
        ],
        texts=[
            str(HERE / "Snakefile"),
            *sorted(map(str, HERE.glob("workflow/rules/*.smk"))),
        ],
        citation=str(HERE / "CITATION.cff"),
    output:
        json=f"{RESULTS}/ro-crate-metadata.json",
        texts=directory(f"{RESULTS}/{WORKFLOW}"),
    log:
        log_of("crate"),
    benchmark:
        benchmark_of("crate")
    params:
        files=lambda w, input: f"@{kept(chr(10).join(input.files))}",
        sources=str(HERE),
        contents=lambda w, input: contents(*input.texts, input.citation),
        code=code("pipeline.documents.crate"),
    shell:
        "python -m twodiscs.pipeline.documents.crate {params.files:q} --sources {params.sources:q}"
        " --texts {input.texts:q} --output {output.json:q} > {log:q} 2>&1"


# All results against the record of the jobs that wrote them.


rule audit:
    log:
        log_of("audit"),
    params:
        results=BUILT,
    shell:
        "python -m twodiscs.pipeline.results.record {params.results:q} 2> {log:q}"


# It builds nothing: it has no input that could be out of date, and no output, so that it is done
# whenever it is asked for.


rule verify:
    log:
        log_of("verify"),
    params:
        configuration=as_json(config),
        expected=str(HERE / "paper/expected"),
        results=BUILT,
    shell:
        "python -m twodiscs.pipeline.results.verify --results {params.results:q}"
        " --expected {params.expected:q} --configuration {params.configuration:q} 2> {log:q}"


# What the configuration is going to take on this machine, said before it is paid for. A forecast is of
# the moment: it is made anew whenever it is asked for and never otherwise, so it is no output that
# Snakemake would keep up to date. cost.csv compares what jobs took with the last one there is.


rule forecast:
    input:
        compiled=sorted(
            {
                FILES.compiled(scene, stage)
                for scene in SCENES.values()
                for stage in STAGES
                if scene.keys[stage]
            }
        ),
    log:
        log_of("forecast"),
    threads: 64  # all that there are
    params:
        configuration=as_json(config),
        table=f"{BUILT}/forecast.csv",
    shell:
        "python -m twodiscs.pipeline.forecast --configuration {params.configuration:q}"
        " --cores {threads} --output {params.table:q} 2> {log:q}"


# What survives kills and damage, tried on a build of its own in a temporary folder.


rule soak:
    log:
        log_of("soak"),
    threads: 64  # all that there are
    params:
        snakefile=str(HERE / "Snakefile"),
        seconds=os.environ.get("SOAK_SECONDS", "600"),
        seed=os.environ.get("SOAK_SEED", "1"),
    shell:
        "python -m twodiscs.pipeline.soak --snakefile {params.snakefile:q} --cores {threads}"
        " --seconds {params.seconds:q} --seed {params.seed:q} 2> {log:q}"


# How fast the engines are on this machine. Not part of `all`: it measures, so it must run alone.


rule benchmark:
    input:
        scenes=rules.effects_cost.input.scenes,
    output:
        table=ensure(f"{RESULTS}/benchmark.csv", non_empty=True),
    log:
        log_of("benchmark"),
    benchmark:
        benchmark_of("benchmark")
    threads: 64  # all that there are
    params:
        code=code("benchmark", without=NAMES_ALONE),
    shell:
        "python -m twodiscs.benchmark --scenes {input.scenes:q} --output {output.table:q} > {log:q} 2>&1"
