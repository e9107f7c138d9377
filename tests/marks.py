"""Marks of the parameters of a test."""

from functools import partial

import pytest

#: A parameter with which a test takes long, most often because it compiles a kernel of its own.
slow = partial(pytest.param, marks=pytest.mark.slow)
