"""Forecasts against truth: the processor time of runs, and the error that a budget reaches.

    python tests/forecast_truth.py

prints a line for each run, and how many ratios are near 1. It takes some minutes, most of them to
compile. Processor time depends on what else the machine does, so no test decides by it.
"""

import time
import warnings

import twodiscs as td
from twodiscs.comparison import cost
from twodiscs.dynamics.runs import CountingRun

#: The scenes: the keywords of ``td.Scene`` in a box of 1.5 × 1.
SCENES = [
    {"radius": 0.05},
    {"radius": 0.2},
    {"radius": 0.2499},
    {"radius": 0.3},
    {"radius": 0.374},
    {"radius": 0.38},
    {"radius": 0.2, "mass_ratio": 4.0},
    {"radius": 0.12, "radius_ratio": 1.5},
    {"radius": 0.15, "periodic": "x"},
    {"radius": 0.15, "periodic": "xy"},
    {"radius": 0.2, "field": 0.5},
    {"radius": 0.2, "field": 1.5},
    {"radius": 0.2, "moment_of_inertia": 0.5},
    {"radius": 0.2, "friction": 1.0},
    {"radius": 0.2, "depth": 1.0},
    {"radius": 0.1, "discs": 3},
    {"radius": 0.2, "discs": 3},
    {"radius": 0.05, "discs": 16},
    {"radius": 0.05, "discs": 16, "friction": 1.0},
    {"radius": 0.015, "discs": 200},
]

#: Processor seconds that the runs of a scene take, by the forecast, and that of a budget.
SECONDS, OF_BUDGET = (0.15, 0.5, 1.5), 0.5


def ratios(keywords):
    """Return the ratios true/forecast of times, and of the error at a budget, of a scene."""
    scene = td.Scene(1.5, 1.0, **keywords)
    target = dict.fromkeys(scene.events, 1.0)
    pilots = cost.pilots(CountingRun(scene, target, None, 0))
    c = td.Cost(scene, [], [], pilots).seconds(1e-6) * 1e-12
    found = []
    for seconds in SECONDS:
        error = min(1.0, (c / seconds) ** 0.5)
        said = td.Cost(scene, [], [], pilots).seconds(error)
        start = time.process_time()
        td.simulate(scene, error, seed=1)
        taken = time.process_time() - start
        found.append(taken / said)
        print(f"{keywords} error {error:.1e}: {said:.2f} s said, {taken:.2f} s, {taken / said:.2f}")
    smaller = dict.fromkeys(scene.events, min(1.0, (c / OF_BUDGET) ** 0.5 / 4))
    whole = cost.forecast(CountingRun(scene, smaller, None, 0), pilots)
    budget = int(whole.events * OF_BUDGET / whole.seconds)
    said = cost.forecast(CountingRun(scene, smaller, budget, 0), pilots).reached
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", td.AccuracyWarning)
        md = td.simulate(scene, smaller, budget=budget, seed=1)
    worst = max(said, key=lambda event: said[event])
    reached = md[f"{worst}_time"].relative_stderr
    ratio = reached / said[worst] if reached else float("nan")
    print(
        f"{keywords} budget {budget:.1e}: {worst} {said[worst]:.1e} said, {ratio:.2f}", flush=True
    )
    return found, ratio


def main():
    """Print all ratios, and how many are within 1.5, 2 and 1.2."""
    td.simulate(td.Scene(1.5, 1.0, 0.2), 1.0)  # imports what a run takes
    times, errors = [], []
    for keywords in SCENES:
        of_times, of_error = ratios(keywords)
        times.append(max(max(r, 1 / r) for r in of_times))
        errors.append(max(of_error, 1 / of_error))
    for limit in (1.5, 2):
        print(f"times within {limit}: {sum(t <= limit for t in times)} of {len(times)} scenes")
    print(f"errors at a budget within 1.2: {sum(e <= 1.2 for e in errors)} of {len(errors)} scenes")


if __name__ == "__main__":
    main()
