"""An engine without effects, in a process that imports this module before all modules of kernels.

Each optional function is what stands in for it if its effect is absent, so the compiler never sees
the code of effects. Functions remain that put discs on walls, see either disc there, and count what
is tracked.
"""

from twodiscs.sampling import jit

#: The optional functions that no effect adds.
REMAINING = "snap_to_wall", "hit", "add_one"

_optional = jit.optional


def _without(absent):
    def decorate(present):
        if present.__name__ == "add_one":
            return _optional(absent)(present)
        return jit.inlined(present if present.__name__ in REMAINING else absent)

    return decorate


jit.optional = _without

# The code of these kernels is kept in folders of their own.
for folders in jit.SOURCES.values():
    folders.append("twodiscs_paper/studies/effects")
