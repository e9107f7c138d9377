"""Every mutant of the list is still a mistake of one line: its text occurs once."""

import mutants
import pytest


@pytest.mark.parametrize("mutant", mutants.MUTANTS, ids=lambda mutant: f"{mutant[0]}: {mutant[1]}")
def test_the_text_of_a_mutant_occurs_once(mutant):
    file, _, old, new = mutant
    text = (mutants.REPOSITORY / "src" / mutants.source(file)).read_text(encoding="utf-8")
    assert text.count(old) == 1
    assert old != new


def test_a_mutant_has_tests_of_its_own():
    for file, *_ in mutants.MUTANTS:
        assert all((mutants.REPOSITORY / path).exists() for path in [*mutants.tiers(file)][1])
