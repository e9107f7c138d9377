"""Wrong calls, with an ``InputError`` that names the nearest right one, and warnings of a call."""

import sys
import warnings
from collections.abc import Callable
from functools import wraps
from inspect import signature
from typing import Any, TypeVar

from twodiscs.model.checks import InputError
from twodiscs.model.formats import did_you_mean

#: A function or a class, whose type a checker keeps.
Call = TypeVar("Call", bound=Callable[..., Any])


class WrongCall(InputError, TypeError):
    """A call with an unknown argument, with too many arguments or with too few."""


def checked_call(function: Call) -> Call:
    """Return a ``function`` that raises a ``WrongCall`` for wrong arguments, or such a class."""
    if isinstance(function, type):
        function.__init__ = checked_call(function.__init__)
        return function

    @wraps(function)
    def call(*given, **named):
        try:
            return function(*given, **named)
        except TypeError as error:
            if error.__traceback__.tb_next is not None:  # the body raised it, not the call
                raise
            known = signature(function).parameters
            unknown = [name for name in named if name not in known]
            hint = did_you_mean(unknown[0], known) if unknown else ""
            said = str(error).partition(". Did you mean")[0]  # Python 3.13 has a hint of its own
            raise WrongCall(f"{said}{hint}") from None

    return call


def warn(sentence: str, category: type[Warning] = UserWarning) -> None:
    """Warn at the line that calls this package, through however many of its functions."""
    # From Python 3.12 on, ``skip_file_prefixes`` of ``warnings.warn`` does the same.
    frame, level = sys._getframe(1), 2
    while frame and frame.f_globals.get("__name__", "").partition(".")[0] == "twodiscs":
        frame, level = frame.f_back, level + 1
    warnings.warn(sentence, category, stacklevel=level)
