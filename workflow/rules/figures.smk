# The figures of all scenes, as PDF for the manuscript and as PNG for the screen; the figures of studies, which
# are made once; and the animation, a GIF for any program and a PNG because Snakemake's report shows no other
# animated image.


rule figure:
    """A figure of a scene, from its tables."""
    input:
        tables=lambda w: CONFIGURATION.figure_reads(
            ENTRIES[w.figure], w.get("scene")
        ).values(),
    output:
        pdf=f"{RESULTS}/{{scene}}/figures/{{figure}}.pdf",
        png=report(
            f"{RESULTS}/{{scene}}/figures/{{figure}}.png",
            caption="../report/figure.rst",
            category=lambda w: ENTRIES[w.figure].category,
            subcategory="{scene}",
            labels=lambda w: ENTRIES[w.figure].labels,
        ),
    log:
        f"{RESULTS}/logs/{{scene}}/figure-{{figure}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/{{scene}}/figure-{{figure}}.tsv"
    wildcard_constraints:
        figure="|".join(FIGURES),
    localrule: True
    params:
        box=box,
        radius=radius_of,
        tables=figure_tables,
        origin=origin,
        caption=Caption,
        options=lambda w: str(ENTRIES[w.figure].options),
    shell:
        "python -P -m twodiscs_paper.pipeline.jobs.figure {wildcards.figure} {params.box:q} {params.radius}"
        " --tables {params.tables:q} --origin {params.origin:q} --output {output:q} > {log:q} 2>&1"


use rule figure as shared_figure with:
    output:
        pdf=f"{RESULTS}/figures/{{figure}}.pdf",
        png=report(
            f"{RESULTS}/figures/{{figure}}.png",
            caption="../report/shared_figure.rst",
            category=lambda w: ENTRIES[w.figure].category,
            subcategory="all scenes",
            labels=lambda w: ENTRIES[w.figure].labels,
        ),
    log:
        f"{RESULTS}/logs/figure-{{figure}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/figure-{{figure}}.tsv"
    wildcard_constraints:
        figure="|".join(STUDY_FIGURES),
    localrule: True


use rule figure as animate with:
    output:
        gif=f"{RESULTS}/{{scene}}/figures/{{figure}}.gif",
        png=report(
            f"{RESULTS}/{{scene}}/figures/{{figure}}.png",
            caption="../report/figure.rst",
            category=ANIMATION.category,
            subcategory="{scene}",
            labels=ANIMATION.labels,
        ),
    wildcard_constraints:
        figure="animation",
    localrule: True
