# The two discs as they move, from the table of one trajectory, for every scene that has one.


def animation_files(scene):
    """Return the animation of a scene in a list, which is empty if the scene has no trajectory."""
    called = ANIMATION.is_called(scene.watch.quantities, scene.effects)
    return [f"{RESULTS}/{scene.name}/figures/animation.gif"] if called else []


def animation_parameters(scene):
    """Return what the animation of a scene needs beside the trajectory."""
    return {
        "height": scene.height,
        "radius": scene.watch.trajectory,
        "width": scene.width,
    }


rule animate:
    input:
        table=f"{RESULTS}/{{scene}}/trajectory.csv",
        code=code("cli.animation"),
    output:
        gif=report(
            f"{RESULTS}/{{scene}}/figures/animation.gif",
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
        " --output {output.gif:q} > {log:q} 2>&1"


rule animation:
    input:
        [animation_files(scene) for scene in SCENES.values()],
