"""Results as an RO-Crate: each file with its description, its hash and the workflow that made it.

    python -m twodiscs_paper.pipeline.documents.crate results/paper.pdf … \\
        --provenance results/provenance.json --citation CITATION.cff \\
        --texts workflow/Snakefile … --output results/ro-crate-metadata.json

The crate is the folder of the output, with a copy of the texts of the workflow in ``_workflow``.
Its dates and versions come from ``provenance.json``: the same results give the same bytes.
"""

import json
from mimetypes import MimeTypes
from pathlib import Path
from urllib.parse import quote

import yaml

from twodiscs.arguments import Parser, run
from twodiscs.points.digests import digest
from twodiscs_paper.catalogue import ENTRIES, TABLES
from twodiscs_paper.pipeline.documents.numbers import PaperNumbers

#: The profiles that the crate follows, below w3id.org, and where sha256 is defined.
PROFILES = {
    "ro/wfrun/process/0.5": "Process Run Crate",
    "ro/wfrun/workflow/0.5": "Workflow Run Crate",
    "workflowhub/workflow-ro-crate/1.0": "Workflow RO-Crate",
}
TERMS = "https://w3id.org/ro/terms/workflow-run/context"

#: The folder of the crate with the texts of the workflow. No scene can have this name.
WORKFLOW = "_workflow"

#: Descriptions of files that are neither a table nor a figure.
OTHERS = {
    "check.passed": "The verdict: exact theory, Monte Carlo and molecular dynamics agree",
    "configuration.json": "The configuration that all results were built from",
    "manifest.sha256": "Fingerprints of all tables and figures that hold no run times",
    "paper.pdf": "The manuscript",
    "paper_numbers.csv": PaperNumbers.meaning(),
    "provenance.json": "Commit, versions, machine and times",
    "report.html": "The report: verdict, agreement and key figures",
    "report-workflow.html": "Snakemake's report: every table and figure, and the job that made it",
}


def described(name, path):
    """Return the properties of the file at ``path`` that the crate calls ``name``."""
    stem, kind = Path(name).stem, Path(name).suffix
    text = OTHERS.get(name, "A part of the workflow")
    if kind == ".csv" and stem in TABLES:
        text = TABLES[stem].meaning()
    elif "figures/" in name and stem in ENTRIES:
        text = f"{ENTRIES[stem].title}. {ENTRIES[stem].caption()}"
    return {
        "name": name,
        "description": text,
        # Python's own list of file types: the machine's list may differ.
        "encodingFormat": MimeTypes().types_map[True].get(kind, "text/plain"),
        "contentSize": str(path.stat().st_size),
        "sha256": digest(path),
    }


def crate_of(files, texts, citation, made):
    """Return the ``ROCrate`` of ``files``, {name in the crate: path}.

    Its workflow are the ``texts``, in the same form, the Snakefile first. ``citation`` and ``made``
    are the contents of CITATION.cff and provenance.json.
    """
    from rocrate.model.contextentity import ContextEntity
    from rocrate.rocrate import ROCrate

    def add(identifier, kind, name, **more):
        properties = {"@type": kind, "name": name, **more}
        return crate.add(ContextEntity(crate, identifier, properties=properties))

    def author(known):
        name = known.get("name") or f"{known['given-names']} {known['family-names']}"
        return add(f"#{quote(name)}", "Organization" if "name" in known else "Person", name)

    def files_of(paths):
        return [crate.add_file(p, name, properties=described(name, p)) for name, p in paths]

    crate = ROCrate(version="1.1")
    crate.metadata.extra_contexts.append(TERMS)
    licence = f"https://spdx.org/licenses/{citation['license']}"
    authors = [author(known) for known in citation["authors"]]
    shared = {
        "author": authors if len(authors) > 1 else authors[0],
        "license": add(licence, "CreativeWork", citation["license"], url=licence),
    }
    described_files = files_of(files.items())
    (main, text), *parts = texts.items()
    changed = " with changes" if made["changed_since_the_commit"] else ""
    properties = {
        **described(main, text),
        **shared,
        "name": citation["title"],
        "version": f"{citation['version']}, commit {made['commit']}{changed}",
        "softwareRequirements": [
            add(f"#{name}", "SoftwareApplication", name, version=version)
            for name, version in made["versions"].items()
        ],
    }
    snakemake = {"lang": "snakemake", "lang_version": made["versions"]["snakemake"], "main": True}
    workflow = crate.add_workflow(text, main, properties=properties, **snakemake)
    workflow["hasPart"] = files_of(parts)
    build = {
        "name": "The build of these results",
        "description": "All jobs, from the first file that was written to the last",
        "startTime": made["first_file"],
        "endTime": made["last_file"],
        "actionStatus": "http://schema.org/CompletedActionStatus",
    }
    given = crate.get("configuration.json")
    results = [entity for entity in described_files if entity is not given]
    root = {
        **shared,
        "name": f"Results of {citation['title']}",
        "description": citation["abstract"].strip(),
        "datePublished": made["last_file"],
        "keywords": ", ".join(citation["keywords"]),
        "conformsTo": [
            add(f"https://w3id.org/{address}", "CreativeWork", name, version=Path(address).name)
            for address, name in PROFILES.items()
        ],
        "citation": [
            add(f"https://doi.org/{entity['doi']}", "ScholarlyArticle", entity["title"])
            for entity in citation["references"]
        ],
        "mentions": crate.add_action(workflow, "#build", given, results, build),
    }
    for name, value in root.items():
        crate.root_dataset[name] = value
    return crate


def main():
    parser = Parser(prog=__spec__.name, description=__doc__.split("\n")[0])
    parser.add_argument("files", nargs="+", type=Path, metavar="FILE")
    parser.add_argument("--provenance", required=True, type=Path, metavar="JSON")
    parser.add_argument("--citation", required=True, type=Path, metavar="CFF")
    parser.add_argument("--texts", nargs="+", required=True, type=Path, metavar="FILE")
    parser.add_argument("--output", required=True, type=Path, metavar="FILE")
    options = parser.parse_args()
    folder = options.output.parent
    files = {path.relative_to(folder).as_posix(): path for path in sorted(options.files)}
    texts = {f"{WORKFLOW}/{path.name}": path for path in options.texts}
    made = json.loads(options.provenance.read_text(encoding="utf-8"))
    citation = yaml.safe_load(options.citation.read_text(encoding="utf-8"))
    crate_of(files, texts, citation, made).write(folder)


if __name__ == "__main__":
    run(main)
