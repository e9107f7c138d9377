"""The settings of Numba: its arithmetic, its vector width and the folder for compiled code.

Arithmetic is plain IEEE 754, without fastmath and without contraction. The only function of a math
library that kernels call is the square root, which is correctly rounded. This makes the bits the
same on every processor and for every vector width.

Numba's cache keeps compiled code. Numba itself compares only the file of a kernel, and would keep
it after an edit of the event law that the file imports, so a folder belongs to one state of the
sources. Import this module, not numba, to compile anything.

Kernels copy arrays element by element. The assignment of one array to a part of another compiles
the error message for shapes that differ, which takes seconds.
"""

import atexit
import gc
import os
import sys
import tempfile
import uuid
from functools import cache, cached_property
from hashlib import blake2b
from pathlib import Path
from types import FunctionType

from twodiscs.model.checks import InputError

# The objects of numba's import stay in memory: garbage collections meanwhile take a fifth of the
# start.
collecting = gc.isenabled()
gc.disable()

import numba  # noqa: E402
from llvmlite import binding  # noqa: E402
from numba.core import caching, types  # noqa: E402
from numba.core.compiler_lock import global_compiler_lock  # noqa: E402
from numba.core.registry import CPUDispatcher, cpu_target  # noqa: E402
from numba.extending import overload  # noqa: E402

# No kernel needs BLAS. Numba would import SciPy's, which takes a quarter of the start. We hide it;
# numba then uses its own functions for inner products.
if (blas := "scipy.linalg.cython_blas") not in sys.modules:
    sys.modules[blas] = None  # makes its import fail
    import numba.np.arraymath

    del sys.modules[blas]

if collecting:
    gc.enable()

if numba.config.DISABLE_JIT:
    raise InputError(
        "NUMBA_DISABLE_JIT must not be set: in Python integers do not wrap around and the root of "
        "a negative number is an error; to step through one kernel, call its attribute py_func"
    )

# LLVM uses 512-bit vectors if the processor has them, unless the user set a width or has compiled.
features = binding.get_host_cpu_features()
if features.get("avx512f") and not (numba.config.CPU_NAME or numba.config.CPU_FEATURES):
    # Numba reads the features when it makes the context of all compilations. Afterwards the
    # settings are again the user's, also in the keys of numba's caches: a user's kernels are found
    # there whatever is imported first.
    users = numba.config.CPU_FEATURES
    numba.config.CPU_FEATURES = features.flatten() + ",-prefer-256-bit"
    codegen = cpu_target.target_context.codegen()
    numba.config.CPU_FEATURES = users
    #: The features that kernels are compiled for, a part of the name of their folder.
    FEATURES, codegen._tm_features = codegen._tm_features, codegen._customize_tm_features()
else:
    FEATURES = "the user's"

# Daemon threads end with the process. During a compilation that crashes it, so we wait.
atexit.register(global_compiler_lock.acquire)

#: The options of every compilation: division by zero gives infinity, as IEEE 754 requires. No
#: kernel is called from C.
OPTIONS = {"error_model": "numpy", "boundscheck": False, "nogil": True, "no_cfunc_wrapper": True}

_ROOT = Path(__file__).parents[2]
_FLOORS = [f"twodiscs/{name}" for name in ("model", "points", "theory", "sampling", "dynamics")]

#: {package whose kernels are kept: folders of the sources that are compiled into them}.
SOURCES = {"twodiscs": _FLOORS, "twodiscs_paper": [*_FLOORS, "twodiscs_paper/studies"]}


@cache
def cache_folder(package):
    """Return the folder for compiled code of a ``package``, None if no code can be kept.

    Its name changes with the path below the packages, the size and the time of each file in
    ``SOURCES``, and with ``FEATURES``, so a copy of the sources elsewhere has the same folder.
    """
    digest = blake2b(FEATURES.encode(), digest_size=8)
    for path in sorted(p for folder in SOURCES[package] for p in (_ROOT / folder).rglob("*.py")):
        name, status = path.relative_to(_ROOT), path.stat()
        digest.update(f"{name} {status.st_size} {status.st_mtime_ns}\n".encode())
    try:
        home = os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache"
        kept = Path(numba.config.CACHE_DIR or Path(home, "twodiscs"), digest.hexdigest())
        kept.mkdir(parents=True, exist_ok=True)
        tempfile.TemporaryFile(dir=kept).close()
    except (OSError, RuntimeError) as error:  # the user may have no home
        print(
            f"Compiled code cannot be kept, so every process compiles again: {error}; "
            "NUMBA_CACHE_DIR names another folder",
            file=sys.stderr,
        )
        return None
    return str(kept)


class Locator(caching.UserProvidedCacheLocator):
    """Names the folder and the file for the code of a kernel."""

    def __init__(self, function, file):
        self._cache_path, self._module = cache_folder(_package(function)), function.__module__

    def get_source_stamp(self):
        """Return an empty text: the name of the folder is the stamp of the sources."""
        return ""

    def get_disambiguator(self):
        """Return the name of the module: two modules of two folders may have one file name."""
        return self._module

    @classmethod
    def from_function(cls, function, file):
        """Return the locator of a ``function``."""
        return cls(function, file)


class KernelCacheImpl(caching.CompileResultCacheImpl):
    """The compiled code that numba keeps, in the folder that ``Locator`` names."""

    _locator_classes = [Locator]


class KernelCache(caching.FunctionCache):
    """Numba's cache of the compiled code of one kernel."""

    _impl_class = KernelCacheImpl

    def __init__(self, function):
        super().__init__(function)
        # Numba numbers its files: two processes that save together would use a number twice.
        self._cache_file._data_name = lambda number: f"{function.__name__}.{uuid.uuid4().hex}.nbc"


def compiled(function, **options):
    """Compile ``function`` with ``OPTIONS``; the functions that it calls are compiled into it.

    The code of kernels in ``SOURCES`` is kept on disk. A function within a function is not kept,
    because others in its module have the same name. ``options`` are further ones of ``numba.njit``.
    """
    return _kept(numba.njit(function, **OPTIONS | options))


def _kept(kernel):
    function, package = kernel.py_func, _package(kernel.py_func)
    if package in SOURCES and "<" not in function.__qualname__ and cache_folder(package):
        kernel._cache = KernelCache(function)
    return kernel


def _package(function):
    return function.__module__.partition(".")[0]


class Inlined(CPUDispatcher):
    """A function of kernels. The code for calls from Python takes long to compile."""

    def __call__(self, *arguments):
        return self._for_python(*arguments)

    @cached_property
    def _for_python(self):
        # Under another name: the code of the same name that is kept is that of kernels.
        f = self.py_func
        copy = FunctionType(f.__code__, f.__globals__, f.__name__, f.__defaults__, f.__closure__)
        copy.__module__, copy.__qualname__ = f.__module__, f"{f.__qualname__}.called"
        return compiled(copy)


def inlined(function):
    """Compile ``function`` into its callers, whatever its length: for the innermost loops.

    A call from Python compiles it once more, with the code for such calls.
    """
    options = {"nopython": True, "forceinline": True, "no_cpython_wrapper": True}
    return _kept(Inlined(function, targetoptions=OPTIONS | options))


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
