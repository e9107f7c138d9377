# The name of a figure is a target: the figure in every scene that has it. The name of a study is a target, too:
# its tables and figures.


rule animation:
    """The animations of all scenes that have a trajectory."""
    input:
        [CONFIGURATION.animation(scene) for scene in CONFIGURED],


for name, entry in FIGURES.items():

    rule:
        name:
            name
        input:
            [CONFIGURATION.figures(scene).get(name, []) for scene in CONFIGURED],

    getattr(rules, name).rule.docstring = f"{entry.title}."


for name, study in ALLOWED.items():

    rule:
        name:
            name
        input:
            CONFIGURATION.study(name),

    getattr(rules, name).rule.docstring = f"A study: {study.builds}."
