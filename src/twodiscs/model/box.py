"""A box, its effects and its number of discs: a scene without a radius, and its limits.

Radii have text keys, and the key of a radius is a part of the seed of its random streams. This
module imports only the standard library, because the Snakefile reads it.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from hashlib import blake2b

from twodiscs.model.checks import (
    SHORTEST,
    InputError,
    check_choice,
    check_integer,
    check_length,
    checked_call,
    did_you_mean,
    quote,
)
from twodiscs.model.effects import ABSENT, EFFECTS
from twodiscs.model.events import AXIS, EVENTS, HOPS
from twodiscs.model.scene import USUAL, Scene, check_scene

#: A radius over the shortest side at which all discs are small.
TINY = 1e-6

#: The methods with random numbers, each with separate streams.
METHODS = (
    "monte_carlo", "dynamics", "intervals", "trajectory", "unmet", "strip", "passages",
    "observe",
)  # fmt: skip


@checked_call
@dataclass(frozen=True)
class Box:
    """A box with its effects and its number of discs, for any radius.

    Parameters
    ----------
    width, height : float
        Sides of the box, in length, from 1e-60 to 1e60.
    effects : dict, optional
        {name: value} of the effects of ``Scene``. Effects with the value of their absence are left
        out.
    discs : int, default 2
        The number of discs, from 2 to 1024.

    Raises
    ------
    InputError
        For a side that is no length, for an unknown effect, and for effects that cannot be
        combined.

    Examples
    --------
    >>> round(td.Box(1.5, 1.0).largest_radius, 12)
    0.383974596216
    """

    width: float
    height: float
    effects: dict[str, object] = field(default_factory=dict)
    discs: int = 2

    def __post_init__(self):
        for name in ("width", "height"):
            object.__setattr__(self, name, check_length(name, getattr(self, name)))
        effects = self.effects
        known = ", ".join(EFFECTS)
        if not isinstance(effects, dict):
            raise InputError(f"effects must be a dict of some of {known}, not {quote(effects)}")
        for name in effects:
            if name not in EFFECTS:
                name = name if isinstance(name, str) else quote(name)
                hint = did_you_mean(name, EFFECTS)
                raise InputError(f"{name:.80} is no effect; effects must be some of {known}{hint}")
        checked = {name: EFFECTS[name].checked(value) for name, value in effects.items()}
        named = {name: value for name, value in checked.items() if value != ABSENT[name]}
        object.__setattr__(self, "effects", named)
        if self.calls_for:
            object.__setattr__(self, "effects", dict(sorted(self.tiny.effects.items())))
            object.__setattr__(self, "discs", self.tiny.discs)

    def __hash__(self):
        return hash((self.width, self.height, *self.calls_for.items()))

    def __repr__(self):
        # This text seeds streams: for two discs it does not have their number.
        named = {"width": self.width, "height": self.height, "effects": self.effects} | self._many
        return f"Box({', '.join(f'{name}={value!r}' for name, value in named.items())})"

    @classmethod
    def of(cls, scene: Scene) -> Box:
        """Return the box of a scene.

        Parameters
        ----------
        scene : Scene
            A scene at any radius.

        Returns
        -------
        Box
            Its box, with the same effects and discs.

        Raises
        ------
        InputError
            For anything but a ``Scene``.
        """
        check_scene(scene)
        return cls(scene.width, scene.height, scene.effects, scene.discs)

    @classmethod
    def configured(cls, sides, effects, discs=2) -> Box:
        """Return the box of the blocks ``box`` and ``effects`` of a configuration.

        Parameters
        ----------
        sides : dict
            {"width": …, "height": …} and maybe a depth, which is an effect here.
        effects : dict
            {name: value}; axes may be a list.
        discs : int, default 2
            The number of discs.

        Returns
        -------
        Box
            The box.

        Raises
        ------
        InputError
            As from the class.
        """
        named = effects | {"periodic": "".join(sorted(effects.get("periodic", "")))}
        named |= {name: side for name, side in sides.items() if name in EFFECTS}
        return cls(sides["width"], sides["height"], named, discs)

    def parameters(self) -> dict[str, object]:
        """Return the box as plain values, from which ``Box(**parameters)`` makes it again.

        Absent effects and two discs are left out. The parameters of a job in a plain box, and its
        results, then do not change if effects are added to the package.

        Returns
        -------
        dict
            {"discs": …, "effects": …, "height": …, "width": …}.

        Examples
        --------
        >>> td.Box(1.5, 1.0).parameters()
        {'height': 1.0, 'width': 1.5}
        """
        box = {"height": self.height, "width": self.width}
        box = {"effects": dict(self.effects)} | box if self.effects else box
        return self._many | box

    @property
    def calls_for(self):
        """Everything beyond a plain box, {name: value}, as ``Scene.calls_for``."""
        return self.effects | self._many

    @property
    def _many(self):
        """The number of discs, {"discs": …}, if there are more than two."""
        return {"discs": self.discs} if self.discs != USUAL["discs"] else {}

    @property
    def family(self):
        """The family of its scenes, as ``Scene.family``."""
        return self.tiny.family

    @property
    def is_plain(self):
        """Whether it is a box of two equal, smooth discs between walls."""
        return not self.calls_for

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
        return Scene(self.width, self.height, radius, **self.effects, discs=self.discs)

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
    def tiny(self) -> Scene:
        """A scene of tiny discs, for properties that do not depend on the radius."""
        radius = TINY * self.shortest / max(1.0, self.effects.get("radius_ratio", 1.0))
        return self.scene(max(radius, SHORTEST))

    @property
    def sides(self) -> tuple[float, ...]:
        """The sides of the box: width, height and maybe depth."""
        return self.width, self.height, *(self.effects[n] for n in ("depth",) if n in self.effects)

    @property
    def shortest(self) -> float:
        """The shortest side."""
        return min(self.sides)

    def turned(self) -> Box:
        """Return the box with x and y exchanged.

        Returns
        -------
        Box
            The box, turned by a quarter.

        Raises
        ------
        InputError
            In a field, which is along y.

        Examples
        --------
        >>> td.Box(1.5, 1.0).turned().parameters()
        {'height': 1.5, 'width': 1.0}
        """
        return Box.of(self.tiny.turned())

    @cached_property
    def largest_radius(self) -> float:
        """The radius at which the discs just fit; a field may stop their motion before."""
        return self.tiny.largest_radius

    @cached_property
    def last_radius(self) -> float:
        """The radius from which on there is no scene: ``largest_radius``, or less in a field."""
        return self.end(lambda scene: True) if self.effects else self.largest_radius

    def end(self, holds):
        """Return the radius from which on there is no scene, or ``holds(scene)`` is false.

        ``holds`` is true for small discs and false for larger ones. The radius is found by
        bisection, to the last digit, if it is above 2⁻⁶⁰ of the shorter side.
        """
        low, high = 0.0, min(self.sides) / 2
        for _ in range(60):
            middle = (low + high) / 2
            try:
                fits = holds(self.scene(middle))
            except InputError:
                fits = False
            low, high = (middle, high) if fits else (low, middle)
        return high

    def threshold(self, event: str) -> float | None:
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
            nearly = self.scene(self.last_radius * (1 - TINY))
            return self.last_radius if nearly.is_possible(event) else None
        if not self.is_plain:
            has_place = event in self.tiny.events
            return self.end(lambda scene: scene.is_possible(event)) if has_place else None
        return min(self.blocking_radius(event), self.largest_radius)

    def blocking_radius(self, hop):
        """Return w/4 or h/4, at which ``hop`` becomes blocked in a plain box if the discs fit.

        Discs that pass each other on y1 = y2 are side by side along x, and need four radii there.
        """
        return (self.width if AXIS[hop] == "y" else self.height) / 4

    @cached_property
    def thresholds(self) -> tuple[float, ...]:
        """The radii below the last one at which a hop becomes blocked, ascending, without repeats.

        Without effects they are h/4 and w/4, if discs of these radii fit.
        """
        limits = {self.threshold(hop) for hop in HOPS if hop in self.tiny.events}
        return tuple(sorted(radius for radius in limits if radius < self.last_radius))


def parameters_of(scene):
    """Return the parameters of a ``Scene`` as plain values, from which ``scene_of`` makes it."""
    return Box.of(scene).parameters() | {"radius": scene.radius}


def scene_of(parameters):
    """Return the ``Scene`` of its ``parameters``."""
    box = {name: value for name, value in parameters.items() if name != "radius"}
    return Box(**box).scene(parameters["radius"])


# Keys and seeds ----------------------------------------------------------------------------------


def key(radius):
    """Return the text that names ``radius`` in file names and seeds: its shortest repr."""
    return repr(check_length("radius", radius))


def shortest_decimal(value, distance, avoid=()):
    """Return the number of fewest digits within ``distance`` of ``value`` and not in ``avoid``."""
    candidates = (float(f"{value:.{digits}g}") for digits in range(1, 18))
    return next(c for c in candidates if abs(c - value) <= distance and c not in avoid)


def stream_seed(seed, scene, method, key):
    """Return the integer in [0, 2**63) that seeds the streams of one job.

    It depends on the configured ``seed``, the name of the scene, the method (one of ``METHODS``)
    and the key of the radius. It does not depend on the order of a list or on other jobs.
    """
    seed = check_integer("seed", seed, 0)
    text = "\n".join((str(seed), scene, check_choice("method", method, METHODS), key))
    return int.from_bytes(blake2b(text.encode(), digest_size=8).digest(), "big") >> 1


def stream_name(scene, name):
    """Return the name of a scene in its seeds: the parameters of its box if ``name`` is None."""
    check_scene(scene)
    if name is None:
        return repr(Box.of(scene).parameters())
    if not isinstance(name, str):
        raise InputError(f"name must be the name of a scene, not {quote(name)}")
    return name


def job_seed(scene, method, seed, name):
    """Return the seed of the random streams of one job; the arguments are those of the face."""
    return stream_seed(seed, stream_name(scene, name), method, key(scene.radius))
