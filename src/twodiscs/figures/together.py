"""All events of a result in one panel, in a new figure or in axes of the user."""

from twodiscs.figures.kit import panels
from twodiscs.figures.kit.looks import LOOKS, name_of
from twodiscs.figures.radius.over_radius import over_radius, quantity_of, series_of

#: {figure: (the last word of its quantities, label of the ordinate)}
KINDS = {"mean_times": ("time", r"mean time $\tau$"), "areas": ("area", "area $S$")}


def names_of(figure):
    """Return {quantity: its name in the legend} and {quantity: its look} of one of ``KINDS``."""
    kind = KINDS[figure][0]
    names = {f"{event}_{kind}": name_of(event) for event in LOOKS}
    return names, {f"{event}_{kind}": look for event, look in LOOKS.items()}


def draw(box, tables, figure):
    """Draw all quantities of one of ``KINDS`` in one panel, with the rows of its table."""
    names, looks = names_of(figure)
    return over_radius(box, tables, names, KINDS[figure][1], "best", looks=looks)


def add(axes, box, rows, shown):
    """Draw a set of quantities, ``shown``, into ``axes``, which may have other curves.

    Every call takes unused colours and markers. Names in the legend include the box, because
    ``axes`` may show several.
    """
    texts = {"volume": "volume"} | names_of("mean_times")[0] | names_of("areas")[0]
    quantities = [
        quantity for quantity in texts if quantity in {*map(quantity_of, rows)} & {*shown}
    ]
    before, looks = len(axes.get_legend_handles_labels()[1]), [*LOOKS.values()]
    names = {q: ", ".join([texts[q], *panels.heading(box)]) for q in quantities}
    looks = {q: looks[(before + i) % len(looks)] for i, q in enumerate(quantities)}
    radii, found = series_of(box, rows, names, looks)
    series, ends = [*found.values()], axes.get_ylim()
    panels.draw_series(axes, None, radii, series)
    for part in series:
        axes.plot([], [], label=part.name, **panels.open_symbol(*part.look))
    panels.logarithmic(axes, radii, series)
    if before:
        low, high = zip(ends, axes.get_ylim(), strict=True)
        axes.set_ylim(min(low), max(high))
    else:
        kind = quantities[0].rpartition("_")[2]
        labels = dict(KINDS.values()) | {"volume": "volume $V$"}
        axes.set(xlabel="radius $r$", ylabel=labels[kind])
    axes.legend()
