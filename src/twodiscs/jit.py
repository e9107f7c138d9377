"""Numba, set up in one place: which arithmetic, which vector width, where compiled code is kept.

Arithmetic is plain IEEE 754: no fastmath, no contraction, and kernels call nothing of a math
library but the square root, which is correctly rounded. So every processor and vector width gives
the same bits.

Import this module, not numba, wherever something is compiled: the settings must precede the import.
"""

import os
import shutil
import time
from pathlib import Path

from twodiscs.sources import package_hash

#: How many versions of compiled code stay on disk; older ones belong to sources that were edited.
#: What was used within so many seconds stays as well: another process may be about to read it.
KEPT_CACHES, IN_USE = 4, 3600


def _use_wide_vectors():
    """Lift LLVM's preference for 256-bit vectors on a processor with 512; a user's choice wins."""
    if "NUMBA_CPU_NAME" in os.environ or "NUMBA_CPU_FEATURES" in os.environ:
        return
    from llvmlite import binding

    features = binding.get_host_cpu_features()
    if features.get("avx512f"):
        os.environ["NUMBA_CPU_FEATURES"] = features.flatten() + ",-prefer-256-bit"


def _use_keyed_cache():
    """Keep compiled code in a folder named by the hash of all sources of this package.

    Numba compares the time stamp of the file that holds a function, so it would go on using a
    kernel whose imported event law has been edited.
    """
    home = os.environ.get("NUMBA_CACHE_DIR")
    caches = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
    root = Path(home) if home else caches / "twodiscs"
    if not root.name.startswith("sources-"):
        root = root / f"sources-{package_hash()[:16]}"
    try:
        root.mkdir(parents=True, exist_ok=True)
        os.utime(root)
        stale = sorted(root.parent.glob("sources-*"), key=lambda path: -path.stat().st_mtime)
        for folder in stale[KEPT_CACHES:]:
            if folder.stat().st_mtime < time.time() - IN_USE:
                shutil.rmtree(folder, ignore_errors=True)
    except OSError:
        return
    os.environ["NUMBA_CACHE_DIR"] = str(root)


_use_wide_vectors()
_use_keyed_cache()

import numba  # noqa: E402
from numba.core import types  # noqa: E402
from numba.extending import overload  # noqa: E402

#: How everything is compiled: division by zero gives infinity, as IEEE 754 has it.
OPTIONS = {"error_model": "numpy", "boundscheck": False, "nogil": True}


def compiled(function):
    """Compile ``function`` with the house settings; what a kernel calls is compiled into it."""
    return numba.njit(function, cache=True, **OPTIONS)


def inlined(function):
    """Compile ``function`` into whatever calls it, however long it is: for the innermost loops."""
    return numba.njit(function, cache=True, forceinline=True, **OPTIONS)


def optional(absent):
    """Decorate a function of an effect; ``absent`` takes its place where its last argument is None.

    Which of them it is follows from the type of that argument, when the kernel that calls it is
    compiled: the other one is not even looked at, so it need make no sense for these arguments.
    """

    def decorate(present):
        def chosen(*arguments):
            return (absent if arguments[-1] is None else present)(*arguments)

        chosen.__name__, chosen.__doc__ = present.__name__, present.__doc__

        @overload(chosen, strict=False, jit_options=OPTIONS | {"forceinline": True})
        def choose(*arguments):
            missing = isinstance(arguments[-1], types.NoneType | types.Omitted)
            return absent if missing else present

        return chosen

    return decorate
