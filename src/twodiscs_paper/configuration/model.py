"""The keys of a configuration: their values, limits, units, defaults and meanings.

The page config/README.md, config/schema.json and the sentences about mistakes follow from these
classes. ``scene.py`` has what follows from a box, such as its default radii.
"""

import re
from typing import Annotated, Literal

from pydantic import AfterValidator, BaseModel, BeforeValidator, ConfigDict, Field, create_model

from twodiscs.model.checks import (
    LARGEST_INTEGER,
    LONGEST,
    MOST_DISCS,
    PRESETS,
    SHORTEST,
    format_number,
)
from twodiscs.model.effects import EFFECTS
from twodiscs.model.events import EVENTS, HOPS
from twodiscs_paper.catalogue import STUDIES

#: A decimal number. YAML 1.1 has others: it reads 010 as 8 and 1:30 as 90.
DECIMAL = re.compile(r"[-+]?(0|[1-9]\d*|\d*\.\d+|\d+\.\d*)(e[-+]?\d+)?", re.IGNORECASE)

#: The studies that a configuration may name, those about scenes without effects, and the documents.
NAMED_STUDIES = tuple(study.name for study in STUDIES.values() if study.shared)
ABOUT_PLAIN = (*(name for name in NAMED_STUDIES if STUDIES[name].about_plain), "paper")
BUILT_ONCE = (*NAMED_STUDIES, "paper", "report")

#: The most events that any budget allows.
MOST_EVENTS = 10**15

#: The unit of budgets.
EVENTS_UNIT = "wall hits and disc collisions"


# Values -----------------------------------------------------------------------------------------


def words(allowed, **more):
    """Return the part of a type that describes its values, for sentences about mistakes."""
    return Field(json_schema_extra={"allowed": allowed, **more})


def _to_float(value):
    """Return text such as "2e9", which is no number in YAML, as a float; others as they are."""
    return float(value) if isinstance(value, str) and DECIMAL.fullmatch(value) else value


def _to_integer(value):
    """Return 2e9 or "2e9" as an integer, if it is one; others as they are."""
    if isinstance(value, str) and DECIMAL.fullmatch(value):
        value = float(value) if re.search("[.eE]", value) else int(value)
    return int(value) if isinstance(value, float) and value.is_integer() else value


def _check_different(items):
    if len({*items}) < len(items):
        raise ValueError("two items are equal")
    return items


def number(allowed, **limits):
    """Return the type of a finite number within limits."""
    limits = Field(allow_inf_nan=False, **limits)
    return Annotated[float, limits, BeforeValidator(_to_float), words(allowed)]


def integer(low, high):
    """Return the type of an integer within limits."""
    last = "2^63 - 1" if high == LARGEST_INTEGER else format_number(high, "g")
    allowed = words(f"an integer from {format_number(low, 'g')} to {last}")
    return Annotated[int, Field(ge=low, le=high), BeforeValidator(_to_integer), allowed]


def one_of(names):
    """Return the type of one of some names."""
    return Annotated[Literal[tuple(names)], words(f"one of {', '.join(names)}")]


def different(item, allowed, least=0):
    """Return the type of a list of different items, at least ``least`` of them."""
    check = AfterValidator(_check_different)
    return Annotated[list[item], Field(min_length=least), check, words(allowed, uniqueItems=True)]


A_LENGTH = (
    f"a positive length between {format_number(SHORTEST, 'g')} and {format_number(LONGEST, 'g')}"
)
AN_ERROR = "a number above 0 and at most 1"
PRESET_NAMES = ", ".join(PRESETS)

Flag = Annotated[bool, words("true or false")]
Length = number(A_LENGTH, ge=SHORTEST, le=LONGEST)
Radii = Annotated[list[Length], Field(min_length=1), words("a non-empty list of different radii")]
Events = Annotated[
    bool | different(one_of(EVENTS), "a non-empty list of different events", 1),
    words("true, false, or a non-empty list of different events"),
]
Error = Annotated[
    number(AN_ERROR, gt=0, le=1) | Literal[tuple(PRESETS)],
    words(f"{AN_ERROR}, or a preset ({PRESET_NAMES})"),
]
AXES = "a list of different axes among x, y and, in a box with a depth, z, or text such as xy"
Axis = Annotated[Literal["x", "y", "z"], words("an axis (x, y, z)")]
Axes = Annotated[
    different(Axis, AXES) | Annotated[str, Field(pattern="^[xyz]*$")],
    words(AXES),
]


# Blocks -----------------------------------------------------------------------------------------


class Block(BaseModel):
    """A block of keys; others are mistakes."""

    model_config = ConfigDict(extra="forbid", strict=True, regex_engine="python-re")


def key(default, meaning, unit=None, otherwise=None, allowed=None):
    """Return the declaration of a key.

    ``default`` is ... if the key is required, or a class of a block whose keys have defaults. If
    the default is None, it follows from the box, and ``otherwise`` describes it. ``allowed``
    describes the values if their type does not.
    """
    more = {"unit": unit, "otherwise": otherwise, "allowed": allowed}
    more = {name: text for name, text in more.items() if text}
    if default is None:  # a schema has no default then: editors would take null for a value
        return Field(default_factory=lambda: None, description=meaning, json_schema_extra=more)
    if isinstance(default, type):
        return Field(default_factory=default, description=meaning, json_schema_extra=more)
    return Field(default, description=meaning, json_schema_extra=more)


def _effects(of_box):
    """Return {name: (type, key)} of the effects that are sides of a box, or of all others."""
    keys = {}
    for effect in EFFECTS.values():
        if effect.of_box == of_box:
            meaning = effect.meaning[0].upper() + effect.meaning[1:]
            meaning = " ".join(filter(None, (f"{meaning}.", effect.more)))
            otherwise = "none" if effect.default is None else None
            default = effect.default if effect.is_number else []
            declared = key(default, meaning, effect.unit, otherwise)
            keys[effect.name] = (_effect(effect) if effect.is_number else Axes, declared)
    return keys


def _effect(effect):
    """Return the type of the value of an effect that is a number."""
    kind = "ratio" if effect.name.endswith("_ratio") else "length" if effect.of_box else "number"
    low, high = format_number(effect.low, "g"), format_number(effect.high, "g")
    allowed = f"a {kind} between {low} and {high}"
    if effect.default == 0:
        return number(f"0, or {allowed}", ge=0, le=effect.high)
    return number(allowed, ge=effect.low, le=effect.high)


class _Sides(Block):
    width: Length = key(..., "Its side along x.", "length")
    height: Length = key(..., "Its side along y.", "length")


Sides = create_model("Sides", __base__=_Sides, **_effects(of_box=True))
Effects = create_model("Effects", __base__=Block, **_effects(of_box=False))


class Grid(Block):
    smallest: Length = key(
        None,
        "The first radius of the grid.",
        "length",
        "a hundredth of the shorter side, for the larger disc",
    )
    count: integer(1, 1000) = key(
        24, "The number of radii in the grid, without the radii of `include`."
    )
    include: Radii = key(None, "Additional radii, which do not move the grid.", "length", "none")


class Histogram(Block):
    radii: Radii = key(
        None,
        "The radii of the histograms; they need not be among the radii of the scene.",
        "length",
        "0.1, 0.3, 0.5 and 0.7 of the hop's threshold",
    )
    event: one_of(HOPS) = key(
        None, "The hop.", None, "`vertical_hop`, or the only hop of the scene"
    )
    intervals: integer(1, 10**12) = key(10**6, "The number of intervals in each histogram.")
    event_budget: integer(1, MOST_EVENTS) = key(
        10**11,
        "The most events that one histogram may use, even if fewer intervals result.",
        EVENTS_UNIT,
    )


class Watch(Block):
    volume: Flag = key(False, "The volume of configuration space, by Monte Carlo.")
    areas: Events = key(
        False, "The areas of these events' surfaces, by Monte Carlo; true for all of them."
    )
    mean_times: Events = key(
        False, "The mean times between these events, by molecular dynamics; true for all of them."
    )
    hop_histogram: bool | Radii | Histogram = key(
        False,
        "The histogram of the times from one hop to the next: a list of radii, a block of the four"
        " keys below, or true for radii at 0.1, 0.3, 0.5 and 0.7 of the hop's threshold.",
        "length",
        allowed="true, false, a non-empty list of radii, or a block {radii: …, event: …, …}",
    )
    trajectory: bool | Length = key(
        False,
        "The radius of one trajectory, drawn as x2 − x1 against time. `true` stands for 0.24 of the"
        " shorter side, where both hops are open and the horizontal hop of a wide box is rare. With"
        " effects it stands for half of the radius at which the first hop becomes blocked.",
        "length",
        allowed=f"true, false, or {A_LENGTH}",
    )


class MonteCarlo(Block):
    samples: integer(1, MOST_EVENTS) = key(
        10**8,
        "The number of configurations drawn for each radius, rounded up to full blocks of 2^20. If"
        " fewer than 1/64 of the samples are accepted, a conditioned sampler draws 1/64 as many"
        " samples at the same cost.",
    )
    shell: number("a number above 0 and below 1", gt=0, lt=1) = key(
        0.02,
        "The thickness of the shell that measures an area, as a fraction of the radius, or of the"
        " gap left to the discs if that is smaller.",
    )


class _Accuracy(Block):
    default: Error = key("paper", "The requested error of all events that the block does not name.")


_of_event = key(None, "The requested error of this event.", None, "the error of `default`")
Accuracy = create_model("Accuracy", __base__=_Accuracy, **dict.fromkeys(EVENTS, (Error, _of_event)))


class SceneBlock(Block):
    name: Annotated[
        str,
        Field(
            max_length=100,
            pattern="^(?!(all|benchmarks|draft|figures|logs|needed|points|scenes)$)"
            r"[a-z0-9][a-z0-9_-]*$(?!\n)",
        ),
    ] = key(
        ...,
        "The name of the scene and of its folder of results; different for every scene.",
        allowed="a name of small letters, digits, - and _, 100 at most, that starts with a letter"
        " or a digit, and none of all, benchmarks, draft, figures, logs, needed, points, scenes",
    )
    box: Sides = key(
        ...,
        "The rectangle that holds the discs, or with a depth the box that holds two balls.",
        allowed="a block {width: …, height: …}, with a depth for balls",
    )
    discs: integer(2, MOST_DISCS) = key(
        2,
        "The number of discs. More than two discs are equal. Their effects may be periodic x,"
        " moment_of_inertia and friction. Collisions and hops then count for any pair of discs,"
        " hits of a wall for one disc. Exact values are known for three discs in any box, and for"
        " any number in a channel in which only neighbours touch, h ≤ (2 + √3) r. In other boxes"
        " Monte Carlo and dynamics are compared with each other.",
    )
    effects: Effects = key(
        Effects,
        "All that differs from equal, smooth discs that move freely between walls. An effect that"
        " is not named here is neither simulated nor compiled.",
    )
    radii: Radii | Grid = key(
        Grid,
        "The radii of the discs: a list, or a block of the three keys below. The block makes a grid"
        " that is dense on both sides of h/4 and w/4, where a hop becomes blocked, and below the"
        " largest radius that fits. With effects, the grid has equal steps up to 0.9 of the largest"
        " radius.",
        "length",
        allowed="a non-empty list of radii, or a block {smallest: …, count: …, include: […]}",
    )
    watch: bool | Watch = key(
        Watch(mean_times=True),
        "The quantities to compute and measure. A quantity that this block leaves out is neither"
        " computed nor drawn. Without the block these are the mean times. `true` stands for all"
        " quantities of the scene: on a periodic axis there are neither hops nor walls, intervals"
        " between hops of rough discs have no exact mean, and intervals of more than two discs are"
        " recorded only on request.",
        None,
        "`{mean_times: true}`",
        "a block of the keys volume, areas, mean_times, hop_histogram, trajectory, or true for all"
        " of them",
    )
    accuracy: Error | Accuracy = key(
        "paper",
        "The requested relative standard error of every mean time: a number, a preset (draft 1e-2,"
        " paper 3e-4, reference 1e-4), or a block with one of these for each event.",
        allowed=f"{AN_ERROR}, a preset ({PRESET_NAMES}), or a block of these by event",
    )
    event_budget: integer(1, MOST_EVENTS) = key(
        2 * 10**9,
        "The most events that the simulation of one radius may use, even if it has not reached the"
        " accuracy by then.",
        EVENTS_UNIT,
    )
    monte_carlo: MonteCarlo = key(
        MonteCarlo, "The settings of the Monte Carlo estimates of volume and areas."
    )


class AccuracyCost(Block):
    seconds: number("a number from 1 to 1e6", ge=1, le=1e6) = key(
        30, "The processor time of the study; with more time, it reaches smaller errors.", "s"
    )


class Model(Block):
    results: Annotated[
        str,
        Field(
            max_length=200,
            pattern="^/?(?!(config|docs|paper|profiles|src|tests|workflow)(/|$))"
            r"[A-Za-z0-9_][A-Za-z0-9_.-]*(/[A-Za-z0-9_][A-Za-z0-9_.-]*)*$(?!\n)",
        ),
    ] = key(
        "results",
        "The folder of all results.",
        allowed="a path, 200 characters at most, of folders whose names have letters, digits, _, -"
        " and dots, no dot first, without a slash at its end, and outside the folders of the"
        " sources",
    )
    seed: integer(0, LARGEST_INTEGER) = key(
        1908,
        "The root of all random numbers. Another seed repeats every simulation independently.",
    )
    shard_events: integer(10**7, MOST_EVENTS) = key(
        10**11,
        "If a radius may take more events or samples than this, its work is divided into shards:"
        " jobs of about this many events each. Results do not depend on it if the budget is"
        " larger.",
        EVENTS_UNIT,
    )
    accuracy_cost: AccuracyCost = key(
        AccuracyCost, "The study of the cost of accuracy by each method."
    )
    shared: different(
        one_of(BUILT_ONCE), f"a list of different names among {', '.join(BUILT_ONCE)}"
    ) = key(
        ["report"],
        "The documents and studies to build, beside the tables and figures of the scenes and the"
        " check. `report` is about these scenes. The manuscript and the studies are built only if"
        " named here, or as a target. "
        f"{', '.join(f'`{name}`' for name in ABOUT_PLAIN[:-1])} and `paper` are about scenes"
        " without effects, most of them about the first, and need such a scene. `effects` is always"
        " about the scenes of `config/scenes`. `paper` includes all studies that it reads: all of"
        " these and `accuracy_cost`.",
    )
    scenes: Annotated[
        list[Annotated[SceneBlock, words("a block of keys, at least name and box")]],
        Field(min_length=1),
    ] = key(..., "The boxes to study, one block each.", allowed="a non-empty list of scenes")
