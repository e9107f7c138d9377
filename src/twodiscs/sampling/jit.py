"""Numba, set up in one place: which arithmetic, which vector width, where compiled code is kept.

Arithmetic is plain IEEE 754: no fastmath, no contraction, and kernels call nothing of a math
library but the square root, which is correctly rounded. So every processor and vector width gives
the same bits.

Import this module, not numba, wherever something is compiled: the settings must precede the import.
"""

import os
import shutil
import time
from hashlib import blake2b
from pathlib import Path

#: The folder of the package, all of whose sources compiled code may be made from.
PACKAGE = Path(__file__).resolve().parents[1]

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


def sources_hash():
    """Return 16 hexadecimal digits that change with any edit of the sources of this package."""
    digest = blake2b(digest_size=8)
    for path in sorted(PACKAGE.rglob("*.py")):
        text = path.read_bytes()
        digest.update(f"{path.relative_to(PACKAGE).as_posix()} {len(text)}\n".encode() + text)
    return digest.hexdigest()


def _use_keyed_cache():
    """Keep compiled code in a folder named by the hash of all sources of this package.

    Numba compares the time stamp of the file that holds a function, so it would go on using a
    kernel whose imported event law has been edited.
    """
    home = os.environ.get("NUMBA_CACHE_DIR")
    caches = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
    root = Path(home) if home else caches / "twodiscs"
    if not root.name.startswith("sources-"):
        root = root / f"sources-{sources_hash()}"
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
