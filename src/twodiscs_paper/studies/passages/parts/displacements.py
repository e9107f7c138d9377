"""A long run of displacements in long files, blocked and open."""

from twodiscs.model.scene import Box
from twodiscs_paper.studies.passages.near import ONE_INERTIA, radius_at
from twodiscs_paper.studies.passages.parts.in_long_file import FILE_FRICTION, one_long_file

#: Halvings of the distance below h/4 where discs can pass.
OPEN_HALVINGS = range(3, 6)


def displacements(name, width, height, blocked, seed, replicas):
    """Yield the rows of a long run of ``replicas`` of long files, without and with friction.

    They are blocked at the first of the radii ``blocked``, or open; rough discs are blocked. At the
    other radii they are blocked and have friction, as in a build.
    """
    box, opened = Box(width, height), [radius_at(height / 4, n) for n in OPEN_HALVINGS]
    files = [(radius, [None, FILE_FRICTION], None) for radius in (blocked[0], *opened)]
    files.append((blocked[0], [None], ONE_INERTIA))
    files += [(radius, [FILE_FRICTION], None) for radius in blocked[1:]]
    for radius, frictions, inertia in files:
        yield from one_long_file(name, box, radius, frictions, seed, inertia, replicas)
