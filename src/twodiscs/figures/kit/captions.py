"""``Shown``, the questions of captions about a figure, and the sentences of several captions.

The module of a figure has a function ``caption(shown)`` beside ``draw``. It takes a ``Shown`` and
returns plain text; line breaks and indentation in it do not matter.
"""

from dataclasses import dataclass

from twodiscs.figures.kit.limits import (
    ACROSS_X,
    ACROSS_Y,
    HORIZONTAL,
    LARGEST,
    TOP,
    VERTICAL,
    limits,
)
from twodiscs.model.box import Box


@dataclass(frozen=True)
class Shown:
    """The content of a figure: ``quantities`` of a ``box``, from tables with these ``rows``.

    ``quantities`` is a set of names as in theory.csv. Each of the three is None if it is not known:
    every method then returns True, and the box is plain.
    """

    box: Box | None = None
    quantities: frozenset | None = None
    rows: list | None = None

    @property
    def effects(self):
        """The effects of the box, and ``discs`` if they are more than two."""
        return self.box.calls_for if self.box else {}

    @property
    def plain(self):
        """Whether the scene has two discs and no effects."""
        return not self.effects

    @property
    def many(self):
        """Whether the scene has more than two discs."""
        return "discs" in self.effects

    def has(self, effect):
        """Return whether the scene has two discs and this ``effect``."""
        return effect in self.effects and not self.many

    @property
    def square(self):
        """Whether the box is square, and neither a field nor a periodic axis distinguishes x, y."""
        same = self.effects.keys().isdisjoint({"field", "periodic"})
        return same and (self.box is None or not self.is_longer_than(1))

    def is_longer_than(self, ratio):
        """Return whether the longer side of the box is more than ``ratio`` times the shorter."""
        box = self.box
        return box is None or max(box.width, box.height) > ratio * min(box.width, box.height)

    def is_marked(self, *names):
        """Return whether vertical lines mark the radii with all of these ``names``."""
        return self.box is None or self.lines.issuperset(names)

    @property
    def lines(self):
        """The names of the radii that vertical lines mark, except the largest one."""
        pieces = [name.split("=") for _, name in limits(self.box)]
        return {piece for some in pieces for piece in some} - {LARGEST}

    def shows(self, *quantities):
        """Return whether the figure shows all of these ``quantities``."""
        return self.quantities is None or self.quantities.issuperset(quantities)

    def any_row(self, condition):
        """Return whether ``condition`` is true for any row."""
        return self.rows is None or any(map(condition, self.rows))

    def if_any(self, condition, text):
        """Return the ``text`` that explains a symbol if ``condition`` is true for any row.

        If the rows are not known, the text begins with "If there are any".
        """
        if self.rows is None:
            text = " ".join(text.split())
            return f" If there are any, {text[0].lower()}{text[1:]}"
        return f" {text}" if self.any_row(condition) else ""


def is_judged(row):
    """Return whether the residual of a ``row`` is drawn: there is one, and it may differ from 0."""
    return row.get("z") is not None and row.get("test") != "certain"


def is_unknown(rows):
    """Return whether the ``rows`` have estimates, but no exact value is known for any of them."""
    measured = [row for row in rows if row.get("estimate") is not None]
    return bool(measured) and all(row.get("exact") is None for row in measured)


# Symbols ------------------------------------------------------------------------------------------

ERROR_BARS = """
Error bars are one standard error; they are hidden if they are smaller than the symbols.
"""
STRIP = """
Full symbols come from initial states in a strip around the surface of the hop, where the flux is
measured and not the waiting time.
"""


def _in_bursts(row):
    """Return whether no law is known for the counts of a row of mean_times.csv."""
    few = row.get("status") == "too-few"
    return few and "replicas" in row and row["exact"] is not None and row["z"] is None


def symbols(shown, note):
    """Return the text about crosses and arrows in figures of a ``note``, one of ``NOTES``."""
    text = shown.if_any(
        lambda row: row.get("status") == "too-few" and not _in_bursts(row),
        "Crosses are estimates from too few events for an error bar.",
    )
    if note == "simulated":
        text += shown.if_any(
            _in_bursts,
            """
            Crosses are estimates without an error bar: events come in bursts, and the largest burst
            may not have come yet.
            """,
        )
        text += shown.if_any(
            lambda row: row.get("bound") is not None,
            "Arrows start at 95 % lower bounds if no event was counted.",
        )
    return text


# Notes of several figures -------------------------------------------------------------------------


def _lines(shown):
    """Return the text about vertical lines."""
    text = _lines_of_plain(shown) if shown.plain else _other_lines(shown)
    if shown.has("radius_ratio"):
        text += " The radius r is that of disc 1."
    if shown.has("depth"):
        text += " The discs are balls."
    if shown.effects.get("discs", 2) > 3:
        text += " For larger discs no arrangement is known."
    if shown.many and shown.any_row(
        lambda row: row.get("exact") is None and row.get("estimate") is not None
    ):
        text += " If no exact value is known there is no line and no residual."
    return text


def _lines_of_plain(shown):
    if shown.is_marked("h/4", "w/4"):
        return """
        Vertical lines mark h/4 and w/4, where hops become blocked, and the largest radius.
        """
    for name, hops in (("h/4", "horizontal"), ("w/4", "vertical")):
        if shown.is_marked(name):
            return f"""
            Vertical lines mark {name}, where {hops} hops become blocked, and the largest radius.
            """
    return ""


def _other_lines(shown):
    """Return the text about vertical lines in scenes with effects or with more than two discs."""
    if not shown.lines:
        return " The vertical line marks the largest radius, r_max."
    text = " Vertical lines mark the largest radius, r_max, and the radii where something changes."
    meanings = {
        VERTICAL: "Vertical hops end at r_v.",
        HORIZONTAL: "Horizontal hops end at r_h.",
        ACROSS_X: "From r_x on, disc 1 stays on its side of disc 2 along x.",
        ACROSS_Y: "From r_y on, disc 1 stays on its side of disc 2 along y.",
        TOP: "From r_t on, disc 1 has the energy to reach the top wall.",
    }
    for side, axis, place in (("h/2", "x", "above"), ("w/2", "y", "beside")):
        end = f"no ball fits straight {place} the other one"
        if "depth" not in shown.effects:
            end = f"discs do not pass each other along {axis}"
        meanings[side] = f"From σ = r1 + r2 = {side} on, {end}."
    return " ".join([text, *(words for name, words in meanings.items() if name in shown.lines)])


_RESIDUALS = " Residuals z beneath are in standard errors, with guide lines at ±2 and ±5."


def sampled(shown):
    """Return the text of figures of volumes."""
    text = ERROR_BARS + _lines(shown)
    if shown.has("field"):
        text += " In a field volumes and areas are weighted with the invariant density."
    return text + (_RESIDUALS if shown.any_row(is_judged) else "")


def shells(shown):
    """Return the common text of figures of areas."""
    text = sampled(shown)
    if shown.any_row(is_judged):
        text += """
        They are taken from the exact expectation of the shell. Its thickness shifts the estimate
        slightly off the line.
        """
    return text


def simulated(shown):
    """Return the common text of figures of dynamics."""
    text = ERROR_BARS + _lines(shown)
    return text + (_RESIDUALS if shown.any_row(is_judged) else "")


#: The common texts of captions, {name: function of a ``Shown``}.
NOTES = {"sampled": sampled, "shells": shells, "simulated": simulated}
