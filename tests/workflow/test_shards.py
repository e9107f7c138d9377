"""Shards in the workflow.

Without these tests shards could be done twice, be lost, or have the numbers of others.
"""

import re

from checkout import folder, one_scene

from twodiscs.model.scene import Scene
from twodiscs.points.base import file_content, write_json
from twodiscs_paper.configuration.yaml_files import load
from twodiscs_paper.pipeline import job_cost

TINY = {"shard_events": 1e7} | one_scene(
    "tiny",
    radii=[0.24],
    watch={"mean_times": ["horizontal_hop", "top_wall"]},
    accuracy=1e-3,
    event_budget=1e10,
)
TABLE = "results/tiny/mean_times.csv"


def place_at(path, home, **keys):
    """Return a folder with a configuration in which ``keys`` of the scene differ."""
    return folder(path, home, TINY | {"scenes": [TINY["scenes"][0] | keys]})


def test_shards_are_jobs_of_a_dry_run_and_one_of_another_scene_is_refused(unbuilt, tmp_path):
    """Those that Snakemake takes for made, here by ``--touch``, are not planned again.

    They do not depend on the accuracy. A job that is tried again has twice the time.
    """
    place = place_at(tmp_path, unbuilt)

    def planned():
        return {words for rule, words in place.jobs(TABLE) if rule == "shard"}

    first = planned()
    name_of = "results/{scene}/shards/{stage}/{radius}/{component}-{first}-{stop}.json".format
    files = [name_of(**dict(word.split("=") for word in words)) for words in first]
    for name in files:
        place.edit(name, "{}")
    assert len(files) > 3
    assert all(any(f"/{each}-" in name for name in files) for each in ("all", "horizontal_hop"))
    place.snakemake("--cores", "1", "results/code/physics.sha256")
    place.snakemake("--cores", "1", "--touch", "--", *files)
    # A file with the first blocks, which another box has, too.
    (scene,), other = load(TINY).scenes, Scene(3.0, 1.0, 0.24).parameters()
    _, first_block, stop = min(job_cost.shards(scene, "dynamics", 0.24))
    blocks = {"all": {"sums": {(first_block, stop): [0]}}}
    content = file_content("simulate", other, scene.shard_arguments("dynamics"), blocks)
    name = f"all-{first_block}-{stop}.json"
    write_json(tmp_path / "results/tiny/shards/dynamics/0.24" / name, content)
    point = "results/tiny/points/dynamics/0.24.json"
    run = place.snakemake("--cores", "1", "--retries", "1", "--", point, passes=False)
    limits = [int(n) for n in re.findall(r"resources: .*runtime=(\d+)", run.stderr)]
    assert limits == [job_cost.minutes(scene, "dynamics") * attempt for attempt in (1, 2)]
    log = (tmp_path / "results/logs/tiny/dynamics/0.24.log").read_text()
    said = f"{name} has width 3.0, but its job asks for 1.5; delete it, and it is made again\n"
    assert log.endswith(said)
    assert not (tmp_path / point).exists()

    place_at(place.path, unbuilt, accuracy=5e-4)
    assert planned()
    assert not planned() & first
