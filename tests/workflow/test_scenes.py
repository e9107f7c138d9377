"""The jobs of a scene are what it calls for: whatever it watches, whatever its effects are."""

import pytest
import yaml
from checkout import REPOSITORY

from twodiscs.figures.catalogue import FIGURES
from twodiscs.model.events import HOPS, WALLS
from twodiscs_paper.catalogue import STUDIES
from twodiscs_paper.configuration.load import load, read
from twodiscs_paper.configuration.request import STAGES

FILES = sorted((REPOSITORY / "config" / "scenes").glob("*.yaml"))
BLOCKS = {path.stem: read(path) for path in FILES}

#: Rules for all scenes together, whatever else is built once.
ALWAYS = {"check", "configuration", "manifest", "provenance"}
OF_REPORT = {"report"}


def showing(quantity):
    """Return the names of the figures that show a quantity."""
    return {name for name, figure in FIGURES.items() if quantity in figure.needs}


#: What a scene watches, the jobs that find it, the tables that hold it, the figures that show it.
WATCHED = {
    "volume": (True, {"monte_carlo"}, {"volume"}, showing("volume")),
    "areas": (["right_wall"], {"monte_carlo"}, {"areas"}, showing("right_wall_area")),
    "mean_times": (["top_wall"], {"dynamics"}, {"mean_times"}, showing("top_wall_time")),
    "hop_histogram": ([0.1], {"intervals"}, {"hop_histogram"}, showing("hop_histogram")),
    "trajectory": (0.1, {"trajectory", "animate"}, set(), showing("trajectory")),
}

#: The figures of scenes with effects that need tables.
ALL = {name for name, figure in FIGURES.items() if figure.needs} - {"all_areas"}


def about(*events):
    """Return the names of the figures that show nothing else than some events."""
    quantities = {f"{event}_{what}" for event in events for what in ("area", "time")}
    return {name for name in ALL if FIGURES[name].needs <= quantities}


#: The figures that scenes with effects call for: all, but where something has no place.
CALLED = {
    "torus": ALL - about(*HOPS, *WALLS, "any_wall") - {"hopping_trajectory", "hop_histogram"},
    "channel": ALL - about("horizontal_hop", "right_wall"),
    "field": ALL - {"pressure"},
    "friction": ALL - {"hop_histogram"},
    "rough": ALL - {"hop_histogram"},
    "three": ALL,
    "channel-of-eight": ALL - {"hop_histogram"},
}


def jobs(checkout, path, scenes, *targets):
    """Return the jobs of a dry run of these ``scenes`` and nothing that is made once."""
    path.write_text(yaml.safe_dump({"shared": [], "scenes": scenes}))
    return checkout.jobs("--configfile", str(path), "--", *targets)


def of(jobs, scene):
    """Return (rules, tables, figures) of the jobs of a scene."""
    mine = [(rule, wildcards) for rule, wildcards in jobs if f"scene={scene}" in wildcards]

    def named(kind):
        parts = (part for _, wildcards in mine for part in wildcards)
        return {part.partition("=")[2] for part in parts if part.startswith(f"{kind}=")}

    tables, figures = named("table") - {"trajectory"}, named("figure") - {"animation"}
    return {rule for rule, _ in mine}, tables, figures


@pytest.mark.parametrize("effects", [{}, {"field": 0.5, "mass_ratio": 2}])
def test_every_subset_of_what_is_watched(unbuilt, tmp_path, effects):
    """One thing at a time, and all but one."""
    names = list(WATCHED)
    subsets = [{name} for name in names] + [{*names} - {name} for name in names]
    scenes = [
        {
            "name": f"s{i}",
            "box": {"width": 1.5, "height": 1},
            "radii": [0.1, 0.2],
            "effects": effects,
            "watch": {name: WATCHED[name][0] for name in subset},
        }
        for i, subset in enumerate(subsets)
    ]
    found = jobs(unbuilt, tmp_path / "subsets.yaml", scenes)
    for i, subset in enumerate(subsets):
        parts = [WATCHED[name][1:] for name in subset]
        rules, tables, figures = (set().union(*part) for part in zip(*parts, strict=True))
        if effects:
            figures -= {"pressure", "all_areas"}  # none in a field; of plain scenes only
        if tables:
            rules |= {"table"}
            tables |= {"check", "cost"}
        tables |= {"grid", "theory"}
        assert of(found, f"s{i}") == (rules | {"exact", "figure"}, tables, figures)


def test_scenes_with_effects_call_for_what_has_a_place(unbuilt, tmp_path):
    scenes = [block["scenes"][0] for block in BLOCKS.values()]
    assert [scene["name"] for scene in scenes] == list(BLOCKS)
    assert {*CALLED} <= {*BLOCKS}
    found = jobs(unbuilt, tmp_path / "all.yaml", scenes)
    shared = {rule for rule, wildcards in found if "scene" not in repr(wildcards)}
    assert shared == ALWAYS
    for request in load({"scenes": scenes}).scenes:
        rules, tables, figures = of(found, request.name)
        assert figures == CALLED.get(request.name, ALL)
        assert ("intervals" in rules) == ("hop_histogram" in tables) == ("hop_histogram" in figures)
        assert ("trajectory" in rules) == ("hopping_trajectory" in figures)
        assert ("animate" in rules) == ("trajectory" in rules)
        assert rules - {"intervals", "trajectory", "animate"} == {
            *("exact", "monte_carlo", "dynamics", "table", "figure"),
        }
        assert tables == {*request.tables} - {"trajectory"}
        for stage in STAGES:
            points = [w for r, w in found if r == stage and f"scene={request.name}" in w]
            expected = {
                (f"scene={request.name}", f"stage={stage}", f"radius={key}")
                for key in request.keys[stage]
            }
            assert {*points} == expected


@pytest.mark.parametrize("name", BLOCKS)
def test_a_file_is_a_quick_look_at_one_scene(name):
    block = BLOCKS[name]
    (request,) = load(block).scenes
    assert request.name == name
    assert request.effects
    assert block["results"] == f"results/scenes/{name}"
    assert load(block).shared == ("report",)
    assert 6 <= len(request.radii) <= 8
    sides = (4.8, 0.6) if name == "channel-of-eight" else (1.5, 1.0)
    assert (request.box.width, request.box.height) == sides
    assert set(request.dynamics["accuracy"].values()) == {1e-2}


def test_a_file_builds_its_scene_alone(unbuilt):
    found = unbuilt.jobs("--configfile", "config/scenes/torus.yaml")
    assert {w for _, wildcards in found for w in wildcards if w.startswith("scene=")} == {
        "scene=torus"
    }
    assert not [rule for rule, _ in found if rule.startswith("effects")]
    # What is about a box without effects is no target there.
    run = unbuilt.snakemake(
        "--dry-run", "--configfile", "config/scenes/torus.yaml", "--", "paper", passes=False
    )
    assert run.returncode != 0
    assert "No rule to produce paper" in run.stdout + run.stderr


def test_what_is_built_once_is_what_is_asked_for(unbuilt, tmp_path):
    scene = {"name": "a", "box": {"width": 1.5, "height": 1}, "watch": {"volume": True}}
    path = tmp_path / "shared.yaml"
    shared = {table.name() for study in STUDIES.values() for table in study.tables}
    for names, studies in ((["errata", "report"], {"errata"}), (["paper"], shared)):
        path.write_text(yaml.safe_dump({"shared": names, "scenes": [scene]}))
        found = [
            (r, w) for r, w in unbuilt.jobs("--configfile", str(path)) if "scene" not in repr(w)
        ]
        made = {w[0].removeprefix("table=") for rule, w in found if rule == "study_table"}
        assert made == studies
        once = {rule for rule, _ in found} - {"study_table", "study_part", "shared_figure"}
        more = {"paper"} if "paper" in names else OF_REPORT
        assert once == ALWAYS | more


def test_scenes_of_another_file_do_not_inherit_what_is_built_once(unbuilt, tmp_path):
    """A box of one's own over the default configuration: its jobs and the report on it."""
    scene = {"name": "mine", "box": {"width": 2, "height": 1}, "watch": {"volume": True}}
    path = tmp_path / "mine.yaml"
    path.write_text(yaml.safe_dump({"scenes": [scene]}))
    found = {rule for rule, w in unbuilt.jobs("--configfile", str(path)) if "scene" not in repr(w)}
    assert found == ALWAYS | OF_REPORT
    # A file without scenes is laid over config.yaml, which asks for studies.
    path.write_text("seed: 5\n")
    assert "study_table" in {rule for rule, _ in unbuilt.jobs("--configfile", str(path))}


def test_the_explorer_needs_no_points(unbuilt):
    assert [rule for rule, _ in unbuilt.jobs("explorer")] == ["explorer"]
