"""The run that makes a point: that of a stage, for a scene."""

from twodiscs.model.radii import key, stream_seed

#: The function of the face that does the work of a stage.
KINDS = {"monte_carlo": "sample", "dynamics": "simulate", "intervals": "intervals"}


def run_of(stage, scene, settings):
    """Return the run of a ``stage`` for a ``Scene``: monte_carlo, dynamics or intervals.

    ``settings`` are the arguments of its function of the face. Only the module of the stage is
    imported.
    """
    given = dict(settings)
    seed = stream_seed(given.pop("seed"), given.pop("name"), stage, key(scene.radius))
    if stage == "monte_carlo":
        from twodiscs.sampling.montecarlo import SamplingRun

        return SamplingRun(scene, seed=seed, **given)
    if stage == "dynamics":
        from twodiscs.dynamics.counting import CountingRun

        return CountingRun(scene, given["error"], given["budget"], seed)
    from twodiscs.dynamics.intervals import IntervalRun

    return IntervalRun(scene, given["hop"], given["number"], seed, given["budget"])
