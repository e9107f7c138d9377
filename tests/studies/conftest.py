"""Each study declares the families of its scenes: the rules take its fingerprint from them."""

import pytest

from twodiscs.model import family
from twodiscs_paper.catalogue import STUDIES


@pytest.fixture(autouse=True)
def families(request, monkeypatch):
    """Record the families that a test of a study uses, unless it tests bad input."""
    study = STUDIES.get(request.path.stem.removeprefix("test_"))
    used, found = set(), family._found

    def recorded(floor, name, function):
        used.add(name)
        return found(floor, name, function)

    monkeypatch.setattr(family, "_found", recorded)
    yield
    if study and "refused" not in request.node.name:
        assert used <= set(study.families), study.name
