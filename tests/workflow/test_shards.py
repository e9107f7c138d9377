"""Points in shards: how they are cut is of no consequence, and no shard is done twice."""

import pytest
import yaml
from checkout import Checkout

TINY = {
    "shared": [],
    "shard_events": 1e7,
    "scenes": [
        {
            "name": "tiny",
            "box": {"width": 1.5, "height": 1.0},
            "radii": [0.1, 0.24],
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
    place.snakemake(
        "--snakefile", str(place.home.path / "Snakefile"), "--cores", "2", *arguments, "--", TABLE
    )
    after = written(place)
    new = {name for name, stamp in after.items() if before.get(name) != stamp}
    return (place.path / TABLE).read_bytes(), new


def written(place):
    """Return {path: time stamp} of the files of points and shards."""
    folder = place.path / "results" / "tiny" / "points"
    files = (path for path in folder.rglob("*.json") if not {"cost", ".record"} & {*path.parts})
    return {path.relative_to(folder).as_posix(): path.stat().st_mtime_ns for path in files}


def shards(new):
    """Return the shards among the files ``new``."""
    return {name for name in new if name.startswith("shards/") and "/plan-" not in name}


@pytest.fixture(scope="module")
def place(unbuilt, tmp_path_factory):
    return Checkout(tmp_path_factory.mktemp("shards"), unbuilt)


def test_shards(place, unbuilt, tmp_path):
    change(place)
    table, new = build(place)
    first = shards(new)
    assert {name.split("/")[2] for name in first} == {"0.1", "0.24"}
    assert any("horizontal_hop-" in name for name in first)
    assert build(place) == (table, set())

    # Larger ones: the same bits.
    other = Checkout(tmp_path, unbuilt)
    change(other, shard_events=3e7)
    assert build(other)[0] == table

    # A tighter accuracy takes more shards, and none of the first ones again.
    change(place, accuracy=0.005)
    tighter, new = build(place)
    assert tighter != table
    assert shards(new)
    assert not shards(new) & first

    # Another radius is of no consequence to the points there are.
    change(place, accuracy=0.005, radii=[0.1, 0.24, 0.3])
    new = build(place)[1]
    assert {name for name in new if "/plan-" not in name} == {
        "dynamics/0.3.json",
        "shards/dynamics/0.3/all-0-32.json",
    }

    # What was asked for first is still there.
    change(place)
    again, new = build(place)
    assert again == table
    assert not shards(new)
