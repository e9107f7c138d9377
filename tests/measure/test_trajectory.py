"""A trajectory as a table, and as a file for other programs.

Without it another program could read other positions, cells or masses.
"""

import tracemalloc

import numpy as np
import pandas as pd
import pytest
from effect_scenes import SCENES

import twodiscs as td

KINDS = {"three": td.Scene(1.5, 1.0, 0.15, discs=3)}
KINDS |= {name: SCENES[name] for name in ("larger", "combination")}


@pytest.fixture(scope="module", params=KINDS)
def path(request):
    return td.trajectory(KINDS[request.param], 6, seed=2)


def test_positions_and_velocities_are_arrays(path):
    scene, times = path.scene, [0.3, 4.0, 1.5]
    shape = (scene.discs, len(scene.axes))
    assert path.positions().shape == (len(path), *shape)
    assert path.velocities(times).shape == path.positions(times).shape == (3, *shape)
    states = path.states_at(times)
    assert [*path.positions(times)[:, 1, 0]] == [*states["x2"]]
    assert [*path.velocities(times)[:, 0, 1]] == [*states["v1"]]
    assert [*path.positions()[:, 0, 1]] == [*path["y1"]]
    # Velocities are derivatives; in a field of order one, halves of steps squared are below 1e-6.
    step = 1e-4
    moved = (path.positions([1 + step]) - path.positions([1.0])) / step
    if not ((path["time"] > 1) & (path["time"] < 1 + step)).any():
        assert np.allclose(moved, path.velocities([1.0]), atol=1e-3)
    with pytest.raises(td.InputError, match="must have all of its columns, but has no x1"):
        path[["time", "event"]].positions()


def test_hops_can_be_left_out(path, monkeypatch):
    """And columns may be put in order row by row."""
    monkeypatch.setattr("twodiscs.measure.trajectory.CHUNK_NUMBERS", 1)
    bare = td.trajectory(path.scene, 6, seed=2, hops=False)
    kept = path[~path["event"].str.endswith("_hop")].reset_index(drop=True)
    pd.testing.assert_frame_equal(pd.DataFrame(bare), pd.DataFrame(kept))


def test_memory_holds_two_tables():
    scene = td.Scene(1.5, 1.0, 0.2)
    td.trajectory(scene, 1)  # kernels take memory of their own when they are compiled
    tracemalloc.start()
    table = td.trajectory(scene, 1e5)
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert peak < 2.1 * table.memory_usage().sum()


def test_ase_reads_it(path, tmp_path):
    ase = pytest.importorskip("ase.io", reason="ASE comes with requirements.lock")
    path.to_xyz(tmp_path / "a.xyz", [0.0, 2.5])
    first, second = ase.read(tmp_path / "a.xyz", ":", format="extxyz")
    scene, axes, n = path.scene, len(path.scene.axes), path.scene.discs
    corner = np.array([scene.side(axis) / 2 for axis in scene.axes])
    assert np.allclose(second.positions[:, :axes] - corner, path.positions([2.5])[0], atol=1e-15)
    assert np.allclose(first.get_velocities()[:, :axes], path.velocities([0.0])[0], atol=1e-15)
    assert (second.positions[:, axes:] == max(scene.radii)).all()  # in the middle of the lattice
    assert [*first.arrays["id"]] == [*range(1, n + 1)]
    sides = [scene.side(axis) for axis in scene.axes]
    assert [*first.cell.lengths()] == [*sides, 2 * max(scene.radii)][:3]
    assert [*first.pbc] == [axis in scene.periodic for axis in "xyz"]
    assert (*first.get_masses(),) == (scene.masses if scene.discs == 2 else (1.0,) * 3)
    for name in ("all.xyz.gz", "again.xyz.gz"):
        path.to_xyz(tmp_path / name)
    assert (tmp_path / "all.xyz.gz").read_bytes() == (tmp_path / "again.xyz.gz").read_bytes()
    frames = ase.read(tmp_path / "all.xyz.gz", ":", format="extxyz")
    assert [frame.info["Time"] for frame in frames] == [*path["time"]]
    assert first.get_kinetic_energy() == pytest.approx(0.5) or scene.field
    assert second.info["Time"] == 2.5
    # A path goes on from the last frame, or from the same arrays with any energy.
    faster = 1 if scene.field else 3
    arrays = second.positions[:, :axes], faster * second.get_velocities()[:, :axes]
    del second.arrays["id"]
    ase.write(tmp_path / "b.xyz.gz", second, format="extxyz")  # to eight digits
    rounded = (tmp_path / "b.xyz.gz").rename(tmp_path / "B.XYZ.GZ")
    # Nor do the order of the lines, of numbered discs, and empty lines matter; without masses here.
    lines = (tmp_path / "a.xyz").read_text().replace(":masses:", ":other:").splitlines()
    frame = ["", *lines[-n - 2 : -n], *lines[1 - n :], lines[-n]]
    (tmp_path / "c.xyz").write_text("\n".join([*lines[: -n - 2], *frame]))
    for start in (tmp_path / "a.xyz", tmp_path / "c.xyz", arrays, *[rounded] * (not scene.field)):
        (state,) = td.trajectory(scene, 1, start=start).states_at(0.0)
        assert np.allclose([*state], [*path.states_at(2.5)[0]], atol=1e-15)


def test_a_file_has_the_spins_of_rough_discs(tmp_path):
    path = td.trajectory(SCENES["rough"], 6, seed=2)
    path.to_xyz(tmp_path / "a.xyz", [2.5])
    velocities = (tmp_path / "a.xyz").read_text().replace(":momenta:", ":velo:")  # of the mass 1
    (tmp_path / "a.xyz").write_text(velocities)
    (state,) = td.trajectory(path.scene, 1, start=tmp_path / "a.xyz").states_at(0.0)
    assert np.allclose([*state], [*path.states_at(2.5)[0]], atol=1e-15)


def test_hops_of_one_flight_in_the_wrong_order_are_refused():
    """The discs would fly back from one to the other."""
    path = td.trajectory(td.Scene(1.5, 1.0, 0.05), duration=30)
    hops = path.event.str.endswith("_hop").to_numpy()
    k, swapped = np.flatnonzero(hops[1:] & hops[:-1])[0], [*range(len(path))]
    swapped[k], swapped[k + 1] = k + 1, k
    with pytest.raises(td.InputError, match="must have all rows from its first to its last"):
        path.iloc[swapped].states_at(1)
