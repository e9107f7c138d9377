"""The provenance of a build: commit, versions and files.

Without these tests a report could name another commit, or hide that files differ from it.
"""

import os
import re
import subprocess

import pytest

from twodiscs_paper.pipeline.results import provenance


def git(folder, *words):
    identity = ("-c", "user.name=A", "-c", "user.email=a@example.org")
    subprocess.run(["git", "-C", folder, *identity, *words], check=True, capture_output=True)


@pytest.fixture
def repository(tmp_path):
    """A repository with one commit of one file."""
    folder = tmp_path / "repository"
    folder.mkdir()
    git(folder, "init", "-q")
    assert provenance.commit(folder) == "unknown"  # before the first commit
    (folder / "paper.typ").write_text("one\n")
    git(folder, "add", "paper.typ")
    git(folder, "commit", "-q", "-m", "One")
    return folder


def test_the_commit_is_that_of_the_sources_and_says_if_files_differ(repository, monkeypatch):
    clean = provenance.commit(repository)
    assert re.fullmatch(r"[0-9a-f]{12}", clean)
    git(repository, "tag", "v1")
    assert provenance.commit(repository) == clean
    paths = [repository / name for name in ("paper.typ", "last.csv", "first.csv")]
    for path, moment in zip(paths, (60, 120, 0), strict=True):
        path.touch()
        os.utime(path, (moment, moment))
    known = provenance.provenance(repository, paths)
    assert known["changed_since_the_commit"] is False
    ends = known["first_file"], known["last_file"]
    assert ends == ("1970-01-01T00:00:00+00:00", "1970-01-01T00:02:00+00:00")
    paths[0].write_text("two\n")
    assert provenance.commit(repository) == f"{clean} with changes"
    monkeypatch.setenv("PATH", os.devnull)  # without git
    unknown = provenance.provenance(repository, paths)
    assert unknown["commit"] is unknown["changed_since_the_commit"] is None


def test_a_worktree_has_its_own_commit_whatever_a_hook_is_about(repository, tmp_path, monkeypatch):
    git(repository, "worktree", "add", "-q", tmp_path / "other")
    (tmp_path / "other" / "paper.typ").write_text("two\n")
    git(tmp_path / "other", "commit", "-q", "-a", "-m", "Two")
    first, second = provenance.commit(repository), provenance.commit(tmp_path / "other")
    assert first != second
    monkeypatch.setenv("GIT_DIR", str(repository / ".git"))
    monkeypatch.setenv("GIT_WORK_TREE", str(repository))
    assert provenance.commit(tmp_path / "other") == second


def test_packages_in_the_repository_of_somebody_else_have_no_commit(repository):
    installed = repository / ".venv" / "share"
    installed.mkdir(parents=True)
    (installed / "paper.typ").write_text("one\n")
    assert provenance.commit(installed) == "unknown"
