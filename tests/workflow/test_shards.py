"""Points in shards: plans go on until the accuracy is reached, and no shard is done twice."""

import pytest
import yaml
from checkout import BELOW, Checkout, use

TINY = {
    "shared": [],
    "shard_events": 1e7,
    "scenes": [
        {
            "name": "tiny",
            "box": {"width": 1.5, "height": 1.0},
            "radii": [0.24],
            "watch": {"mean_times": ["horizontal_hop", "top_wall"]},
            "accuracy": 0.01,
            "event_budget": 4e7,
        }
    ],
}
TABLE = "results/tiny/mean_times.csv"


def change(place, **keys):
    """Write a configuration with other ``keys`` at its top, or of its scene."""
    top = {name: keys.pop(name) for name in TINY.keys() & keys.keys()}
    place.configuration.parent.mkdir(exist_ok=True)
    content = TINY | top | {"scenes": [TINY["scenes"][0] | keys]}
    place.configuration.write_text(yaml.safe_dump(content))


def build(place, *arguments):
    """Build the mean times; return (the bytes of them, what was written below points)."""
    before = written(place)
    place.snakemake("--cores", "2", *arguments, "--", TABLE)
    after = written(place)
    new = {name: stamp for name, stamp in after.items() if before.get(name) != stamp}
    return (place.path / TABLE).read_bytes(), new


def written(place):
    """Return {path: time stamp} of the files of points, shards and plans."""
    folder = place.path / "results" / "tiny" / "points"
    files = (
        path for path in folder.rglob("*.json") if not {"cost", ".record", "needed"} & {*path.parts}
    )
    return {path.relative_to(folder).as_posix(): path.stat().st_mtime_ns for path in files}


def shards(new):
    """Return those of the files ``new`` that are shards."""
    return {name: new[name] for name in new if name.split("/")[-1][0] in "ah"}


@pytest.mark.slow
def test_no_shard_is_done_twice(unbuilt, tmp_path):
    place = Checkout(tmp_path, unbuilt)
    change(place)
    table, new = build(place)
    first = shards(new)
    assert {name.split("/")[-1].split("-")[0] for name in first} == {"all", "horizontal_hop"}

    # A tighter accuracy takes more shards, however its build was interrupted.
    change(place, accuracy=0.001)
    build(place, "--until", "plan")
    assert (place.path / TABLE).read_bytes() == table
    tighter = build(place)[0]
    assert tighter.count(b",0.001,reached,") == 2
    assert all(written(place)[name] == stamp for name, stamp in first.items())
    more = shards(written(place)).keys() - first.keys()
    assert more

    # Another radius is of no consequence to the point there is; the old accuracy is still known.
    change(place, radii=[0.24, 0.3])
    rows, new = build(place)
    assert all("0.3" in name for name in new if "/plan-" not in name and "0.24.json" not in name)
    assert not {name for name in shards(new) if "/0.24/" in name}
    assert rows.startswith(table)


@pytest.mark.slow
def test_points_go_from_shards_to_bundles_and_back(unbuilt, tmp_path):
    place = Checkout(tmp_path, unbuilt)
    change(place)
    sharded = build(place)[0]
    change(place, shard_events=1e9, accuracy=0.02)
    bundled = build(place)[0]
    assert b",0.02,reached," in bundled
    change(place)
    assert build(place)[0] == sharded
    change(place, shard_events=1e9, accuracy=0.02)
    assert build(place)[0] == bundled


@pytest.mark.slow
def test_as_a_module_shards_are_found_below_a_prefix(unbuilt, tmp_path):
    alone = Checkout(tmp_path / "alone", unbuilt)
    alone.path.mkdir()
    change(alone)
    place = Checkout(tmp_path / "other", unbuilt)
    place.path.mkdir()
    use(place, TINY, "discs_", BELOW)
    place.snakemake("--cores", "2", "--", f"below/{TABLE}")
    assert (place.path / "below" / TABLE).read_bytes() == build(alone)[0]
