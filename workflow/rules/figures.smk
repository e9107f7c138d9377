# Every figure of every scene that calls for it, as PDF for the manuscript and as PNG for the screen.


rule figure:
    input:
        tables=lambda w: [
            f"{RESULTS}/{w.scene}/{table}.csv" for table in FIGURES[w.figure].tables
        ],
        code=lambda w: code("cli.figure", f"figures.{w.figure}"),
    output:
        pdf=f"{RESULTS}/{{scene}}/figures/{{figure}}.pdf",
        png=report(
            f"{RESULTS}/{{scene}}/figures/{{figure}}.png",
            caption="../report/figure.rst",
            category=lambda w: FIGURES[w.figure].category,
            subcategory="{scene}",
            labels=lambda w: FIGURES[w.figure].labels,
        ),
    log:
        f"{RESULTS}/logs/{{scene}}/figure-{{figure}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/{{scene}}/figure-{{figure}}.tsv"
    wildcard_constraints:
        figure="|".join(FIGURES),
    params:
        scene=lambda w: figure_parameters(SCENES[w.scene], w.figure),
        tables=lambda w, input: " ".join(
            f"--table {Path(t).stem}={t}" for t in input.tables
        ),
        caption=lambda w: FIGURES[w.figure].caption_with(SCENES[w.scene].effects),
    shell:
        "python -m twodiscs.cli.figure {wildcards.figure} --scene {params.scene:q}"
        " {params.tables} --output {output.pdf:q} {output.png:q} > {log:q} 2>&1"


# Those that are made once, whatever the scenes.


rule shared_figure:
    input:
        tables=lambda w: shared_figure_tables(w.figure),
        code=lambda w: code("cli.figure", f"figures.{w.figure}"),
    output:
        pdf=f"{RESULTS}/figures/{{figure}}.pdf",
        png=report(
            f"{RESULTS}/figures/{{figure}}.png",
            caption="../report/shared_figure.rst",
            category=lambda w: SHARED[w.figure].category,
            subcategory="all scenes",
            labels=lambda w: SHARED[w.figure].labels,
        ),
    log:
        f"{RESULTS}/logs/figure-{{figure}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/figure-{{figure}}.tsv"
    wildcard_constraints:
        figure="|".join(SHARED),
    params:
        scene={"height": MAIN.height, "width": MAIN.width} if MAIN else {},
        tables=lambda w, input: " ".join(
            f"--table {Path(t).stem}={t}" for t in input.tables
        ),
        caption=lambda w: SHARED[w.figure].caption,
    shell:
        "python -m twodiscs.cli.figure {wildcards.figure} --scene {params.scene:q}"
        " {params.tables} --output {output.pdf:q} {output.png:q} > {log:q} 2>&1"


# A figure's name is a target: that figure, for every scene that calls for it.
for figure in FIGURES:

    rule:
        name:
            figure
        input:
            [files.get(figure, []) for files in map(figure_files, SCENES.values())],
