"""Marks of the parameters of a test, and what only slow tests see.

``make test-all`` runs the slow tests. Each kind has a reason, and a fast test nearby:

* A kernel of two discs with several effects, or with one effect in a strip or in a field, takes
  seconds to compile. The law of every scene and its kicks are tested in Python, all effects at once
  among them; counts, intervals and passages with friction are fast, and strips have their loop.
* Rough discs, many, moved in time or on a ring with cells: one trajectory is compared with the
  engine of two, counts with theory. Cells in a box that count no events, cells of many discs on a
  torus, and cells that count events between kicks: counts without kicks, few discs on a torus, and
  on a ring trajectories with kicks are fast.
* Intervals of few discs on a ring, and of cells: those of few discs between walls are fast.
* 2e7 events without drift, many more scenes of theory and Monte Carlo, all figures in all boxes:
  some are fast.
* 16 seeds of each call and each study, whole animations: seeds of two calls, and of two studies
  with few events, are fast, and so are short animations.
* Other processors, an empty environment, the network, a type checker, the whole site.
* A second build: on one core, as a module, in a storage, with the manuscript, with Slurm, in a
  queue. Fast are dry runs of the same, shards of others, minutes by attempt, the script of a queue.
* Signals to ``snakemake``: fast are those to ``twodiscs run``.
"""

from functools import partial

import pytest

#: A parameter with which a test takes long, most often because it compiles a kernel of its own.
slow = partial(pytest.param, marks=pytest.mark.slow)
