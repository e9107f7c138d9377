# The name of a figure is a target: the figure in every scene that has it. The name of a study is a target, too:
# its tables and figures.


rule animation:
    """The animations of all scenes that have a trajectory."""
    input:
        [CONFIGURATION.animation(scene) for scene in CONFIGURED],


rule model:
    """The billiard."""
    input:
        figure_files("model"),


rule hopping_trajectory:
    """Hopping dynamics."""
    input:
        figure_files("hopping_trajectory"),


rule configuration_space:
    """Configuration space."""
    input:
        figure_files("configuration_space"),


rule volume:
    """Volume of configuration space."""
    input:
        figure_files("volume"),


rule vertical_hop_area:
    """Area of vertical hops."""
    input:
        figure_files("vertical_hop_area"),


rule horizontal_hop_area:
    """Area of horizontal hops."""
    input:
        figure_files("horizontal_hop_area"),


rule collision_area:
    """Area of disc collisions."""
    input:
        figure_files("collision_area"),


rule wall_area:
    """Areas of wall hits."""
    input:
        figure_files("wall_area"),


rule mean_hop_time:
    """Mean times between hops."""
    input:
        figure_files("mean_hop_time"),


rule mean_collision_time:
    """Mean time between disc collisions."""
    input:
        figure_files("mean_collision_time"),


rule mean_wall_time:
    """Mean times between wall hits."""
    input:
        figure_files("mean_wall_time"),


rule pressure:
    """Pressures and virials."""
    input:
        figure_files("pressure"),


rule hop_histogram:
    """Times between hops."""
    input:
        figure_files("hop_histogram"),


rule largest_radius:
    """The largest radius."""
    input:
        figure_files("largest_radius"),


rule integration_regimes:
    """Regimes of the integration."""
    input:
        figure_files("integration_regimes"),


rule surface_shell:
    """Shells around surfaces."""
    input:
        figure_files("surface_shell"),


rule accuracy_cost:
    """The cost of a digit by each method."""
    input:
        CONFIGURATION.study("accuracy_cost"),


rule effects:
    """How each effect changes the mean times, and its cost."""
    input:
        CONFIGURATION.study("effects"),


# The others are about a scene without effects.
if MAIN:

    rule errata:
        """Which formulas of the source are right, with the evidence."""
        input:
            CONFIGURATION.study("errata"),

    rule stability:
        """How accurate each method is in numerically hard cases."""
        input:
            CONFIGURATION.study("stability"),

    rule tails:
        """How probable long intervals are."""
        input:
            CONFIGURATION.study("tails"),

    rule distributions:
        """How intervals between hops are distributed."""
        input:
            CONFIGURATION.study("distributions"),

    rule passages:
        """Which hops are passages, and diffusion by them."""
        input:
            CONFIGURATION.study("passages"),

    rule thresholds:
        """The laws where a hop becomes blocked."""
        input:
            CONFIGURATION.study("thresholds"),

    rule more_discs:
        """Mean times of three to 64 discs."""
        input:
            CONFIGURATION.study("more_discs"),
