"""A box, its effects and how many discs it has: a scene without its radius, and its limits."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

from twodiscs.model.checks import SHORTEST, InputError, check_choice, check_length, quote
from twodiscs.model.effects import ABSENT, EFFECTS
from twodiscs.model.events import AXIS, EVENTS, HOPS
from twodiscs.model.scene import USUAL, Scene, check_scene

#: Larger radii than this share of the shortest side tell nothing of a box that smaller ones do not.
TINY = 1e-6


@dataclass(frozen=True)
class Box:
    """A box of ``width`` × ``height`` with ``effects``, {name: value}, in which ``discs`` may move.

    There are two of them unless told, at most 1024. Effects that have the value of their absence
    are left out. Raises ``InputError`` for a side that is no length, for an unknown effect, and for
    effects that do not go together.

    Example:

        td.Box(1.5, 1.0).largest_radius
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
                raise InputError(f"{name:.80} is no effect; effects must be some of {known}")
        checked = {name: EFFECTS[name].checked(value) for name, value in effects.items()}
        named = {name: value for name, value in checked.items() if value != ABSENT[name]}
        object.__setattr__(self, "effects", named)
        if self.calls_for:
            object.__setattr__(self, "effects", dict(sorted(self.tiny.effects.items())))
            object.__setattr__(self, "discs", self.tiny.discs)

    def __hash__(self):
        return hash((self.width, self.height, *self.calls_for.items()))

    def __repr__(self):
        # Streams are seeded by this text: for two discs it does not mention their number.
        more = f", discs={self.discs!r}" if "discs" in self.calls_for else ""
        sides = f"width={self.width!r}, height={self.height!r}"
        return f"Box({sides}, effects={self.effects!r}{more})"

    @classmethod
    def of(cls, scene: Scene) -> Box:
        """Return the box of a ``Scene``; raise ``InputError`` for anything else."""
        check_scene(scene)
        return cls(scene.width, scene.height, scene.effects, scene.discs)

    @classmethod
    def configured(cls, sides, effects, discs=2) -> Box:
        """Return the box of the blocks ``box`` and ``effects`` of a configuration.

        ``sides`` are {"width": …, "height": …} and maybe a depth, which is an effect here; axes may
        be listed. Raises ``InputError`` as the class does.
        """
        named = effects | {"periodic": "".join(sorted(effects.get("periodic", "")))}
        named |= {name: side for name, side in sides.items() if name in EFFECTS}
        return cls(sides["width"], sides["height"], named, discs)

    def parameters(self) -> dict[str, object]:
        """Return {"discs": …, "effects": …, "height": …, "width": …}: plain values.

        ``Box(**parameters)`` is this box again. Absent effects and two discs are left out. So the
        parameters of a job in a plain box, and with them its results, do not know that there is
        anything else.
        """
        box = {"height": self.height, "width": self.width}
        box = {"effects": dict(self.effects)} | box if self.effects else box
        return {"discs": self.discs} | box if "discs" in self.calls_for else box

    @property
    def calls_for(self):
        """Everything beyond a plain box, {name: value}, as ``Scene.calls_for``."""
        return self.effects | ({"discs": self.discs} if self.discs != USUAL["discs"] else {})

    @property
    def family(self):
        """The family of its scenes, as ``Scene.family``."""
        return self.tiny.family

    @property
    def is_plain(self):
        """Whether it is a box of two equal, smooth discs between walls."""
        return not self.calls_for

    def scene(self, radius: float) -> Scene:
        """Return the ``Scene`` at a ``radius``; raise ``InputError`` where there is none."""
        return Scene(self.width, self.height, radius, **self.effects, discs=self.discs)

    def fits(self, radius: float) -> bool:
        """Say whether there is a scene at this ``radius``, a length."""
        radius = check_length("radius", radius)
        try:
            self.scene(radius)
        except InputError:
            return False
        return True

    @cached_property
    def tiny(self) -> Scene:
        """A scene of tiny discs: what does not depend on the radius can be asked of it."""
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
        """Return the box with x and y exchanged; raise ``InputError`` in a field along y."""
        return Box.of(self.tiny.turned())

    @cached_property
    def largest_radius(self) -> float:
        """The radius at which the discs have no room left; a field may stop them before."""
        return self.tiny.largest_radius

    @cached_property
    def last_radius(self) -> float:
        """The radius from which on there is no scene: ``largest_radius``, or less in a field."""
        return self.end(lambda scene: True) if self.effects else self.largest_radius

    def end(self, holds):
        """Return the radius from which on there is no scene, or ``holds`` is no longer true of it.

        ``holds`` says something of a ``Scene`` that is true of small discs and false of larger
        ones. By bisection, to the last digit; below 2⁻⁶⁰ of the shorter side nothing is found.
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
        """Return the radius from which on ``event`` is impossible; None if it always is.

        For hops of equal discs that is w/4 (vertical) or h/4 (horizontal), unless the discs jam
        before; for what stays possible to the end it is the last radius.
        """
        if check_choice("event", event, EVENTS) not in HOPS:
            # In a field it may take a large disc to touch the top.
            nearly = self.scene(self.last_radius * (1 - TINY))
            return self.last_radius if nearly.is_possible(event) else None
        if not self.is_plain:
            has_place = event in self.tiny.events
            return self.end(lambda scene: scene.is_possible(event)) if has_place else None
        return min(self.blocking_radius(event), self.largest_radius)

    def blocking_radius(self, hop):
        """Return w/4 or h/4, where ``hop`` is blocked if the discs of a plain box fit that far.

        Discs that pass each other on y1 = y2 are side by side along x, and need four radii there.
        """
        return (self.width if AXIS[hop] == "y" else self.height) / 4

    @cached_property
    def thresholds(self) -> tuple[float, ...]:
        """The radii below the last one at which a hop becomes blocked, ascending, without repeats.

        Those of h/4 and w/4 that fit, where there are no effects.
        """
        limits = {self.threshold(hop) for hop in HOPS if hop in self.tiny.events}
        return tuple(sorted(radius for radius in limits if radius < self.last_radius))
