"""A job does a bundle of points, and of those what is missing or has other parameters."""

from collections import Counter
from pathlib import Path

import pytest
import yaml
from checkout import Checkout

RADII = [round(0.01 + 2e-4 * i, 4) for i in range(1001)]
TABLES = ("results/many/mean_times.csv", "results/many/volume.csv")


def write(place, radii, **keys):
    """Write a configuration of one scene with these ``radii``, whose points take no time."""
    scene = {
        "name": "many",
        "box": {"width": 1.5, "height": 1.0},
        "radii": radii,
        "watch": {"mean_times": ["top_wall"], "volume": True},
        "accuracy": 0.5,
        "event_budget": 1000,
        "monte_carlo": {"samples": 1000},
    }
    place.configuration.parent.mkdir(exist_ok=True)
    place.configuration.write_text(yaml.safe_dump({"shared": [], "scenes": [scene | keys]}))


@pytest.fixture
def place(unbuilt, tmp_path):
    """A folder that uses the sources of another one, with many radii."""
    place = Checkout(tmp_path, unbuilt)
    write(place, RADII)
    return place


def files(place):
    """Return {path: (time stamp, bytes)} of the points."""
    folder = place.path / "results" / "many" / "points"
    points = [*folder.glob("dynamics/*.json"), *folder.glob("monte_carlo/*.json")]
    return {
        path.relative_to(folder).as_posix(): (path.stat().st_mtime_ns, path.read_bytes())
        for path in points
    }


def test_jobs_are_few(place):
    jobs = place.jobs("--cores", "2", "--", *TABLES)
    rules = Counter(rule for rule, _ in jobs)
    assert rules.keys() == {"compile", "dynamics", "monte_carlo", "table", "theory"}
    assert len(RADII) / 100 < rules["dynamics"] == rules["monte_carlo"] < 100


def build(place, *more):
    """Build the tables and return the bytes of them."""
    place.snakemake("--cores", "2", *more, "--", *TABLES)
    return [(place.path / table).read_bytes() for table in TABLES]


def test_who_goes_back_to_former_settings_has_their_results_again(place):
    """Points are bundled otherwise in between, and those of a bundle that is left are others."""
    write(place, RADII[:100])
    former = build(place)
    write(place, RADII[:3], accuracy=0.4, monte_carlo={"samples": 1 << 22})
    build(place)
    write(place, RADII[:100])
    assert build(place) == former


@pytest.mark.slow
def test_what_is_there_stays(place):
    def built(*forced):
        tables = build(place, *forced)
        return files(place), tables

    write(place, RADII[:3])
    few, _ = built()
    write(place, RADII)
    many, tables = built()
    assert len(many) == 2 * len(RADII)
    assert few.items() <= many.items()

    # Another radius; a damaged point; a tighter accuracy, which the tables must not miss.
    write(place, [*RADII, 0.3])
    more, _ = built()
    assert more.keys() - many.keys() == {"dynamics/0.3.json", "monte_carlo/0.3.json"}
    assert many.items() <= more.items()
    write(place, RADII)
    for harm in (lambda path: path.write_text("{}"), Path.unlink):
        before = files(place)
        harm(place.path / "results/many/points/dynamics/0.1.json")
        mended, same = built()
        assert same == tables
        assert {name for name in many if mended[name] != before[name]} == {"dynamics/0.1.json"}
        assert mended["dynamics/0.1.json"][1] == many["dynamics/0.1.json"][1]
    # Who forces the jobs has every point made again.
    forced, same = built("--forcerun", "dynamics")
    assert same == tables
    again = {name for name in many if forced[name] != mended[name]}
    assert again == {name for name in many if name.startswith("dynamics/")}
    assert all(forced[name][1] == many[name][1] for name in many)
    write(place, RADII, accuracy=0.4)
    _, tighter = built()
    assert b",0.4," in tighter[0]
    assert tighter[1] == tables[1]
