"""The reference: numpydoc finds nothing wrong with any public docstring, and its examples run."""

import doctest
import inspect
from operator import attrgetter

import pytest

import twodiscs as td

Validator = pytest.importorskip("numpydoc.validate", reason="numpydoc reads docstrings").validate

#: Checks of numpydoc that we do not follow: the summary begins after the quotes, some have one
#: sentence alone, a See Also is not worth its line, and types are written as people say them.
OTHERWISE = {
    "GL01",  # a summary in the line after the quotes
    "ES01",  # an extended summary
    "SA01",  # See Also
    "EX01",  # examples: asked for below, of functions and classes
}

#: Names that are data, whose meaning the reference says.
DATA = ("EFFECTS", "EVENTS")

FUNCTIONS = [n for n in td.__all__ if inspect.isfunction(getattr(td, n))]
CLASSES = [n for n in td.__all__ if inspect.isclass(getattr(td, n))]


def members(name):
    """Return the public functions and properties that a class of ours defines for its users."""
    found = []
    for owner in getattr(td, name).__mro__:
        if owner.__module__.partition(".")[0] != "twodiscs":
            continue
        for member, value in vars(owner).items():
            function = getattr(value, "fget", getattr(value, "func", value))
            function = getattr(function, "__func__", function)
            public = not member.startswith("_") and inspect.isfunction(function)
            if public and "return" in function.__annotations__:
                found.append(member)
    return sorted({*found})


def _value(name):
    """Return the function or class that a dotted ``name`` of the face stands for."""
    return attrgetter(name)(td)


MEMBERS = [f"{name}.{member}" for name in CLASSES for member in members(name)]


def test_every_name_is_a_function_a_class_or_data():
    assert sorted([*FUNCTIONS, *CLASSES, *DATA]) == sorted(td.__all__)
    assert len(MEMBERS) > 30


@pytest.mark.parametrize("name", [*FUNCTIONS, *CLASSES, *MEMBERS])
def test_numpydoc_finds_nothing_wrong(name):
    found = Validator(f"twodiscs.{name}")
    assert [error for error in found["errors"] if error[0] not in OTHERWISE] == []


#: Methods, whose examples run, too.
METHODS = [name for name in MEMBERS if inspect.isfunction(_value(name))]


@pytest.mark.parametrize("name", [*FUNCTIONS, *CLASSES, *METHODS])
def test_every_name_has_its_sections_and_an_example_that_runs(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    text = inspect.getdoc(_value(name))
    wanted = ["Examples"]
    if name not in METHODS:
        wanted.append("Parameters")
    if name in FUNCTIONS:
        wanted += ["Raises"] + ["Returns"] * (name != "animate")
    assert [section for section in wanted if f"\n{section}\n{'-' * len(section)}" not in text] == []
    test = doctest.DocTestParser().get_doctest(
        text, {"td": td, "scene": td.Scene(1.5, 1.0, 0.2)}, name, None, 0
    )
    assert test.examples
    said = []
    doctest.DocTestRunner().run(test, out=said.append)
    assert said == [], "".join(said)
