"""What the jobs of one radius share: their scene, their JSON files, and the seconds they took."""

import json
import time

from twodiscs.cli.arguments import Parser, parameters
from twodiscs.parameters import scene


def arguments(description, *names):
    """Return (parameters, scene, path of the point file, path of the cost file or None).

    The parameters are width, height, radius, seed, those of the ``names`` and maybe effects.
    """
    parser = Parser(description=description)
    parser.add_argument("--parameters", required=True, help="all the job depends on, a dict")
    parser.add_argument("--output", required=True, help="the point file to write, JSON")
    parser.add_argument("--cost", help="where to write the number of events and the seconds, JSON")
    given = parser.parse_args()
    names = ("width", "height", "radius", "seed", *names)
    point = parameters(given.parameters, *names, optional=["effects"])
    return point, scene(point, point["radius"]), given.output, given.cost


def write_json(path, content):
    """Write ``content`` with sorted keys, one entry a line; floats keep all their digits."""
    with open(path, "w", encoding="utf-8") as file:
        json.dump(content, file, sort_keys=True, indent=1, allow_nan=False)
        file.write("\n")


def timed(work):
    """Return (result, seconds) of ``work()``, in processor time so that other jobs do not count."""
    start = time.process_time()
    return work(), time.process_time() - start
