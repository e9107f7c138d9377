"""All studies: each is an analysis with its own folder, tables and figures.

Each folder of ``studies``, and ``errata``, declares one or several studies in its module ``study``.
Target, key in the configuration, report and page follow from the declaration. Standard
library only: the Snakefile imports this module.
"""

from importlib import import_module
from pathlib import Path

from twodiscs.analysis.tables import SCENE_TABLES
from twodiscs.figures.scene_figures import ANIMATION, FIGURES
from twodiscs_paper.studies.effects.study import Benchmark
from twodiscs_paper.study import Study


def _declared():
    """Yield the studies of all folders."""
    here = Path(__file__).parent
    for path in (here / "errata/study.py", *here.glob("studies/*/study.py")):
        folder = ".".join(path.parent.relative_to(here).parts)
        module = import_module(f"{__package__}.{folder}.study")
        yield from (value for value in vars(module).values() if isinstance(value, Study))


#: {name: ``Study``}
STUDIES = {s.name: s for s in sorted(_declared(), key=lambda study: (study.order, study.name))}

#: The figures of studies, and all figures with the animation, {name: ``Figure``}.
STUDY_FIGURES = {name: e for study in STUDIES.values() for name, e in study.figures.items()}
ALL_FIGURES = {**FIGURES, **STUDY_FIGURES, "animation": ANIMATION}

#: The tables of studies, {name: table}, those of long runs that figures read, and all tables.
STUDY_TABLES = {table.name(): table for study in STUDIES.values() for table in study.tables}
LONG_RUN_TABLES = {table.name(): table for study in STUDIES.values() for table in study.long_runs}
TABLES = {**SCENE_TABLES, **STUDY_TABLES, **LONG_RUN_TABLES, "benchmark": Benchmark}

#: The tables with seconds that belong to no study, and the documents that show them.
TIMED_FILES = {"cost", "benchmark", "paper", "paper_numbers", "report"}
TIMED_FILES |= {name for study in STUDIES.values() for name in study.timed}


def read_table(path):
    """Return the rows of the table at ``path``.

    The name of a file is that of its table. A part of a table is in a folder of this name.
    """
    path = Path(path)
    return TABLES[path.stem if path.stem in TABLES else path.parent.name].read(path)


def is_reproducible(path):
    """Return whether a result is the same bytes on every run: a table or figure without seconds."""
    path = Path(path)
    figure = STUDY_FIGURES.get(path.stem) if path.suffix != ".csv" else None
    timed = not TIMED_FILES.isdisjoint(figure.tables if figure else [path.stem])
    return path.suffix in (".csv", ".pdf", ".png", ".gif") and not timed
