"""All tables that there are, by the names of their files."""

from twodiscs.comparison.scene_tables import SCENE_TABLES
from twodiscs.comparison.tables.cost import Forecast
from twodiscs.studies.catalogue import STUDY_TABLES
from twodiscs.studies.effects.table import Benchmark

#: {name: table}
TABLES = {**SCENE_TABLES, **STUDY_TABLES, "forecast": Forecast, "benchmark": Benchmark}
