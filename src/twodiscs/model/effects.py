"""The effects beyond two equal, smooth discs between walls. Each is declared only here.

The fields of ``Scene``, the keys of a configuration, the options of the command line and the labels
of the figures follow from these declarations.
"""

from dataclasses import dataclass

from twodiscs.model.checks import (
    LONGEST_LENGTH,
    SHORTEST_LENGTH,
    InputError,
    check_number,
    is_real,
)
from twodiscs.model.formats import quote


@dataclass(frozen=True)
class Effect:
    """A physical effect: a number, or axes.

    ``default`` is the value that means its absence. ``low`` and ``high`` are the range of every
    other value (None for ``periodic``, whose value is text such as "xy"), and ``unit`` its unit.
    ``meaning`` is its definition, and ``more`` a note for a configuration. ``symbol`` is its text
    in a figure, a format in mathtext for the value. ``of_box`` means that it is a side of the box,
    beside width and height.
    """

    name: str
    default: object
    low: float | None
    high: float | None
    unit: str
    meaning: str
    symbol: str
    more: str = ""
    of_box: bool = False

    @property
    def is_number(self):
        """Whether the value is a number; otherwise it is a text of axes."""
        return self.low is not None

    def checked(self, value):
        """Return ``value``, a number as a float; raise ``InputError`` unless absent or in range.

        For text only the type is checked.
        """
        if not self.is_number:
            if not isinstance(value, str):
                raise InputError(f"{self.name} must be some of the axes, not {quote(value)}")
            return value
        if value is None or (is_real(value) and value == self.default):
            return self.default
        kind = "ratio" if self.name.endswith("_ratio") else "number"
        kind += f", or 0, {self.meaning}" if self.default == 0.0 else ""
        return check_number(self.name, value, self.low, self.high, kind)


EFFECTS = {
    effect.name: effect
    for effect in (
        Effect(
            "depth", None, SHORTEST_LENGTH, LONGEST_LENGTH, "length",
            "the third side of the box; the discs are balls then", "$d={:g}$", of_box=True,
        ),
        Effect(
            "radius_ratio", 1.0, 1e-3, 1e3, "radius of disc 1",
            "the radius of disc 2", "$r_2/r_1={:g}$",
            "Every radius in the configuration is the radius of disc 1.",
        ),
        Effect(
            "mass_ratio", 1.0, 1e-3, 1e3, "mass of disc 1",
            "the mass of disc 2", "$m_2/m_1={:g}$",
        ),
        Effect(
            "periodic", "", None, None, "",
            "the axes without walls, along which the box repeats itself", "${}$ periodic",
            "The momentum along them is conserved, unless rough discs meet walls, and it is zero.",
        ),
        Effect(
            "field", 0.0, SHORTEST_LENGTH, LONGEST_LENGTH, "speed²/length",
            "the uniform acceleration along −y", "$g={:g}$",
            "The total energy of 1/2 includes the potential energy.",
        ),
        Effect(
            "moment_of_inertia", None, 1e-3, 1.0, "m r² of each disc",
            "the moment of inertia of rough discs", "$I/mr^2={:g}$",
            "Collisions with each other and with walls reverse the tangential velocity of their"
            " surfaces too.",
        ),
        Effect(
            "friction", 0.0, SHORTEST_LENGTH, LONGEST_LENGTH, "1/time",
            "the rate of random times at which all velocities are drawn anew", r"$\gamma={:g}$",
            "Energy and conserved momenta stay, and so does every mean time.",
        ),
    )
}  # fmt: skip
