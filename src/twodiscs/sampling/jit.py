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
import os
import sys
import tempfile
import uuid
from functools import cache, cached_property
from hashlib import blake2b
from pathlib import Path
from types import FunctionType

import numba
from llvmlite import binding
from numba.core import caching, types
from numba.core.compiler_lock import global_compiler_lock
from numba.core.registry import CPUDispatcher, cpu_target
from numba.extending import overload

from twodiscs.model.checks import InputError

# No kernel needs BLAS. Numba would import SciPy's, 0.15 s of the 0.6 s that a short job takes. We
# hide it; numba then uses its own functions for inner products.
if (blas := "scipy.linalg.cython_blas") not in sys.modules:
    sys.modules[blas] = None  # makes its import fail
    import numba.np.arraymath

    del sys.modules[blas]

if numba.config.DISABLE_JIT:
    raise InputError(
        "NUMBA_DISABLE_JIT must not be set: in Python integers do not wrap around and the root of "
        "a negative number is an error; to step through one kernel, call its attribute py_func"
    )

# LLVM prefers vectors of 256 bits on many processors that have 512, and kernels take 1.6 times as
# long. Numba reads the features once, for all compilations of a process. A user's choice wins.
features, users = binding.get_host_cpu_features(), numba.config.CPU_FEATURES
if features.get("avx512f") and not (numba.config.CPU_NAME or users):
    numba.config.CPU_FEATURES = features.flatten() + ",-prefer-256-bit"
    cpu_target.target_context.codegen()
    numba.config.CPU_FEATURES = users

# Daemon threads end with the process. During a compilation that crashes it, so we wait.
atexit.register(global_compiler_lock.acquire)

#: The options of every compilation: division by zero gives infinity, as IEEE 754 requires. No
#: kernel is called from C.
OPTIONS = {"error_model": "numpy", "boundscheck": False, "nogil": True, "no_cfunc_wrapper": True}

_ROOT = Path(__file__).parents[2]
_FLOORS = [f"twodiscs/{name}" for name in ("model", "points", "theory", "sampling", "dynamics")]

#: {package whose kernels are kept: folders of the sources that are compiled into them}.
SOURCES = {"twodiscs": _FLOORS, "twodiscs_paper": [*_FLOORS, "twodiscs_paper/studies"]}

#: Endings of modules, of which ``compileall -b`` and a deletion leave the second.
_MODULES = ".py", ".pyc"


@cache
def cache_folder(package):
    """Return the folder for compiled code of a ``package``, None if no code can be kept.

    Its name is a digest of each file in ``SOURCES``, and of its path below the packages, so a copy
    of the sources elsewhere has the same folder. If only compiled modules lie there, they are its
    files; without any file the sources are unknown, and no code is kept.
    """
    digest = blake2b(repr(SOURCES[package]).encode(), digest_size=8)
    try:
        for folder in SOURCES[package]:
            found = sorted((_ROOT / folder).rglob("*.py*"))
            paths = [p for p in found if "__pycache__" not in p.parts and p.suffix in _MODULES]
            if not paths:
                raise FileNotFoundError(f"no modules lie in {_ROOT / folder}")
            for path in paths:
                text = path.read_bytes()
                digest.update(f"{path.relative_to(_ROOT)} {len(text)}\n".encode() + text)
        home = Path(os.environ.get("XDG_CACHE_HOME", "")).expanduser()
        home = home if home.is_absolute() else Path.home() / ".cache"
        kept = Path(numba.config.CACHE_DIR or home / "twodiscs").expanduser().absolute()
        kept /= digest.hexdigest()
        kept.mkdir(parents=True, exist_ok=True)
        tempfile.TemporaryFile(dir=kept).close()
    except (OSError, RuntimeError) as error:  # the user may have no home
        return _warn_not_kept(str(error))
    return str(kept)


@cache
def _warn_not_kept(reason):
    print(
        f"Compiled code cannot be kept, so every process compiles again: {reason}; NUMBA_CACHE_DIR "
        "names another folder",
        file=sys.stderr,
    )


def _or_not_kept(call):
    """Return a method of Numba's cache without its failures: a full disk, a file that was cut."""

    def attempt(*arguments):
        try:
            return call(*arguments)
        except Exception as error:
            why = getattr(error, "strerror", None) or error
            return _warn_not_kept(f"{call.__self__.cache_path}: {why}")

    return attempt


class Locator(caching.UserProvidedCacheLocator):
    """Names the folder and the file for the code of a kernel."""

    def __init__(self, function, file):
        self._module = function.__module__

    def get_cache_path(self):
        """Return the folder for the package of the kernel."""
        return cache_folder(_package(self._module))

    def get_source_stamp(self):
        """Return an empty text: the name of the folder is the stamp of the sources."""
        return ""

    def get_disambiguator(self):
        """Return the name of the module: two modules of two folders may have one file name."""
        return self._module

    @classmethod
    def from_function(cls, function, file):
        """Return the locator of a ``function``, None if its code is not kept here."""
        return cls(function, file) if _package(function.__module__) in SOURCES else None


def compiled(function):
    """Compile ``function`` with ``OPTIONS``; the functions that it calls are compiled into it.

    The code of kernels in ``SOURCES`` is kept on disk. A function within a function is not kept,
    because others in its module have the same name.
    """
    return _kept(numba.njit(function, **OPTIONS))


def _kept(kernel):
    function, package = kernel.py_func, _package(kernel.py_func.__module__)
    if package in SOURCES and "<" not in function.__qualname__ and cache_folder(package):
        users = numba.config.CACHE_LOCATOR_CLASSES
        numba.config.CACHE_LOCATOR_CLASSES = f"{__name__}.{Locator.__name__}"
        kernel.enable_caching()
        numba.config.CACHE_LOCATOR_CLASSES = users
        # Numba numbers its files: two processes that save together would use a number twice.
        kept = kernel._cache
        kept._cache_file._data_name = lambda number: f"{function.__name__}.{uuid.uuid4().hex}.nbc"
        kept.save_overload = _or_not_kept(kept.save_overload)
        kept.load_overload = _or_not_kept(kept.load_overload)
    return kernel


def compiling():
    """Return whether another thread compiles at the moment."""
    if free := global_compiler_lock._lock.acquire(blocking=False):
        global_compiler_lock._lock.release()
    return not free


def _package(module):
    return module.partition(".")[0]


class Inlined(CPUDispatcher):
    """A function of kernels.

    The code for calls from Python takes 12 % of the compilation of a first simulation, so it is
    made only for functions that Python calls.
    """

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
