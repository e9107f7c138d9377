"""The study of more discs: methods against each other.

Without these tests methods for more discs could disagree, or have the errors of others.
"""

import math
import re

import numpy as np
import pytest
from factory import of

from twodiscs.model.scene import Scene
from twodiscs.theory import exact
from twodiscs_paper.studies.more_discs import measure, tori
from twodiscs_paper.studies.more_discs.study import MoreDiscsTable


@pytest.fixture(scope="module")
def rows(tmp_path_factory):
    path = tmp_path_factory.mktemp("more") / "more_discs.csv"
    scenes = {"discs": (2, 3, 4), "radii": (0.1, 0.28), "on_tori": ((3, 0.3),)}
    MoreDiscsTable.write(path, measure.rows(events=300_000, samples=60_000, seed=1, **scenes))
    return MoreDiscsTable.read(path)


@pytest.mark.parametrize("aspect", tori.ASPECTS)
def test_a_torus_has_the_aspect_that_its_name_says(aspect):
    """Its discs have the diameter 1 and fill a fraction of the area."""
    scene = tori.torus(12, 0.5, aspect)
    width, height = re.sub(r"(\d)sqrt", r"\1*sqrt", aspect).split(":")
    assert scene.width / scene.height == pytest.approx(eval(width) / eval(height, vars(math)))
    assert scene.radius == 0.5
    assert scene.width * scene.height == pytest.approx(12 * math.pi / 4 / 0.5)


def test_errors_of_rates_are_those_of_the_replicas(monkeypatch):
    """Rates per time, and the virial sum with the covariances of its events."""
    scene, replicas, duration = Scene(2.25, 1.0, 0.1, discs=3), 500, 4.0
    classes = len(measure.CLASSES)
    counts = np.random.default_rng(1).poisson(20, (replicas, 1)) + np.arange(classes)
    counts += np.random.default_rng(2).poisson(9, counts.shape)
    sums, products = counts.sum(axis=0), np.triu(counts.T @ counts)
    monkeypatch.setattr(measure, "counted", lambda *_: (sums, products, replicas, duration))
    rates, errors, error = measure.dynamics_rates(scene, 1, 1)
    assert [*rates.values()] == pytest.approx(counts.mean(axis=0) / duration)
    root = math.sqrt(replicas) * duration
    assert [*errors.values()] == pytest.approx(counts.std(axis=0) / root)
    weights = [measure.virial_weights(scene).get(event, 0.0) for event in measure.CLASSES]
    assert error == pytest.approx((counts @ weights).std() / root)


def test_scores_are_deviations_over_the_errors_of_both(rows):
    """Dynamics is compared with the exact value, or with Monte Carlo if there is none."""
    events = [row for row in rows if row["z"] is not None]
    assert len({row["exact"] is None for row in events}) == 2
    for row in events:
        known = row["exact"] is not None
        due = row["exact"] if known else row["monte_carlo"]
        error = math.hypot(row["dynamics_stderr"], 0 if known else row["monte_carlo_stderr"])
        assert row["z"] == pytest.approx((row["dynamics"] - due) / error, rel=1e-9)
        assert abs(row["z"]) < 5
        assert row["dynamics_stderr"] < 0.1 * row["dynamics"]
        if row["monte_carlo_z"] is not None:
            due = (row["monte_carlo"] - row["exact"]) / row["monte_carlo_stderr"]
            assert row["monte_carlo_z"] == pytest.approx(due, rel=1e-9)
            assert row["monte_carlo_stderr"] < 0.1 * row["monte_carlo"]


@pytest.mark.parametrize(("discs", "share"), [(3, 1), (16, 1 / 8)])
def test_rates_are_from_the_events_that_were_asked_for(discs, share):
    """Whole blocks of few discs, and an eighth of many, whose rate is a guess."""
    sums, *_ = measure.counted(Scene(0.75 * discs, 1.0, 0.1, discs=discs), 10**6, 1)
    assert share * 0.5 < measure.class_counts.simulated_events(sums) / 10**6 < share * 1.5


@pytest.mark.parametrize("discs", [2, 3])
def test_exact_times_are_those_of_theory_at_the_energy_of_two_discs(discs, rows):
    scene = Scene(0.75 * discs, 1.0, 0.1, discs=discs)
    times = exact.mean_times(scene)
    known = {
        row["event"]: row["exact"] for row in of(rows, discs=discs, radius=0.1) if row["exact"]
    }
    assert len(known) > 4
    for event, time in known.items():
        due = 1.0 if event == "virial" else times[event] / math.sqrt(discs / 2)
        assert time == pytest.approx(due, rel=1e-12)


def test_no_exact_value_is_not_impossible(rows):
    """Four discs that pass each other have a time, but no exact one; in a channel there is none."""
    at = {(row["discs"], row["radius"], row["event"]): row for row in rows}
    four = at[4, 0.1, "horizontal_hop"]
    assert (four["theory"], four["exact"]) == ("none", None)
    assert four["dynamics"] > 0
    blocked = at[4, 0.28, "horizontal_hop"]
    assert blocked["theory"] == "channel"
    assert blocked["exact"] is blocked["dynamics"] is blocked["monte_carlo"] is None
