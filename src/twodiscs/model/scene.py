"""The scene: hard discs in a rectangular box, two unless told, and what follows from it.

Coordinates have their origin at the centre of the box. Lengths are in the unit of the box, disc 1
has mass one and the total energy is 1/2: the speed of disc 1 is at most one, and times are lengths
over that speed.

The plain scene has equal, smooth discs between walls. A scene may call for effects: unequal radii
or masses, periodic axes, a uniform field along −y, rough discs, a third dimension (then the discs
are balls), more discs than two. What a scene does not call for is neither simulated nor compiled.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from fractions import Fraction
from functools import cached_property

from twodiscs.model.checks import (
    LONGEST,
    MOST_DISCS,
    SHORTEST,
    InputError,
    check_choice,
    check_integer,
    check_length,
    check_number,
    quote,
)
from twodiscs.model.effects import ABSENT, EFFECTS
from twodiscs.model.events import DECLARED, EVENTS

#: What is open to the discs, named by the hops that remain.
REGIMES = ("all-hops", "vertical-hops", "horizontal-hops", "no-hops")

#: How close to the largest radius dynamics in doubles holds, relatively: at a tenth of that mean
#: times begin to be off by more than 1e-4.
FOLLOWED = 1e-12

#: Decimal digits before or after the point that the prism of all places of more than two discs may
#: have: its volume is then a double that is neither 0 nor infinite.
MOST_DIGITS = 150

#: The total energy, kinetic and potential.
ENERGY = 0.5


@dataclass(frozen=True)
class Scene:
    """Hard discs in a box of ``width`` × ``height``, two of them, disc 1 of radius ``radius``.

    Effects, each absent by default:

    * ``depth``: the third side of the box; the discs are balls then.
    * ``radius_ratio``, ``mass_ratio``: of disc 2 to disc 1.
    * ``periodic``: the axes ("x", "y", "z", a list of them or text such as "xy") with neither wall
      nor end.
    * ``field``: the acceleration g along −y, in speed²/length. Heights count from where each disc
      rests on the bottom, so the potential energy is never negative.
    * ``moment_of_inertia``: I/(m r²), in (0, 1], of rough discs: at contact the tangential velocity
      of the surfaces is reversed too, between discs and at walls. None means smooth.

    ``discs`` is their number, an integer from 2 to 64. More than two are equal and smooth, in the
    plane, and of the effects only ``periodic`` "x" goes with them: the box is then a ring along x,
    with a total momentum of 0 along it. A collision or a hop is then that of any pair, a hit of the
    right or the top wall that of one disc, averaged over all initial conditions.

    Raises ``InputError`` for a value that is not of its kind, for a radius that leaves the discs no
    room or no motion at total energy 1/2, and for effects that do not go together.

    Example:

        td.Scene(1.5, 1.0, 0.2, mass_ratio=2, periodic="x").regime
    """

    width: float
    height: float
    radius: float
    depth: float | None = None
    radius_ratio: float = 1.0
    mass_ratio: float = 1.0
    periodic: str | Sequence[str] = ""
    field: float = 0.0
    moment_of_inertia: float | None = None
    discs: int = 2

    def __post_init__(self):
        for name in ("width", "height", "radius"):
            object.__setattr__(self, name, check_length(name, getattr(self, name)))
        if isinstance(self.periodic, list | tuple) and all(a in list("xyz") for a in self.periodic):
            object.__setattr__(self, "periodic", "".join(self.periodic))
        for name, effect in EFFECTS.items():
            object.__setattr__(self, name, effect.checked(getattr(self, name)))
        if self.has_effects:
            self._check_effects()
        if self.discs != 2 or type(self.discs) is not int:
            object.__setattr__(self, "discs", check_integer("discs", self.discs, 2, MOST_DISCS))
        if self.discs > 2:
            self._check_many()
            return
        if not self._fits():
            raise InputError(
                f"radius {self.radius!r} does not fit: two {self._what} in a box of "
                f"{self._box} need a radius below {self.largest_radius!r}"
            )
        if self.field:
            self._check_energy()

    def _check_effects(self):
        def settle(name, value):
            object.__setattr__(self, name, value)

        if self.depth is not None:
            # Six lengths are multiplied.
            for name in ("depth", "width", "height", "radius"):
                settle(name, check_number(name, getattr(self, name), SHORTEST**0.75, LONGEST**0.75))
        repeated = len(set(self.periodic)) != len(self.periodic)
        if repeated or not set(self.periodic) <= {*self.axes}:
            allowed = "x and y (z needs a depth)" if self.depth is None else "x, y and z"
            raise InputError(
                f"periodic must be some of the axes {allowed}, each once and no other letter, not "
                f"{quote(self.periodic)}"
            )
        settle("periodic", "".join(sorted(self.periodic)))
        if self.field and "y" in self.periodic:
            raise InputError(
                "field must be 0 where y is periodic, for nothing would hold the discs, not "
                f"{self.field!r}"
            )
        if self.moment_of_inertia is not None:
            self._check_roughness()

    def _check_many(self):
        if other := [name for name in self.effects if name != "periodic"]:
            raise InputError(
                f"{other[0]} must be left out with {self.discs} discs, for more than two are equal "
                f"and smooth discs of the plane, not {self.effects[other[0]]!r}"
            )
        size = self.discs * math.log10(self.gas.range_x * self.gas.range_y)
        if abs(size) > MOST_DIGITS:
            raise InputError(
                f"width and height must be in a unit of length in which the prism of all places of "
                f"{self.discs} discs lies between 1e-{MOST_DIGITS} and 1e{MOST_DIGITS}, not "
                f"{self.width!r} and {self.height!r} at radius {self.radius!r}"
            )

    @cached_property
    def gas(self):
        """The same as a ``Gas`` of N discs; only of equal, smooth discs of the plane."""
        from twodiscs.model.many import Gas  # more than two discs alone have a use for it

        return Gas(self.discs, self.width, self.height, self.radius, self.periodic)

    def _check_roughness(self):
        if self.depth is not None:
            where = "in a box with a depth (rough discs are for the plane)"
        elif not self.walled:
            where = "in a box without walls (the spins would keep I1 ω1/r1 − I2 ω2/r2 for ever)"
        else:
            return
        raise InputError(
            f"moment_of_inertia must be left out {where}, not {self.moment_of_inertia!r}"
        )

    def _check_energy(self):
        if self._lowest_potential(self._spread("y")) >= ENERGY:
            raise InputError(
                f"field {self.field!r} is too strong at radius {self.radius!r}: with a total "
                "energy of 1/2 the discs cannot leave the bottom, where they do not fit side by "
                "side"
            )
        if (self.radius_ratio, self.mass_ratio) != (1.0, 1.0) and not self.vertical_hops:
            raise InputError(
                "unequal discs in a field need room and energy to pass each other on y1 = y2, or "
                f"the parts of configuration space are unequal, too; at radius {self.radius!r} "
                "they lack it"
            )

    def __getstate__(self):
        """Return the fields alone: a copy is the same whatever was asked of the scene before."""
        return {field.name: getattr(self, field.name) for field in fields(self)}

    def __repr__(self):
        sides = f"{self.width!r}, {self.height!r}, {self.radius!r}"
        return f"Scene({', '.join([sides, *(f'{n}={v!r}' for n, v in self.calls_for.items())])})"

    def __str__(self):
        """Say what the scene is, in a line."""
        more = {name: value for name, value in self.effects.items() if name != "depth"}
        words = [f"{name.replace('_', ' ')} {value}" for name, value in more.items()]
        number = "Two" if self.discs == 2 else self.discs
        discs = f"{number} {self._what} of radius {self.radius!r} in a box of {self._box}"
        return ", ".join([discs, *words])

    @property
    def _what(self):
        return "discs" if self.depth is None else "balls"

    @property
    def _box(self):
        return " × ".join(repr(self.side(axis)) for axis in self.axes)

    def unit(self, quantity: str) -> str:
        """Return the unit of a "volume", an "area" or anything that is a "time"."""
        dimensions = self.discs * len(self.axes)
        powers = {"volume": dimensions, "area": dimensions - 1}
        kind = quantity.rpartition("_")[2]
        if kind not in powers:
            return "time"
        return "length" + "".join("⁰¹²³⁴⁵⁶⁷⁸⁹"[int(digit)] for digit in str(powers[kind]))

    def with_radius(self, radius: float) -> Scene:
        """Return the same scene with another radius of disc 1."""
        return replace(self, radius=radius)

    @property
    def effects(self) -> dict[str, object]:
        """The effects that the scene calls for, {name: value} in the order of the fields."""
        return {
            name: getattr(self, name)
            for name, default in ABSENT.items()
            if getattr(self, name) != default
        }

    @property
    def has_effects(self) -> bool:
        """Whether the scene calls for any effect."""
        return bool(self.effects)

    @property
    def calls_for(self):
        """What it calls for beyond two equal, smooth discs between walls, {name: value}.

        These are its effects, and ``discs`` where they are more than two.
        """
        return self.effects | ({"discs": self.discs} if self.discs > 2 else {})

    @property
    def is_plain(self):
        """Whether it is two equal, smooth discs between walls."""
        return not self.calls_for

    @cached_property
    def axes(self) -> tuple[str, ...]:
        """The names of the axes: x, y and, for balls, z."""
        return ("x", "y") if self.depth is None else ("x", "y", "z")

    @cached_property
    def walled(self) -> tuple[str, ...]:
        """The axes with walls."""
        return tuple(axis for axis in self.axes if axis not in self.periodic)

    @cached_property
    def conserved(self) -> tuple[str, ...]:
        """The axes along which the total momentum is conserved; the ensemble has it at 0.

        Those are the periodic ones, unless there are rough walls, which push discs along them.
        """
        return tuple(self.periodic) if self.moment_of_inertia is None else ()

    @cached_property
    def velocity_components(self) -> int:
        """D: the components of velocities and spins, less the momenta that are conserved."""
        if self.discs > 2:
            return self.gas.velocity_components
        spins = 0 if self.moment_of_inertia is None else 2
        return 2 * len(self.axes) + spins - len(self.conserved)

    @cached_property
    def radii(self) -> tuple[float, float]:
        """The radii of disc 1 and disc 2."""
        return self.radius, self.radius * self.radius_ratio

    @cached_property
    def masses(self) -> tuple[float, float]:
        """The masses of disc 1 and disc 2."""
        return 1.0, self.mass_ratio

    def side(self, axis):
        """Return the side of the box along ``axis``."""
        return {"x": self.width, "y": self.height, "z": self.depth}[axis]

    @cached_property
    def range_x(self):
        """A = w − σ: the largest separation x1 − x2 between walls, and an equal disc's range."""
        return self.width - sum(self.radii)

    @cached_property
    def range_y(self):
        """B = h − σ: the same along y; neither means anything on a periodic axis."""
        return self.height - sum(self.radii)

    @cached_property
    def contact_distance(self) -> float:
        """σ: the distance of the centres when the discs touch, twice the radius if equal."""
        return sum(self.radii)

    @cached_property
    def exact_radii(self):
        """The radii of the discs as fractions; the same doubles as ``radii``."""
        return tuple(map(Fraction, self.radii))

    @cached_property
    def exact_contact(self):
        """σ as a fraction."""
        return sum(self.exact_radii)

    def reach(self, axis):
        """Return the largest separation of the centres along ``axis``, as an exact fraction.

        That is the side less σ between walls, and half the side on a periodic axis, where the
        nearest image counts.
        """
        side = Fraction(self.side(axis))
        return side / 2 if axis in self.periodic else side - self.exact_contact

    def _spread(self, *without):
        """Return the sum of the squared reaches of all axes but some, an exact fraction."""
        return sum(self.reach(axis) ** 2 for axis in self.axes if axis not in without)

    def _fits(self):
        """Say, in exact arithmetic, whether both discs have room to move."""
        widest = 2 * max(self.exact_radii)
        if any(Fraction(self.side(axis)) <= widest for axis in self.axes):
            return False
        if any(self.reach(axis) <= 0 for axis in self.axes):
            return False
        return self._spread() > self.exact_contact**2

    @cached_property
    def largest_radius(self) -> float:
        """The radius of disc 1 at which the discs have no room left.

        Of more than three discs it is that of the densest arrangement that is known here;
        in a channel so narrow that only neighbours can touch there is no denser one.
        """
        if self.discs > 2:
            return self.gas.largest_radius
        if not self.has_effects:
            return _largest_radius(self.width, self.height)
        # In σ: Σ over walls of (side − σ)² + Σ over periodic axes of (side/2)² = σ².
        walls = [self.side(axis) for axis in self.walled]
        n, total = len(walls), math.fsum(walls)
        squares = math.fsum(side * side for side in walls)
        squares += math.fsum(self.side(axis) ** 2 / 4 for axis in self.periodic)
        limits = [min(map(self.side, self.axes)) / max(1.0, self.radius_ratio) / 2]
        limits += [side / (1 + self.radius_ratio) for side in walls]
        if n == 0:
            limits.append(math.sqrt(squares) / (1 + self.radius_ratio))
        elif n == 1:
            limits.append(squares / (2 * total) / (1 + self.radius_ratio))
        elif total**2 >= (n - 1) * squares:
            # The smaller root, without its cancellation.
            root = math.sqrt(total**2 - (n - 1) * squares)
            limits.append(squares / (total + root) / (1 + self.radius_ratio))
        return min(limits)

    def require_followable(self):
        """Raise ``InputError`` where dynamics in doubles is off: too close to the largest radius.

        Where discs jam along a diagonal, the room left to them is lost in the roundings of places.
        """
        jams = not self.has_effects and self.largest_radius < min(self.width, self.height) / 2
        if jams and self.radius > (closest := self.largest_radius * (1 - FOLLOWED)):
            raise InputError(
                f"radius {self.radius!r} must not exceed {closest!r} for molecular dynamics: "
                f"beyond it, roundings count in the room that is left below {self.largest_radius!r}"
            )

    def _lowest_potential(self, spread):
        """Return the least potential energy of discs whose separation but for y has this square.

        ``spread`` is the largest such square. The lower disc lies on the bottom and the other one
        on it, or beside it if there is room.
        """
        if not self.field:
            return 0.0
        square = self.exact_contact**2 - spread
        apart = math.sqrt(square) if square > 0 else 0.0
        (r1, r2), (m1, m2) = self.radii, self.masses
        return self.field * min(m2 * max(apart + r1 - r2, 0.0), m1 * max(apart + r2 - r1, 0.0))

    @cached_property
    def _passed(self):
        """The axes along which the discs can exchange sides.

        Of more than three discs those along which geometry does not exclude it.
        """
        if self.discs > 2:
            return tuple(axis for axis in self.walled if self.gas.can_be_level(axis))
        return tuple(axis for axis in self.walled if self._has_gap(axis))

    def _has_gap(self, axis):
        """Say whether there are room and energy to pass along an axis with walls."""
        if self._spread(axis) <= self.exact_contact**2:
            return False
        if axis == "y":
            (r1, r2), (m1, m2) = self.radii, self.masses
            lowest = self.field * (m1 * (r2 - r1) if r2 > r1 else m2 * (r1 - r2))
        else:
            lowest = self._lowest_potential(self._spread(axis, "y"))
        return lowest < ENERGY

    def room(self, hop):
        """Return how far apart discs that are level along the axis of ``hop`` can be, less σ.

        For equal discs of the plane that is B − σ for the horizontal hop, A − σ for the vertical
        one; it is negative where the hop is blocked.
        """
        spread, sigma = self._spread(DECLARED[hop].axis), self.exact_contact
        return float(spread - sigma**2) / (math.sqrt(spread) + float(sigma))

    @cached_property
    def fastest(self):
        """The largest relative velocity of the centres, √(1/m1 + 1/m2) at total energy 1/2.

        That is the length of the gradient of a separation, too, in the metric of the masses.
        """
        return math.sqrt(sum(2 * ENERGY / mass for mass in self.masses))

    @cached_property
    def vertical_hops(self):
        """Whether the discs can pass each other on y1 = y2; equal discs of the plane if w > 4r."""
        return "y" in self._passed

    @cached_property
    def horizontal_hops(self):
        """Whether the discs can pass each other on x1 = x2; equal discs of the plane if h > 4r."""
        return "x" in self._passed

    @cached_property
    def regime(self) -> str:
        """One of ``REGIMES``; on a periodic axis there are no hops."""
        if self.vertical_hops and self.horizontal_hops:
            return "all-hops"
        if self.vertical_hops:
            return "vertical-hops"
        return "horizontal-hops" if self.horizontal_hops else "no-hops"

    @cached_property
    def ergodic_components(self) -> int | None:
        """The number of disjoint parts of configuration space.

        Each hop that is blocked between walls doubles it. A periodic axis has a way around. Of more
        than two discs there are N! where they keep their order, (N − 1)! on a ring, more in a short
        channel where heights have parts of their own, 1 where all discs pass each other with room
        to spare, and None where it is not known.
        """
        if self.discs > 2:
            return self.gas.ergodic_components
        return 2 ** (len(self.walled) - len(self._passed))

    def _confined(self, axis):
        """Say whether disc 1 reaches the far wall of ``axis`` only from its own side of disc 2.

        It does so once the hop is blocked, unless it is the larger disc and there is room for
        disc 2 in the corner behind it.
        """
        if axis in self._passed or axis not in self.walled:
            return False
        r1, r2 = self.exact_radii
        if r1 <= r2:
            return True
        behind = (r1 - r2) ** 2
        if self._spread(axis) + behind <= self.exact_contact**2:
            return True
        return self._lowest_potential(self._spread(axis, "y") + behind) >= ENERGY

    @cached_property
    def confined(self):
        """Whether disc 1 reaches a wall of x, and one of y, only from its own side of disc 2.

        False for more than two discs: their times are averages over all initial conditions.
        """
        if self.discs > 2:
            return False, False
        return self._confined("x"), self._confined("y")

    @cached_property
    def identical(self):
        """Whether the discs are equal, so that they may be exchanged."""
        return self.radius_ratio == self.mass_ratio == 1

    def share(self, event):
        """Return the share of trajectories that can see ``event``.

        That is 1/2 for a wall that disc 1 reaches from its own side of disc 2 only, else 1.
        """
        declared = DECLARED[event]
        return 0.5 if declared.kind == "wall" and self.confined["xy".index(declared.axis)] else 1.0

    def multiplicity(self, event):
        """Return the mean count of ``event`` in one mean time, with all that is equal to it.

        Mirror images and equal discs leave four of the pairs of a disc and a wall that have one
        rate, two of them within the reach of a trajectory where the discs keep their sides. A field
        has no mirror image along y. It is 2N for walls of more than two discs, and 1 for everything
        but walls.
        """
        declared = DECLARED[event]
        if declared.kind != "wall":
            return 1
        if self.discs > 2:
            return 2 * self.discs
        mirrored = declared.axis == "x" or not self.field
        return round((1 + mirrored) * (1 + self.identical) * self.share(event))

    @cached_property
    def events(self) -> tuple[str, ...]:
        """Those of ``EVENTS`` that have a place in the scene, whether or not they are possible."""
        return tuple(event.name for event in DECLARED.values() if self._has_place(event))

    def _has_place(self, event):
        if event.axis:
            return event.axis in self.walled
        return event.kind == "collision" or bool(self.walled)

    def is_possible(self, event: str) -> bool:
        """Say whether ``event`` ever happens; hops can be blocked, and a field keeps discs down."""
        if check_choice("event", event, EVENTS) not in self.events:
            return False
        declared = DECLARED[event]
        if declared.kind == "hop":
            return declared.axis in self._passed
        if self.field and (declared.axis, declared.side) == ("y", +1):
            return self.field * (self.height - 2 * self.radius) < ENERGY
        return True


def _largest_radius(width, height):
    """Return the radius at which two equal discs just fit in a ``width`` × ``height`` box.

    For max < 2 min the discs jam along a diagonal, (w + h − √(2wh))/2; otherwise each of them spans
    the short side, min/2.
    """
    short, long = min(width, height), max(width, height)
    if long >= 2 * short:
        return short / 2
    return (width + height - math.sqrt(2 * width) * math.sqrt(height)) / 2


def check_scene(value):
    """Return ``value``; raise ``InputError`` unless it is a ``Scene``."""
    if not isinstance(value, Scene):
        raise InputError(f"scene must be a Scene, not {quote(value)}")
    return value


def check_two_discs(scene, what):
    """Return ``scene``; raise ``InputError`` unless it is a ``Scene`` of two discs.

    ``what`` is what more discs are refused, in words that follow "for".
    """
    if check_scene(scene).discs != 2:
        raise InputError(f"discs must be 2 for {what}, not {scene.discs}")
    return scene


if {f.name: f.default for f in fields(Scene)[3:-1]} != ABSENT:
    raise TypeError(
        "the fields of Scene between radius and discs must be the effects of "
        f"model/effects.py with the values that mean their absence, {ABSENT}"
    )
