"""The list of mutants: each has its text in the sources.

Without these tests an edit of the sources could take away the text of one, and nobody would see it.
"""

import mutants
import pytest


@pytest.mark.slow
@pytest.mark.parametrize("mutant", mutants.MUTANTS, ids=lambda mutant: mutant[0])
def test_a_mutant_is_in_the_sources_and_has_tests(mutant):
    _, old, new = mutant
    assert old != new
    assert mutants.nearest(old)
