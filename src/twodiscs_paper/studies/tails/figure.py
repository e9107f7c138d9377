"""How probable long intervals are: tails that fall as t⁻³, and one that seems exponential."""

import numpy as np

from twodiscs.figures import panels
from twodiscs.figures.style import BLACK, BLUE, GREEN, VERMILLION, event_name
from twodiscs_paper.studies.estimates import columns
from twodiscs_paper.study import select

#: Colour and marker of the cases, in the order of the table.
CASE_LOOKS = ((BLUE, "o"), (VERMILLION, "s"), (GREEN, "^"))

#: Counts with a larger relative error than this are not drawn.
SHOWN_TAIL_ERROR = 0.3


def draw(box, tables):
    """Draw the rows of tails.csv, in the ``Box`` of the first scene; they have their own radii."""
    rows = tables["tails"]
    figure, (tails, ratio, exponential) = panels.stacked(tails=1.9, ratio=1.4, exponential=1.7)
    cases = dict.fromkeys((row["event"], row["radius"]) for row in rows)
    for (event, radius), look in zip(cases, CASE_LOOKS, strict=False):
        own = select(rows, event=event, radius=radius)
        if select(own, quantity="rate"):
            _decay(exponential, own, *look)
        elif select(own, method="weighted"):
            _tail(tails, ratio, own, *look)
    times = np.geomspace(0.9, 20)
    tails.plot(times, np.exp(-times), color=BLACK, ls=(0, (4, 2)), label=r"$e^{-t/\tau}$")
    tails.plot([], [], "o", color=BLACK, markersize=1.7, label="plain counts")
    for axes in (tails, ratio):
        axes.set(xscale="log", yscale="log", xlim=(0.9, 1150))
    tails.set(ylim=(1e-11, 1.5), ylabel=r"$P(T>t)$")
    tails.tick_params(labelbottom=False)
    tails.legend(loc="upper right")
    ratio.axhline(1, color=BLACK, lw=0.7)
    ratio.set(ylim=(0.7, 14), xlabel=r"interval $t/\tau$", ylabel=r"$P(T>t)\,t^3/C$")
    ratio.set_yticks([1, 2, 5, 10], ["1", "2", "5", "10"])
    ratio.yaxis.set_minor_formatter("")
    exponential.set(yscale="log", xlim=(0, 10.5), xlabel=r"interval $t/\tau$", ylabel=r"$P(T>t)$")
    exponential.legend(loc="upper right")
    panels.title(tails, "a", box)
    return figure


def _name(row):
    return f"{event_name(row['event'])}, $r={panels.mathtext(row['radius'])}$"


def _values(rows):
    """Return the rows with a small enough error, and arrays of their t/τ, estimate and error."""
    kept = [r for r in rows if r["stderr"] and r["stderr"] < SHOWN_TAIL_ERROR * r["estimate"]]
    time, mean, estimate, error = columns(kept, "time", "exact_mean", "estimate", "stderr")
    return kept, time / mean, estimate, error


def _tail(tails, ratio, rows, colour, marker):
    """Draw weighted estimates (open) and plain counts (full), and the law at long times."""
    for method in ("weighted", "counted"):
        kept, times, values, errors = _values(select(rows, method=method))
        (laws,) = columns(kept, "law")
        style = panels.open_symbol(colour, marker)
        if method == "counted":
            style = panels.open_symbol(colour, marker, 0.45) | {"markerfacecolor": colour}
        name = _name(rows[0]) if method == "weighted" else None
        tails.plot(times, values, ls="", label=name, zorder=3, **style)
        ratio.errorbar(times, values / laws, errors / laws, ls="", elinewidth=0.6, **style)
        if method == "weighted":
            late = times > 4
            tails.plot(times[late], laws[late], color=colour, zorder=2)


def _decay(axes, rows, colour, marker):
    """Draw plain counts, the exponential with the mean τ and the fitted exponential."""
    fit = select(rows, quantity="rate")[0]
    _, times, values, errors = _values(select(rows, quantity="survival"))
    style = panels.open_symbol(colour, marker)
    axes.errorbar(times, values, errors, ls="", label=_name(fit), zorder=3, **style)
    mean = fit["exact_mean"]
    first, last = fit["time"] / mean, fit["until"] / mean
    within = (times > first * 0.999) & (times < last * 1.001)
    rate, error = fit["estimate"] * mean, fit["stderr"] * mean
    digits = max(0, -int(np.floor(np.log10(error))))
    digits_of_rate = f"{rate:.{digits}f}({round(error * 10**digits)})"
    scale = np.exp(np.mean(np.log(values[within]) + rate * times[within]))
    span = np.array([first, last])
    name = rf"fit, rate ${digits_of_rate}/\tau$"
    axes.plot(span, scale * np.exp(-rate * span), color=colour, zorder=2, label=name)
    span = np.array([0, 10.5])
    axes.plot(span, np.exp(-span), color=BLACK, ls=(0, (4, 2)), label=r"$e^{-t/\tau}$")
