"""The box and the scene: hard discs in a rectangle, two by default, and their geometry.

A ``Box`` has all that does not depend on the radius. A ``Scene`` is a box with a radius.

Coordinates have their origin at the centre of the box. Lengths are in the unit of the box, disc 1
has mass one and the total energy is 1/2. The speed of disc 1 is then at most one, and times are
lengths over that speed.

The plain scene has two equal, smooth discs between walls. A scene may have effects: unequal radii
or masses, periodic axes, a uniform field along −y, rough discs, friction, a third dimension (then
the discs are balls); or more discs than two. Absent effects are neither simulated nor compiled.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import KW_ONLY, dataclass, fields, replace
from fractions import Fraction
from functools import cached_property

from twodiscs.model import many_geometry, two_geometry
from twodiscs.model.calls import checked_call
from twodiscs.model.checks import (
    LONGEST_LENGTH,
    MOST_DISCS,
    SHORTEST_LENGTH,
    InputError,
    check_choice,
    check_integer,
    check_length,
    check_number,
)
from twodiscs.model.effects import EFFECTS
from twodiscs.model.events import DECLARED_EVENTS, EVENT_AXES, EVENTS, HOPS, WALL_HITS, WALLS
from twodiscs.model.formats import quote
from twodiscs.model.two_geometry import ENERGY

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Self

    from twodiscs import Axis, Event

#: The regimes, named by the hops that are open.
REGIMES = ("all-hops", "vertical-hops", "horizontal-hops", "no-hops")

#: The most kicks by friction in the time that a disc of speed 1 takes along the shortest side.
MOST_KICKS = 1e6


@checked_call
@dataclass(frozen=True)
class Box:
    """A box with its effects and its number of discs, for any radius.

    Parameters
    ----------
    width, height : float
        Sides of the box, in length, from 1e-60 to 1e60.
    depth, radius_ratio, mass_ratio, periodic, field, moment_of_inertia, friction, discs : optional
        The effects of ``Scene``, and its number of discs.

    Raises
    ------
    InputError
        For a value of another type or range, and for effects that cannot be combined.

    Examples
    --------
    >>> round(td.Box(1.5, 1.0).largest_radius, 12)
    0.383974596216
    >>> round(td.Box(1.5, 1.0, periodic="x").largest_radius, 12)
    0.390625
    """

    width: float
    height: float
    _: KW_ONLY
    depth: float | None = None
    radius_ratio: float = 1.0
    mass_ratio: float = 1.0
    periodic: str | Sequence[Axis] = ""
    field: float = 0.0
    moment_of_inertia: float | None = None
    friction: float = 0.0
    discs: int = 2

    #: The lengths that have no default.
    LENGTHS = ("width", "height")

    def __post_init__(self):
        for name in self.LENGTHS:
            self._settle(name, check_length(name, getattr(self, name)))
        if isinstance(self.periodic, list | tuple) and all(a in list("xyz") for a in self.periodic):
            self._settle("periodic", "".join(self.periodic))
        for name, effect in EFFECTS.items():
            self._settle(name, effect.checked(getattr(self, name)))
        self._check_effects()
        self._settle("discs", check_integer("discs", self.discs, 2, MOST_DISCS))
        if self.discs > 2:
            many_geometry.check_box(self)

    def _settle(self, name, value):
        object.__setattr__(self, name, value)

    def _check_effects(self):
        if self.depth is not None:
            # Six lengths are multiplied.
            ends = SHORTEST_LENGTH**0.75, LONGEST_LENGTH**0.75
            for name in ("depth", *self.LENGTHS):
                self._settle(name, check_number(name, getattr(self, name), *ends))
        if len({*self.periodic} & {*self.axes}) < len(self.periodic):
            allowed = "x and y (z needs a depth)" if self.depth is None else "x, y and z"
            raise InputError(
                f"periodic must be some of the axes {allowed}, each once and no other letter, not "
                f"{quote(self.periodic)}"
            )
        self._settle("periodic", "".join(sorted(self.periodic)))
        if self.field and "y" in self.periodic:
            raise InputError(
                "field must be 0 if y is periodic, because the discs would fall for ever, not "
                f"{self.field!r}"
            )
        if self.moment_of_inertia is not None:
            self._check_roughness()
        if self.friction * self.shortest > MOST_KICKS:
            raise InputError(
                f"friction must not exceed {MOST_KICKS:g} over the shortest side, which is "
                f"{MOST_KICKS / self.shortest!r}, not {self.friction!r}"
            )

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

    def __getstate__(self):
        """Return only the fields: a copy does not depend on cached properties."""
        return {field.name: getattr(self, field.name) for field in fields(self)}

    def __repr__(self):
        lengths = [repr(getattr(self, name)) for name in self.LENGTHS]
        named = [f"{name}={value!r}" for name, value in self.options.items()]
        return f"{type(self).__name__}({', '.join([*lengths, *named])})"

    def parameters(self) -> dict[str, object]:
        """Return the box as plain values, from which ``Box(**parameters)`` makes it again.

        Those of a scene include its radius, and ``Scene(**parameters)`` makes it again. Absent
        effects and two discs are left out. The parameters of a job in a plain box, and its results,
        then do not change if effects are added to the package.

        Returns
        -------
        dict
            {name: value}.

        Examples
        --------
        >>> td.Box(1.5, 1.0, field=0.5).parameters()
        {'width': 1.5, 'height': 1.0, 'field': 0.5}
        """
        return {name: getattr(self, name) for name in self.LENGTHS} | self.options

    @property
    def effects(self) -> dict[str, object]:
        """The effects, {name: value} in the order of the fields."""
        return {name: value for name, value in self.options.items() if name != "discs"}

    @property
    def family(self) -> str:
        """The family: "plain" (two equal, smooth discs between walls), "effects" or "many"."""
        if self.discs > 2:
            return "many"
        return "effects" if self.effects else "plain"

    @property
    def _geometry(self):
        """The module with the functions of a ``Scene`` that differ between two discs and more.

        Each of both has check, require_followable, largest_radius, open_axes, ergodic_components,
        confined and copies.
        """
        return many_geometry if self.discs > 2 else two_geometry

    @property
    def options(self):
        """Everything beyond two equal, smooth discs between walls, {name: value}.

        These are its effects, and ``discs`` if there are more than two.
        """
        return {
            n: getattr(self, n) for n, usual in USUAL_VALUES.items() if getattr(self, n) != usual
        }

    @property
    def is_plain(self):
        """Whether it is two equal, smooth discs between walls."""
        return not self.options

    def turned(self) -> Self:
        """Return the same box or scene with x and y exchanged.

        Returns
        -------
        Box or Scene
            It is turned by a quarter.

        Raises
        ------
        InputError
            In a field, which is along y.

        Examples
        --------
        >>> td.Box(1.5, 1.0).turned()
        Box(1.0, 1.5)
        """
        if self.field:
            raise InputError(f"field must be 0 to exchange the axes, not {self.field!r}")
        periodic = self.periodic.translate(str.maketrans("xy", "yx"))
        return replace(self, width=self.height, height=self.width, periodic=periodic)

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
        """The axes along which the total momentum is conserved; it is 0 in the ensemble.

        These are the periodic axes, unless there are rough walls, which change the momentum along
        them.
        """
        return tuple(self.periodic) if self.moment_of_inertia is None else ()

    @cached_property
    def velocity_components(self) -> int:
        """D: the number of components of velocities and spins, minus the conserved momenta."""
        spin = self.moment_of_inertia is not None
        return self.discs * (len(self.axes) + spin) - len(self.conserved)

    @cached_property
    def masses(self) -> tuple[float, ...]:
        """The masses of all discs."""
        return 1.0, *(self.mass_ratio,) * (self.discs - 1)

    def side(self, axis):
        """Return the side of the box along ``axis``."""
        return {"x": self.width, "y": self.height, "z": self.depth}[axis]

    @property
    def sides(self) -> tuple[float, ...]:
        """The sides of the box: width, height and maybe depth."""
        return tuple(map(self.side, self.axes))

    @property
    def shortest(self) -> float:
        """The shortest side."""
        return min(self.sides)

    @property
    def noun(self):
        """The word for two of them: discs or balls."""
        return "discs" if self.depth is None else "balls"

    @property
    def box_text(self):
        """The sides of the box as text, "1.5 × 1.0" say."""
        return " × ".join(map(repr, self.sides))

    def unit(self, quantity: str) -> str:
        """Return the unit of a quantity.

        Parameters
        ----------
        quantity : str
            A name that ends in "volume" or "area"; any other is a time.

        Returns
        -------
        str
            The unit, such as "length⁴".

        Examples
        --------
        >>> scene.unit("any_wall_area")
        'length³'
        """
        dimensions = self.discs * len(self.axes)
        powers = {"volume": dimensions, "area": dimensions - 1}
        kind = quantity.rpartition("_")[2]
        if kind not in powers:
            return "time"
        return "length" + "".join("⁰¹²³⁴⁵⁶⁷⁸⁹"[int(digit)] for digit in str(powers[kind]))

    @cached_property
    def identical(self):
        """Whether the discs are equal, so that they may be exchanged."""
        return self.radius_ratio == self.mass_ratio == 1

    @cached_property
    def events(self) -> tuple[Event, ...]:
        """The ``EVENTS`` that exist in the box: hops and walls need walls along their axis.

        They include events that are impossible at some radii.
        """
        return tuple(filter(self._has_place, EVENTS))

    def _has_place(self, event):
        if event in EVENT_AXES:
            return EVENT_AXES[event] in self.walled
        return event not in WALL_HITS or bool(self.walled)

    # Radii -------------------------------------------------------------------------------------

    def scene(self, radius: float) -> Scene:
        """Return the scene at a radius.

        Parameters
        ----------
        radius : float
            The radius of disc 1, in length.

        Returns
        -------
        Scene
            The scene.

        Raises
        ------
        InputError
            If the discs do not fit or cannot move.

        Examples
        --------
        >>> td.Box(1.5, 1.0).scene(0.3).regime
        'vertical-hops'
        """
        return Scene(self.width, self.height, radius, **self.options)

    def fits(self, radius: float) -> bool:
        """Return whether there is a scene at a radius.

        Parameters
        ----------
        radius : float
            The radius of disc 1, in length.

        Returns
        -------
        bool
            True if the discs fit and can move.

        Examples
        --------
        >>> td.Box(1.5, 1.0).fits(0.39)
        False
        """
        radius = check_length("radius", radius)
        try:
            self.scene(radius)
        except InputError:
            return False
        return True

    @cached_property
    def largest_radius(self) -> float:
        """The radius of disc 1 at which the discs just fit.

        For more than three discs it belongs to the densest arrangement that is known here. In a
        channel so narrow that only neighbours can touch, no arrangement is denser.
        """
        return self._geometry.largest_radius(self)

    @cached_property
    def last_radius(self) -> float:
        """The radius from which on there is no scene: ``largest_radius``, or less in a field."""
        return self.end(lambda scene: True) if self.effects else self.largest_radius

    def end(self, holds):
        """Return the radius from which on there is no scene, or ``holds(scene)`` is false.

        ``holds`` is true for small discs and false for larger ones. The radius is found by
        bisection, to the last digit, if it is above 2⁻⁶⁰ of the shorter side.
        """
        low, high = 0.0, self.shortest / 2
        for _ in range(60):
            middle = (low + high) / 2
            try:
                fits = holds(self.scene(middle))
            except InputError:
                fits = False
            low, high = (middle, high) if fits else (low, middle)
        return high

    def threshold(self, event: Event) -> float | None:
        """Return the radius from which on an event is impossible.

        For hops of equal discs it is w/4 (vertical) or h/4 (horizontal), unless the discs jam
        before. For events that stay possible it is the last radius.

        Parameters
        ----------
        event : str
            One of ``EVENTS``.

        Returns
        -------
        float or None
            In length; None if the event is always impossible.

        Examples
        --------
        >>> td.Box(1.5, 1.0).threshold("horizontal_hop")
        0.25
        """
        if check_choice("event", event, EVENTS) not in HOPS:
            # In a field maybe only a large disc can touch the top.
            nearly = self.scene(self.last_radius * (1 - 1e-6))
            return self.last_radius if nearly.is_possible(event) else None
        if not self.is_plain:
            has_place = event in self.events
            return self.end(lambda scene: scene.is_possible(event)) if has_place else None
        return min(self.blocking_radius(event), self.largest_radius)

    def blocking_radius(self, hop):
        """Return w/4 or h/4, at which ``hop`` becomes blocked in a plain box if the discs fit.

        Discs that pass each other on y1 = y2 are side by side along x, and need four radii there.
        """
        return (self.width if EVENT_AXES[hop] == "y" else self.height) / 4

    @cached_property
    def thresholds(self) -> tuple[float, ...]:
        """The radii below the last one at which a hop becomes blocked, ascending, without repeats.

        Without effects they are h/4 and w/4, if discs of these radii fit.
        """
        limits = {self.threshold(hop) for hop in HOPS if hop in self.events}
        return tuple(sorted(radius for radius in limits if radius < self.last_radius))


#: The values of keywords that are not given, {name: value}.
USUAL_VALUES = {field.name: field.default for field in fields(Box)[2:]}


@checked_call
@dataclass(frozen=True, repr=False)
class Scene(Box):
    """Hard discs in a box, two of them by default, in which disc 1 has mass 1.

    The total energy is 1/2. Each effect is absent by default. More than two discs are equal, in the
    plane. They can have ``friction``, ``moment_of_inertia`` and ``periodic``: the box is then a
    ring along x or y, or a torus, and smooth discs have a total momentum of 0 along periodic axes.
    The hops and collisions of all pairs count then, and the hits of one disc on the right and the
    top wall, averaged over all initial conditions.

    Parameters
    ----------
    width, height : float
        Sides of the box, in length, from 1e-60 to 1e60.
    radius : float
        The radius of disc 1, in length.
    depth : float, optional
        The third side of the box, in length; the discs are balls then.
    radius_ratio : float, default 1
        The radius of disc 2 over that of disc 1, from 1e-3 to 1e3.
    mass_ratio : float, default 1
        The mass of disc 2 over that of disc 1, from 1e-3 to 1e3.
    periodic : str or sequence of str, default ""
        The axes without walls: "x", "y", "z", a list of them or text such as "xy".
    field : float, default 0
        The acceleration g along −y, in speed²/length, 0 or from 1e-60 to 1e60. The height of a disc
        is 0 on the bottom, so the potential energy is never negative.
    moment_of_inertia : float, optional
        I/(m r²) of rough discs, from 1e-3 to 1. Collisions of rough discs, with each other and with
        walls, also reverse the tangential velocity of the surfaces. Without it discs are smooth.
    friction : float, default 0
        The rate γ of a Poisson process, in 1/time, 0 or from 1e-60 to 1e6 over the shortest side.
        At its times all velocities and spins are drawn anew, uniformly on the sphere of the same
        kinetic energy and the same conserved momenta.
    discs : int, default 2
        The number of discs, from 2 to 16384.

    Raises
    ------
    InputError
        For a value of another type or range, for a radius at which the discs do not fit or cannot
        move at total energy 1/2, and for effects that cannot be combined.

    Examples
    --------
    >>> td.Scene(1.5, 1.0, 0.2, mass_ratio=2, periodic="x").regime
    'vertical-hops'
    """

    radius: float

    LENGTHS = ("width", "height", "radius")

    def __post_init__(self):
        super().__post_init__()
        self._geometry.check(self)

    def __str__(self):
        """Return the scene in words, on one line."""
        more = {name: value for name, value in self.effects.items() if name != "depth"}
        words = [f"{name.replace('_', ' ')} {value}" for name, value in more.items()]
        number = {2: "Two"}.get(self.discs, self.discs)
        discs = f"{number} {self.noun} of radius {self.radius!r} in a box of {self.box_text}"
        return ", ".join([discs, *words])

    @property
    def box(self) -> Box:
        """The box with its effects and its number of discs, without the radius."""
        return Box(self.width, self.height, **self.options)

    def with_radius(self, radius: float) -> Scene:
        """Return the same scene with another radius of disc 1.

        Parameters
        ----------
        radius : float
            The radius, in length.

        Returns
        -------
        Scene
            The scene.

        Raises
        ------
        InputError
            If the discs do not fit or cannot move.

        Examples
        --------
        >>> scene.with_radius(0.3).regime
        'vertical-hops'
        """
        return replace(self, radius=radius)

    @cached_property
    def radii(self) -> tuple[float, ...]:
        """The radii of all discs."""
        return self.radius, *(self.radius * self.radius_ratio,) * (self.discs - 1)

    @cached_property
    def range_x(self):
        """A: between walls w − σ, the range of an equal disc's centre; w on a periodic axis."""
        return self._range("x")

    @cached_property
    def range_y(self):
        """B: the same along y."""
        return self._range("y")

    def _range(self, axis):
        return self.side(axis) - (0.0 if axis in self.periodic else self.contact_distance)

    @cached_property
    def contact_distance(self) -> float:
        """The distance σ of the centres when the discs touch, twice the radius if equal."""
        return sum(self.radii[:2])

    @cached_property
    def exact_radii(self):
        """The radii of the discs as fractions; the same doubles as ``radii``."""
        return tuple(map(Fraction, self.radii))

    @cached_property
    def exact_contact(self):
        """σ as a fraction."""
        return sum(self.exact_radii[:2])

    def reach(self, axis):
        """Return the largest separation of the centres along ``axis``, as an exact fraction.

        It is the side minus σ between walls, and half the side on a periodic axis, on which the
        nearest image counts.
        """
        side = Fraction(self.side(axis))
        return side / 2 if axis in self.periodic else side - self.exact_contact

    def squared_reaches(self, *without):
        """Return the sum of the squared reaches of all axes but some, an exact fraction."""
        return sum(self.reach(axis) ** 2 for axis in self.axes if axis not in without)

    def require_followable(self):
        """Raise ``InputError`` too close to the largest radius for dynamics in doubles."""
        self._geometry.require_followable(self)

    @cached_property
    def open_axes(self) -> tuple[str, ...]:
        """The axes with walls along which the discs can exchange sides.

        For more than three discs these are the axes along which geometry does not exclude it.
        """
        return self._geometry.open_axes(self)

    def clearance(self, hop):
        """Return the largest distance of discs at a ``hop``, minus σ.

        For equal discs in the plane it is B − σ for the horizontal hop and A − σ for the vertical
        one. It is negative if the hop is blocked.
        """
        spread, sigma = self.squared_reaches(EVENT_AXES[hop]), self.exact_contact
        return float(spread - sigma**2) / (math.sqrt(spread) + float(sigma))

    @cached_property
    def fastest(self):
        """The largest relative velocity of the centres, √(1/m1 + 1/m2) at total energy 1/2.

        It is also the length of the gradient of a separation, in the metric of the masses.
        """
        return math.sqrt(sum(2 * ENERGY / mass for mass in self.masses[:2]))

    @cached_property
    def vertical_hops(self):
        """Whether the discs can pass each other on y1 = y2; equal discs in the plane if w > 4r."""
        return "y" in self.open_axes

    @cached_property
    def horizontal_hops(self):
        """Whether the discs can pass each other on x1 = x2; equal discs in the plane if h > 4r."""
        return "x" in self.open_axes

    @cached_property
    def regime(self) -> str:
        """One of ``REGIMES``; on a periodic axis there are no hops."""
        return REGIMES[2 * (not self.vertical_hops) + (not self.horizontal_hops)]

    @cached_property
    def ergodic_components(self) -> int | None:
        """The number of disjoint parts of configuration space.

        Each hop that is blocked between walls doubles it. On a periodic axis discs can go around.
        More than two discs have N! components if they keep their order, (N − 1)! on a ring, and
        more in a short channel, in which the heights of one order also form several components.
        They have 1 if any two of them can be exchanged. If the number is not known, it is None.
        """
        return self._geometry.ergodic_components(self)

    @cached_property
    def confined(self):
        """Whether disc 1 reaches a wall of x, and one of y, only from one side of disc 2.

        It is False for more than two discs: their times are averages over all initial conditions.
        """
        return self._geometry.confined(self)

    def accessible_fraction(self, event):
        """Return the fraction of trajectories that can have ``event``.

        It is 1/2 for a wall that disc 1 reaches only from one side of disc 2, else 1.
        """
        return 0.5 if event in WALLS and self.confined["xy".index(EVENT_AXES[event])] else 1.0

    def copies(self, event):
        """Return how many events are equal to ``event`` by symmetry; their hits are counted as one.

        It is 1 except for wall hits. A wall and its mirror image, hit by either of two equal discs,
        are four events with one rate. If the discs keep their sides, a trajectory can reach two of
        them. In a field the bottom is no mirror image of the top. For N > 2 discs it is 2N.
        """
        return self._geometry.copies(self, event)

    def is_possible(self, event: Event) -> bool:
        """Return whether an event ever happens; hops can be blocked, and a field keeps discs down.

        Parameters
        ----------
        event : str
            One of ``EVENTS``.

        Returns
        -------
        bool
            False if no trajectory has the event.

        Raises
        ------
        InputError
            For anything but one of ``EVENTS``.

        Examples
        --------
        >>> scene.is_possible("horizontal_hop")
        True
        """
        if check_choice("event", event, EVENTS) not in self.events:
            return False
        if event in HOPS:
            return EVENT_AXES[event] in self.open_axes
        if self.field and EVENT_AXES.get(event) == "y" and DECLARED_EVENTS[event].side > 0:
            return self.field * (self.height - 2 * self.radius) < ENERGY
        return True


def check_scene(value):
    """Return ``value``; raise ``InputError`` unless it is a ``Scene``."""
    if not isinstance(value, Scene):
        raise InputError(f"scene must be a Scene, not {quote(value)}")
    return value


def why_absent(scene, name):
    """Return ": " and why a ``Scene`` has no event along a periodic axis, else "".

    ``name`` is that of an event or of its quantity.
    """
    event = str(name).removesuffix("_area").removesuffix("_time")
    axis = EVENT_AXES.get(event)
    if axis is None or axis not in scene.periodic:
        return ""
    if event not in HOPS:
        return f": the periodic axis {axis} has no walls"
    if scene.discs == 2 or scene.periodic == "xy":
        discs = "two discs" if scene.discs == 2 else "discs on a torus"
        return f": along the periodic axis {axis} {discs} have no order that a hop could change"
    return f": hops along the periodic axis {axis} are those of neighbours, see transmission"


def hopping_along(scene, hop, axis):
    """Return an equivalent ``Scene`` and hop, axes exchanged so that the hop is along ``axis``.

    ``hop`` is a "vertical_hop" (along y) or a "horizontal_hop" (along x). One compiled kernel can
    then simulate both hops. In a field axes cannot be exchanged, and both are returned unchanged.
    """
    if EVENT_AXES[check_choice("hop", hop, HOPS)] == axis or scene.field:
        return scene, hop
    return scene.turned(), next(other for other in HOPS if other != hop)
