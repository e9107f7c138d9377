"""The entry points of the group "twodiscs", by which packages on top of this one extend it."""

from importlib import metadata


def plugin(name):
    """Return the object that an installed package registers as ``name``, None if none does.

    ``tables`` are its tables, {name: ``Table``}; ``build`` is the module of ``twodiscs run`` and
    ``twodiscs new``.
    """
    for entry in metadata.entry_points(group="twodiscs", name=name):
        return entry.load()
    return None
