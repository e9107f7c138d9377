"""Passages with friction: one function of a scaled friction, between two exponents."""

import numpy as np

from twodiscs.figures import drawing, panels
from twodiscs.figures.style import BLACK, GREY, SERIES
from twodiscs_paper.studies.estimates import columns
from twodiscs_paper.studies.passages.figure import at_places, first_scene, points
from twodiscs_paper.studies.passages.parts.with_friction import (
    NECK_HALVINGS,
    row_scene,
    scaled_friction,
    scaling_law,
)
from twodiscs_paper.study import select

#: The scaled friction that is shown.
FRICTION_RANGE = (0.015, 45)

#: The law with the exact slope at 0.
FORMULA = r"$1/\kappa=4x/3+1/(1+bx+cx^2)$"

#: κ x for large x and smooth discs between walls, see docs/passages.md.
FRICTION_LIMIT = 3 / 4


def draw(box, tables):
    """Draw the rows of passages.csv with friction, and those of a long run, the ``kept`` ones."""
    kept = tables["kept"]
    rows = at_places(tables["passages"], kept, False)
    rows = [row for row in rows if row["friction"] is not None]
    figure, (upper, lower) = panels.stacked(kappa=2.3, exponent=1.8)
    # A box without horizontal hops that end has no rows.
    panels.title(upper, "a", first_scene([*rows, *kept], box)[0])
    # {rate of kicks: colour, marker}.
    for friction, look in dict(zip(NECK_HALVINGS, SERIES, strict=True)).items():
        for some, filled in ((rows, False), (kept, True)):
            own = select(some, friction=friction, quantity="coefficient")
            if own:
                value, error = columns(own, "estimate", "stderr")
                is_named = filled and select(rows, friction=friction, quantity="coefficient")
                name = None if is_named else rf"$\gamma={friction:g}$"
                points(upper, scaled(own), value, error, look, name, filled)
            # An exponent belongs between its two distances.
            steps = select(some, friction=friction, quantity="local_exponent")
            before = [_before(row, own) for row in steps]
            if steps:
                value, error = columns(steps, "estimate", "stderr")
                points(
                    lower, np.sqrt(scaled(steps) * scaled(before)), value, error, look, None, filled
                )
    limit = columns(select(kept, method="limit", quantity="coefficient"), "friction", "estimate")
    upper.plot(*limit, "x", color=BLACK, markersize=4, label="limit of a narrow neck", zorder=6)
    x = np.geomspace(*FRICTION_RANGE, 60)
    upper.plot(x, scaling_law(x), color=BLACK, lw=0.8, label=FORMULA, zorder=5)
    style = {"color": BLACK, "lw": 0.8, "ls": (0, (4, 2)), "zorder": 5}
    upper.plot(FRICTION_RANGE, np.ones(2), **style)
    large = np.array([FRICTION_LIMIT, FRICTION_RANGE[1]])
    upper.plot(large, FRICTION_LIMIT / large, label=r"$1$ and $3/(4x)$", **style)
    for exponent, name, side in (
        (-1.5, "$-3/2$  long necks", "left"),
        (-2.0, "$-2$  short necks", "right"),
    ):
        lower.axhline(exponent, color=GREY, lw=0.8, ls=(0, (4, 2)), zorder=1)
        at, offset = (FRICTION_RANGE[0], 3) if side == "left" else (FRICTION_RANGE[1], -3)
        drawing.label(lower, name, (at, exponent), (offset, 5), ha=side, color=GREY)
    upper.set(xscale="log", yscale="log", xlim=FRICTION_RANGE, ylim=(0.012, 1.3))
    upper.set_ylabel(r"transmission $\kappa$")
    upper.tick_params(which="both", labelbottom=False)
    lower.set(xscale="log", xlim=FRICTION_RANGE, ylim=(-2.15, -1.15))
    lower.set_xlabel(r"scaled friction $x=\gamma\sqrt{\varepsilon\sigma}$")
    lower.set_ylabel(r"exponent of $\tau/\kappa$")
    lower.xaxis.set_major_formatter("{x:g}")
    upper.yaxis.set_major_formatter("{x:g}")
    upper.legend(loc="lower left")
    return figure


def scaled(rows):
    """Return γ√(εσ) of each row, as an array."""
    return np.array([scaled_friction(row_scene(row), row["event"]) for row in rows])


def _before(row, coefficients):
    """Return the row of κ at the next larger distance than that of a ``row``."""
    return min(
        (one for one in coefficients if one["distance"] > row["distance"]),
        key=lambda one: one["distance"],
    )
