"""The manuscript: it compiles from any build, and its captions fit the scene.

Without these tests the manuscript could have typed numbers, or need more than there is.
"""

import re
import shutil

import pytest
from checkout import REPOSITORY, Checkout, copy_tables
from typst import TypstError

from twodiscs.analysis.tables import SCENE_TABLES
from twodiscs.figures import style
from twodiscs.figures.scene_figures import FIGURES
from twodiscs_paper.catalogue import ALL_FIGURES, STUDY_FIGURES, STUDY_TABLES
from twodiscs_paper.pipeline.documents import manuscript

PAPER = REPOSITORY / "paper"
SOURCE = (PAPER / "paper.typ").read_text()

#: Comments, code and labels of Typst.
ARGUMENTS = r"(?:columns|stroke|align|inset|placement|scope|size|spacing|width|above|below)"
CODE = re.compile(
    r"//.*|`[^`]*`|^#(?:set|show|let|import)\b.*|[@<][\w-]+"
    rf"|#?[\w.-]+\((?:[^()\[]|\([^()\[]*\))*\)|\b{ARGUMENTS}: (?:\([^()]*\)|[^,\n]+)",
    re.M,
)
#: Digits of a name, and of definitions.
DEFINED = r"\b[Dd]isc\s[12]\b|\bnominal 95 per cent\b"

# Typed numbers ------------------------------------------------------------------------------------


def typed_numbers(source):
    """Return the numbers of Typst markup that ought to have been printed by their names.

    In the text these are all digits except the ``DEFINED`` ones; in formulas decimals, powers
    of numbers, and integers too large for a coefficient.
    """
    formulas = " ".join(re.findall(r"\$([^$]*)\$", source))
    text = re.sub(DEFINED, "", CODE.sub(" ", re.sub(r"\$[^$]*\$", " ", source)))
    found = re.findall(r"\d+\.\d+|\b\d+\^(?:\(-?\d+\)|\d{2,})|\b10\^\S+|\d{3,}", formulas)
    return re.findall(r"\S*\d\S*", text) + found


def test_every_number_is_printed_by_its_name():
    assert typed_numbers(SOURCE[SOURCE.index("#place(top + center") :]) == []


def test_no_figure_is_shown_twice_and_those_that_are_shown_are_there_and_spoken_of():
    named = re.findall(r'"(\w+)"', " ".join(re.findall(r"#drawn\((.*?)\)", SOURCE)))
    assert len({*named}) == len(named) > 1
    assert {*named} <= {*FIGURES, *STUDY_FIGURES}
    assert {*named} == {*re.findall(r"\w+", " ".join(re.findall(r"#see\((.*?)\)", SOURCE)))}


# How it compiles ----------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def paper(tmp_path_factory):
    """Return a function that typesets the manuscript from the expected tables.

    It returns the bytes and {name: text} of the numbers. ``figures`` are those of a scene, and
    ``common`` the others. The first scene has tables, of which the ``empty`` ones have no rows.
    ``edit`` is (file, old text, new text) for a file of the results or of the manuscript. All
    figures are empty pages.
    """
    page = tmp_path_factory.mktemp("page") / "page.pdf"
    with style.context():
        style.save(style.new_figure(1.0), page)

    def make(figures=(*FIGURES,), common=(*STUDY_FIGURES,), scenes=1, empty=(), edit=()):
        tmp_path = tmp_path_factory.mktemp("paper")
        results, folder = tmp_path / "results", tmp_path / "elsewhere"
        names = ["paper", "other", "third"][:scenes]
        copy_tables(results, {"paper": "paper"}, empty)
        for own, some in {**dict.fromkeys(names, figures), ".": common}.items():
            (results / own / "figures").mkdir(parents=True)
            for name in some:
                shutil.copy(page, results / own / "figures" / f"{name}.pdf")
        shutil.copytree(PAPER, folder, ignore=shutil.ignore_patterns("expected", "shards"))
        shutil.copy(PAPER.parent / "CITATION.cff", tmp_path)
        if edit:
            Checkout(tmp_path).replace(*edit)
        one = {"width": 1.5, "height": 1.0, "figures": figures, "tables": []}
        output = tmp_path / "results" / "paper.pdf"
        given = {"figures": common, "seed": 1908, "configuration": "0123456789abcdef"}
        given["scenes"] = [one | {"name": name} for name in names]
        given["scenes"][0]["tables"] = list(SCENE_TABLES)
        numbers = manuscript.typeset(folder / "paper.typ", output, **given)
        return output.read_bytes(), {number["name"]: number["text"] for number in numbers}

    return make


def test_it_is_the_same_bytes_again_until_a_number_of_a_table_is_another(paper):
    """With each second figure alone: those that are missing leave no dangling reference."""
    some, rest = (([*FIGURES][n::2], [*STUDY_FIGURES][n::2], 3) for n in range(2))
    content, numbers = paper(*some)
    assert (content, numbers) == paper(*some)
    assert content.startswith(b"%PDF")
    assert b"CreationDate" not in content
    cell = "third_virial,,,,,0.782004437"
    edit = "results/agreement.csv", cell, cell.replace("0.782", "0.882")
    _, others = paper(*rest, edit=edit)
    changed = {name: text for name, text in others.items() if text != numbers[name]}
    assert changed == {"third_virial": "$0.882004438$"}


def test_it_compiles_without_rows(paper):
    _, numbers = paper(empty=[*SCENE_TABLES, *STUDY_TABLES])
    assert "tests" not in numbers
    assert numbers["seed"] == "1908"


@pytest.mark.parametrize(
    ("file", "old", "new"),
    [
        ("paper.typ", '#number("more_discs_width")', '#number("third_viral")'),
        ("paper.typ", '#if has("decay_chi2")', '#if has("third_viral")'),
        ("published.yaml", "ours: third_virial", "ours: third_viral"),
    ],
)
def test_a_misspelt_name_stops_the_compiler(paper, file, old, new):
    with pytest.raises(TypstError, match='does not contain key "third_viral"'):
        paper(edit=(f"elsewhere/{file}", old, new))


def test_what_captions_explain_alike_is_split_off():
    found = manuscript.captions({"name": "one", "width": 5.0, "height": 1.0})
    assert found["volume"][1].startswith("Error bars")
    assert " ".join(found["volume"]) == FIGURES["volume"].caption()
    assert found["model"] == (FIGURES["model"].caption(), "")
    square = manuscript.captions({"name": "one", "width": 2.0, "height": 2.0})
    assert "In a square box" in square["mean_hop_time"][0]
    assert "square" not in "".join(found["mean_hop_time"])
    assert found.keys() == FIGURES.keys() | STUDY_FIGURES.keys()
    # The first sentence is the alt text in a report, where the title stands beside it.
    titles = {name: " ".join(entry.title.split()[:3]) for name, entry in ALL_FIGURES.items()}
    again = [n for n, title in titles.items() if ALL_FIGURES[n].caption().startswith(title)]
    assert again == []
