"""The histogram of intervals between hops: bins that are joined, and exact densities at zero."""

import numpy as np
from figure_cases import PAPER, draw, tables_of

from twodiscs.figures import hop_histogram
from twodiscs.figures.kit import style


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


def test_joined_bins_hold_what_they_should():
    rows = [
        {"left": i / 4, "right": (i + 1) / 4, "count": n, "intervals": 2000}
        for i, n in enumerate([500, 400, 300, 200, 100, 60, 30, 20, 4, 3, 9, 9])
    ]
    edges, density, errors = hop_histogram.joined(rows, 0, 1)
    assert edges.tolist() == [i / 4 for i in range(13)]
    np.testing.assert_allclose(density * 2000 / 4, [r["count"] for r in rows], rtol=1e-14)
    np.testing.assert_allclose(errors[0] * 2000 / 4, (500 * 0.75) ** 0.5, rtol=1e-14)
    edges, density, _ = hop_histogram.joined(rows, 0.3, 20)
    assert edges.tolist() == [0, 0.25, 0.5, 0.75, 1, 1.5, 2]
    counts = density * 2000 * np.diff(edges)
    np.testing.assert_allclose(counts, [500, 400, 300, 200, 160, 50], rtol=1e-14)
