"""Captions: plain sentences, some of them with a condition on what the figure shows."""

from collections.abc import Callable
from dataclasses import dataclass


@dataclass(frozen=True)
class Shown:
    """What a figure shows: a scene with these ``effects`` in a box with these ``sides``.

    Among the effects is ``discs`` where they are more than two.

    ``rows`` are those of its tables, of the quantities that it shows. Sides and rows are None where
    they are not known: whatever may be said then is said.
    """

    effects: tuple = ()
    sides: tuple | None = None
    rows: list | None = None


def always(shown):
    """Say that the sentence holds for every figure."""
    return True


def plain(shown):
    """Say whether the scene has no effects."""
    return not shown.effects


def of_many(shown):
    """Say whether the scene has more discs than two."""
    return "discs" in shown.effects


def on_ring(shown):
    """Say whether the scene has more discs than two, on a ring."""
    return of_many(shown) and "periodic" in shown.effects


def of_two(shown):
    """Say whether the scene has two discs."""
    return not of_many(shown)


def with_effects(shown):
    """Say whether the scene has effects, of two discs."""
    return bool(shown.effects) and not of_many(shown)


def with_effect(name):
    """Return the condition that the scene has the effect ``name``, of two discs."""
    return lambda shown: name in shown.effects and not of_many(shown)


def longer_than(ratio):
    """Return the condition that the longer side of the box is more than ``ratio`` shorter ones."""
    return lambda shown: shown.sides is None or max(shown.sides) > ratio * min(shown.sides)


def plain_square(shown):
    """Say whether the box is square and the scene has no effects."""
    return plain(shown) and (shown.sides is None or max(shown.sides) == min(shown.sides))


@dataclass(frozen=True)
class Sentence:
    """A sentence of a caption, or several, that are said of what ``holds`` is true of.

    One with a ``mark`` explains a symbol: it is said where that is true of any row.
    """

    text: str
    holds: Callable = always
    mark: Callable | None = None

    def __post_init__(self):
        object.__setattr__(self, "text", " ".join(self.text.split()))

    def is_said(self, shown):
        """Say whether the sentence belongs to the caption of a figure."""
        marked = self.mark is None or shown.rows is None or any(map(self.mark, shown.rows))
        return marked and self.holds(shown)


def sentences(caption):
    """Return a ``caption``, a text or some texts and ``Sentence``, as a tuple of the latter."""
    parts = (caption,) if isinstance(caption, str) else caption
    return tuple(Sentence(part) if isinstance(part, str) else part for part in parts)


def said(caption, shown):
    """Return the text of the sentences of a ``caption`` that belong to a figure."""
    return " ".join(sentence.text for sentence in caption if sentence.is_said(shown))
