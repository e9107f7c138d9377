"""The manuscript: its numbers are read from the results, and it compiles from any part of them."""

import json
import re
import shutil
import subprocess
from pathlib import Path

import pytest
import typst

from twodiscs.comparison.scene_tables import SCENE_TABLES
from twodiscs.figures.catalogue import FIGURES, NOTES
from twodiscs.figures.kit import style
from twodiscs.pipeline.documents import manuscript
from twodiscs.studies.catalogue import STUDY_FIGURES, STUDY_TABLES

PAPER = Path(__file__).resolve().parents[2] / "paper"
TABLES = SCENE_TABLES | STUDY_TABLES

# What is typed ------------------------------------------------------------------------------------

STATEMENT = re.compile(r"#(?:let|set|show|import)\b")
EXPRESSION = re.compile(r"#(?:[\w-]+(?:\.[\w-]+)*)?")
METHOD = re.compile(r"\.[a-z][\w-]*(?=[(\[])")
LABEL = re.compile(r"@[\w-]+|<[\w-]+>")
CLOSING = {"(": ")", "{": "}"}


def parts(source):
    """Return pairs ("text" or "math", characters) of Typst markup less code, comments and labels.

    Texts and formulas within code, such as captions and cells, are parts of their own. Code begins
    with # and ends where its brackets do or, for statements such as #let, with the line.
    """
    stack, found, i = [["text", ""]], [], 0
    while i < len(source):
        mode, here, after = stack[-1][0], source[i], i + 1
        code = mode not in ("text", "math")
        if here == "\\":
            after = i + 2
        elif source.startswith("//", i):
            after = source.index("\n", i)
        elif code and here == '"':
            after = source.index('"', i + 1) + 1
        elif mode == "math" and here == "$":
            found.append(stack.pop())
        elif here == "$" and mode not in ("call", "if"):
            stack.append(["math", ""])
        elif code and here in "([{":
            stack.append(["text" if here == "[" else here, ""])
        elif mode == "call":
            if more := METHOD.match(source, i):
                after = more.end()
            else:
                stack.pop()
                continue
        elif (mode == "line" and here == "\n") or here == CLOSING.get(mode):
            stack.pop()
        elif mode == "text" and here == "]" and len(stack) > 1:
            found.append(stack.pop())
            if stack[-1][0] == "if" and not source.startswith(" else", after):
                stack.pop()
        elif not code and here == "#":
            after = EXPRESSION.match(source, i).end()
            condition = source[i:after] == "#if"
            line = STATEMENT.match(source, i)
            stack.append(["line" if line else "if" if condition else "call", ""])
        elif mode == "text" and (label := LABEL.match(source, i)):
            after = label.end()
        elif not code:
            stack[-1][1] += here
        i = after
    assert len(stack) == 1, f"{stack[-1]} is not closed"
    return found + stack


#: Digits of a name, and of what is so by definition.
DEFINED = r"\b[Dd]isc [12]\b|\bnominal 95 per cent\b|`manifest\.sha256`"


def typed_numbers(source):
    """Return the numbers of Typst markup that ought to have been read from the results.

    In the text these are all digits but those that are ``DEFINED``; in formulas decimals, powers
    of ten, and integers too large for a coefficient.
    """
    found = []
    for kind, characters in parts(source):
        if kind == "text":
            characters = re.sub(DEFINED, "", " ".join(characters.split()))
            found += re.findall(r"\S*\d\S*", characters)
        else:
            found += re.findall(r"\d+\.\d+|\b10\^\S+|\d{3,}", characters)
    return found


@pytest.mark.parametrize(
    ("markup", "found"),
    [
        ("It took 12 s. // 13\n", ["12"]),
        ("at $r = 0.24$ or $10^(-3)$, not $64/3 r^3$", ["0.24", "10^(-3)"]),
        ('#figure(image("a2.pdf", width: 80%), caption: [See 7.]) <fig3> and @fig3', ["7."]),
        ("#digits(3.14, 2) and #x.map(y => [#y at $t = 0.5$]).join(2) is 5", ["0.5", "5"]),
        ("#let a = 3\n#set text(size: 9pt)\nfour 4", ["4"]),
        ("#{ let a = 3; [is 8] } and #(1 + 2).", ["8"]),
        ("#if a > 3 [ has 6 of ] disc 1 in the nominal 95 per cent of 7", ["6", "7"]),
        ("#if a > 3 [ 1 ] else [ 2 ] 3", ["1", "2", "3"]),
        ("$#str(12.5) + 1000$", ["1000"]),
    ],
)
def test_typed_numbers_are_found(markup, found):
    assert typed_numbers(markup) == found


def test_every_number_is_read_from_the_results():
    assert typed_numbers((PAPER / "paper.typ").read_text()) == []


def test_no_figure_is_shown_twice_and_those_that_are_shown_are_there_and_spoken_of():
    source = (PAPER / "paper.typ").read_text()
    named = re.findall(r'#drawn\("(\w+)"', source)
    assert len({*named}) == len(named) > 1
    assert {*named} <= {*FIGURES, *STUDY_FIGURES}
    spoken = " ".join(re.findall(r"#see\((.*?)\)", source))
    assert {*named} == {*re.findall(r"\w+", spoken)}


# Fabricated results -------------------------------------------------------------------------------


def rows(table, *values):
    """Return rows of ``table`` that are empty but for ``values``, dicts."""
    return [TABLES[table].empty(**value) for value in values]


def cost(part, quantity, method, **values):
    start = {"part": part, "quantity": quantity, "method": method}
    return start | {"work": 1000, "seconds": 0.25, "error": 0.01} | values


def hard(part, quantity, method=None, **values):
    return {"part": part, "quantity": quantity, "method": method, "count": 2000} | values


OF_SCENE = {
    "grid": rows("grid", {"radius": 0.1}, {"radius": 0.2}),
    "areas": rows("areas", {"quantity": "horizontal_hop_area", "status": "reached"}),
    "mean_times": rows("mean_times", {"event": "vertical_hop", "status": "reached"}),
    "check": rows(
        "check",
        *(
            {"method": method, "z": z, "passed": True, "independent": True, "bound": 4.75}
            for method, z in (("monte_carlo", -1.25), ("dynamics", 2.5))
        ),
    ),
    "cost": rows(
        "cost",
        {"stage": "monte_carlo", "radius": 0.1, "events": 4_000_000},
        {"stage": "dynamics", "radius": 0.1, "events": 70_000_000},
    ),
}

OF_STUDIES = {
    "errata": rows(
        "errata",
        {"label": "volindic", "place": "II", "verdict": "right"},
        {"label": "hoptau", "place": "V", "verdict": "wrong", "ratio": 0.5, "radius": 0.2}
        | {"number": "26", "severity": "major", "correction": "`8√2 b√(a² − r²)`, with `√2` once"},
    ),
    "accuracy_cost": rows(
        "accuracy_cost",
        *(
            cost(part, quantity, method, slope=-0.5, slope_stderr=0.03)
            for part, quantity, method in (
                ("volume", "volume", "rejection"),
                ("volume", "volume", "sobol"),
                ("area", "disc_collision_area", "surface"),
                ("area", "disc_collision_area", "sobol"),
                ("area", "disc_collision_area", "balanced_shell"),
                ("time", "vertical_hop_time", "lockstep"),
                ("time", "vertical_hop_time", "scalar"),
                ("time", "vertical_hop_time", "single_precision"),
            )
        ),
        cost("floor", "disc_collision_area", "shell", setting=0.05),
        cost("floor", "vertical_hop_time", "time_step", setting=0.0625),
        cost("radius", "vertical_hop_time", "paid", error=1e-3),
    ),
    "stability": rows(
        "stability",
        hard("theory", "volume", "stable", value=1e-15),
        hard("sampling", "accepted_share", "conditioned", value=0.4),
        hard("dynamics", "energy_error", value=2e-13),
        hard("dynamics", "smallest_gap", value=-3e-16),
        hard("times", "contact_time", value=0.75),
        hard("coverage", "any_wall", value=0.94),
    ),
    "distributions": rows(
        "distributions",
        *(
            {"scene": "scene0", "radius": 0.24, "event": "vertical_hop", "exact_mean": 1.1}
            | {"quantity": quantity, "estimate": 0.8, "stderr": 0.004, "z": z, "p": p}
            | ({"first": 4.4, "last": 12.0} if p else {})
            for quantity, z, p in (
                ("mean", 0.5, None),
                ("squared_cv", None, None),
                ("first_passage", 1.5, None),
                ("density_at_zero", -0.75, None),
                ("rate", -30.0, 0.5),
                ("trend", -0.7, 0.5),
            )
        ),
        *(
            {"scene": scene, "radius": 0.4, "event": "vertical_hop", "exact_mean": 0.5}
            | {"width": 3.0, "height": 1.0, "quantity": quantity, "estimate": 0.5, "stderr": 0.01}
            | {"first": first, "last": 10.0, "count": 900, "p": p, "z": -9.0}
            for scene in ("scene0", "other")
            for quantity, first, p in (("rate", 2.0, 1e-6), ("hazard", 9.0, None))
        ),
    ),
    "thresholds": rows(
        "thresholds",
        *(
            {"scene": "scene0", "event": event, "quantity": "mean_time", "points": 9, "law": law}
            | {"form": form, "parameter": parameter, "z": 0.3, "curve": law}
            | {"estimate": 0.99 * law, "stderr": 0.01, "limit_radius": 0.25, "farthest": 0.04}
            for event in ("vertical_hop", "horizontal_hop")
            for form, parameter, law in (
                ("plain", "exponent", -2.0),
                ("plain", "coefficient", 0.5),
                ("reduced", "exponent", -2.0),
                ("reduced", "coefficient", 0.5),
            )
        ),
    ),
    "effects": rows(
        "effects",
        {"scene": "rough", "effects": "{'moment_of_inertia': 0.5}", "radius": 0.2, "z": 1.5}
        | {"quantity": "any_wall_time"},
        *(
            {"scene": "rough", "effects": effects, "radius": 0.2, "quantity": "never_met_share"}
            | {"estimate": share, "duration": 1e4}
            for effects, share in (("{}", 1e-7), ("{'moment_of_inertia': 0.5}", 2e-3))
        ),
    ),
    "effects_cost": rows("effects_cost", {"benchmark": "effects", "variant": "rough"}),
    "tails": rows(
        "tails",
        *(
            {"event": event, "radius": 0.24, "exact_mean": 2.0, "quantity": "survival"}
            | {"method": "weighted", "time": 60.0, "estimate": 1.1e-5, "stderr": 3e-7, "law": 1e-5}
            for event in ("disc_collision", "vertical_hop")
        ),
        {"event": "vertical_hop", "radius": 0.3, "exact_mean": 0.8, "quantity": "rate"}
        | {"time": 3.0, "until": 9.0, "estimate": 1.0, "stderr": 0.002, "law": 1.25},
    ),
}


@pytest.fixture(scope="session")
def page(tmp_path_factory):
    """Return a PDF file with nothing on it."""
    path = tmp_path_factory.mktemp("page") / "page.pdf"
    with style.context():
        style.save(style.new_figure(1.0), path)
    return path


@pytest.fixture(scope="module")
def paper(tmp_path_factory, page):
    """Return a function that typesets the manuscript from fabricated results: its bytes.

    ``figures`` are those of a scene and ``common`` the others, ``empty`` tables have no rows, and
    ``change`` sets (table, row, column) to a value; ``text`` is another template.
    """

    def make(
        figures=tuple(FIGURES),
        common=tuple(STUDY_FIGURES),
        scenes=1,
        empty=(),
        change=None,
        text=None,
    ):
        tmp_path = tmp_path_factory.mktemp("paper")
        folder = tmp_path / "results"
        named = {
            name: [] if name in empty else [dict(row) for row in found]
            for name, found in (OF_SCENE | OF_STUDIES).items()
        }
        for (table, row, column), value in (change or {}).items():
            named[table][row][column] = value
        names = [f"scene{i}" for i in range(scenes)]
        for place, some, shown in (
            *((folder / name, OF_SCENE, figures) for name in names),
            (folder, OF_STUDIES, common),
        ):
            (place / "figures").mkdir(parents=True)
            for name in shown:
                shutil.copy(page, place / "figures" / f"{name}.pdf")
            for name in some:
                TABLES[name].write(place / f"{name}.csv", named[name])
        template = tmp_path / "elsewhere" / "paper.typ"
        template.parent.mkdir()
        for source in PAPER.iterdir():
            if source.is_file():
                shutil.copy(source, template.parent)
        shutil.copy(PAPER.parent / "CITATION.cff", tmp_path)
        if text:
            template.write_text(text)
        box = {"width": 1.5, "height": 1.0}
        contents = {
            "configuration": "0123456789abcdef",
            "figures": list(common),
            "results": str(folder),
            "seed": 1,
            "scenes": [
                box | {"name": name, "figures": list(figures), "tables": list(OF_SCENE)}
                for name in names
            ],
            "tables": list(OF_STUDIES),
        }
        output = tmp_path / "paper.pdf"
        manuscript.typeset(str(template), str(output), contents)
        return output.read_bytes()

    return make


@pytest.fixture(scope="module")
def unchanged(paper):
    """Return the manuscript from the fabricated results as they are."""
    return paper()


def test_it_is_the_same_bytes_again_and_has_no_date(paper, unchanged):
    assert paper() == unchanged
    assert unchanged.startswith(b"%PDF")
    assert b"CreationDate" not in unchanged


@pytest.mark.parametrize("start", [0, 1])
def test_a_missing_figure_leaves_no_dangling_reference(paper, start):
    paper(figures=list(FIGURES)[start::2], common=list(STUDY_FIGURES)[start::2])


def test_figures_are_only_spoken_of_where_they_are():
    references = re.findall(r"@(\w+)", (PAPER / "paper.typ").read_text())
    assert not {*FIGURES, *STUDY_FIGURES} & {*references}


def test_it_compiles_without_figures_without_fits_and_with_many_scenes(paper):
    paper(figures=())
    paper(empty=("distributions", "thresholds", "tails", "effects"))
    paper(scenes=3)


@pytest.mark.parametrize(
    ("cell", "value"),
    [
        (("check", 1, "z"), 4.5),
        (("check", 0, "bound"), 4.25),
        (("check", 0, "status"), "none-seen"),
        (("check", 0, "passed"), False),
        (("check", 0, "independent"), False),
        (("errata", 1, "severity"), "slip"),
        (("areas", 0, "status"), "too-few"),
        (("mean_times", 0, "bound"), 0.5),
        (("stability", 5, "value"), None),
        (("cost", 0, "events"), 9_000_000),
        (("cost", 1, "events"), 90_000_000),
        (("errata", 1, "ratio"), 0.25),
        (("errata", 1, "verdict"), "right"),
        (("accuracy_cost", 0, "slope"), -0.25),
        (("accuracy_cost", 6, "seconds"), 0.5),
        (("accuracy_cost", 10, "error"), 1e-2),
        (("stability", 2, "value"), 5e-13),
        (("distributions", 2, "z"), 2.5),
        (("distributions", 3, "estimate"), 0.7),
        (("distributions", 4, "p"), 1e-5),
        (("distributions", 5, "p"), 1e-5),
        (("distributions", 7, "estimate"), 0.6),
        (("distributions", 9, "estimate"), 0.6),
        (("thresholds", 0, "farthest"), 0.05),
        (("thresholds", 0, "estimate"), -1.5),
        (("thresholds", 7, "z"), 3.5),
        (("effects", 0, "z"), 4.5),
        (("effects", 2, "estimate"), 4e-3),
        (("tails", 0, "estimate"), 1.3e-5),
        (("tails", 2, "estimate"), 1.1),
    ],
)
def test_what_the_tables_say_is_what_is_printed(paper, unchanged, cell, value):
    assert paper(change={cell: value}) != unchanged


@pytest.mark.parametrize("name", ["COST_RATIO", "RETURNS"])
def test_numbers_of_the_methods_are_those_of_the_code(paper, unchanged, name, monkeypatch):
    monkeypatch.setattr(manuscript, name, 3)
    assert paper() != unchanged


def test_a_mistake_in_the_template_is_one_sentence(paper):
    with pytest.raises(ValueError, match="does not compile: unknown variable: nothing"):
        paper(text="#nothing")


# How numbers look ---------------------------------------------------------------------------------


def plain(node):
    """Return the text of an element as Typst's query returns it."""
    if isinstance(node, dict):
        if node.get("func") == "attach":
            return plain(node["base"]) + "^" + plain(node.get("t", ""))
        return "".join(plain(node[key]) for key in ("text", "body", "children") if key in node)
    if isinstance(node, list):
        return "".join(map(plain, node))
    return node if isinstance(node, str) else ""


def query(call, folder, **contents):
    """Return what the ``call`` of a function of results.typ gives."""
    shutil.copy(PAPER / "results.typ", folder)
    source = folder / "one.typ"
    source.write_text(f'#import "results.typ": *\n#metadata({call}) <found>')
    contents = {"tables": [], "figures": [], "captions": {}} | contents
    found = typst.query(
        str(source), "<found>", sys_inputs={"contents": json.dumps(contents)}, field="value"
    )
    (value,) = json.loads(found)
    return value


@pytest.mark.parametrize(
    ("call", "shown"),
    [
        ("digits(0, 2)", "0"),
        ("digits(3.14159, 3)", "3.14"),
        ("digits(0.0999, 2)", "0.1"),
        ("digits(-1234.0, 3)", "−1230"),
        ("digits(10000, 2)", "10^4"),
        ("digits(44312345678, 2)", "4.4×10^10"),
        ("digits(1e-15, 2)", "10^−15"),
        ("with-error(0.8134, 0.0021)", "0.813(2)"),
        ("with-error(-0.6098, 0.1141)", "−0.61(11)"),
        ("with-error(1.0, 0.03)", "1.00(3)"),
        ("with-error(0.9996, 0.00096)", "0.9996(10)"),
        ("with-error(0.03, 0.0098)", "0.030(10)"),
        ("with-error(120.0, 30.0)", "120(30)"),
        ("largest((0.3, 3.013))", "3.1"),
        ("largest((3.1, 0.0))", "3.1"),
        ("largest((1.525e-15,))", "1.6×10^−15"),
        ("largest((9.96,))", "10"),
        ("smallest((3.19, 9.98))", "3.1"),
        ("percent((0.39689, 0.5), calc.min)", "39.6"),
        ("percent((0.39689, 0.9412), calc.max)", "94.2"),
        ("bound(0.0926, 1)", "0.1"),
        ("count(2)", "two"),
        ("count(12)", "12"),
    ],
)
def test_numbers_are_written_as_physicists_do(call, shown, tmp_path):
    value = query(call, tmp_path, scenes=[{"figures": [], "tables": []}])
    text = plain(value).replace(" ", "").replace("(", "(").replace("-", "−")
    assert text == shown


# Where it comes from ------------------------------------------------------------------------------


def git(folder, *words):
    identity = ("-c", "user.name=A", "-c", "user.email=a@example.org")
    subprocess.run(["git", "-C", folder, *identity, *words], check=True, capture_output=True)


def test_the_commit_is_that_of_the_template_and_says_if_files_differ(tmp_path):
    assert manuscript.commit(tmp_path) == "unknown"
    git(tmp_path, "init", "-q")
    assert manuscript.commit(tmp_path) == "unknown"
    file = tmp_path / "paper.typ"
    file.write_text("one\n")
    git(tmp_path, "add", "paper.typ")
    git(tmp_path, "commit", "-q", "-m", "One")
    clean = manuscript.commit(tmp_path)
    assert re.fullmatch(r"[0-9a-f]{12}", clean)
    git(tmp_path, "tag", "v1")
    assert manuscript.commit(tmp_path) == clean
    file.write_text("two\n")
    assert manuscript.commit(tmp_path) == f"{clean} with changes"


def test_versions_are_those_installed():
    found = manuscript.versions()
    assert next(iter(found)) == "python"
    assert set(manuscript.PACKAGES) < set(found)
    assert all(re.match(r"\d+\.\d+", version) for version in found.values())


def test_what_captions_explain_alike_is_split_off(tmp_path):
    entry, scene = FIGURES["volume"], {"name": "one", "width": 5.0, "height": 1.0}
    found = manuscript.captions(tmp_path, scene)
    own, alike, note = found["volume"]
    assert own.endswith("(symbols).")
    assert alike.startswith("Error bars")
    assert alike == NOTES[note].plain.replace(
        " Crosses are estimates from too few events for an error bar.", ""
    )
    assert note == entry.note
    assert found["model"] == (FIGURES["model"].full_caption(), "", None)
    assert found.keys() == FIGURES.keys() | STUDY_FIGURES.keys()
