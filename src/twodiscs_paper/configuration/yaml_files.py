"""From a configuration file to a ``Configuration``, or to a sentence for each mistake."""

import json
import re
import sys
from itertools import islice
from pathlib import Path

import yaml
from pydantic import ValidationError

from twodiscs.model.checks import MOST_SENTENCES, InputError, parse_number
from twodiscs.model.formats import format_number
from twodiscs_paper.catalogue import STUDIES
from twodiscs_paper.configuration.mistakes import ConfigError, describe, scene_name, sentences
from twodiscs_paper.configuration.model import (
    ABOUT_PLAIN,
    BUILT_ONCE,
    DECIMAL_NUMBER,
    Model,
)
from twodiscs_paper.configuration.request import Configuration
from twodiscs_paper.configuration.scene_block import scene_request
from twodiscs_paper.configuration.schema import keys

#: The range of sides that the study of stability can take: lengths end at 1e-60 and 1e60.
SHORTEST_SIDE, LONGEST_SIDE = 1e-40, 1e40

#: The tags of numbers in YAML.
NUMBER_TAGS = {f"tag:yaml.org,2002:{kind}" for kind in ("int", "float")}


def read(path):
    """Return the mapping in the YAML file ``path``.

    Raises ``ConfigError`` if the file cannot be read or holds no mapping. The error names the line
    if the text is no YAML, if a key is given twice, and if a number is not decimal.
    """
    try:
        text = Path(path).read_text(encoding="utf-8")
        mapping = yaml.load(text.replace("\t", " ") if _is_json(text) else text, _Loader)
    except OSError as error:
        raise ConfigError(f"{path}: {error.strerror}") from None
    except yaml.MarkedYAMLError as error:
        hint = "; indent with blanks" if "\\t" in error.problem else ""
        line = error.problem_mark.line + 1  # every error of PyYAML's safe loader has this mark
        raise ConfigError(f"{path}, line {line}: {error.problem}{hint}") from None
    except UnicodeDecodeError as error:
        byte, line = error.object[error.start], error.object.count(b"\n", 0, error.start) + 1
        raise ConfigError(
            f"{path}, line {line}: save the file as UTF-8, which has no byte {byte:#x}"
        ) from None
    # A value such as the date 2001-13-41 is an error of Python, and so are very deep lists.
    except (yaml.YAMLError, ArithmeticError, LookupError, ValueError, RecursionError) as error:
        raise ConfigError(f"{path}: {error}") from None
    if not isinstance(mapping, dict):
        hint = "; twodiscs new writes one" if mapping is None else ""
        raise ConfigError(f"{path}: must hold {keys()['allowed']}, not {describe(mapping)}{hint}")
    return mapping


def _is_json(text):
    """Return whether a text is JSON, in which YAML forbids the tabs."""
    try:
        json.loads(text)
    except (ValueError, RecursionError):
        return False
    return True


class _Loader(yaml.SafeLoader):
    """YAML in which a key given twice and a number that is not decimal are mistakes.

    YAML takes the last of two equal keys. It reads 010 as 8 and 1:30 as 90.
    """

    def compose_mapping_node(self, anchor):
        node, given = super().compose_mapping_node(anchor), set()
        for key, _ in node.value:
            if isinstance(key, yaml.ScalarNode):
                if key.value in given:
                    problem = f"the key {key.value!r} is given a second time"
                    raise yaml.MarkedYAMLError(problem=problem, problem_mark=key.start_mark)
                given.add(key.value)
        return node

    def compose_scalar_node(self, anchor):
        node = super().compose_scalar_node(anchor)
        number = self.construct_object(node) if node.tag in NUMBER_TAGS else None
        is_decimal = number is None or DECIMAL_NUMBER.fullmatch(node.value)
        # A float may be a rounded integer.
        if not is_decimal or (isinstance(number, float) and parse_number(node.value) != number):
            problem = (
                f"{node.value} must be a decimal number or text in quotes: YAML reads {number}"
            )
            raise yaml.MarkedYAMLError(problem=problem, problem_mark=node.start_mark)
        return node


def load(mapping):
    """Return the ``Configuration`` of a mapping, as YAML gives it.

    Numbers may be text such as "2e9", which YAML does not take for a number. Raises ``ConfigError``
    with a sentence and a line for each mistake. It names the key, the allowed values, the given
    value and the scene.
    """
    try:
        model = Model.model_validate(mapping)
    except ValidationError as error:
        found = error.errors(include_url=False, include_context=False)
        raise ConfigError(*islice(sentences(found, mapping), MOST_SENTENCES + 1)) from None
    scenes, mistakes = [], []
    for i, block in enumerate(model.scenes):
        if block.name in [scene.name for scene in model.scenes[:i]]:
            mistakes.append(
                f"scenes[{i}].name must differ from every other scene's, not {block.name!r}"
            )
        try:
            scenes.append(scene_request(block, model.seed, model.shard_events))
        except InputError as error:
            named = scene_name(mapping, ("scenes", i))
            mistakes.append(f"scenes[{i}].{error}{named}")
    if mistakes:
        raise ConfigError(*mistakes)
    configuration = Configuration(
        model.results,
        model.seed,
        _built_once(model.shared),
        tuple(scenes),
        model.accuracy_cost.model_dump(),
    )
    _check_built_once(model.shared, configuration)
    return configuration


def _built_once(asked):
    """Return the names in ``shared`` with all that the manuscript reads, in the order of keys."""
    wanted = {*asked, *(STUDIES if "paper" in asked else ())}
    return tuple(name for name in BUILT_ONCE if name in wanted)


def _check_built_once(asked, configuration):
    """Raise ``ConfigError`` if the scenes do not allow a study or a document."""
    main = configuration.main
    for name in asked:
        if main is None and name in ABOUT_PLAIN:
            raise ConfigError(
                f"shared must leave out {name!r} if every scene has effects, because it is about "
                "a scene without effects"
            )
    in_range = main is None or all(SHORTEST_SIDE <= side <= LONGEST_SIDE for side in main.box.sides)
    if "stability" in configuration.shared and not in_range:
        raise ConfigError(
            f"shared must leave out 'stability' unless the sides of the scene {main.name!r} "
            f"lie between {format_number(SHORTEST_SIDE, 'g')} and "
            f"{format_number(LONGEST_SIDE, 'g')}, because it uses much smaller radii"
        )


def check_results(results, home):
    """Raise ``ConfigError`` unless ``results`` may be a folder beside the sources at ``home``."""
    node, path = keys()["properties"]["results"], Path(results).resolve()
    home = Path(home).resolve()
    inside = path.is_relative_to(home)
    a_file = any(folder.exists() and not folder.is_dir() for folder in (path, *path.parents))
    if a_file or (inside and not re.match(node["pattern"], path.relative_to(home).as_posix())):
        raise ConfigError(f"results must be {node['allowed']}, not {results!r}")


def or_exit(function, *arguments):
    """Return ``function(*arguments)``, or end the program with the sentence of a mistake."""
    try:
        return function(*arguments)
    except InputError as error:
        about = "Configuration: " if isinstance(error, ConfigError) else ""
        sys.exit("\n".join(f"{about}{sentence}" for sentence in str(error).split("\n")))
