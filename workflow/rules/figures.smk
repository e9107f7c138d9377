# Every figure of every scene that calls for it, as PDF for the manuscript and as PNG for the screen; those
# of studies, which are made once; and the animation, a GIF for any program and a PNG because the report
# shows no other animated image.


ENTRIES = FIGURES | STUDY_FIGURES

for name, place, entries in (
    ("figure", "{scene}/", FIGURES),
    ("shared_figure", "", STUDY_FIGURES),
):

    rule:
        name:
            name
        input:
            tables=lambda w: FILES.figure_reads(
                ENTRIES[w.figure], w.get("scene")
            ).values(),
        output:
            pdf=f"{RESULTS}/{place}figures/{{figure}}.pdf",
            png=report(
                f"{RESULTS}/{place}figures/{{figure}}.png",
                caption=f"../report/{name}.rst",
                category=lambda w: ENTRIES[w.figure].category,
                subcategory="{scene}" if place else "all scenes",
                labels=lambda w: ENTRIES[w.figure].labels,
            ),
        log:
            log_of(f"{place}figure-{{figure}}"),
        benchmark:
            benchmark_of(f"{place}figure-{{figure}}")
        wildcard_constraints:
            figure="|".join(entries),
        params:
            about=lambda w: about(getattr(drawn(w), "name", None)),
            job=lambda w: as_json(figure_job(drawn(w), ENTRIES[w.figure])),
            module=lambda w: ENTRIES[w.figure].module,
            tables=lambda w, input: named_tables(
                FILES.figure_reads(ENTRIES[w.figure], w.get("scene")), input.tables
            ),
            caption=lambda w: ENTRIES[w.figure].full_caption(
                getattr(drawn(w), "effects", ())
            ),
            code=lambda w: figure_code(ENTRIES[w.figure].module),
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
