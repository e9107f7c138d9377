"""The transmission coefficient of a hop: the fraction of hops that are passages, with its error."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from twodiscs.measure.result import Result, data_frame, note_of_number, work
from twodiscs.model.calls import checked_call
from twodiscs.model.checks import check_choice, check_count, check_integer
from twodiscs.model.events import HOPS
from twodiscs.model.formats import texts_with_error
from twodiscs.model.scene import Scene, check_scene
from twodiscs.points.estimates import Estimate

if TYPE_CHECKING:
    import pandas as pd

    from twodiscs import Hop


@dataclass(frozen=True, repr=False)
class Transmission(Result):
    """The fraction of hops of one kind that are passages; ``transmission`` returns one.

    Parameters
    ----------
    scene : Scene
        The scene.
    hop : str
        "vertical_hop" or "horizontal_hop".
    coefficient : Estimate or None
        The fraction κ with its error, None if hops are so frequent that κ(t) has no plateau. The
        error is None unless at least 100 hops are passages and at least 100 are in clusters of two
        or more.
    gap : float
        The pause: the time without a hop that ends a cluster.
    clusters : dict
        {n: number of hops in clusters of n}, empty if hops are too frequent for clusters.
    exact_mean : float or None
        The mean time τ between hops, of any pair; None if no exact value is known.
    neighbour_mean : float
        The mean time between hops of two neighbours: τ for two discs. For more discs in a box it is
        (N − 1) τ, and it has an error of about one per cent if τ is not known.
    times : tuple of float
        The times of the curve.
    curve : list of Estimate
        The fractions κ(t) at these times; an error needs 100 hops that are undone by then and 100
        others.
    settings : dict, optional
        {argument: value} beside the scene.
    components : dict, optional
        The components of its run, from which it goes on.
    note : str, optional
        The difference between the work that was asked for and the work that was done.

    Examples
    --------
    >>> found = td.transmission(td.Scene(1.5, 1.0, 0.246), "horizontal_hop", 2**12, seed=1)
    >>> found.passage_time.value > found.exact_mean
    True
    """

    scene: Scene
    hop: str
    coefficient: Estimate | None
    gap: float
    clusters: dict[int, int]
    exact_mean: float | None
    neighbour_mean: float
    times: tuple[float, ...]
    curve: list[Estimate]
    settings: dict[str, object] = field(default_factory=dict)
    components: dict[str, dict] = field(default_factory=dict, compare=False)
    note: str | None = None

    kind = "transmission"

    @property
    def passage_time(self) -> Estimate | None:
        """The mean time between passages τ/κ, an ``Estimate``; None without κ or an exact τ."""
        kappa, mean = self.coefficient, self.exact_mean
        if kappa is None or mean is None:
            return None
        error = None if kappa.stderr is None else mean * kappa.stderr / kappa.value**2
        return Estimate(mean / kappa.value, error, kappa.n)

    @property
    def uncorrected(self) -> float | None:
        """Odd clusters over hops, None without clusters; κ corrects it for merged passages."""
        odd = sum(hops / n for n, hops in self.clusters.items() if n % 2)
        return odd / sum(self.clusters.values()) if self.clusters else None

    def frame(self) -> pd.DataFrame:
        """Return κ(t) as a table.

        Returns
        -------
        DataFrame
            One row per time, with the columns kappa and stderr, NaN if there is no error.

        Examples
        --------
        >>> found = td.transmission(td.Scene(1.5, 1.0, 0.246), "horizontal_hop", 2**12, seed=1)
        >>> found.frame().shape
        (21, 2)
        """
        rows = [(t, e.value, e.stderr) for t, e in zip(self.times, self.curve, strict=True)]
        return data_frame(rows, ["time", "kappa", "stderr"], "time").astype(float)

    def _texts(self) -> pd.DataFrame:
        """Return the texts of the printed table, one row for each quantity."""
        name, kappa, passage = self.hop.replace("_", " "), self.coefficient, self.passage_time
        if kappa is None:
            why = f"too frequent, with a mean time of {self.neighbour_mean:.4g}; .frame() has κ(t)"
            lines = [(f"{name}s", why)]
        else:
            merged = texts_with_error(self.uncorrected, kappa.stderr)[0]
            lines = [
                (f"fraction of {name}s that are passages", str(kappa)),
                (f"if passages within {self.gap:.4g} are merged", merged),
            ]
        if passage is not None:
            exact = texts_with_error(self.exact_mean, passage.stderr)[0]
            lines += [
                ("mean time between hops, exact", exact),
                ("mean time between passages", str(passage)),
            ]
        return data_frame(lines, ["quantity", "value"])


@checked_call
def transmission(
    scene: Scene,
    hop: Hop,
    hops: float = 2**17,
    *,
    seed: int = 1,
    name: str | None = None,
    cores: int = 1,
    progress: bool | None = None,
) -> Transmission:
    """Measure the fraction of hops of one kind that are passages, that is, not soon undone.

    Let t be the time that a disc of speed 1 takes along the box. There is a coefficient κ if hops
    are rare, at most one in 200 to 500 t. Hops count as independent after a pause of 48 t, with
    friction γ of γt²/4 or more: the time in which discs that diffuse forget their order (half as
    long again for rough discs). κ is corrected for passages that are merged, because they follow
    each other within a pause. It misses that a hop is undone after a longer pause. This makes κ
    too large by about 1e-3 for hops of this frequency, and by less for rarer hops; the error does
    not include it.

    With N > 2 discs a hop is undone by the next hop of the same pair. t is then the time that a
    disc of the mean speed takes across the room of two discs, t √(2/N) of the box, and hops are
    those of two neighbours.

    Parameters
    ----------
    scene : Scene
        The box, its discs, at most 19, and their effects.
    hop : str
        "vertical_hop" or "horizontal_hop", along an axis with walls; of more than two discs also
        along a ring.
    hops : float, default 2**17
        Hops to follow, forwards and backwards in time for κ, forwards for the curve: an integer
        from 1 to 1e9. It is rounded up to whole blocks.
    seed, name, cores, progress : optional
        See ``help(twodiscs)``.

    Returns
    -------
    Transmission
        The coefficient κ, the fraction of hops that are passages, with its error; the mean time
        between passages of any pair, in time, if the rate of hops is known exactly; and the curve
        κ(t), in ``frame()``. ``more(hops=…)`` goes on from it.

    Raises
    ------
    InputError
        For a hop that is blocked; for two discs along a periodic axis, and for more across a ring;
        for 20 discs or more, or so large ones that a hop has almost no room among the others.

    Examples
    --------
    >>> rare = td.Scene(1.5, 1.0, 0.246)
    >>> 0.5 < td.transmission(rare, "horizontal_hop", 2**12, seed=1).coefficient.value < 1
    True
    """
    return make_transmission(scene, hop, hops, seed, name, cores=cores, progress=progress)


def make_transmission(scene, hop, hops, seed, name, **how):
    """Return the ``Transmission`` of these arguments; ``how`` is for ``work``."""
    settings = {"hop": check_choice("hop", hop, HOPS), "hops": check_count("hops", hops, 10**9)}
    settings |= {"seed": check_integer("seed", seed, 0), "name": name}
    from twodiscs.dynamics.transmission import TransmissionRun

    found = work("transmission", TransmissionRun(check_scene(scene), **settings), **how)
    note = note_of_number("hops", settings["hops"], found["curve"][0].n)
    return Transmission(scene, hop, **found, settings=settings, note=note)


Transmission.makers = {"transmission": make_transmission}
