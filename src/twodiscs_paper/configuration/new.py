"""``twodiscs new``: a commented configuration. It needs the standard library only."""

import os
import re
import shlex
from pathlib import Path

from twodiscs.model.checks import InputError, writing_to

#: The file that ``twodiscs new`` writes: keys with a default are comments, RUN is the command and
#: FOLDER the folder of the results.
NEW = """\
# RUN
# builds mean times at each radius, their figures, a check against the exact theory, and the report
# FOLDER/report.html. For more of a box, such as its volume, name it in `watch`. By name you get:
# RUN explorer    a page in which the discs move and their events are counted
# RUN tails       a study; twodiscs run --help lists all targets
# RUN all         the report, with the origin of every file

# Use any unit of length. Mass 1 of disc 1 and a total energy of 1/2 set the speed to 1, so a time
# has the same number as a length.

results: FOLDER # the folder of everything that is built
# Another seed repeats every simulation independently.
# seed: 1908
# Documents and studies beside the scenes; [paper, report] for the manuscript and all studies.
# shared: [report]

scenes:
  - name: mine # also the name of its folder in FOLDER
    box: {width: 1.5, height: 1.0}
    radii: [0.1, 0.2, 0.3] # without radii there is a grid up to the largest radius that fits
    # The relative error of mean times: draft is 1e-2, paper 3e-4, reference 1e-4; or a number.
    accuracy: draft
    # Only mean times without this line; also volume, areas, hop_histogram; true for everything.
    # watch: {mean_times: true, trajectory: 0.24}
    # Also mass_ratio, periodic: [x], field, friction, moment_of_inertia. With a depth of the box
    # the discs are balls.
    # effects: {radius_ratio: 0.5}
    # Random configurations for volume and areas, at each radius.
    # monte_carlo: {samples: 1e7}
"""


def new(path):
    """Write a commented configuration to ``path``; raise ``InputError`` if there is a file.

    The name of its folder of results has the name of the file, so that it is not the folder of
    another configuration.
    """
    run = f"twodiscs run {shlex.quote(str(path))}"
    folder = "results-" + re.sub("[^A-Za-z0-9_.-]", "-", Path(path).stem)[:100]
    if os.path.lexists(path):
        raise InputError(f"{path} exists already and is not overwritten")
    with writing_to(path) as new_path:
        # Both at once, because the name of the file may have these words, too.
        text = re.sub("RUN|FOLDER", lambda word: {"RUN": run, "FOLDER": folder}[word[0]], NEW)
        Path(new_path).write_text(text, encoding="utf-8", newline="\n")
    print(f"{path} is written. To build it: {run}")
