"""Write the SHA-256 of each of some results, as ``sha256sum --check`` reads it.

    python -m twodiscs.cli.manifest results/paper/areas.csv … --output results/manifest.sha256

Files are named from the folder of the manifest.
"""

from pathlib import Path

from twodiscs.cli import arguments
from twodiscs.verify import manifest


def main():
    parser = arguments.Parser(prog="twodiscs.cli.manifest", description="Write SHA-256 of files.")
    parser.add_argument("files", nargs="+", metavar="FILE")
    parser.add_argument("--output", required=True, type=Path, metavar="FILE")
    options = parser.parse_args()
    text = manifest(options.output.parent, options.files)
    options.output.write_text(text, encoding="utf-8", newline="\n")


if __name__ == "__main__":
    arguments.run(main)
