"""Numba, set up in one place: which arithmetic, which vector width, where compiled code is kept.

Arithmetic is plain IEEE 754: no fastmath, no contraction, and kernels call nothing of a math
library but the square root, which is correctly rounded. So every processor and vector width gives
the same bits.

Import this module, not numba, wherever something is compiled: the settings must precede the import.
"""

import os
import pickle
import re
import shutil
import sys
import time
import uuid
from contextlib import contextmanager, suppress
from functools import cache
from hashlib import blake2b
from pathlib import Path

#: The folder of the package.
PACKAGE = Path(__file__).resolve().parents[1]

#: The rooms whose sources make the kernels that stand in them: imports point down. A kernel that
#: stands elsewhere is kept for exactly the package as it is.
ROOMS = ("model", "theory", "sampling", "dynamics")

#: How many versions of compiled code stay on disk; older ones belong to sources that were edited.
#: What was used within so many seconds stays as well: another process may be about to read it.
KEPT_CACHES, IN_USE = 4, 3600

#: A file that says that a folder is a cache of this package, which it may remove.
MARK = "compiled by twodiscs"


def _use_wide_vectors():
    """Lift LLVM's preference for 256-bit vectors on a processor with 512; a user's choice wins."""
    if "NUMBA_CPU_NAME" in os.environ or "NUMBA_CPU_FEATURES" in os.environ:
        return
    from llvmlite import binding

    features = binding.get_host_cpu_features()
    if features.get("avx512f"):
        os.environ["NUMBA_CPU_FEATURES"] = features.flatten() + ",-prefer-256-bit"


_use_wide_vectors()

import llvmlite  # noqa: E402
import numba  # noqa: E402
import numpy as np  # noqa: E402
from numba.core import types  # noqa: E402
from numba.core.caching import CompileResultCacheImpl, FunctionCache  # noqa: E402
from numba.core.serialize import dumps  # noqa: E402
from numba.extending import overload  # noqa: E402

#: How everything is compiled: division by zero gives infinity, as IEEE 754 has it. No kernel is
#: called from C.
OPTIONS = {
    "error_model": "numpy", "boundscheck": False, "nogil": True, "no_cfunc_wrapper": True,
}  # fmt: skip


@cache
def sources_hash(room):
    """Return 16 hexadecimal digits that change with the sources and packages that make a kernel.

    Only the text of the files counts and their places in the package, for the kernels that stand in
    ``room``, the first part of a module's name: not where the package is, nor any time stamp.
    """
    folders = [PACKAGE / name for name in ROOMS] if room in ROOMS else [PACKAGE]
    versions = sys.version, numba.__version__, llvmlite.__version__, np.__version__
    digest = blake2b(repr(versions).encode(), digest_size=8)
    for path in sorted(path for folder in folders for path in folder.rglob("*.py")):
        text = path.read_bytes()
        digest.update(f"{path.relative_to(PACKAGE).as_posix()} {len(text)}\n".encode() + text)
    return digest.hexdigest()


def _homes():
    """Yield the folders where compiled code may be kept, the best one first."""
    if chosen := os.environ.get("NUMBA_CACHE_DIR"):
        yield Path(chosen)
    elif chosen := os.environ.get("XDG_CACHE_HOME"):
        yield Path(chosen) / "twodiscs"
    else:
        with suppress(RuntimeError):  # who runs this may have no entry in the list of users
            yield Path.home() / ".cache" / "twodiscs"
    yield PACKAGE / "__pycache__"


@cache
def cache_folder(room):
    """Return the folder of the compiled code of a room, None where no such folder can be made.

    Its name has the hash of the sources. Numba alone looks at the file that holds a function, and
    would go on using a kernel whose imported event law has been edited.
    """
    for home in _homes():
        folder = home / f"kernels-{sources_hash(room)}"
        try:
            folder.mkdir(parents=True, exist_ok=True)
            (folder / MARK).touch()
            os.utime(folder)
            _remove_old(home)
        except OSError:
            continue
        return folder
    print(
        "Compiled code is kept nowhere, so every process compiles anew: none of the folders "
        f"{', '.join(map(str, _homes()))} can be written to; NUMBA_CACHE_DIR names another one",
        file=sys.stderr,
    )
    return None


def _remove_old(home):
    """Remove the caches that were used longest ago, of those that this package made."""
    made = [
        path
        for path in home.glob("kernels-*")
        if re.fullmatch("kernels-[0-9a-f]{16}", path.name) and (path / MARK).is_file()
    ]
    made.sort(key=lambda path: -path.stat().st_mtime)
    for folder in made[KEPT_CACHES:]:
        if folder.stat().st_mtime < time.time() - IN_USE:
            shutil.rmtree(folder, ignore_errors=True)


@contextmanager
def _without_blas():
    """Let numba set itself up without BLAS: the import of SciPy's takes a quarter of the start.

    No kernel needs it. Numba looks for it once; its own functions for inner products then take
    their place in what others compile in this process.
    """
    module = "scipy.linalg.cython_blas"
    if module in sys.modules:
        yield
        return
    sys.modules[module] = None  # so an import of it fails at once
    try:
        yield
    finally:
        del sys.modules[module]


class _Reduction(CompileResultCacheImpl):
    """How numba turns a compiled function into what can be stored, whichever file has it."""

    def __init__(self):
        """Choose no file."""


class KernelCache(FunctionCache):
    """The compiled versions of one function, a file each, named by all that it was compiled for.

    A file has a digest of its content: one that was cut short is compiled again. There is no index
    that two processes could write at the same time.
    """

    def __init__(self, function):
        self._py_func, self._name, self._impl = function, repr(function), _Reduction()
        room = function.__module__.partition(".")[2].partition(".")[0]
        self._cache_path = cache_folder(room)
        self._enabled = self._cache_path is not None

    def _file(self, signature, codegen):
        code = self._py_func.__code__
        key = repr((self._index_key(signature, codegen), code.co_firstlineno)).encode()
        name = f"{self._py_func.__module__}.{self._py_func.__qualname__}".replace("<", "(")
        return self._cache_path / (
            f"{name.replace('>', ')')}-{blake2b(key, digest_size=16).hexdigest()}"
        )

    def load_overload(self, sig, target_context):
        with _without_blas():
            return super().load_overload(sig, target_context)

    def _load_overload(self, sig, target_context):
        if not self._enabled:
            return None
        path = self._file(sig, target_context.codegen())
        try:
            content = path.read_bytes()
        except OSError:
            return None
        digest, stored = content[:32], content[32:]
        if blake2b(stored, digest_size=32).digest() != digest:
            return None
        return self._impl.rebuild(target_context, pickle.loads(stored))

    def _save_overload(self, sig, data):
        if not self._enabled or not self._impl.check_cachable(data):
            return
        path = self._file(sig, data.codegen)
        stored = dumps(self._impl.reduce(data))
        part = path.with_name(f"{uuid.uuid4().hex}.part")
        try:
            part.write_bytes(blake2b(stored, digest_size=32).digest() + stored)
            os.replace(part, path)
        except OSError as error:
            print(f"Compiled code was not kept: {error}", file=sys.stderr)
            part.unlink(missing_ok=True)


def _kept(dispatcher):
    if not numba.config.DISABLE_JIT:  # else it is the function itself
        dispatcher._cache = KernelCache(dispatcher.py_func)
    return dispatcher


def compiled(function):
    """Compile ``function`` with the house settings; what a kernel calls is compiled into it."""
    return _kept(numba.njit(function, **OPTIONS))


def inlined(function):
    """Compile ``function`` into whatever calls it, however long it is: for the innermost loops."""
    return _kept(numba.njit(function, forceinline=True, **OPTIONS))


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


def inlined_closure(function):
    """Compile a function that is made at import like ``inlined``; it is kept in its kernel only."""
    return numba.njit(function, forceinline=True, **OPTIONS)


def written_out(arguments, lines, names):
    """Return an inlined function of ``arguments`` with these ``lines`` of code.

    For a kernel that does the same with each of several functions: a loop over functions is not
    something that numba compiles. ``arguments`` is text as in "x, y"; ``names`` are those that the
    lines use besides.
    """
    body = "".join(f"    {line}\n" for line in lines)
    exec(f"def function({arguments}):\n{body}", names)
    return inlined_closure(names["function"])


def tally(counters, arguments):
    """Return an inlined function (count, ``arguments``) that adds up the units of what is seen.

    ``counters`` are triples: a unit, a number of the type of ``count`` such as 256, so that several
    counts fit into one; a function of the first arguments that says yes or no; and the name of an
    argument without which (None) the counter is not compiled, or None.
    """
    lines, names = [], {}
    for i, (unit, seen, needed) in enumerate(counters):
        taken = ", ".join(arguments.split(", ")[: seen.__code__.co_argcount])
        names |= {f"unit_{i}": unit, f"zero_{i}": type(unit)(0), f"seen_{i}": inlined_closure(seen)}
        only = "" if needed is None else f"if {needed} is not None: "
        lines.append(f"{only}count += unit_{i} if seen_{i}({taken}) else zero_{i}")
    return written_out(f"count, {arguments}", [*lines, "return count"], names)
