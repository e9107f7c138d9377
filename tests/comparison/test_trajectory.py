"""A trajectory by other names, as arrays, and as a file of other programs."""

import re

import numpy as np
import pandas as pd
import pytest
from effect_scenes import SCENES

import twodiscs as td

KINDS = {name: SCENES[name] for name in ("unequal", "combination", "channel")}
KINDS |= {"plain": td.Scene(1.5, 1.0, 0.2), "three": td.Scene(1.5, 1.0, 0.15, discs=3)}


@pytest.fixture(
    scope="module",
    params=[
        pytest.param(kind, marks=pytest.mark.slow) if kind == "combination" else kind
        for kind in KINDS
    ],
)
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


def frames(text):
    """Read an extended XYZ file by the rules of the format: [(fields of the comment, rows)]."""
    lines, found = text.splitlines(), []
    while lines:
        number, comment, *lines = lines
        fields = dict(re.findall(r'(\w+)=("[^"]*"|\S+)', comment))
        rows, lines = lines[: int(number)], lines[int(number) :]
        found.append(({k: v.strip('"') for k, v in fields.items()}, [row.split() for row in rows]))
    return found


@pytest.mark.parametrize("times", [None, [0.0, 2.5, 1.25]])
def test_a_file_of_extended_xyz_has_all_states(path, times, tmp_path):
    scene = path.scene
    path.to_xyz(tmp_path / "a.xyz", times)
    found = frames((tmp_path / "a.xyz").read_text(encoding="utf-8"))
    at = [*path["time"]] if times is None else times
    assert [float(fields["Time"]) for fields, _ in found] == at
    corner = np.array([scene.side(axis) / 2 for axis in scene.axes])
    masses = scene.masses if scene.discs == 2 else (1.0,) * 3
    for k, (fields, rows) in enumerate(found):
        lattice = np.array(fields["Lattice"].split(), float).reshape(3, 3)
        assert np.array_equal(lattice, np.diag(np.diag(lattice)))
        assert [*np.diag(lattice)[: len(scene.axes)]] == [scene.side(axis) for axis in scene.axes]
        assert fields["pbc"].split() == ["T" if axis in scene.periodic else "F" for axis in "xyz"]
        columns = re.findall(r"(\w+):([SRI]):(\d)", fields["Properties"])
        assert [sum(int(n) for *_, n in columns)] * len(rows) == [len(row) for row in rows]
        numbers = np.array([row[1:] for row in rows], float)
        places, mass, momenta = numbers[:, :3], numbers[:, 3], numbers[:, 4:7]
        axes = len(scene.axes)
        assert np.allclose(places[:, :axes] - corner, path.positions(times)[k], atol=1e-15)
        assert np.allclose(momenta[:, :axes] / mass[:, None], path.velocities(times)[k], atol=1e-15)
        assert tuple(mass) == masses
        assert [*numbers[:, 8]] == [*range(1, scene.discs + 1)]


def test_ase_reads_it(path, tmp_path):
    read = pytest.importorskip("ase.io", reason="ASE comes with requirements.lock").read
    path.to_xyz(tmp_path / "a.xyz", [0.0, 2.5])
    first, second = read(tmp_path / "a.xyz", ":", format="extxyz")
    scene, axes = path.scene, len(path.scene.axes)
    corner = np.array([scene.side(axis) / 2 for axis in scene.axes])
    assert np.allclose(second.positions[:, :axes] - corner, path.positions([2.5])[0], atol=1e-15)
    assert np.allclose(first.get_velocities()[:, :axes], path.velocities([0.0])[0], atol=1e-15)
    assert [*first.cell.lengths()[:axes]] == [scene.side(axis) for axis in scene.axes]
    assert [*first.pbc] == [axis in scene.periodic for axis in "xyz"]
    assert first.get_kinetic_energy() == pytest.approx(0.5) or scene.field
    assert second.info["Time"] == 2.5


def test_a_trajectory_is_a_table_as_before(path):
    assert isinstance(path[path["event"] != "end"], td.Trajectory)
    assert isinstance(path["time"], pd.Series)
    assert [*path[["time", "u1"]]] == ["time", "u1"]
    with pytest.raises(td.InputError, match="path must be a file to write"):
        path.to_xyz("/nowhere/a.xyz")


def test_hops_of_one_flight_in_the_wrong_order_are_refused():
    """The discs would fly back from one to the other."""
    path = td.trajectory(td.Scene(1.5, 1.0, 0.05), duration=30)
    hops = path.event.str.endswith("_hop").to_numpy()
    k, swapped = np.flatnonzero(hops[1:] & hops[:-1])[0], [*range(len(path))]
    swapped[k], swapped[k + 1] = k + 1, k
    with pytest.raises(td.InputError, match="must have all rows from its first to its last"):
        path.iloc[swapped].states_at(1)
