"""The paper on top of the library ``twodiscs``: its studies, and the pipeline that builds them."""

import sys
from importlib.util import find_spec

# Snakemake looks for modules beside the Snakefile first.
if (_library := find_spec("twodiscs")) and not _library.submodule_search_locations:
    sys.exit(f"{_library.origin} hides the package twodiscs: give this file another name")
