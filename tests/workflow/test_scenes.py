"""The jobs of scenes.

Without these tests a scene could miss a job that it calls for, or run one that it does not.
"""

import pytest
import yaml
from checkout import REPOSITORY

from twodiscs.dynamics.stages import STAGES
from twodiscs.figures.scene_figures import FIGURES
from twodiscs.model.events import HOPS, WALLS
from twodiscs_paper.catalogue import STUDY_TABLES
from twodiscs_paper.configuration.yaml_files import load, read

BLOCKS = {path.stem: read(path) for path in sorted(REPOSITORY.glob("config/scenes/*.yaml"))}

#: Rules for all scenes together, whatever else is built once.
ALWAYS = {"check", "configuration", "manifest", "provenance"}


def showing(quantity):
    """Return the names of the figures that show a quantity."""
    return {name for name, figure in FIGURES.items() if quantity in figure.needs}


#: {quantity: its settings, the stages that find it, tables that hold it, figures that show it}
WATCHED = {
    "volume": (True, {"monte_carlo"}, {"volume"}, showing("volume")),
    "areas": (["right_wall"], {"monte_carlo"}, {"areas"}, showing("right_wall_area")),
    "mean_times": (["top_wall"], {"dynamics"}, {"mean_times"}, showing("top_wall_time")),
    "hop_histogram": (True, {"intervals"}, {"hop_histogram"}, showing("hop_histogram")),
    "trajectory": (True, {"trajectory", "animate"}, set(), showing("trajectory")),
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
    "channel-of-eight": ALL - {"hop_histogram"},
}


def jobs(checkout, path, scenes, **shared):
    """Return the jobs of a dry run of these ``scenes`` and of what is ``shared``."""
    path.write_text(yaml.safe_dump(shared | {"scenes": scenes}))
    return checkout.jobs("--configfile", str(path))


def of(jobs, scene):
    """Return (rules, tables, figures) of the jobs of a scene."""
    mine = [(rule, wildcards) for rule, wildcards in jobs if f"scene={scene}" in wildcards]

    def named(kind):
        parts = (part for _, wildcards in mine for part in wildcards)
        return {part.partition("=")[2] for part in parts if part.startswith(f"{kind}=")}

    tables, figures = named("table") - {"trajectory"}, named("figure") - {"animation"}
    return {rule for rule, _ in mine}, tables, figures


def test_every_subset_of_what_is_watched(unbuilt, tmp_path):
    """One thing at a time, and all but one, without and with effects.

    The names of some radii have exponents, of either sign.
    """
    names = list(WATCHED)
    subsets = [{name} for name in names] + [{*names} - {name} for name in names]
    kinds = [({}, 1, 1e-5), ({"field": 5e-21, "mass_ratio": 2}, 1e20, 1e19)]
    cases = [(one, *kind) for one in subsets for kind in kinds]
    scenes = [
        {"name": f"s{i}", "box": {"width": 1.5 * unit, "height": unit}, "effects": effects}
        | {"radii": [small, 0.2 * unit], "watch": {name: WATCHED[name][0] for name in subset}}
        for i, (subset, effects, unit, small) in enumerate(cases)
    ]
    found = jobs(unbuilt, tmp_path / "subsets.yaml", scenes, shared=[])
    for i, (subset, effects, _, _) in enumerate(cases):
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
    # An accuracy that its budget reaches needs no forecast.
    scenes = [s | {"accuracy": 0.5} for block in BLOCKS.values() for s in block["scenes"]]
    assert [scene["name"] for scene in scenes] == list(BLOCKS)
    assert all(block["results"] == f"results/scenes/{name}" for name, block in BLOCKS.items())
    assert {*CALLED} <= {*BLOCKS}
    found = jobs(unbuilt, tmp_path / "all.yaml", scenes, shared=[])
    assert {rule for rule, wildcards in found if "scene" not in repr(wildcards)} == ALWAYS
    for request in load({"scenes": scenes}).scenes:
        rules, tables, figures = of(found, request.name)
        assert figures == CALLED.get(request.name, ALL)
        assert tables == {*request.tables} - {"trajectory"}
        assert ("trajectory" in rules) == ("animate" in rules) == ("hopping_trajectory" in figures)
        for stage in STAGES:
            points = [w for r, w in found if r == stage and f"scene={request.name}" in w]
            start = f"scene={request.name}", f"stage={stage}"
            assert {*points} == {(*start, f"radius={key}") for key in request.keys[stage]}


def test_the_manuscript_is_no_target_without_a_plain_scene(unbuilt):
    words = "--dry-run", "--configfile", "config/scenes/torus.yaml", "--", "paper"
    run = unbuilt.snakemake(*words, passes=False)
    assert "No rule to produce paper" in run.stdout + run.stderr


@pytest.mark.parametrize(
    ("given", "studies", "more"),
    [
        ({"shared": ["errata", "report"]}, {"errata"}, {"report"}),
        ({"shared": ["paper"]}, None, {"paper"}),
        ({}, set(), {"report"}),  # nothing is inherited from the default configuration
    ],
)
def test_what_is_built_once_is_what_is_asked_for(unbuilt, tmp_path, given, studies, more):
    scene = {"name": "a", "box": {"width": 1.5, "height": 1}, "watch": {"volume": True}}
    every = jobs(unbuilt, tmp_path / "shared.yaml", [scene], **given)
    assert not [words for _, words in every if {*words} & {"scene=full", "scene=walls"}]
    found = [(rule, wildcards) for rule, wildcards in every if "scene" not in repr(wildcards)]
    made = {w[0].removeprefix("table=") for rule, w in found if rule == "study_table"}
    assert made == ({*STUDY_TABLES} if studies is None else studies)
    once = {rule for rule, _ in found} - {"study_table", "study_part", "shared_figure"}
    assert once == ALWAYS | more
