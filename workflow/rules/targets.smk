# A figure's name is a target: that figure, in every scene that calls for it. A study's name is one, too: its
# tables and figures.


rule animation:
    """The animations of all scenes that have a trajectory."""
    input:
        [FILES.animation(scene) for scene in CONFIGURED],


rule model:
    """The billiard."""
    input:
        drawn("model"),


rule hopping_trajectory:
    """Hopping dynamics."""
    input:
        drawn("hopping_trajectory"),


rule configuration_space:
    """Configuration space."""
    input:
        drawn("configuration_space"),


rule volume:
    """Volume of configuration space."""
    input:
        drawn("volume"),


rule vertical_hop_area:
    """Area of vertical hops."""
    input:
        drawn("vertical_hop_area"),


rule horizontal_hop_area:
    """Area of horizontal hops."""
    input:
        drawn("horizontal_hop_area"),


rule collision_area:
    """Area of disc collisions."""
    input:
        drawn("collision_area"),


rule wall_area:
    """Areas of wall hits."""
    input:
        drawn("wall_area"),


rule mean_hop_time:
    """Mean times between hops."""
    input:
        drawn("mean_hop_time"),


rule mean_collision_time:
    """Mean time between disc collisions."""
    input:
        drawn("mean_collision_time"),


rule mean_wall_time:
    """Mean times between wall hits."""
    input:
        drawn("mean_wall_time"),


rule pressure:
    """Pressures and virials."""
    input:
        drawn("pressure"),


rule hop_histogram:
    """Times between hops."""
    input:
        drawn("hop_histogram"),


rule largest_radius:
    """The largest radius."""
    input:
        drawn("largest_radius"),


rule integration_regimes:
    """Regimes of the integration."""
    input:
        drawn("integration_regimes"),


rule surface_shell:
    """Shells around surfaces."""
    input:
        drawn("surface_shell"),


rule accuracy_cost:
    """What a digit costs by each method."""
    input:
        FILES.study("accuracy_cost"),


rule effects:
    """What each effect does to the mean times, and what it costs."""
    input:
        FILES.study("effects"),


# The others are about a scene without effects.
if MAIN:

    rule errata:
        """Which formulas of the source are right, and what decides it."""
        input:
            FILES.study("errata"),

    rule stability:
        """How accurate each method is in numerically hard cases."""
        input:
            FILES.study("stability"),

    rule tails:
        """How probable long intervals are."""
        input:
            FILES.study("tails"),

    rule distributions:
        """How intervals between hops are distributed."""
        input:
            FILES.study("distributions"),

    rule passages:
        """Which hops are passages, and diffusion by them."""
        input:
            FILES.study("passages"),

    rule thresholds:
        """The laws where a hop becomes blocked."""
        input:
            FILES.study("thresholds"),

    rule long_runs:
        """`stability` of the dynamics over ten times the events."""
        input:
            FILES.study("long_runs"),

    rule more_discs:
        """Mean times of three, four and eight discs."""
        input:
            FILES.study("more_discs"),
