"""The keys of a configuration: their values, limits, units, defaults and meanings.

The text below a key is its meaning. The tables of keys on the site, config/schema.json and the
sentences about mistakes follow from these classes. ``scene.py`` has what follows from a box.
"""

import re
from typing import Annotated, Literal

from pydantic import AfterValidator, BaseModel, BeforeValidator, ConfigDict, Field, create_model

from twodiscs.model.checks import (
    LARGEST_INTEGER,
    LONGEST_LENGTH,
    MOST_DISCS,
    NAMED_ERRORS,
    SHORTEST_LENGTH,
    THINNEST_SHELL,
    parse_number,
)
from twodiscs.model.effects import EFFECTS
from twodiscs.model.events import EVENTS, HOPS
from twodiscs.model.formats import format_number
from twodiscs_paper.catalogue import STUDIES

#: A decimal number. YAML 1.1 has others: it reads 010 as 8 and 1:30 as 90. Python has more digits.
DECIMAL_NUMBER = re.compile(r"(?ai)[-+]?(0|[1-9]\d*|\d*\.\d+|\d+\.\d*)(e[-+]?\d+)?")

ABOUT_PLAIN = (*(name for name, study in STUDIES.items() if study.about_plain), "paper")
BUILT_ONCE = (*STUDIES, "paper", "report")

#: The most events that any budget allows.
MOST_EVENTS = 10**15


# Values -----------------------------------------------------------------------------------------


def words(allowed, **more):
    """Return the part of a type that describes its values, for sentences about mistakes."""
    more = {name: value for name, value in more.items() if value}
    return Field(json_schema_extra={"allowed": allowed, **more})


def otherwise(text, meaning=None):
    """Return the declaration of a key whose default follows from the box, as ``text`` describes."""
    # With a default of None the schema of editors would have null as a value.
    more = {"otherwise": text}
    return Field(default_factory=lambda: None, description=meaning, json_schema_extra=more)


def _read_float(value):
    """Return text such as "2e9", which is no number in YAML, as a float; others as they are."""
    return float(value) if isinstance(value, str) and DECIMAL_NUMBER.fullmatch(value) else value


def _read_integer(value):
    """Return 2e9 or "2e9" as an integer, if it is one; others as they are."""
    if isinstance(value, str) and DECIMAL_NUMBER.fullmatch(value):
        return parse_number(value)
    return int(value) if isinstance(value, float) and value.is_integer() else value


def _check_different(items):
    if len({*items}) < len(items):
        raise ValueError("two items are equal")
    return items


def number(allowed, unit=None, **limits):
    """Return the type of a finite number within limits."""
    limits = Field(allow_inf_nan=False, **limits)
    return Annotated[float, limits, BeforeValidator(_read_float), words(allowed, unit=unit)]


def integer(low, high, unit=None):
    """Return the type of an integer within limits."""
    last = "2^63 - 1" if high == LARGEST_INTEGER else format_number(high, "g")
    allowed = words(f"an integer from {format_number(low, 'g')} to {last}", unit=unit)
    return Annotated[int, Field(ge=low, le=high), BeforeValidator(_read_integer), allowed]


def choice(names):
    """Return the type of one of some names."""
    return Annotated[Literal[tuple(names)], words(f"one of {', '.join(names)}")]


def different(item, allowed, least=0):
    """Return the type of a list of different items, at least ``least`` of them."""
    check = AfterValidator(_check_different)
    return Annotated[list[item], Field(min_length=least), check, words(allowed, uniqueItems=True)]


def text(allowed, pattern, most):
    """Return the type of text of at most ``most`` letters that match a pattern."""
    return Annotated[str, Field(pattern=rf"{pattern}$(?!\n)", max_length=most), words(allowed)]


A_LENGTH = (
    f"a positive length between {format_number(SHORTEST_LENGTH, 'g')} and "
    f"{format_number(LONGEST_LENGTH, 'g')}"
)
AN_ERROR = "a number above 0 and at most 1"
PRESET_NAMES = ", ".join(NAMED_ERRORS)

Flag = Annotated[bool, words("true or false")]
Length = number(A_LENGTH, "length", ge=SHORTEST_LENGTH, le=LONGEST_LENGTH)
EVENTS_UNIT = "wall hits and disc collisions"
Budget = integer(1, MOST_EVENTS, EVENTS_UNIT)
Radii = Annotated[
    list[Length],
    Field(min_length=1),
    words("a non-empty list of different radii", unit="length"),
]
Events = Annotated[
    bool | different(choice(EVENTS), "a non-empty list of different events", 1),
    words("true, false, or a non-empty list of different events"),
]
Error = Annotated[
    number(AN_ERROR, gt=0, le=1) | Literal[tuple(NAMED_ERRORS)],
    words(f"{AN_ERROR}, or a preset ({PRESET_NAMES})"),
]
AXES = "a list of different axes among x, y and, in a box with a depth, z, or text such as xy"
Axis = Annotated[Literal["x", "y", "z"], words("an axis (x, y, z)")]
Axes = Annotated[
    different(Axis, AXES) | Annotated[str, Field(pattern="^[xyz]*$")],
    words(AXES),
]
Folder = text(
    "a path, 200 characters at most, of folders whose names have letters, digits, _, - and dots, no"
    " dot first, without a slash at its end, and outside the folders of the sources",
    "^/?(?!(config|docs|paper|profiles|src|tests|workflow)(/|$))"
    "[A-Za-z0-9_][A-Za-z0-9_.-]*(/[A-Za-z0-9_][A-Za-z0-9_.-]*)*",
    200,
)
#: Names that a scene must not have: of folders, of targets, and of devices of Windows.
RESERVED_NAMES = (
    "all", "benchmarks", "code", "draft", "figures", "logs", "parts", "points", "scenes", *STUDIES,
    "aux", "con", "nul", "prn", *(f"{port}{n}" for port in ("com", "lpt") for n in range(10)),
)  # fmt: skip
Name = text(
    "a name of small letters, digits, - and _, 100 at most, that starts with a letter or a digit",
    f"^(?!({'|'.join(RESERVED_NAMES)})$)[a-z0-9][a-z0-9_-]*",
    100,
)


# Blocks -----------------------------------------------------------------------------------------


class Block(BaseModel):
    """A block of keys; others are mistakes."""

    model_config = ConfigDict(extra="forbid", strict=True, regex_engine="python-re")


def _effects(of_box):
    """Return {name: (type, declaration)} of the effects that are sides of a box, or of others."""
    keys = {}
    for effect in EFFECTS.values():
        if effect.of_box != of_box:
            continue
        meaning = f"{effect.meaning[0].upper()}{effect.meaning[1:]}. {effect.more}".strip()
        if not effect.is_number:
            keys[effect.name] = (Axes, Field([], description=meaning))
        elif effect.default is None:
            keys[effect.name] = (_effect_number(effect), otherwise("none", meaning))
        else:
            keys[effect.name] = (_effect_number(effect), Field(effect.default, description=meaning))
    return keys


def _effect_number(effect):
    """Return the type of an effect that is a number."""
    kind = "ratio" if effect.name.endswith("_ratio") else "length" if effect.of_box else "number"
    low, high = format_number(effect.low, "g"), format_number(effect.high, "g")
    allowed = f"a {kind} between {low} and {high}"
    if effect.default == 0:
        return number(f"0, or {allowed}, {effect.meaning}", effect.unit, ge=0, le=effect.high)
    return number(allowed, effect.unit, ge=effect.low, le=effect.high)


class _Sides(Block):
    width: Length
    """Its side along x."""

    height: Length
    """Its side along y."""


Sides = create_model("Sides", __base__=_Sides, **_effects(of_box=True))
Effects = create_model("Effects", __base__=Block, **_effects(of_box=False))


class Grid(Block):
    smallest: Length = otherwise("a hundredth of the shorter side, for the larger disc")
    """The first radius of the grid."""

    count: integer(1, 1000) = 24
    """The number of radii in the grid, without the radii of `include`."""

    include: Radii = otherwise("none")
    """Additional radii, which do not move the grid."""


class Histogram(Block):
    radii: Radii = otherwise("0.1, 0.3, 0.5 and 0.7 of the hop's threshold")
    """The radii of the histograms; they need not be among the radii of the scene."""

    event: choice(HOPS) = otherwise("`vertical_hop`, or the only hop of the scene")
    """The hop."""

    intervals: integer(1, 10**12) = 10**6
    """The number of intervals in each histogram."""

    event_budget: Budget = 10**11
    """The most events that one histogram may use, even if fewer intervals result."""


class Watch(Block):
    volume: Flag = False
    """The volume of configuration space, by Monte Carlo."""

    areas: Events = False
    """The areas of these events' surfaces, by Monte Carlo; true for all of them."""

    mean_times: Events = False
    """The mean times between these events, by molecular dynamics; true for all of them."""

    hop_histogram: Annotated[
        bool | Radii | Histogram,
        words("true, false, a non-empty list of radii, or a block {radii: …, event: …, …}"),
    ] = False
    """The histogram of the times from one hop to the next: a list of radii, a block of the four
    keys below, or true for radii at 0.1, 0.3, 0.5 and 0.7 of the hop's threshold."""

    trajectory: Annotated[bool | Length, words(f"true, false, or {A_LENGTH}")] = False
    """The radius of one trajectory, drawn as x2 − x1 against time. `true` stands for 0.24 of the
    shorter side, where both hops are open and the horizontal hop of a wide box is rare. With
    effects it stands for half of the radius at which the first hop becomes blocked."""


class MonteCarlo(Block):
    samples: integer(1, MOST_EVENTS) = 10**8
    """The number of configurations drawn for each radius, rounded up to full blocks of 2^20. If
    fewer than 1/64 of the samples are accepted, a conditioned sampler draws 1/64 as many samples at
    the same cost."""

    shell: number("a number above 1e-6 and below 1", gt=THINNEST_SHELL, lt=1) = 0.02
    """The thickness of the shell that measures an area, as a fraction of the radius, or of the gap
    left to the discs if that is smaller."""


class _Accuracy(Block):
    default: Error = "paper"
    """The requested error of all events that the block does not name."""


_of_event = Error, otherwise("the error of `default`", "The requested error of this event.")
Accuracy = create_model("Accuracy", __base__=_Accuracy, **dict.fromkeys(EVENTS, _of_event))


class SceneBlock(Block):
    name: Name
    """The name of the scene and of its folder of results; different for every scene, and not the
    name of a target, of another folder or of a device of Windows."""

    box: Annotated[Sides, words("a block {width: …, height: …}, with a depth for balls")]
    """The rectangle that holds the discs, or with a depth the box that holds two balls."""

    discs: integer(2, MOST_DISCS) = 2
    """The number of discs. More than two discs are equal. Their effects may be periodic,
    moment_of_inertia and friction. Collisions and hops then count for any pair of discs, hits of a
    wall for one disc. Exact values are known for three discs in any box or on a torus, and for any
    number in a channel in which only neighbours touch, h ≤ (2 + √3) r. In other boxes Monte Carlo
    and dynamics are compared with each other."""

    effects: Effects = Field(default_factory=Effects)
    """All that differs from equal, smooth discs that move freely between walls. An effect that is
    not named here is neither simulated nor compiled."""

    radii: Annotated[
        Radii | Grid,
        words("a non-empty list of radii, or a block {smallest: …, count: …, include: […]}"),
    ] = Field(default_factory=Grid)
    """The radii of the discs: a list, or a block of the three keys below. The block makes a grid
    that is dense on both sides of h/4 and w/4, where a hop becomes blocked, and below the largest
    radius that fits. With effects, the grid has equal steps up to 0.9 of the largest radius."""

    watch: Annotated[
        bool | Watch,
        words(
            f"a block of the keys {', '.join(Watch.model_fields)}, or true for all of them",
            otherwise="`{mean_times: true}`",
        ),
    ] = Field(default_factory=lambda: Watch(mean_times=True))
    """The quantities to compute and measure. A quantity that this block leaves out is neither
    computed nor drawn. Without the block these are the mean times. `true` stands for all quantities
    of the scene: on a periodic axis there are neither hops nor walls, intervals between hops of
    rough discs have no exact mean, intervals of more than two discs are recorded only on request,
    and Monte Carlo samples at most 64 discs."""

    accuracy: Annotated[
        Error | Accuracy,
        words(f"{AN_ERROR}, a preset ({PRESET_NAMES}), or a block of these by event"),
    ] = "paper"
    """The requested relative standard error of every mean time: a number, a preset (draft 1e-2,
    paper 3e-4, reference 1e-4), or a block with one of these for each event."""

    event_budget: Budget = otherwise("the accuracy is reached, unless it takes about a day")
    """The most events that the simulation of one radius may use, even if it has not reached the
    accuracy by then."""

    monte_carlo: MonteCarlo = Field(default_factory=MonteCarlo)
    """The settings of the Monte Carlo estimates of volume and areas."""


class AccuracyCost(Block):
    seconds: number("a number from 1 to 1e6", "s", ge=1, le=1e6) = 30
    """The processor time of the study; with more time, it reaches smaller errors."""


class Model(Block):
    results: Folder = "results"
    """The folder of all results."""

    seed: integer(0, LARGEST_INTEGER) = 1908
    """The root of all random numbers. Another seed repeats every simulation independently."""

    shard_events: integer(10**7, MOST_EVENTS, EVENTS_UNIT) = 10**11
    """If a radius may take more events or samples than this, its work is divided into shards: jobs
    of about this many events each. Results do not depend on it if the budget is larger."""

    accuracy_cost: AccuracyCost = Field(default_factory=AccuracyCost)
    """The study of the cost of accuracy by each method."""

    shared: different(
        choice(BUILT_ONCE), f"a list of different names among {', '.join(BUILT_ONCE)}"
    ) = Field(
        ["report"],
        description="The documents and studies to build, beside the tables and figures of the"
        " scenes and the check. `report` is about these scenes. The manuscript and the studies are"
        " built only if named here, or as a target. "
        f"{', '.join(f'`{name}`' for name in ABOUT_PLAIN[:-1])} and `paper` are about scenes"
        " without effects, most of them about the first, and need such a scene. `effects` is always"
        " about the scenes of `config/scenes`. `paper` includes all studies that it reads: all of"
        " these and `accuracy_cost`.",
    )

    scenes: Annotated[
        list[Annotated[SceneBlock, words("a block of keys, at least name and box")]],
        Field(min_length=1),
        words("a non-empty list of scenes"),
    ]
    """The boxes to study, one block each."""
