# Every figure of every scene that calls for it, as PDF for the manuscript and as PNG for the screen; those
# of studies, which are made once; and the animation, a GIF for any program and a PNG because the report
# shows no other animated image.

for name, folder, entries in (
    ("figure", "{scene}/", FIGURES),
    ("shared_figure", "", STUDY_FIGURES),
):

    rule:
        """Draw a figure of its tables."""
        name:
            name
        input:
            tables=lambda w: FILES.figure_reads(
                ENTRIES[w.figure], w.get("scene")
            ).values(),
        output:
            pdf=f"{RESULTS}/{folder}figures/{{figure}}.pdf",
            png=report(
                f"{RESULTS}/{folder}figures/{{figure}}.png",
                caption=f"../report/{name}.rst",
                category=lambda w: ENTRIES[w.figure].category,
                subcategory="{scene}" if folder else "all scenes",
                labels=lambda w: ENTRIES[w.figure].labels,
            ),
        log:
            f"{RESULTS}/logs/{folder}figure-{{figure}}.log",
        benchmark:
            f"{RESULTS}/benchmarks/{folder}figure-{{figure}}.tsv"
        wildcard_constraints:
            figure="|".join(entries),
        localrule: True
        params:
            box=box,
            radius=radius_of,
            tables=figure_tables,
            origin=origin,
            caption=Caption,
            options=lambda w: str(ENTRIES[w.figure].options),
            code=figure_code,
        shell:
            "python -m twodiscs_paper.pipeline.jobs.figure {wildcards.figure} {params.box} {params.radius}"
            " --tables {params.tables} --origin '{params.origin}, code {params.code}'"
            " --output {output.pdf} {output.png} > {log} 2>&1"


rule animate:
    """Draw the two discs as they move, and a hop."""
    input:
        tables=[f"{RESULTS}/{{scene}}/trajectory.csv"],
    output:
        gif=f"{RESULTS}/{{scene}}/figures/{{figure}}.gif",
        png=report(
            f"{RESULTS}/{{scene}}/figures/{{figure}}.png",
            caption="../report/figure.rst",
            category=ANIMATION.category,
            subcategory="{scene}",
            labels=ANIMATION.labels,
        ),
    log:
        f"{RESULTS}/logs/{{scene}}/figure-{{figure}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/{{scene}}/figure-{{figure}}.tsv"
    wildcard_constraints:
        figure="animation",
    localrule: True
    params:
        box=box,
        radius=radius_of,
        tables=figure_tables,
        caption=Caption,
        code=figure_code,
    shell:
        "python -m twodiscs_paper.pipeline.jobs.figure {wildcards.figure} {params.box} {params.radius}"
        " --tables {params.tables} --output {output.gif} {output.png} > {log} 2>&1"


rule animation:
    """The animations of all scenes that watch a trajectory."""
    input:
        [FILES.animation(scene) for scene in CONFIGURED],
    localrule: True


# A figure's name is a target: that figure, for every scene that calls for it.
for figure in FIGURES:

    rule:
        """A figure, in every scene that calls for it."""
        name:
            figure
        input:
            [FILES.figures(scene).get(figure, []) for scene in CONFIGURED],
        localrule: True
