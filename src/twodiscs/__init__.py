"""Two hard discs in a box: exact times between events, Monte Carlo and molecular dynamics.

    import twodiscs as td

    scene = td.Scene(1.5, 1.0, 0.2)
    td.mean_times(scene)["vertical_hop_time"]     # exact
    td.simulate(scene, error=1e-3, seed=1)        # by molecular dynamics, with errors, beside it

Use any unit of length. Mass 1 of disc 1 and a total energy of 1/2 set the speed to 1, so a time
has the same number as a length. A wrong argument raises an ``InputError``, a ``ValueError``, with
one sentence.

A scene and the amount of work may be positional arguments, all others are keywords:
``td.sample(scene, 1e6, seed=7)``. A quantity has one name, in print, as a key and as a column:
``volume``, ``vertical_hop_area``, ``vertical_hop_time``.

Functions that draw or simulate have these arguments:

- ``seed``, 1 by default: the seed of the random numbers, from 0 to 2⁶³ − 1. Random streams also
  depend on the method, the box and the radius.
- ``name``: the name of a scene in a configuration. With it and the configured seed, results are
  those of the pipeline, bit for bit.
- ``cores``, 1 by default: cores to work on. Results do not depend on their number.
- ``progress``: whether to show a progress bar; if left out, only in a terminal or a notebook.

The table of contents is ``__init__.pyi`` beside this file: all names and their modules. A module is
imported at the first use of one of its names. The tutorial is docs/python.md of the repository.
"""

import lazy_loader

__version__ = "1.0.0"

_load, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)


def __getattr__(name):
    """Return an attribute at its first use; the error about an unknown one has the nearest name."""
    try:
        return _load(name)
    except AttributeError as error:
        if name.startswith("_"):
            raise
        from twodiscs.model.formats import did_you_mean

        raise AttributeError(f"{error}{did_you_mean(name, __all__)}") from None
