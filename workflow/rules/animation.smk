# The two discs as they move, from the table of one trajectory, for every scene that has one:
# a GIF for any program, and a PNG because the report shows no other animated image.


rule animate:
    input:
        table=f"{RESULTS}/{{scene}}/trajectory.csv",
        code=code("cli.animation"),
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
        f"{RESULTS}/logs/{{scene}}/animation.log",
    benchmark:
        f"{RESULTS}/benchmarks/{{scene}}/animation.tsv"
    params:
        scene=lambda w: animation_parameters(SCENES[w.scene]),
        caption=ANIMATION.caption,
    shell:
        "python -m twodiscs.cli.animation --scene {params.scene:q} --trajectory {input.table:q}"
        " --output {output.gif:q} {output.png:q} > {log:q} 2>&1"


rule animation:
    input:
        [animation_files(scene) for scene in SCENES.values()],
