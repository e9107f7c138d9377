"""Every mutant of the list is still a mistake: its text is in the sources once, near tests."""

import mutants
import pytest


@pytest.mark.slow
@pytest.mark.parametrize("mutant", mutants.MUTANTS, ids=lambda mutant: mutant[0])
def test_a_mutant_is_in_the_sources_and_has_tests(mutant):
    _, old, new = mutant
    assert old != new
    assert mutants.nearest(old)
