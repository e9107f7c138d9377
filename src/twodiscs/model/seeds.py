"""The seeds of random streams, and the texts in them."""

from hashlib import blake2b

from twodiscs.model.checks import InputError, check_choice, check_integer, check_length
from twodiscs.model.formats import quote
from twodiscs.model.scene import check_scene

#: The methods with random numbers, each with separate streams.
RANDOM_METHODS = (
    "monte_carlo", "dynamics", "intervals", "trajectory", "unmet", "strip", "passages",
    "observe",
)  # fmt: skip


def key(radius):
    """Return the text that names ``radius`` in file names and seeds: its shortest repr."""
    return repr(check_length("radius", radius))


def seed_text(box):
    """Return the text that stands for a ``Box`` without a name in the seeds of its streams.

    Published numbers depend on each of its letters.
    """
    effects = {"effects": dict(sorted(box.effects.items()))} if box.effects else {}
    discs = {"discs": box.discs} if box.discs > 2 else {}
    return repr(discs | effects | {"height": box.height, "width": box.width})


def stream_seed(seed, scene, method, key):
    """Return the integer in [0, 2**63) that seeds the streams of one job.

    It depends on the configured ``seed``, the name of the scene, the method (one of
    ``RANDOM_METHODS``) and the key of the radius. It does not depend on the order of a list or on
    other jobs.
    """
    seed = check_integer("seed", seed, 0)
    text = "\n".join((str(seed), scene, check_choice("method", method, RANDOM_METHODS), key))
    return int.from_bytes(blake2b(text.encode(), digest_size=8).digest(), "big") >> 1


def stream_name(scene, name):
    """Return the name of a scene in its seeds: the text of its box if ``name`` is None."""
    check_scene(scene)
    if name is not None and not isinstance(name, str):
        raise InputError(f"name must be the name of a scene, not {quote(name)}")
    return seed_text(scene) if name is None else name


def job_seed(scene, method, seed, name):
    """Return the seed of the random streams of one job; the arguments are those of the face."""
    return stream_seed(seed, stream_name(scene, name), method, key(scene.radius))
