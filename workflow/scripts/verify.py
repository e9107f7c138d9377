"""Compare the results with the expected ones, or renew these."""

import sys
from pathlib import Path

from twodiscs_paper.pipeline.results.verify import differences, renew

job = snakemake
results, expected = Path(job.input.configuration).parent, Path(job.params.expected)
if job.rule.endswith("renew"):
    renew(results, expected, job.input.tables, job.params.points)
    sys.exit()
if not expected.exists():
    sys.exit("the expected results are in the repository, not in the installed package")
found = differences(results, expected)
wrong = [f"{name}: {sentence}" for name, sentence in found.items() if sentence]
text = "\n".join((*wrong, f"compared {len(found)} files, {len(wrong)} differ"))
Path(job.log[0]).write_text(f"{text}\n", "utf-8")
print(text)
sys.exit(bool(wrong))
