"""The histogram of intervals between hops: bins that are joined, and exact densities at zero."""

import numpy as np
from figure_cases import BOXES, PAPER, draw, tables_of

from twodiscs.figures import motion, panels, style


def test_densities_at_zero_are_marked():
    with style.context():
        short = draw("hop_histogram", PAPER, tables_of("paper")).axes[1]
    exact = {
        # 3√2/(16 (h − 2r)), in units of the mean time.
        row["exact_mean"] * 3 * 2**0.5 / (16 * (1 - 2 * row["radius"]))
        for row in tables_of("paper")["hop_histogram"]
    }
    marked = {line.get_ydata()[0] for line in short.lines if not line.get_clip_on()}
    np.testing.assert_allclose(sorted(marked), sorted(exact), rtol=1e-14)


def test_a_curve_ends_before_a_bin_that_holds_too_few():
    rows = [
        {"left": i / 4, "right": (i + 1) / 4, "count": n, "density": 2.0 * n, "stderr": 1.0 * n}
        | {"exact_mean": 0.5}
        for i, n in enumerate([500, 400, 9, 30])
    ]
    for fewest, shown in ((10, 2), (1, 4), (1000, 0)):
        edges, density, errors = motion.curve(rows, fewest)
        assert edges.tolist() == [i / 2 for i in range(shown + 1)]
        assert density.tolist() == [row["count"] for row in rows[:shown]]
        assert errors.tolist() == [row["count"] / 2 for row in rows[:shown]]


def test_a_density_that_bins_are_too_wide_for_is_not_marked():
    rows = [row for row in tables_of("paper")["hop_histogram"] if row["left"] == 0]
    wide = [row | {"right": row["right"] + 0.2 * (i > 0)} for i, row in enumerate(rows)]
    with style.context():
        axes = [motion.draw_hop_histogram(PAPER, r).axes[1] for r in (rows, wide)]
    marked = [sum(not line.get_clip_on() for line in one.lines) for one in axes]
    assert marked[0] > marked[1]


def test_the_radii_of_a_legend_are_written_alike():
    assert panels.numbers([0.1, 0.25]) == ["0.1", "0.25"]
    assert panels.numbers([7.5e-5, 1.25e-4, 1e-3]) == [
        r"7.5\times10^{-5}",
        r"1.25\times10^{-4}",
        "10^{-3}",
    ]
    read = tables_of("tiny")
    with style.context():
        figure = draw("hop_histogram", BOXES["tiny"], read)
    names = [
        text.get_text() for text in figure.axes[0].get_legend().texts if "r=" in text.get_text()
    ]
    assert len(names) > 1
    assert all("10^" in name for name in names)
