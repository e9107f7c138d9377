"""Read configuration files with limits, before anything else reads them.

The Snakefile calls ``read`` before its own ``configfile:``.
"""

import re
import sys

import yaml

from twodiscs.model import checks
from twodiscs.model.checks import InputError
from twodiscs_paper.pipeline.configuration.schema import schema

#: Limits far above any configuration: bytes of a file, letters of one value, blocks within blocks,
#: and values with every alias written out.
BYTES, LETTERS, DEPTH, VALUES = 1_000_000, 1000, 32, 50_000

#: The tags of numbers in YAML, and the form of a decimal number. YAML 1.1 also has octal, binary
#: and sexagesimal numbers: 010 is 8 and 1:30 is 90.
NUMBERS = {f"tag:yaml.org,2002:{kind}" for kind in ("int", "float")}
PLAIN = re.compile(
    r"[-+]?(0|[1-9]\d*|\d*\.\d+|\d+\.\d*)([eE][-+]?\d+)?|[-+]?\.(inf|nan)", re.IGNORECASE
)


class ConfigError(InputError):
    """Mistakes in a configuration, one sentence and one line for each."""


def read(path):
    """Return the mapping in the YAML file ``path``.

    Raises ``ConfigError`` with file and line if the text is no YAML, or if a key is given twice,
    because YAML would silently take the last value. The same error names a file that cannot be
    read, exceeds the limits of this module, or holds no mapping.
    """
    try:
        with open(path, "rb") as file:
            content = file.read(BYTES + 1)
    except OSError as error:
        raise ConfigError(f"{path}: {error.strerror}") from None
    if len(content) > BYTES:
        raise ConfigError(f"{path} must be a file of at most {BYTES} bytes")
    try:
        mapping = yaml.load(content.decode(), _StrictLoader)
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        byte = content[error.start]
        raise ConfigError(f"{path}, line {line}: must be UTF-8, not the byte {byte:#x}") from None
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        raise ConfigError(f"{path}, line {mark.line + 1}: {error.problem}") from None
    except (yaml.YAMLError, ArithmeticError, ValueError) as error:
        raise ConfigError(f"{path}: {' '.join(str(error).split())}") from None
    if not isinstance(mapping, dict):
        raise ConfigError(f"{path}: must hold {schema()['allowed']}, not {describe(mapping)}")
    return mapping


def or_exit(function, *arguments):
    """Return ``function(*arguments)``, or end the program with the sentence of a mistake."""
    try:
        return function(*arguments)
    except ConfigError as error:
        sys.exit("\n".join(f"Configuration: {sentence}" for sentence in str(error).split("\n")))


def describe(value):
    """Return a short text of a ``value`` for a sentence."""
    return "empty" if value is None else checks.quote(value)


def _step(index):
    """Return the part of a path that stands for ``index``: a key, or a number in a list."""
    if isinstance(index, yaml.ScalarNode):
        return f".{index.value}"
    return "" if index is None else f"[{index}]"


def _mistake(problem, node):
    return yaml.MarkedYAMLError(problem=problem, problem_mark=node.start_mark)


class _StrictLoader(yaml.SafeLoader):
    """The usual YAML, within limits; a key given twice is a mistake."""

    def __init__(self, stream):
        super().__init__(stream)
        self.path, self.names, self.sizes, self.total = [], [], {}, 0

    def compose_node(self, parent, index):
        # Values are counted as they are composed: an alias counts as much as its anchor.
        if len(self.path) > DEPTH:
            raise _mistake(f"there must be at most {DEPTH} blocks within blocks", parent)
        if self.check_event(yaml.AliasEvent):
            node = super().compose_node(parent, index)
            if node not in self.sizes:
                raise _mistake("an alias must not stand within its own anchor", node)
        else:
            self.path.append(0)
            self.names.append(_step(index))
            node = super().compose_node(parent, index)
            self.names.pop()
            self.sizes[node] = self.path.pop() + 1
        if isinstance(node, yaml.ScalarNode) and len(node.value) > LETTERS:
            raise _mistake(f"a value must have at most {LETTERS} letters", node)
        if node.tag in NUMBERS and not PLAIN.fullmatch(node.value):
            where = "".join([*self.names, _step(index)]).lstrip(".") or "the file"
            asked = f"{where} must be a decimal number, or text in quotes, not {node.value:.40}"
            raise _mistake(f"{asked}: YAML reads {self.construct_object(node)!r}", node)
        if self.path:
            self.path[-1] += self.sizes[node]
        self.total += 1
        if max(self.total, self.sizes[node]) > VALUES:
            raise _mistake(f"there must be at most {VALUES} values, aliases written out", node)
        return node

    def compose_mapping_node(self, anchor):
        node = super().compose_mapping_node(anchor)
        keys = set()
        for key, _ in node.value:
            if isinstance(key, yaml.ScalarNode):
                if key.value in keys:
                    raise _mistake(f"the key {key.value!r} is given a second time", key)
                keys.add(key.value)
        return node

    def construct_object(self, node, deep=False):
        try:
            return super().construct_object(node, deep)
        except yaml.YAMLError:
            raise
        except Exception as error:  # of many kinds, from int(), float() and datetime
            raise _mistake(f"{node.value!r:.40} cannot be read: {error}", node) from None
