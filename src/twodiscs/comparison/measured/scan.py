"""Mean times at several radii of one box: one object for all of them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, overload

from twodiscs.comparison.measured.measurements import Measurements, box_with, scenes_of, simulate
from twodiscs.comparison.measured.result import Result
from twodiscs.model.box import Box
from twodiscs.model.checks import InputError, quote

if TYPE_CHECKING:
    import pandas as pd


class Scan(Result, Sequence[Measurements]):
    """The ``Measurements`` of mean times at several radii of one ``box``, in the order of radii.

    ``settings`` are those of each of them.
    """

    kind = "scan"

    def __init__(self, results):
        self.results = sorted(results, key=lambda result: result.scene.radius)
        self.box, self.settings = Box.of(self.results[0].scene), self.results[0].settings

    @property
    def radii(self) -> list[float]:
        """The radii, ascending."""
        return [result.scene.radius for result in self.results]

    @overload
    def __getitem__(self, index: int) -> Measurements: ...
    @overload
    def __getitem__(self, index: slice) -> list[Measurements]: ...
    def __getitem__(self, index):
        return self.results[index]

    def __len__(self) -> int:
        return len(self.results)

    def __iter__(self) -> Iterator[Measurements]:
        return iter(self.results)

    def __eq__(self, other):
        return self.results == other.results if isinstance(other, Scan) else NotImplemented

    def __hash__(self):
        return hash((self.box, *self.radii))

    def more(
        self,
        error: float | str | Mapping[str, float | str] | None = None,
        budget: float | None = None,
        cores: int = 1,
        progress: bool | None = None,
    ) -> Scan:
        """Return the scan with a smaller ``error`` or a larger ``budget`` at each radius.

        It goes on from this one, and is the same, bit for bit, as one asked for in one call.
        """
        return Scan([result.more(error, budget, None, cores, progress) for result in self.results])

    def to_dict(self) -> dict[str, object]:
        """Return what ``save`` writes."""
        return {
            "twodiscs": self.version,
            "kind": self.kind,
            "results": [result.to_dict() for result in self.results],
        }

    def frame(self) -> pd.DataFrame:
        """Return a pandas ``DataFrame`` by radius and event, with the columns of mean_times.csv."""
        import pandas as pd

        rows = [row for result in self.results for row in result.rows]
        return pd.DataFrame(rows).set_index(["radius", "event"])

    def __str__(self) -> str:
        return "\n\n".join(str(result) for result in self.results)

    __repr__ = __str__

    def _repr_html_(self) -> str:
        return "".join(result._repr_html_() for result in self.results)


def joined(results):
    """Return the ``Scan`` of results that were saved."""
    return Scan(results)


def scan(
    width, height, radii, error, seed, budget, events, name, cores=1, progress=None, effects=None
):
    """Return the ``Scan`` of mean times over ``radii`` (see the face)."""
    box = box_with(width, height, {} if effects is None else effects)
    scenes = scenes_of(box, radii)
    if len({scene.radius for scene in scenes}) < len(scenes):
        raise InputError(
            "radii must differ, for the same one has the same random numbers, not "
            f"{quote([scene.radius for scene in scenes])}; another seed repeats it"
        )
    return Scan(
        [simulate(scene, error, seed, budget, events, name, cores, progress) for scene in scenes]
    )
