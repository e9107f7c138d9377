"""The effects that are declared: they are the fields of a scene, and their values are checked."""

import math
from dataclasses import fields
from fractions import Fraction

import pytest

from twodiscs.model.effects import ABSENT, EFFECTS
from twodiscs.model.scene import Scene

NUMBERS = {name: effect for name, effect in EFFECTS.items() if effect.is_number}


def test_effects_are_the_fields_of_a_scene_after_its_radius():
    _, _, radius, *rest, discs = fields(Scene)
    assert (radius.name, discs.name, discs.default) == ("radius", "discs", 2)
    assert {field.name: field.default for field in rest} == ABSENT
    # The parameters of a scene are in the order of the declarations.
    assert [field.name for field in rest] == list(EFFECTS)


def test_every_effect_says_what_it_is():
    for effect in EFFECTS.values():
        assert effect.meaning
        assert bool(effect.unit) == effect.is_number
        symbol = effect.symbol.format(0.25 if effect.is_number else "xy")
        assert ("0.25" if effect.is_number else "xy") in symbol
        assert symbol.count("$") == 2


def test_only_the_depth_is_a_side_of_the_box():
    assert [name for name, effect in EFFECTS.items() if effect.of_box] == ["depth"]


@pytest.mark.parametrize("effect", NUMBERS.values(), ids=NUMBERS)
def test_a_value_is_a_float_in_range_or_that_of_absence(effect):
    for value in (effect.low, effect.high, Fraction(1, 2)):
        found = effect.checked(value)
        assert type(found) is float
        assert found == value
    for value in (effect.default, None, *([] if effect.default is None else [int(effect.default)])):
        assert effect.checked(value) is effect.default
    for bad in (-1.0, math.nan, math.inf, "0.5", b"1", True, False, [], 1j, 10**400):
        with pytest.raises(ValueError, match=rf"^{effect.name} must be a positive"):
            effect.checked(bad)
    for bad in (math.nextafter(effect.low, 0), math.nextafter(effect.high, math.inf)):
        with pytest.raises(ValueError, match=rf"^{effect.name} must lie between .* and "):
            effect.checked(bad)
