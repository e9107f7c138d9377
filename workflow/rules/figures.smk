# The figures of all scenes, as PDF for the manuscript and as PNG for the screen; the figures of studies, which
# are made once; and the animation, a GIF for any program and a PNG because Snakemake's report shows no other
# animated image.


rule figure:
    """A figure of a scene, from its tables."""
    input:
        tables=lambda w: figure_reads(w).values(),
        code=code("figure", "figures", "physics", "tables"),
        own_code=own_code,
    output:
        pdf=f"{RESULTS}/{{scene}}/figures/{{figure}}.pdf",
        png=report(
            f"{RESULTS}/{{scene}}/figures/{{figure}}.png",
            category=lambda w: ALL_FIGURES[w.figure].category,
            subcategory="{scene}",
        ),
    log:
        f"{RESULTS}/logs/{{scene}}/figures/{{figure}}.log",
    wildcard_constraints:
        figure="|".join(FIGURES),
    localrule: True
    params:
        box=box,
        names=lambda w: [*figure_reads(w)],
        radius=radius,
        seed=CONFIGURATION.seed,
    script:
        "../scripts/figure.py"


use rule figure as shared_figure with:
    """A figure of a study, from its tables."""
    output:
        pdf=f"{RESULTS}/figures/{{figure}}.pdf",
        png=report(
            f"{RESULTS}/figures/{{figure}}.png",
            category=lambda w: ALL_FIGURES[w.figure].category,
            subcategory="all scenes",
        ),
    log:
        f"{RESULTS}/logs/figures/{{figure}}.log",
    wildcard_constraints:
        figure="|".join(STUDY_FIGURES),
    localrule: True


use rule figure as animate with:
    """The animation of a trajectory."""
    output:
        gif=f"{RESULTS}/{{scene}}/figures/{{figure}}.gif",
        png=report(
            f"{RESULTS}/{{scene}}/figures/{{figure}}.png",
            category=ANIMATION.category,
            subcategory="{scene}",
        ),
    wildcard_constraints:
        figure="animation",
    localrule: True
