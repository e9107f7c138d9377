"""The settings of Numba: its arithmetic, its vector width and the folder for compiled code.

Arithmetic is plain IEEE 754, without fastmath and without contraction. The only function of a math
library that kernels call is the square root, which is correctly rounded. This makes the bits the
same on every processor and for every vector width.

Numba's cache keeps compiled code, in a folder named by the ``fingerprint`` of the kernel's module.
Numba itself compares only the file of that module, and would keep a kernel after an edit of the
event law that the module imports. Import this module, not numba, to compile anything: the settings
must precede the import of numba.

Kernels copy arrays element by element. The assignment of one array to a part of another compiles
the error message for shapes that differ, which takes seconds.
"""

import atexit
import fcntl
import gc
import os
import shutil
import sys
import time
import uuid
from contextlib import suppress
from functools import cache
from pathlib import Path

from twodiscs.model.checks import InputError
from twodiscs.model.sources import PACKAGES, fingerprint


def _use_wide_vectors():
    """Let LLVM use 512-bit vectors if the processor has them, unless the user set a width."""
    if "NUMBA_CPU_NAME" in os.environ or "NUMBA_CPU_FEATURES" in os.environ:
        return
    from llvmlite import binding

    features = binding.get_host_cpu_features()
    if features.get("avx512f"):
        os.environ["NUMBA_CPU_FEATURES"] = features.flatten() + ",-prefer-256-bit"


_use_wide_vectors()

# The objects of numba's import stay in memory: garbage collections meanwhile take a fifth of the
# start.
collecting = gc.isenabled()
gc.disable()

import numba  # noqa: E402
from numba.core import caching, types  # noqa: E402
from numba.core.compiler_lock import global_compiler_lock  # noqa: E402
from numba.extending import overload  # noqa: E402

# No kernel needs BLAS. Numba would import SciPy's, which takes a quarter of the start. We hide it;
# numba then uses its own functions for inner products.
if (blas := "scipy.linalg.cython_blas") not in sys.modules:
    sys.modules[blas] = None  # makes its import fail
    import numba.np.arraymath

    del sys.modules[blas]

gc.freeze()
if collecting:
    gc.enable()

if numba.config.DISABLE_JIT:
    raise InputError(
        "NUMBA_DISABLE_JIT must not be set: in Python integers do not wrap around and the root of "
        "a negative number is an error; to step through one kernel, call its attribute py_func"
    )

# Daemon threads end with the process. During a compilation that crashes it, so we wait.
atexit.register(global_compiler_lock.acquire)

#: The options of every compilation: division by zero gives infinity, as IEEE 754 requires. No
#: kernel is called from C.
OPTIONS = {
    "error_model": "numpy", "boundscheck": False, "nogil": True, "no_cfunc_wrapper": True,
}  # fmt: skip

#: Compiled code of older sources is removed after this number of seconds without use.
UNUSED = 30 * 86400


@cache
def cache_home():
    """Return the folder for compiled code, None if no folder can be written to.

    It is the first that can be written to of NUMBA_CACHE_DIR, ``twodiscs`` in XDG_CACHE_HOME or in
    ``~/.cache``, and the folder of the package.
    """
    homes = [Path(__file__).parents[1] / "__pycache__"]
    if chosen := os.environ.get("NUMBA_CACHE_DIR"):
        homes.insert(0, Path(chosen))
    elif chosen := os.environ.get("XDG_CACHE_HOME"):
        homes.insert(0, Path(chosen) / "twodiscs")
    else:
        with suppress(RuntimeError):  # the user may have no entry in the list of users
            homes.insert(0, Path.home() / ".cache" / "twodiscs")
    for home in homes:
        with suppress(OSError):
            home.mkdir(parents=True, exist_ok=True)
            if os.access(home, os.W_OK | os.X_OK):
                return home
    print(
        "Compiled code cannot be kept, so every process compiles again: none of the folders "
        f"{', '.join(map(str, homes))} can be written to; NUMBA_CACHE_DIR names another one",
        file=sys.stderr,
    )
    return None


@cache
def cache_folder(module):
    """Return the folder of the compiled code of a ``module``, a dotted name.

    When a folder is new, old folders without use for ``UNUSED`` seconds are removed.
    """
    folder = cache_home() / f"kernels-{fingerprint(module)}"
    if not folder.exists():
        for old in cache_home().glob("kernels-" + 16 * "[0-9a-f]"):
            if old.stat().st_mtime < time.time() - UNUSED:
                shutil.rmtree(old, ignore_errors=True)
    folder.mkdir(exist_ok=True)
    os.utime(folder)
    return folder


class BySources(caching.UserProvidedCacheLocator):
    """Gives numba's cache the folder of a function, whose name has the fingerprint of sources."""

    def __init__(self, function, file):
        self._cache_path = str(cache_folder(function.__module__))

    def get_source_stamp(self):
        """Return what compiled code depends on beside the versions of numba and Python."""
        return numba.llvmlite.__version__

    def get_disambiguator(self):
        """Return an empty text: a module has one function of a name, on any line."""
        return "kernel"

    @classmethod
    def from_function(cls, function, file):
        """Return the locator of a ``function``."""
        return cls(function, file)


class CacheFile(caching.IndexDataCacheFile):
    """Numba's files of one function; after damage, or on a full disk, it is compiled again."""

    def load(self, key):
        """Return the compiled kernel for ``key``, None if there is none or a file is damaged."""
        try:
            return super().load(key)
        except OSError:
            raise
        except Exception:  # its type depends on the byte at which a pickle ends
            print(f"{self._index_path} is damaged; the kernel is compiled again", file=sys.stderr)
            with suppress(OSError):
                os.unlink(self._index_path)

    def save(self, key, data):
        """Keep ``data``, a compiled kernel, for ``key``, if the disk has room."""
        try:
            super().save(key, data)
        except OSError as error:
            print(f"{self._index_path} cannot be kept: {error.strerror}", file=sys.stderr)

    def _data_name(self, number):
        # Numba numbers its files: two processes that save together would use a number twice.
        return f"{Path(self._index_name).stem}.{uuid.uuid4().hex}.nbc"


def compiled(function, **options):
    """Compile ``function`` with ``OPTIONS``; the functions that it calls are compiled into it.

    The code is kept on disk if possible. ``options`` are further ones of ``numba.njit``.
    """
    options = OPTIONS | options
    if cache_home() is None or function.__module__.partition(".")[0] not in PACKAGES:
        return numba.njit(function, **options)
    usual = numba.config.CACHE_LOCATOR_CLASSES
    numba.config.CACHE_LOCATOR_CLASSES = f"{__name__}.{BySources.__name__}"
    try:
        kept = numba.njit(function, cache=True, **options)
    finally:
        numba.config.CACHE_LOCATOR_CLASSES = usual
    kept._cache._cache_file.__class__ = CacheFile
    _compile_once(kept._cache, function.__name__)
    return kept


def _compile_once(cache, name):
    """Let one process at a time compile the function of a ``cache``: others wait, and load it.

    A function is locked before the functions that it calls, so no two processes wait for each
    other.
    """
    load, save, held = cache.load_overload, cache.save_overload, []

    def load_or_lock(signature, context):
        found = load(signature, context)
        if found is None and not held:
            with suppress(OSError):  # without locks in the file system both compile
                held.append(os.open(Path(cache.cache_path, f"{name}.lock"), os.O_CREAT | os.O_RDWR))
                fcntl.flock(held[0], fcntl.LOCK_EX)
            if (found := load(signature, context)) is not None and held:
                os.close(held.pop())
        return found

    def save_and_unlock(signature, data):
        try:
            save(signature, data)
        finally:
            if held:
                os.close(held.pop())

    cache.load_overload, cache.save_overload = load_or_lock, save_and_unlock


def inlined(function):
    """Compile ``function`` into its callers, whatever its length: for the innermost loops.

    Its code is kept, because several kernels have it. A function within a function is not kept,
    because others in its module have the same name.
    """
    if "<" in function.__qualname__:
        return numba.njit(function, forceinline=True, **OPTIONS)
    return compiled(function, forceinline=True)


def optional(absent):
    """Decorate a function of an effect; ``absent`` replaces it if its last argument is None.

    The type of this argument decides when the kernel that calls it is compiled. The other function
    is not compiled, so it need not be valid for these arguments.
    """

    def decorate(present):
        def chosen(*arguments):
            return (absent if arguments[-1] is None else present)(*arguments)

        chosen.__name__, chosen.__doc__ = present.__name__, present.__doc__

        # Only kernels call the function that is chosen: code for Python takes long to compile.
        inner = OPTIONS | {"forceinline": True, "no_cpython_wrapper": True}

        @overload(chosen, strict=False, jit_options=inner)
        def choose(*arguments):
            missing = isinstance(arguments[-1], types.NoneType | types.Omitted)
            return absent if missing else present

        return chosen

    return decorate
