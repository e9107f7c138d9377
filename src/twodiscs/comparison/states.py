"""States of the invariant measure."""

from __future__ import annotations

import numpy as np

from twodiscs.comparison.result import progress_bar, seed_of
from twodiscs.model.checks import answering, check_count
from twodiscs.model.scene import Scene, check_scene


@answering
def starts(
    scene: Scene,
    number: float,
    *,
    seed: int = 1,
    name: str | None = None,
    progress: bool | None = None,
) -> np.ndarray:
    """Draw independent states of the invariant measure: an array with named columns.

    If N discs are too dense for rejection, each state is the end of a chain of trial moves.

    Parameters
    ----------
    scene : Scene
        The box, the discs and their effects.
    number : float
        The number of states, an integer from 1 to 1.5e7 for two plain discs. All states together
        have at most 1.2e8 numbers.
    seed, name, progress : optional
        See ``help(twodiscs)``.

    Returns
    -------
    structured array, shape (number,)
        Fields x1, y1, x2, y2 are the centres, from the centre of the box; u1, v1, u2, v2 are the
        velocities. Balls also have z1, z2, w1, w2, and rough discs s1, s2, the speeds of their
        surfaces. N discs have x1 … xN, then y, u, v and, if they are rough, s.

    Raises
    ------
    InputError
        For a number out of range, and if initial states cannot be drawn.

    Examples
    --------
    >>> states = td.starts(scene, 1000, seed=1)
    >>> bool(abs(states["x1"].mean()) < 5 * 0.32 / 1000**0.5)  # the centre of the box is the mean
    True
    """
    from twodiscs.sampling.starts import MOST_NUMBERS, components, records

    most = MOST_NUMBERS // len(components(check_scene(scene)))
    number = check_count("number", number, most=most)
    seed = seed_of(scene, "trajectory", seed, name)

    with progress_bar(progress, f"starts r = {scene.radius:g}") as progress:
        return records(scene, number, seed, progress)
