"""The picture of the rules in the report, drawn of the graph that Snakemake prints.

    python docs/make/rules.py

It writes ``workflow/report/rules.svg``, which the report of every build shows.
"""

import re
import subprocess
import sys
from graphlib import TopologicalSorter
from pathlib import Path

from jinja2 import Environment

HOME = Path(__file__).resolve().parents[2]
PICTURE = "workflow/report/rules.svg"

#: Pixels of the graph: from column to column, from row to row, width and height of a rule.
ACROSS, DOWN, WIDE, HIGH = 136, 62, 126, 24

SVG = """\
<svg class="graph" id="rules" viewBox="0 0 {{ width }} {{ height }}" role="img"
 aria-label="Graph of the rules of the workflow">
<defs><marker id="head" viewBox="0 0 6 6" refX="5" refY="3" markerWidth="7" markerHeight="7"\
 orient="auto"><path d="M0,0 L6,3 L0,6 Z"/></marker></defs>
{% for (x, y), (u, v) in arrows %}
<path class="arrow" marker-end="url(#head)"\
 d="M{{ x }},{{ y }} C{{ x }},{{ y + 50 }} {{ u }},{{ v - 60 }} {{ u }},{{ v - high // 2 }}"/>
{% endfor %}
{% for name, (x, y) in rules.items() %}
<rect x="{{ x - wide // 2 }}" y="{{ y - high // 2 }}" width="{{ wide }}" height="{{ high }}" rx="5"\
/>
<text x="{{ x }}" y="{{ y }}">{{ name }}</text>
{% endfor %}
</svg>
"""


def direct(feeds):
    """Return ``feeds`` without the arrows that a chain of others makes up for."""

    def reached(rule):
        return {below for next_rule in feeds[rule] for below in ({next_rule} | reached(next_rule))}

    return {
        rule: [later for later in below if not any(later in reached(o) for o in below)]
        for rule, below in feeds.items()
    }


def rules(dot):
    """Return the graph of rules that ``snakemake --rulegraph`` says, a text, placed in rows.

    {"rules": {name: (x, y)}, "arrows": [((x, y), (x, y))], "width": …, "height": …, …} in pixels.
    """
    names = dict(re.findall(r'(\d+)\[label = "(\w+)"', dot))
    feeds = {name: [] for name in sorted(names.values())}
    for source, target in sorted(re.findall(r"(\d+) -> (\d+)", dot)):
        if source != target:  # a study that reads another one
            feeds[names[target]].append(names[source])
    row = {}
    for name in TopologicalSorter(feeds).static_order():
        row[name] = max((row[source] + 1 for source in feeds[name]), default=0)
    lines = [[n for n in feeds if row[n] == i] for i in range(max(row.values()) + 1)]
    width = ACROSS * max(map(len, lines))
    places = {}
    for i, line in enumerate(lines):
        # Each rule as near as may be to what it reads.
        line.sort(key=lambda name: sum(places[s][0] for s in feeds[name]) / (len(feeds[name]) or 1))
        for j, name in enumerate(line):
            places[name] = (round((j + 0.5) * width / len(line)), DOWN * i + HIGH)
    return {
        "arrows": [(places[s], places[t]) for t, some in direct(feeds).items() for s in some],
        "height": DOWN * (len(lines) - 1) + 2 * HIGH,
        "rules": places,
        "width": width,
        "wide": WIDE,
        "high": HIGH,
    }


def picture(dot):
    """Return the picture of a graph of rules that ``snakemake --rulegraph`` says."""
    template = Environment(trim_blocks=True, lstrip_blocks=True).from_string(SVG)
    return template.render(rules(dot)) + "\n"


def graph(folder=HOME):
    """Return what ``snakemake --rulegraph`` says in a ``folder``, of everything."""
    words = [
        sys.executable,
        "-m",
        "snakemake",
        "--rulegraph",
        "dot",
        "--nolock",
        "--forceall",
        "all",
    ]
    run = subprocess.run(words, cwd=folder, check=True, capture_output=True, text=True)
    return run.stdout


if __name__ == "__main__":
    (HOME / PICTURE).write_text(picture(graph()), encoding="utf-8", newline="\n")
