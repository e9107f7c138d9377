# Every figure of every scene that calls for it, as PDF for the manuscript and as PNG for the screen; those
# of studies, which are made once; and the animation, a GIF for any program and a PNG because the report
# shows no other animated image.


rule figure:
    input:
        tables=lambda w: [
            f"{RESULTS}/{w.scene}/{name}.csv" for name in FIGURES[w.figure].tables
        ],
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
        log_of("{scene}/figure-{figure}"),
    benchmark:
        benchmark_of("{scene}/figure-{figure}")
    wildcard_constraints:
        figure="|".join(FIGURES),
    params:
        about=lambda w: about(w.scene),
        job=lambda w: as_json(figure_job(SCENES[w.scene], FIGURES[w.figure])),
        module=lambda w: FIGURES[w.figure].module,
        tables=lambda w, input: named_tables(FIGURES[w.figure].tables, input.tables),
        caption=lambda w: FIGURES[w.figure].full_caption(SCENES[w.scene].effects),
        code=lambda w: figure_code(FIGURES[w.figure].module),
    shell:
        "python -m twodiscs.pipeline.jobs figure {params.module} --parameters {params.job:q}"
        " --table {params.tables:q} --output {output.pdf:q} {output.png:q}"
        " --about {params.about:q} --code {params.code} > {log:q} 2>&1"


rule shared_figure:
    input:
        tables=lambda w: FILES.study_figure_reads(STUDY_FIGURES[w.figure]).values(),
    output:
        pdf=f"{RESULTS}/figures/{{figure}}.pdf",
        png=report(
            f"{RESULTS}/figures/{{figure}}.png",
            caption="../report/shared_figure.rst",
            category=lambda w: STUDY_FIGURES[w.figure].category,
            subcategory="all scenes",
            labels=lambda w: STUDY_FIGURES[w.figure].labels,
        ),
    log:
        log_of("figure-{figure}"),
    benchmark:
        benchmark_of("figure-{figure}")
    wildcard_constraints:
        figure="|".join(STUDY_FIGURES),
    params:
        about=about(MAIN.name if MAIN else None),
        job=as_json({"box": MAIN.box.parameters()} if MAIN else {}),
        module=lambda w: STUDY_FIGURES[w.figure].module,
        tables=lambda w, input: named_tables(
            FILES.study_figure_reads(STUDY_FIGURES[w.figure]), input.tables
        ),
        caption=lambda w: STUDY_FIGURES[w.figure].full_caption(),
        code=lambda w: figure_code(STUDY_FIGURES[w.figure].module),
    shell:
        "python -m twodiscs.pipeline.jobs figure {params.module} --parameters {params.job:q}"
        " --table {params.tables:q} --output {output.pdf:q} {output.png:q}"
        " --about {params.about:q} --code {params.code} > {log:q} 2>&1"


rule animate:
    input:
        table=f"{RESULTS}/{{scene}}/trajectory.csv",
    output:
        gif=f"{RESULTS}/{{scene}}/figures/animation.gif",
        png=report(
            f"{RESULTS}/{{scene}}/figures/animation.png",
            caption="../report/figure.rst",
            category=ANIMATION.category,
            subcategory="{scene}",
            labels=ANIMATION.labels,
        ),
    log:
        log_of("{scene}/animation"),
    benchmark:
        benchmark_of("{scene}/animation")
    params:
        about=lambda w: about(w.scene),
        job=lambda w: as_json(figure_job(SCENES[w.scene], ANIMATION)),
        caption=ANIMATION.full_caption(),
        code=figure_code("figures.motion.animation"),
    shell:
        "python -m twodiscs.pipeline.jobs animation figures.motion.animation --parameters {params.job:q}"
        " --table trajectory={input.table:q} --output {output.gif:q} {output.png:q}"
        " --about {params.about:q} --code {params.code} > {log:q} 2>&1"


rule animation:
    input:
        [FILES.animation(scene) for scene in SCENES.values()],


# A figure's name is a target: that figure, for every scene that calls for it.
for figure in FIGURES:

    rule:
        name:
            figure
        input:
            [files.get(figure, []) for files in map(FILES.figures, SCENES.values())],
