"""Captions: plain sentences, some of them with a condition on what the figure shows."""

from collections.abc import Callable
from dataclasses import dataclass

from twodiscs.figures.kit.limits import LARGEST, limits
from twodiscs.model.box import Box


@dataclass(frozen=True)
class Shown:
    """What a figure shows: ``quantities`` of a ``box``, of which its tables have ``rows``.

    ``quantities`` are a set of names as in theory.csv. Each of the three is None where it is not
    known: whatever may be said then is said, but of a plain box where there is none.
    """

    box: Box | None = None
    quantities: frozenset | None = None
    rows: list | None = None

    @property
    def effects(self):
        """What the box calls for: its effects, and ``discs`` where they are more than two."""
        return self.box.calls_for if self.box else {}

    @property
    def lines(self):
        """The names of the radii that vertical lines mark, the largest one left out."""
        pieces = [name.split("=") for _, name in limits(self.box)]
        return {piece for some in pieces for piece in some} - {LARGEST}


def always(shown):
    """Say that the sentence holds for every figure."""
    return True


def both(*conditions):
    """Return the condition that all of the ``conditions`` hold."""
    return lambda shown: all(condition(shown) for condition in conditions)


def plain(shown):
    """Say whether the scene has no effects."""
    return not shown.effects


def other(shown):
    """Say whether the scene has effects, or more discs than two."""
    return not plain(shown)


def of_many(shown):
    """Say whether the scene has more discs than two."""
    return "discs" in shown.effects


def of_two(shown):
    """Say whether the scene has two discs."""
    return not of_many(shown)


def along_ring(shown):
    """Say whether the scene has more discs than two, and the longer side is periodic."""
    box = shown.box
    return of_many(shown) and "periodic" in box.effects and box.width >= box.height


def shown_hop(box):
    """Return the hop that the figure of a trajectory of two discs in a ``Box`` shows.

    It is that along the longer side unless this is periodic.
    """
    periodic = box.effects.get("periodic", "")
    along_x = "y" in periodic or (box.width >= box.height and "x" not in periodic)
    return "horizontal_hop" if along_x else "vertical_hop"


def hops_shown(shown):
    """Say whether the figure of a trajectory of two discs has hops in it."""
    return of_two(shown) and any_row(lambda row: row["event"] == shown_hop(shown.box))(shown)


def cross(shown):
    """Say whether more discs than two pass each other along the longer side."""
    box = shown.box
    hop = "horizontal_hop" if box and box.width >= box.height else "vertical_hop"
    passed = any_row(lambda row: row["event"] == hop)
    return of_many(shown) and not along_ring(shown) and passed(shown)


def with_effects(shown):
    """Say whether the scene has effects, of two discs."""
    return other(shown) and of_two(shown)


def with_effect(name):
    """Return the condition that the scene has the effect ``name``, of two discs."""
    return lambda shown: name in shown.effects and of_two(shown)


def in_plane(shown):
    """Say whether the scene has no third side."""
    return "depth" not in shown.effects


def walled(shown):
    """Say whether the scene has equal discs of the plane, rough or not, between walls."""
    return shown.effects.keys() <= {"moment_of_inertia", "discs"}


def keeps_side(shown):
    """Say whether disc 1 is at last kept to its side of disc 2 where the figure shows wall hits."""
    near = shown.box.scene(shown.box.last_radius * (1 - 1e-9))
    walls = zip(near.confined, ("right_wall_time", "top_wall_time"), strict=True)
    return any(confined and shows(time)(shown) for confined, time in walls)


def shows(*quantities):
    """Return the condition that the figure shows all of these ``quantities``."""
    return lambda shown: shown.quantities is None or shown.quantities.issuperset(quantities)


def shows_any(*quantities):
    """Return the condition that the figure shows any of these ``quantities``."""
    return lambda shown: shown.quantities is None or not shown.quantities.isdisjoint(quantities)


def marked(*names):
    """Return the condition that vertical lines mark the radii with all of these ``names``."""
    return lambda shown: shown.box is None or shown.lines.issuperset(names)


def marked_alone(*names):
    """Return the condition that vertical lines mark these and the largest radius alone."""
    return lambda shown: shown.box is not None and shown.lines == set(names)


def any_row(condition):
    """Return the condition that ``condition`` is true of any row."""
    return lambda shown: shown.rows is None or any(map(condition, shown.rows))


def is_judged(row):
    """Say whether a ``row`` has a residual to be drawn: one that is not certain to be zero."""
    return row.get("z") is not None and row.get("test") != "certain"


def is_unknown(rows):
    """Say whether the ``rows`` have estimates, but no exact value is known of any of them."""
    measured = [row for row in rows if row.get("estimate") is not None]
    return bool(measured) and all(row.get("exact") is None for row in measured)


def known(shown):
    """Say whether there are exact values that the figure can show as curves."""
    return shown.rows is None or not is_unknown(shown.rows)


def longer_than(ratio):
    """Return the condition that the longer side of the box is more than ``ratio`` shorter ones."""

    def holds(shown):
        box = shown.box
        return box is None or max(box.width, box.height) > ratio * min(box.width, box.height)

    return holds


def square(shown):
    """Say whether the box is square, and neither a field nor a periodic axis tells x from y."""
    alike = shown.effects.keys().isdisjoint({"field", "periodic"})
    return alike and not (shown.box and longer_than(1)(shown))


@dataclass(frozen=True)
class Sentence:
    """A sentence of a caption, or several, that are said of what ``holds`` is true of.

    One with a ``mark`` explains a symbol: it is said where that is true of any row, and with a
    condition where the rows are not known.
    """

    text: str
    holds: Callable = always
    mark: Callable | None = None

    def __post_init__(self):
        object.__setattr__(self, "text", " ".join(self.text.split()))

    def is_said(self, shown):
        """Say whether the sentence belongs to the caption of a figure."""
        return self.holds(shown) and (self.mark is None or any_row(self.mark)(shown))

    def said(self, shown):
        """Return the text of a sentence that belongs to the caption of a figure."""
        if self.mark is None or shown.rows is not None:
            return self.text
        return f"If there are any, {self.text[0].lower()}{self.text[1:]}"


def sentences(caption):
    """Return a ``caption``, a text or some texts and ``Sentence``, as a tuple of the latter."""
    parts = (caption,) if isinstance(caption, str) else caption
    return tuple(Sentence(part) if isinstance(part, str) else part for part in parts)


def said(caption, shown):
    """Return the text of the sentences of a ``caption`` that belong to a figure."""
    return " ".join(sentence.said(shown) for sentence in caption if sentence.is_said(shown))
