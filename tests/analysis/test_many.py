"""Tables and the check of more than two discs.

Without it a disc could be lost on its way to the rows, or two programs differ.
"""

from dataclasses import replace

import numpy as np
import pytest
import scalar_many
from marks import slow

import twodiscs as td
from twodiscs.analysis.tables import CheckTable
from twodiscs.dynamics import runs
from twodiscs.dynamics.many import many_rates
from twodiscs.sampling import initial_states, montecarlo
from twodiscs.sampling.many import insertions
from twodiscs.theory.flux import rates

#: With an exact value, and without; between walls, and on a ring.
SCENES = {
    "three": td.Scene(1.5, 1.0, 0.15, discs=3),
    "three, dense": td.Scene(1.5, 1.0, 0.26, discs=3),
    "eight in a channel": td.Scene(3.5, 0.6, 0.18, discs=8),
    "four, upright": td.Scene(0.6, 2.0, 0.18, discs=4),
    "four": td.Scene(1.5, 1.0, 0.12, discs=4),
    "four on a ring": td.Scene(1.5, 1.0, 0.15, periodic="x", discs=4),
    "three on a torus": td.Scene(1.5, 1.0, 0.22, periodic="xy", discs=3),
}

KNOWN = ("three on a torus", "three", "three, dense", "eight in a channel", "four, upright")


#: Those whose rows are of another kind: exact, not known, on a ring, in a channel.
QUICK = ("three", "four", "four on a ring", "eight in a channel")


@pytest.mark.parametrize("name", [n if n in QUICK else slow(n) for n in SCENES])
def test_the_check_fails_if_a_rate_is_wrong_and_else_it_does_not(name):
    """With a tenth of the events missing, the virial theorem and the flux fail."""
    scene = SCENES[name]
    quantities = ["volume", *(f"{event}_area" for event in scene.events)]
    counted = runs.DynamicsRun(scene, dict.fromkeys(scene.events, 5e-3), 5 * 10**6, 3).run()
    inserted = montecarlo.MonteCarloRun(scene, quantities, 100_000, 0.02, 4).run()
    rows = CheckTable.rows([counted, inserted])
    assert [row for row in rows if row["passed"] is False] == []
    compared = {(row["comparison"], row["quantity"]) for row in rows if row["z"] is not None}
    assert (("sum_rule", "mean_times") in compared) == (not scene.periodic)
    for event in scene.events:
        kind = "mean_time" if name in KNOWN or not scene.is_possible(event) else "flux"
        assert (kind, f"{event}_time") in compared
    for row in rows:
        if row["comparison"] == "volume":
            assert (row["exact"] is None) == (name not in KNOWN)
    assert any(kind == "flux" for kind, _ in compared) == (name not in KNOWN)
    rows = CheckTable.rows([replace(counted, duration=1.1 * counted.duration), inserted])
    failed = {row["comparison"] for row in rows if row["passed"] is False}
    assert failed >= {kind for kind, _ in compared if kind in ("sum_rule", "flux", "mean_time")}


@pytest.mark.parametrize("periodic", ["", "x"])
def test_an_equation_of_state_gives_the_rates_of_twenty_discs_within_ten_per_cent(periodic):
    scene = td.Scene(6.0, 4.0, 0.2, discs=20, periodic=periodic)
    due = rates(scene, insertions.sample(scene, 2**16, 1)[0])
    due["any_wall"] = due["right_wall"] + due["top_wall"]
    expected = many_rates.expected_rates(scene)
    for event in due.keys() & scene.events:
        assert expected[event] == pytest.approx(due[event], rel=0.1), event


# A trajectory -----------------------------------------------------------------------------------


@pytest.mark.parametrize("name", SCENES)
def test_a_trajectory_is_that_of_another_program(name):
    """From the same state, for some sixteen events, in which roundings of 1e-16 stay small."""
    scene = SCENES[name]
    n, (box, _) = scene.discs, scalar_many.constants(scene)
    duration = many_rates.expected_duration(scene, 16)
    for state in initial_states.states(scene, 20, 11).T:
        frame = td.trajectory(scene, start=state, duration=1.1 * duration)
        parts = [np.array(part) for part in state.reshape(4, n)]
        scalar_many.run.py_func(*parts, box, 1, duration, np.zeros(n), 0.0)
        at_end = frame.states_at(1.1 * duration)[0]
        for row, part in zip("xyuv", parts, strict=True):
            found = np.array([at_end[f"{row}{disc}"] for disc in range(1, n + 1)])
            if row in scene.periodic:
                found = found - scene.side(row) * np.round((found - part) / scene.side(row))
            assert found == pytest.approx(part, abs=1e-6)


# Intervals -------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["three", "four"])
def test_the_mean_interval_is_compared_where_it_is_known(name):
    """A result goes on to more intervals, and its density at 0 is that of its first two bins."""
    scene, hop = SCENES[name], "vertical_hop"
    found = td.intervals(scene, hop, 1e5, seed=2, name=name)
    assert found.intervals == sum(found.counts) + found.overflow >= 10**5
    first, second = found.density[:2]
    assert found.at_zero.value == pytest.approx((3 * first - second) / 2, rel=1e-12)
    assert found.more(3e5).rows == td.intervals(scene, hop, 3e5, seed=2, name=name).rows
    point = runs.IntervalsRun(scene, hop, 10**5, 6).run()
    (row,) = (row for row in CheckTable.rows([point]) if row["comparison"] == "hop_interval")
    if name in KNOWN:
        assert row["passed"] is row["independent"] is True
    else:
        assert (row["status"], row["z"], row["passed"]) == ("counted", None, None)
