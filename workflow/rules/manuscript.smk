# The manuscript, about the first scene. Every number in it is read from the tables.


rule paper:
    input:
        template="paper/paper.typ",
        numbers="paper/results.typ",
        references="paper/references.bib",
        figures=[files[0] for files in figure_files(MAIN).values()],
        tables=[path for scene in PLAIN for path in table_files(scene).values()],
        shared=shared_files(),
        code=code("cli.manuscript"),
    output:
        pdf=report(
            f"{RESULTS}/paper.pdf",
            caption="../report/paper.rst",
            category="Manuscript",
            labels={"document": "manuscript"},
        ),
    log:
        f"{RESULTS}/logs/paper.log",
    benchmark:
        f"{RESULTS}/benchmarks/paper.tsv"
    params:
        contents=manuscript_parameters(),
    shell:
        "python -m twodiscs.cli.manuscript --template {input.template:q}"
        " --parameters {params.contents:q} --output {output.pdf:q} > {log:q} 2>&1"
