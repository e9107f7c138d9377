"""SHA-256 of files, and JSON files with the digest of their content."""

import json
from hashlib import sha256
from pathlib import Path

from twodiscs.model.checks import InputError

KEY = "sha256"

#: A key whose value differs from run to run: neither the content nor its digest includes it.
SECONDS = "seconds"


def digest(*paths):
    """Return the SHA-256 of concatenated files, in hexadecimal digits."""
    return sha256(b"".join(Path(path).read_bytes() for path in paths)).hexdigest()


def write_json(path, content, seconds=None):
    """Write the dict ``content`` with its digest, keys sorted; floats keep all their digits.

    ``seconds`` is the processor time that it took, if known.
    """
    content = content | {KEY: _digest_of(content)}
    if seconds is not None:
        content[SECONDS] = seconds
    text = json.dumps(content, sort_keys=True, indent=1, allow_nan=False)
    Path(path).write_text(f"{text}\n", encoding="utf-8", newline="\n")


def read_json(path):
    """Return the content of a file of ``write_json``.

    Raises ``InputError`` if the file was changed, ``OSError`` if it cannot be read.
    """
    try:
        content = json.loads(Path(path).read_bytes())
        content.pop(SECONDS, None)
        written = content.pop(KEY) == _digest_of(content)
    except (ValueError, TypeError, KeyError, AttributeError, RecursionError):
        written = False
    if not written:
        raise InputError(f"{path} is not what its job wrote; delete it, and it is made again")
    return content


def read_seconds(path):
    """Return the seconds in a file of ``write_json``, None without any."""
    return json.loads(Path(path).read_bytes()).get(SECONDS)


def _digest_of(content):
    return sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()
