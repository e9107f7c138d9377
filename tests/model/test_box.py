"""Parameters of jobs: the scene that they are those of, and nonsense refused."""

import pytest

from twodiscs.model import box
from twodiscs.model.scene import Scene

BOX = {"height": 1.0, "width": 1.5}
EFFECTS = [
    {"radius_ratio": 0.5, "mass_ratio": 2.0},
    {"periodic": "xy"},
    {"field": 1.0},
    {"moment_of_inertia": 0.5},
    {"depth": 1.2, "periodic": "z"},
]


def test_a_plain_scene():
    assert box.described({}) == {}
    assert box.scene(BOX, 0.1) == Scene(1.5, 1.0, 0.1)
    assert box.scene(BOX | {"radius": 0.2, "seed": 1}, 0.1) == Scene(1.5, 1.0, 0.1)


@pytest.mark.parametrize("effects", EFFECTS)
def test_a_scene_with_effects(effects):
    described = box.described(dict(reversed(effects.items())))
    assert list(described["effects"]) == sorted(effects)
    scene = box.scene(BOX | described, 0.1)
    assert scene == Scene(1.5, 1.0, 0.1, **effects)
    assert box.described(scene.effects) == described


@pytest.mark.parametrize("effects", [None, 1, "field", [], ["field"], {"gravity": 1}, {1: 2}])
def test_effects_that_make_no_sense(effects):
    with pytest.raises(ValueError, match="effects must be a dict of some of depth, radius_ratio, "):
        box.scene(BOX | {"effects": effects}, 0.1)


def test_effects_that_do_not_go_together():
    with pytest.raises(ValueError, match="field must be 0 where y is periodic"):
        box.scene(BOX | {"effects": {"field": 1.0, "periodic": "y"}}, 0.1)
