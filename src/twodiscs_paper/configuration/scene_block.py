"""Default radii, events and jobs of a scene: they follow from its block and its box.

A mistake raises ``InputError`` with the key in the block of the scene.
"""

from twodiscs.model.checks import MOST_DISCS_WITH_VOLUME, NAMED_ERRORS, InputError
from twodiscs.model.events import EVENTS, HOPS
from twodiscs.model.formats import format_number
from twodiscs.model.many_geometry import has_volume
from twodiscs.model.scene import Box
from twodiscs.theory.exact import MIN_FRACTION, events_per_interval, free_fraction
from twodiscs_paper.configuration.model import Accuracy, Histogram, Watch
from twodiscs_paper.configuration.radii import even_radii, radii
from twodiscs_paper.configuration.request import RequestedQuantities, SceneRequest

#: Radii of the default hop histograms, over the radius at which the hop becomes blocked.
HISTOGRAM_FRACTIONS = (0.1, 0.3, 0.5, 0.7)

#: Radius of the default trajectory over the shorter side: both hops are open, one hop is rare.
TRAJECTORY_FRACTION = 0.24

#: The radius of the default trajectory of a scene with effects, over the radius at which the first
#: hop becomes blocked. In a field this hop is rare far below that radius.
BELOW_THRESHOLD = 0.5

#: The default grid of a scene with effects ends at this fraction of its largest radius.
LAST_FRACTION = 0.9

#: The fewest intervals of a hop that are recorded.
LEAST_INTERVALS = 2**16


def scene_request(block, seed, shard_events):
    """Return the ``SceneRequest`` of a ``SceneBlock``."""
    try:
        box = Box(**block.box.model_dump(), **block.effects.model_dump(), discs=block.discs)
    except InputError as error:
        raise InputError(f"effects: {error}") from None
    radii = _radii(block.radii, box)
    scene = box.scene(radii[0])
    watch = block.watch
    if isinstance(watch, bool):
        watch = _everything(scene) if watch else Watch()
    histogram = _histogram(watch.hop_histogram, box, scene)
    quantities = RequestedQuantities(
        volume=watch.volume,
        areas=_events(watch.areas, scene, "watch.areas"),
        mean_times=_events(watch.mean_times, scene, "watch.mean_times"),
        hop_histogram=histogram.pop("radii"),
        trajectory=_trajectory(watch.trajectory, box, scene),
    )
    _check_quantities(quantities, box, radii, histogram)
    return SceneRequest(
        name=block.name,
        box=box,
        radii=radii,
        quantities=quantities,
        monte_carlo=block.monte_carlo.model_dump(),
        dynamics={
            "accuracy": _accuracy(block.accuracy, quantities.mean_times),
            "event_budget": block.event_budget,
        },
        histogram=histogram,
        seed=seed,
        shard_events=shard_events,
    )


def _radii(asked, box):
    """Return the radii of a scene, from a list or from the block of a grid."""
    if isinstance(asked, list):
        return _checked(asked, box, "radii")
    largest_disc = max(1, box.radius_ratio)
    smallest = asked.smallest or _short(box.shortest / largest_disc / 100)
    _checked([smallest], box, "radii.smallest")
    include = _checked(asked.include or [], box, "radii.include")
    try:
        if not box.is_plain:
            grid = even_radii(smallest, LAST_FRACTION * box.last_radius, asked.count)
        else:
            grid = radii(box.width, box.height, smallest, asked.count)
    except InputError as error:
        raise InputError(f"radii: {error}") from None
    return _checked({*grid, *include}, box, "radii")


def _everything(scene):
    """Return all quantities that a scene has and that can be computed by default."""
    can_hop = bool(_hops(scene))
    can_sample = scene.discs == 2 or has_volume(scene)
    return Watch(
        volume=can_sample,
        areas=can_sample,
        mean_times=True,
        hop_histogram=can_hop and _is_ergodic(scene) and scene.discs == 2,
        trajectory=can_hop,
    )


def _hops(scene):
    return [hop for hop in HOPS if hop in scene.events]


def _is_ergodic(scene):
    return scene.moment_of_inertia is None or scene.friction > 0


def _histogram(asked, box, scene):
    """Return the settings of the histogram, with its radii (none if it is off) and its event."""
    hops = _hops(scene)
    block = Histogram(radii=asked) if isinstance(asked, list) else asked
    if isinstance(asked, bool):
        block = Histogram()
    settings = {
        "radii": (),
        "intervals": block.intervals,
        "event_budget": block.event_budget,
        "event": block.event or next(iter(hops), None),
    }
    if asked is False:
        return settings
    if not _is_ergodic(scene):
        raise InputError(
            "watch.hop_histogram must be false, because rough discs in a box are not ergodic and "
            "their intervals have no exact mean; watch mean_times instead"
        )
    if not hops:
        raise InputError(
            "watch.hop_histogram must be false, because on these periodic axes discs cannot hop"
        )
    event = settings["event"]
    if event not in hops:
        raise InputError(
            f"watch.hop_histogram.event must be a hop of this scene, such as {hops[0]}, "
            f"not {event!r}"
        )
    threshold = box.threshold(event)
    default = [_short(fraction * threshold) for fraction in HISTOGRAM_FRACTIONS]
    radii = _checked(block.radii or default, box, "watch.hop_histogram")
    for radius in radii:
        if not box.scene(radius).is_possible(event):
            raise InputError(
                f"watch.hop_histogram must keep to radii below {threshold!r}, where {event} is "
                f"possible, not {radius!r}"
            )
    return settings | {"radii": radii}


def _trajectory(asked, box, scene):
    """Return the radius of the trajectory, or None."""
    if asked is False:
        return None
    if not _hops(scene):
        raise InputError(
            "watch.trajectory must be false, because on these periodic axes discs cannot hop"
        )
    if asked is not True:
        radius = asked
    elif not box.is_plain:
        radius = _short(BELOW_THRESHOLD * min(map(box.threshold, _hops(scene))))
    else:
        radius = _short(TRAJECTORY_FRACTION * box.shortest)
    return _checked([radius], box, "watch.trajectory")[0]


def _events(asked, scene, path):
    """Return the requested events in the order of ``EVENTS``, if the scene has all of them."""
    if isinstance(asked, bool):
        return scene.events if asked else ()
    for event in asked:
        if event not in scene.events:
            raise InputError(
                f"{path} must hold events of this scene, {', '.join(scene.events)}, not {event!r}"
            )
    return tuple(event for event in EVENTS if event in asked)


def _check_quantities(quantities, box, radii, histogram):
    """Raise ``InputError`` for quantities that cannot be computed."""
    if not quantities.names:
        known = ", ".join(Watch.model_fields)
        raise InputError(f"watch must ask for at least one of {known}, not for nothing")
    for name in ("volume", "areas"):
        if getattr(quantities, name) and box.discs > MOST_DISCS_WITH_VOLUME:
            raise InputError(
                f"watch.{name} must be false for more than {MOST_DISCS_WITH_VOLUME} discs, because "
                f"Monte Carlo finds almost no configuration of {box.discs} discs"
            )
    if quantities.mean_times:
        try:
            box.scene(radii[-1]).require_followable()
        except InputError as error:
            raise InputError(f"radii: {error}") from None
    for radius in () if box.discs > 2 else quantities.hop_histogram:
        events = events_per_interval(box.scene(radius), histogram["event"])
        if events * LEAST_INTERVALS > histogram["event_budget"]:
            budget = format_number(histogram["event_budget"], "g")
            raise InputError(
                f"watch.hop_histogram must keep to radii at which {LEAST_INTERVALS} intervals fit "
                f"into its event_budget, {budget}; at {radius!r} each one takes {events:.2g} events"
            )


def _accuracy(asked, events):
    """Return {event: requested relative standard error}."""
    if not isinstance(asked, Accuracy):
        asked = Accuracy(default=asked)
    errors = {event: getattr(asked, event) or asked.default for event in sorted(events)}
    return {event: NAMED_ERRORS.get(error, error) for event, error in errors.items()}


def _checked(radii, box, path):
    """Return radii as an ascending tuple if all of them fit and none appears twice."""
    found = set()
    for radius in radii:
        try:
            scene = box.scene(radius)
        except InputError as error:
            raise InputError(f"{path}: {error}") from None
        if scene.family == "effects" and (share := free_fraction(scene)) < MIN_FRACTION:
            effects = ", ".join(f"{name} {value}" for name, value in box.effects.items())
            raise InputError(
                f"{path}: with {effects}, radius {radius!r} leaves the discs {share:.1g} of all "
                f"positions, and at least {MIN_FRACTION:g} is needed"
            )
        if radius in found:
            raise InputError(f"{path} must hold every radius once, but holds {radius!r} twice")
        found.add(radius)
    return tuple(sorted(radii))


def _short(value):
    return float(f"{value:.3g}")
