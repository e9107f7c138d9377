"""What the study of effects counts in the scene of a file, as JSON on standard output.

    python -m twodiscs.pipeline.configuration.scene_file config/scenes/rough.yaml --seed 1908

The seed is for a file that names none, as that of the configuration is for a file laid over it.
"""

import json

from twodiscs.model.checks import InputError
from twodiscs.pipeline.arguments import Parser, run
from twodiscs.pipeline.configuration.load import load
from twodiscs.pipeline.configuration.reading import read


def effects_job(path, seed):
    """Return the arguments of ``studies.effects.measure.job`` for the scene of the file ``path``.

    Raises ``InputError`` for a file that holds more than one scene, or one without effects or mean
    times, ``OSError`` for one that cannot be read.
    """
    scenes = load({"seed": seed} | read(path)).scenes
    if len(scenes) != 1 or not scenes[0].effects or not scenes[0].watch.mean_times:
        raise InputError(f"{path} must hold one scene, with effects, that watches mean times")
    (scene,) = scenes
    jobs = [scene.job("dynamics", key) for key in scene.keys["dynamics"]]
    dynamics = [{name: value for name, value in job.items() if name != "box"} for job in jobs]
    box = scene.box.parameters()
    return {"box": box, "dynamics": dynamics, "name": scene.name, "seed": scene.seed}


def main():
    parser = Parser(
        prog="twodiscs.pipeline.configuration.scene_file", description=__doc__.split("\n")[0]
    )
    parser.add_argument("file", metavar="YAML")
    parser.add_argument("--seed", type=int, required=True, help="root of the random numbers")
    options = parser.parse_args()
    print(json.dumps(effects_job(options.file, options.seed), sort_keys=True))


if __name__ == "__main__":
    run(main)
