"""Results come back from their files, and points of a build become results."""

from __future__ import annotations

from os import PathLike

import twodiscs
from twodiscs.comparison.measured.measurements import (
    Intervals,
    Measurements,
    run_intervals,
    run_sampling,
    run_simulation,
)
from twodiscs.comparison.measured.scan import Scan
from twodiscs.comparison.measured.transmission import Transmission, run_transmission
from twodiscs.model.box import scene_of
from twodiscs.model.checks import InputError, answering, quote
from twodiscs.points.base import with_arrays
from twodiscs.points.digests import read_json

#: {kind: function that makes its result}
MAKERS = {
    "simulate": run_simulation,
    "sample": run_sampling,
    "intervals": run_intervals,
    "transmission": run_transmission,
}


def from_dict(content):
    """Return the result that ``to_dict`` describes, made again from its sums."""
    if content["kind"] == "scan":
        return Scan(map(from_dict, content["results"]), dict(content["refused"]))
    parts, settings = with_arrays(content["parts"]), content["settings"]
    return MAKERS[content["kind"]](scene_of(content["scene"]), **settings, kept=parts)


@answering
def load_result(
    path: str | PathLike[str],
) -> Measurements | Intervals | Transmission | Scan:
    """Read a result that ``save(path)`` wrote, or a point of a build; ``more`` goes on from it.

    A type checker needs to know its class before you use it:
    ``assert isinstance(result, td.Measurements)``.

    Parameters
    ----------
    path : path-like
        The file. Only the version of the package that wrote it can read it.

    Returns
    -------
    Measurements, Intervals, Transmission or Scan
        The result.

    Raises
    ------
    InputError
        For a file of another version, and for any other file.

    Examples
    --------
    >>> td.simulate(scene, 0.1, seed=1, events="any_wall").save("walls.json")
    >>> more = td.load_result("walls.json").more(error=5e-4)
    >>> more["any_wall_time"].relative_stderr < 5e-4
    True
    """
    if not isinstance(path, str | PathLike) or "\0" in str(path):
        raise InputError(f"path must be the path of a file, not {quote(path)}")
    try:
        content = read_json(path)
    except OSError as error:
        raise InputError(
            f"path must be a file to read, not {str(path)!r}: {error.strerror}"
        ) from None
    except InputError:
        raise InputError(
            f"path must be a file that save() wrote, or a point of a build, not {str(path)!r}"
        ) from None
    if (version := content.get("twodiscs")) != twodiscs.__version__:
        raise InputError(
            f"the result must be of version {twodiscs.__version__}, so that its numbers are the "
            f"same, not of {quote(version)}"
        )
    return from_dict(content)
