"""Docstrings of the face: sections, types and examples.

Without these tests a docstring could lack a section or a type, and its example could fail.
"""

import doctest
import inspect
from operator import attrgetter

import pytest

import twodiscs as td

Validator = pytest.importorskip("numpydoc.validate", reason="numpydoc reads docstrings").validate

#: Checks of numpydoc that we do not follow: the summary begins after the quotes, some have one
#: sentence alone, and a See Also is not worth its line. Examples are asked for below.
OTHERWISE = {"GL01", "ES01", "SA01", "EX01"}

FUNCTIONS = [n for n in td.__all__ if inspect.isfunction(getattr(td, n))]
CLASSES = [n for n in td.__all__ if inspect.isclass(getattr(td, n))]


def members(name):
    """Return the public functions and properties that a class of ours defines for its users."""
    found = set()
    for owner in getattr(td, name).__mro__:
        for member, value in vars(owner).items() if owner.__module__[:8] == "twodiscs" else ():
            function = getattr(value, "fget", getattr(value, "func", value))
            function = getattr(function, "__func__", function)
            public = not member.startswith("_") and inspect.isfunction(function)
            if public and "return" in function.__annotations__:
                found.add(f"{name}.{member}")
    return found


MEMBERS = sorted({member for name in CLASSES for member in members(name)})


def test_every_name_is_a_function_a_class_or_data():
    assert sorted([*FUNCTIONS, *CLASSES, "EFFECTS", "EVENTS"]) == sorted(td.__all__)
    assert len(MEMBERS) > 30


@pytest.mark.parametrize("name", [*FUNCTIONS, *CLASSES, *MEMBERS])
def test_every_name_has_its_sections_and_an_example_that_runs(name, tmp_path, monkeypatch):
    found = Validator(f"twodiscs.{name}")
    assert [error for error in found["errors"] if error[0] not in OTHERWISE] == []
    value = attrgetter(name)(td)
    if name in MEMBERS and not inspect.isfunction(value):
        return  # a property
    text = inspect.getdoc(value)
    wanted = ["Examples"] + ["Parameters"] * (name not in MEMBERS)
    if name in FUNCTIONS:
        wanted += ["Raises"] + ["Returns"] * (name != "animate")
    assert [section for section in wanted if f"\n{section}\n{'-' * len(section)}" not in text] == []
    monkeypatch.chdir(tmp_path)
    names = {"td": td, "scene": td.Scene(1.5, 1.0, 0.2)}
    test = doctest.DocTestParser().get_doctest(text, names, name, None, 0)
    assert test.examples
    said = []
    doctest.DocTestRunner().run(test, out=said.append)
    assert said == [], "".join(said)
