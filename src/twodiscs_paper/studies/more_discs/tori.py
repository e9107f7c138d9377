"""The compressibility factor of discs on a torus, from collisions, beside published values.

With σ the contact distance, ν the rate of all collisions and D = 2N − 2, Z = 1 + σ ν/(√2 N c_D).
The discs begin from two sides: from rows that are moved by event chains, as the initial states of
all calls, and from a liquid that is compressed and then moved by as many chains. In equilibrium
both have the same Z.

``pressures.csv`` has published pressures P* = βP(2r)², hence Z = P* π/(4φ): from 2022 by B. Li, Y.
Nishikawa, P. Höllmer, L. Carillo, A. C. Maggs and W. Krauth, J. Chem. Phys. 157, 234111 (2022),
from the data beside it; from 1953 by N. Metropolis and others, J. Chem. Phys. 21, 1087 (1953), read
from its figure 4. ``virial.csv`` has B_k/B_2^(k − 1), from N. Clisby and B. M. McCoy, J. Stat.
Phys. 122, 15 (2006), table 1.
"""

import csv
import math
from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree

from twodiscs.dynamics.many import cell_list, many_rates
from twodiscs.dynamics.many.all_pairs import COLLISIONS, many_disc_law
from twodiscs.model.scene import Box
from twodiscs.sampling.many import chains, many_initial_states
from twodiscs.sampling.streams import open_stream
from twodiscs.theory.flux import flux_constant
from twodiscs_paper.study import row

#: Published pressures, and the virial coefficients B_k/B_2^(k − 1).
PUBLISHED, VIRIAL = (Path(__file__).with_name(f"{name}.csv") for name in ("pressures", "virial"))

#: {aspect: width over height}.
ASPECTS = {
    "1:1": 1.0, "1:sqrt(3)/2": 2 / math.sqrt(3), "9:8sqrt(3)/2": 9 / (4 * math.sqrt(3)),
    "29:30sqrt(3)/2": 29 / (15 * math.sqrt(3)),
}  # fmt: skip

#: The number of discs that is compared with the virial series.
SERIES_DISCS = 256


def torus(discs, packing, aspect):
    """Return a ``Scene`` of ``discs`` of radius 1/2 at a ``packing`` fraction."""
    height = math.sqrt(discs * math.pi / 4 / packing / ASPECTS[aspect])
    box = Box(ASPECTS[aspect] * height, height, discs=discs, periodic="xy")
    return box.scene(0.5)


def counted(seed, points):
    """Return the counts of collisions at the ``points`` as a list of mappings, for a JSON file."""
    found = []
    for point in points:
        for start in point["starts"]:
            scene = torus(point["discs"], point["packing"], point["aspect"])
            replicas, rate = point["replicas"], many_rates.expected_rate(scene, "disc_collision")
            duration = point["events"] / replicas / rate
            states = STARTS[start](scene, replicas, seed)
            sums, products = cell_list.count_events(
                states, np.uint64(seed), 0, duration, many_rates.usual_epoch(scene),
                many_disc_law(scene), many_initial_states.large_grid(scene), None, None, None,
            )  # fmt: skip
            keys = {name: point[name] for name in ("discs", "packing", "aspect", "replicas")}
            keys |= {"start": start, "duration": duration, "sum": int(sums[COLLISIONS])}
            found.append(keys | {"squares": int(products[COLLISIONS, COLLISIONS])})
            print(found[-1], flush=True)
    return found


def from_liquid(scene, number, seed):
    """Return initial states that begin with a compressed liquid instead of rows."""
    states = many_initial_states.states(scene, number, seed)
    # At this packing fraction discs are a liquid.
    shrunk = scene.with_radius(scene.radius * math.sqrt(0.45 / packing_fraction(scene)))
    places = many_initial_states.states(shrunk, number, seed)[: 2 * scene.discs]
    stream, initial = open_stream(np.uint64(seed), 1), many_initial_states.make_initial(scene)
    for k in range(number):
        centres = places[:, k].reshape(2, scene.discs).copy()
        compress(stream, initial, centres, shrunk.contact_distance)
        run = initial.chain.sweeps, initial.chain.length, initial.chain.grid
        chains.run_chains(stream, initial, centres, *run)
        states[: 2 * scene.discs, k] = centres.ravel()
    return states


#: {start: function of a scene, the number of its initial states and a seed}. From rows each state
#: has a new chain, as in all calls.
STARTS = {"rows": many_initial_states.states, "compressed": from_liquid}


def compress(stream, initial, centres, sigma):
    """Move ``centres`` (2, N), ``sigma`` apart, until they are as far apart as in ``initial``."""
    sides = 2 * initial.half_x, 2 * initial.half_y
    while sigma < initial.sigma:
        at = (centres.T + np.array(sides) / 2) % sides
        nearest = cKDTree(at, boxsize=sides).query(at, k=2)[0][:, 1].min()
        sigma = min(nearest * (1 - 2.0**-40), initial.sigma)
        narrow = initial._replace(sigma=sigma)
        chains.run_chains(stream, narrow, centres, initial.discs // 4, 1.0, initial.chain.grid)


def packing_fraction(scene):
    """Return the share of the area of a ``Scene`` that discs cover."""
    return scene.discs * math.pi * scene.radius**2 / (scene.width * scene.height)


def read(path):
    """Return the rows of a file of facts."""
    with path.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def virial_series(packing, discs):
    """Return (Z of the virial series for ``discs`` on a torus, the size of what it leaves out).

    The series Σ b_k (2φ)^(k − 1) ends with b_10; the rest is that of a geometric series with the
    last ratio of terms, and it is taken as the uncertainty too. For N discs the partition function
    is that of the grand canonical ensemble at its largest term, so that

        Z_N = Z − (1/2N) φ d ln(d(φZ)/dφ)/dφ + O(1/N²)
    """
    b = np.array([1.0, 1.0, *(float(row["coefficient"]) for row in read(VIRIAL)[1:])])
    powers = np.arange(b.size)
    terms = b * (2 * packing) ** powers
    ratio = terms[-1] / terms[-2]
    rest = terms[-1] * ratio / (1 - ratio)
    slope = terms @ (powers + 1)
    change = terms @ ((powers + 1) * powers) / slope
    return float(terms.sum() + rest - change / (2 * discs)), float(rest)


def references(discs, aspect, packing):
    """Yield (source, Z, its uncertainty) of what is known at a point."""
    if discs == SERIES_DISCS:
        yield "virial", *virial_series(packing, discs)
    for one in read(PUBLISHED):
        point = int(one["discs"]), one["aspect"], float(one["packing_fraction"])
        if point == (discs, aspect, packing):
            per = math.pi / 4 / packing
            yield one["source"], float(one["pressure"]) * per, float(one["error"]) * per


def rows(counts):
    """Yield the rows of tori.csv, from what ``counted`` returns: each start, then both."""
    groups = {}
    for count in counts:
        point = count["discs"], count["aspect"], count["packing"]
        groups.setdefault(point, []).append(count)
    for point, group in groups.items():
        named = dict(zip(("discs", "aspect", "packing_fraction"), point, strict=True))
        found = [compressibility(count) for count in group]
        apart = None
        if len(group) > 1:
            (one, spread), (other, error) = found
            apart = (one - other) / math.hypot(spread, error)
            for count, (z, stderr) in zip(group, found, strict=True):
                parts = {"replicas": count["replicas"], "events": count["sum"]}
                yield row(named | {"start": count["start"]} | parts, estimate=z, stderr=stderr)
        mean = math.fsum(z for z, _ in found) / len(found)
        error = math.hypot(*(stderr for _, stderr in found)) / len(found)
        parts = {"start": "both" if len(group) > 1 else group[0]["start"]}
        parts |= {"replicas": sum(one["replicas"] for one in group)}
        parts |= {"events": sum(one["sum"] for one in group), "estimate": mean, "stderr": error}
        for source, due, spread in references(*point):
            yield row(
                named | parts, reference=source, expected=due, expected_stderr=spread,
                z=(mean - due) / math.hypot(error, spread), starts_z=apart,
            )  # fmt: skip


def compressibility(count):
    """Return (Z, its standard error) of ``counted`` collisions."""
    scene = torus(count["discs"], count["packing"], count["aspect"])
    n = count["replicas"]
    mean = count["sum"] / n
    error = math.sqrt((count["squares"] / n - mean**2) / (n - 1))
    factor = per_collision(scene, count["duration"])
    return 1 + factor * mean, factor * error


def per_collision(scene, time=1.0):
    """Return Z − 1 for each collision in a ``time``, by default for the rate of collisions."""
    factor = scene.contact_distance / time / math.sqrt(2) / scene.discs
    return factor / flux_constant(scene.velocity_components)
