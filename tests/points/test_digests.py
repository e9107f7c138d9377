"""A JSON file that carries the digest of its content: any edit of the content is refused."""

import json
import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from twodiscs.model.checks import InputError
from twodiscs.points.base import KEY, read_json, write_json

CONTENT = {"radius": 0.1, "counts": {"hop": 2**62 + 1}, "mean": 0.1 + 0.2, "sums": [[1, 2], [3]]}
SENTENCE = "is not what its job wrote; delete it, and it is made again"


def test_what_is_written_is_read(tmp_path):
    write_json(tmp_path / "a.json", CONTENT)
    assert read_json(tmp_path / "a.json") == CONTENT
    first = (tmp_path / "a.json").read_bytes()
    write_json(tmp_path / "a.json", dict(reversed(CONTENT.items())))
    assert (tmp_path / "a.json").read_bytes() == first


@given(st.data())
def test_an_edit_is_refused_or_changes_nothing(tmp_path_factory, data):
    path = tmp_path_factory.getbasetemp() / "edited.json"
    write_json(path, CONTENT)
    content = bytearray(path.read_bytes())
    place = data.draw(st.integers(0, len(content) - 1))
    content[place] = data.draw(st.integers(0, 255))
    path.write_bytes(content)
    try:
        found = read_json(path)
    except InputError:
        return
    assert found == CONTENT  # another blank between two words, say


@pytest.mark.parametrize(
    "text",
    ["", "{", "[]", "1", "{}", '{"sha256": "0"}', json.dumps(CONTENT), json.dumps({KEY: None})],
)
def test_what_is_no_such_file_is_refused(tmp_path, text):
    (tmp_path / "a.json").write_text(text)
    with pytest.raises(InputError, match=re.escape(SENTENCE)):
        read_json(tmp_path / "a.json")
