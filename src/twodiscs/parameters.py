"""From the parameters of a job to its scene.

Parameters are a dict of plain values with sorted keys: width, height and, only where the scene
calls for effects, ``effects``, {name: value} of those that it names. So the parameters of a plain
scene, and with them its results, do not know that there are effects.
"""

from twodiscs.scene import EFFECTS, Scene


def scene(parameters, radius):
    """Return the ``Scene`` of ``parameters`` at a ``radius``.

    Raises ``ValueError`` for effects that are no dict of effects and for what makes no ``Scene``.
    """
    effects = parameters.get("effects", {})
    if not isinstance(effects, dict) or not effects.keys() <= EFFECTS.keys():
        raise ValueError(f"effects must be a dict of some of {', '.join(EFFECTS)}, not {effects!r}")
    return Scene(parameters["width"], parameters["height"], radius, **effects)


def described(effects):
    """Return {"effects": …} with sorted keys, or {} without ``effects``: that part of a dict."""
    return {"effects": dict(sorted(effects.items()))} if effects else {}
