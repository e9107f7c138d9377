"""The tables of a scene."""

from twodiscs.comparison.tables import (
    COUNT,
    LENGTH,
    NUMBER,
    RATE,
    SECONDS,
    TEXT,
    TIME,
    TRUTH,
    Column,
    Table,
)

#: Units that depend on the row or on the quantity.
SEE_QUANTITY = Column(float, "see quantity")
AS_QUANTITY = Column(float, "as quantity")
VOLUME, AREA = Column(float, "length⁴"), Column(float, "length³")


class Grid(Table):
    """One row per radius: what the scene computes."""

    radius: LENGTH
    regime: TEXT
    """all-hops, vertical-hops, horizontal-hops or no-hops"""
    ergodic_components: COUNT
    largest_radius: LENGTH
    """radius at which the discs have no room left"""


class Theory(Table):
    """One row per radius and quantity: the exact values."""

    radius: LENGTH
    quantity: TEXT
    """volume, <event>_area or <event>_time"""
    exact: Column(float, "length⁴, length³ or time")
    """exact value; no time where the event is impossible"""


class Sampled(Table):
    """What Monte Carlo finds of one quantity at one radius, beside the exact value."""

    radius: LENGTH
    quantity: TEXT
    """volume, or <event>_area"""
    method: TEXT
    """
    monte_carlo: rejection from the prism; conditioned: draws that keep to where the discs fit,
    where less than one in 64 of the prism does; areas by a thin shell
    """
    exact: AS_QUANTITY
    """exact value"""
    estimate: AS_QUANTITY
    """measure × hits/samples; empty without a hit"""
    stderr: AS_QUANTITY
    """binomial standard error; empty below 100 hits or misses"""
    z: NUMBER
    samples: COUNT
    """configurations drawn from the prism, or proposed"""
    hits: COUNT
    """configurations that count"""
    epsilon: LENGTH
    """
    thickness of the shell in configuration space (to either side, for a hop), × √mass where masses
    differ; empty for the volume and, without effects, for any_wall_area = 4 (right + top), which
    joins two shells
    """
    expectation: AS_QUANTITY
    """exact expectation of the estimate; z is against it"""
    bias: AS_QUANTITY
    """expectation − exact: what the thickness of the shell adds"""
    status: TEXT
    """
    sampled; too-few: under 100 hits or misses, no honest error; none-seen; impossible: blocked by
    geometry
    """
    test: TEXT


class Volume(Sampled):
    """
    One row per radius: the volume of configuration space, exact and by Monte Carlo. In a field it
    is weighted with the invariant density; for balls it is in length⁶.
    """

    exact: VOLUME
    estimate: VOLUME
    stderr: VOLUME
    expectation: VOLUME
    bias: VOLUME


class Areas(Sampled):
    """
    One row per radius and event: the area of the event's surface, exact and by Monte Carlo. A shell
    of finite thickness is not a surface, so its exact expectation has a column. In a field areas
    are weighted as the flux is; for balls they are in length⁵.
    """

    exact: AREA
    estimate: AREA
    stderr: AREA
    expectation: AREA
    bias: AREA


class MeanTimes(Table):
    """
    One row per radius and event: the mean time between events, exact and by dynamics. What starts
    anywhere saw of a hop whose row is from a strip is compared in check.csv.
    """

    radius: LENGTH
    event: TEXT
    """the event"""
    exact: TIME
    """exact mean time; empty where the event is impossible"""
    estimate: TIME
    """
    copies · T/(share · ⟨N⟩) with ⟨N⟩ = count/replicas, in a strip with its mean over strata of the
    starts; empty where none was seen
    """
    stderr: TIME
    """
    standard error from the spread between replicas, in a strip from that within strata; empty when
    too few to be honest
    """
    z: NUMBER
    """
    standard normal deviate, positive when the time is too long; of the mean count, which is
    unbiased for every T
    """
    count: COUNT
    """events counted in all replicas; for walls with all that symmetry makes equal"""
    ergodic_components: COUNT
    replicas: COUNT
    """independent trajectories"""
    duration: TIME
    """length T of a replica"""
    relative_stderr: NUMBER
    """stderr/estimate"""
    target: NUMBER
    """relative standard error asked for"""
    status: TEXT
    """
    reached: the target; budget: stopped by the event budget; too-few: under 100 replicas or 100
    effective events (clusters count once), no honest error; none-seen; impossible: blocked by
    geometry
    """
    bound: TIME
    """
    where none was seen: lower bound on the mean time at 95 %, allowing for clusters of four events
    """
    test: TEXT
    starts: TEXT
    """
    invariant: anywhere, so that dynamics alone gives the time; strip: next to the surface of a rare
    hop, in an exactly known share of configuration space, so that the share is theory's and the
    flux through the surface is tested
    """
    share: NUMBER
    """share of configuration space that starts come from"""
    copies: COUNT
    """
    events that count as one, on average: of a wall, the pairs of a disc and a wall that are equal
    by symmetry and within reach
    """


class HopHistogram(Table):
    """One row per radius and bin: intervals between hops, from one crossing to the next."""

    radius: LENGTH
    event: TEXT
    """the hop"""
    bins: TEXT
    """equal, as wide as τ/16 or so; wide: the same intervals, in bins that widen with time"""
    left: TIME
    """lower edge of the bin"""
    right: TIME
    """upper edge of the bin"""
    count: COUNT
    """intervals in the bin"""
    density: RATE
    """count/(intervals × width of the bin)"""
    stderr: RATE
    """
    its standard error from the spread between independent chains, each of 256 successive intervals;
    empty for an empty bin
    """
    intervals: COUNT
    """intervals in all, those beyond the last bin included"""
    exact_mean: TIME
    """exact mean interval"""
    mean: TIME
    """mean of all intervals"""
    mean_stderr: TIME
    """its standard error from the spread between independent chains; empty below 100"""
    z: NUMBER


class Check(Table):
    """One row per comparison with the exact theory."""

    comparison: TEXT
    """volume, area, mean_time, hop_interval, sum_rule, and over all radii z_mean and z_spread"""
    quantity: TEXT
    """what is compared"""
    radius: LENGTH
    """radius of the discs; empty for a statement on all radii"""
    method: TEXT
    """monte_carlo, conditioned, dynamics, strip (starts next to a rare hop) or intervals"""
    exact: SEE_QUANTITY
    """exact value; for an area, the shell's expectation"""
    estimate: SEE_QUANTITY
    """estimate; empty where there is none"""
    stderr: SEE_QUANTITY
    """its standard error; empty where there is none"""
    z: NUMBER
    p: NUMBER
    """probability of a |z| as large, or larger, if all is right"""
    bound: NUMBER
    """largest |z| that passes"""
    passed: TRUTH
    """whether |z| ≤ bound; empty where nothing can be compared"""
    independent: TRUTH
    """
    whether the row could fail and follows from no other row: false for what is certain, for what is
    put together from other rows (any_wall_area of two shells, the sum rule) and for z_mean and
    z_spread
    """
    status: TEXT
    """status of the estimate in its own table"""
    test: TEXT


class Cost(Table):
    """One row per job: what it took. The only table of a scene that differs from run to run."""

    stage: TEXT
    """monte_carlo, dynamics or intervals; total of the jobs that were forecast"""
    radius: LENGTH
    events: COUNT
    """events simulated, configurations or intervals drawn"""
    seconds: SECONDS
    """processor time of the work itself: compiled code is loaded, Python has started"""
    forecast_seconds: SECONDS
    """the same, forecast before the run; empty without one"""
    ratio: NUMBER
    """seconds/forecast_seconds"""


class Trajectory(Table):
    """One row an event of one trajectory, in order: the state at the event."""

    time: TIME
    """time of the event"""
    x1: LENGTH
    """disc 1, from the centre of the box"""
    y1: LENGTH
    """disc 1, from the centre of the box"""
    x2: LENGTH
    """disc 2, from the centre of the box"""
    y2: LENGTH
    """disc 2, from the centre of the box"""
    event: TEXT
    """what happens"""
    z1: LENGTH
    """ball 1; empty in the plane"""
    z2: LENGTH
    """ball 2; empty in the plane"""


class Forecast(Table):
    """One row per scene and stage: what the configuration is going to take on this machine."""

    scene: TEXT
    """the scene; all for what is made once, and for the total"""
    stage: TEXT
    """
    of a scene: monte_carlo, dynamics, intervals, tables, figures, total; of all: compile and what
    the key shared names, most of it as round figures, and the total
    """
    radius: LENGTH
    """radius of one job; empty for the sum over a stage"""
    jobs: COUNT
    """number of jobs"""
    events: COUNT
    """wall and disc events, samples, or intervals"""
    seconds: SECONDS
    """processor time of the work itself, compiled code loaded"""
    startup: SECONDS
    """time to start the jobs, and of those that only start"""
    cores: COUNT
    """cores to share the work"""
    wall_clock: SECONDS
    """(seconds + startup)/cores, or over the jobs if fewer"""


#: The tables of a scene, {name: table}.
SCENE_TABLES = {
    table.name(): table
    for table in (Grid, Theory, Volume, Areas, MeanTimes, HopHistogram, Check, Cost, Trajectory)
}
