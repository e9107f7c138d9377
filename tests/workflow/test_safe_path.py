"""Files of the folder that the workflow is run from are no modules of its jobs."""

import os
import subprocess
import sys
from pathlib import Path

from checkout import first, fresh


def test_a_file_named_like_a_module_does_no_harm(tmp_path):
    """``python -m`` would look there first: for random, which numpy and tempfile import."""
    checkout = fresh(tmp_path / "checkout")
    for name in ("random", "json", "numpy"):
        (checkout.path / f"{name}.py").write_text("raise SystemExit('imported by mistake')\n")
    # Not ``python -m snakemake``, which looks there as well.
    run = subprocess.run(
        [Path(sys.executable).with_name("snakemake"), "--cores", "1", "results/full/theory.csv"],
        cwd=checkout.path,
        env=os.environ | {"PYTHONPATH": first(str(checkout.path / "src"))},
        capture_output=True,
        text=True,
    )
    assert run.returncode == 0, run.stdout + run.stderr
    assert (checkout.path / "results/full/theory.csv").exists()
