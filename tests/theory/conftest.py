"""The working digits of mpmath in the tests of theory."""

import pytest
from mpmath import mp
from theory.antiderivatives import DIGITS


@pytest.fixture(autouse=True, scope="module")
def digits(request):
    """Work with the ``DIGITS`` of the test file, or with those of antiderivatives."""
    with mp.workdps(getattr(request.module, "DIGITS", DIGITS)):
        yield
