"""The table passages.csv: which hops are passages near a threshold, and how discs diffuse by them.

Each part of the table is a function with a file in ``parts``. The last three are long runs, which
no build makes.
"""

from twodiscs_paper.studies.passages.parts.displacements import displacements
from twodiscs_paper.studies.passages.parts.in_long_file import in_long_file
from twodiscs_paper.studies.passages.parts.in_pore import in_pore
from twodiscs_paper.studies.passages.parts.in_the_limit import in_the_limit
from twodiscs_paper.studies.passages.parts.long_files import long_files
from twodiscs_paper.studies.passages.parts.long_run import long_run
from twodiscs_paper.studies.passages.parts.near_threshold import near_threshold
from twodiscs_paper.studies.passages.parts.on_ring import on_ring
from twodiscs_paper.studies.passages.parts.with_friction import with_friction

#: The parts of passages.csv.
PARTS = {
    part.__name__: part
    for part in (
        near_threshold, on_ring, with_friction, in_long_file, in_the_limit, in_pore, long_run,
        displacements, long_files,
    )
}  # fmt: skip
