"""Without it ``make`` could remove an environment on a machine whose Python is too old."""

import shutil
import subprocess

from checkout import REPOSITORY


def test_old_python_is_refused(tmp_path):
    tools = tmp_path / "tools"
    tools.mkdir()
    for tool in ("make", "sh", "rm", "touch"):
        (tools / tool).symlink_to(shutil.which(tool))
    for name in ("python3", "python"):
        (tools / name).write_text("#!/bin/sh\nexit 1\n")
        (tools / name).chmod(0o755)
    checkout = tmp_path / "checkout"
    (checkout / ".venv" / "old").mkdir(parents=True)
    for name in ("Makefile", "requirements.lock", "pyproject.toml"):
        shutil.copy(REPOSITORY / name, checkout)
    words, given = [tools / "make", ".venv/ready"], {"cwd": checkout, "env": {"PATH": str(tools)}}
    run = subprocess.run(words, **given, capture_output=True, text=True)
    assert run.returncode != 0
    assert "This needs Python 3.11 or newer" in run.stderr
    assert (checkout / ".venv" / "old").exists()
