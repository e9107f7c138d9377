"""The provenance of results."""

import re
import subprocess

from twodiscs_paper.pipeline.results import provenance


def git(folder, *words):
    identity = ("-c", "user.name=A", "-c", "user.email=a@example.org")
    subprocess.run(["git", "-C", folder, *identity, *words], check=True, capture_output=True)


def test_the_commit_is_that_of_the_template_and_says_if_files_differ(tmp_path):
    assert provenance.commit(tmp_path) == "unknown"
    git(tmp_path, "init", "-q")
    assert provenance.commit(tmp_path) == "unknown"
    file = tmp_path / "paper.typ"
    file.write_text("one\n")
    git(tmp_path, "add", "paper.typ")
    git(tmp_path, "commit", "-q", "-m", "One")
    clean = provenance.commit(tmp_path)
    assert re.fullmatch(r"[0-9a-f]{12}", clean)
    git(tmp_path, "tag", "v1")
    assert provenance.commit(tmp_path) == clean
    file.write_text("two\n")
    assert provenance.commit(tmp_path) == f"{clean} with changes"


def test_versions_are_those_installed():
    found = provenance.versions()
    assert next(iter(found)) == "python"
    assert set(provenance.PACKAGES) < set(found)
    assert all(re.match(r"\d+\.\d+", version) for version in found.values())
