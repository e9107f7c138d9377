"""The statements of the source, formula by formula, with the correction of each wrong one.

Every displayed formula that can be checked is a ``Statement``, in the order of the source, and so
are a few claims in its text. ``errata`` decides whether a statement is right.
"""

from collections.abc import Callable
from dataclasses import dataclass

from mpmath import mp, mpf

from twodiscs_paper import reference
from twodiscs_paper.errata import published
from twodiscs_paper.reference import QUANTITIES, MpScene, largest_radius, mean_time

#: The regimes of formulas: boxes and radii (width, height, radius). The first is reported.
REGIMES = {
    "all-hops": ((1.5, 1.0, 0.2), (1.5, 1.0, 0.05), (1.5, 1.0, 0.24), (3.0, 1.0, 0.1)),
    "vertical-hops": ((1.5, 1.0, 0.3), (1.5, 1.0, 0.26), (1.5, 1.0, 0.37), (3.0, 1.0, 0.4)),
    "no-hops": ((1.5, 1.0, 0.38), (1.5, 1.0, 0.376), (1.5, 1.0, 0.3835), (1.2, 1.0, 0.32)),
}

#: Boxes and radii for statements that do not depend on the radius and are reported without one.
GENERAL = ((1.5, 1.0, 0.2), (1.5, 1.0, 0.3), (1.5, 1.0, 0.38))

#: A limit: its boxes (width, height), the radius that is approached, and from which side.
LIMITS = {
    "no radius": (((1.5, 1.0), (3.0, 1.0)), lambda q: mpf(0), +1),
    "h/4": (((1.5, 1.0), (3.0, 1.0)), lambda q: q.h / 4, +1),
    "w/4": (((1.5, 1.0), (1.2, 1.0)), lambda q: q.w / 4, -1),
    "largest radius, w < 2h": (((1.5, 1.0), (1.2, 1.0)), largest_radius, -1),
    "largest radius, w > 2h": (((3.0, 1.0), (2.5, 1.0)), lambda q: q.h / 2, -1),
}

#: The distance from the limiting radius at which a limit is evaluated.
LIMIT_STEP = mpf("1e-30")

#: Printed and true are the same if their ratio is 1 to this accuracy.
SAME = mpf("1e-20")


# Claims that are no formulas ----------------------------------------------------------------------


def cylinder_is_round_a_line(q):
    """Whether the prism ends within √2 r of the diagonal X = Y, x = y = 0.

    Discs overlap at all (X, Y) = (s, −s), x = y = 0, which lie √2 s away from that diagonal.
    """
    return min(q.a, q.b) <= q.r


def contact_is_zero(q):
    """Whether g_coll is zero if the discs touch, and positive if they are farther apart."""
    touching, apart = (
        published.contact(mpf(0), x * mp.cos(1), mpf(0), x * mp.sin(1), q.r)
        for x in (2 * q.r, 3 * q.r)
    )
    return abs(touching) < SAME and apart > 0


def gradient_is_right(q):
    """Whether ∇g_coll has the components of the derivative, and the printed norm."""
    touching = 2 * q.r * mp.cos(1), mpf(0), 2 * q.r * mp.sin(1), mpf(0)
    orders = ((1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0), (0, 0, 0, 1))
    true = [mp.diff(lambda *x: published.contact(*x, q.r), touching, order) for order in orders]
    given = mp.matrix(published.contact_gradient(*touching))
    norm = published.contact_norm(q)
    return mp.norm(mp.matrix(true) - given) < SAME and abs(mp.norm(given) - norm) < SAME


def wall_is_zero(q):
    """Whether g_wall is zero if disc 1 touches the right wall."""
    return published.wall(q.w / 2 - q.r, q) == 0


def hop_surface_is_across_y(q):
    """Whether the surface y1 = y2 is orthogonal to Y = (y1 + y2)/√2."""
    normal, axis = (1, -1), (1, 1)
    return normal[0] * axis[1] == normal[1] * axis[0]


def regimes_are_as_listed(q):
    """Whether the hops that are open at this radius are as in the list of regimes."""
    listed = [
        hops
        for hops, low, high in (
            ("both", 0, q.h / 4),
            ("vertical", q.h / 4, q.w / 4),
            ("none", q.w / 4, published.largest_radius(q)),
        )
        if low < q.r <= high
    ]
    vertical, horizontal = reference.vertical_hop_area(q), reference.horizontal_hop_area(q)
    return listed == ["both" if horizontal else "vertical" if vertical else "none"]


def two_components_are_there(q):
    """Whether r is in the range that the appendix gives for two components."""
    return q.w / 4 < q.r < q.h / 4


def four_components_are_there(q):
    """Whether r is in the range that the appendix gives for four components."""
    return q.h < 4 <= q.r


def collision_time_vanishes(q):
    """Whether the time between disc collisions vanishes at the largest radius."""
    return mean_time("disc_collision", q) < mp.sqrt(LIMIT_STEP)


def collision_time_is_smooth(q):
    """Whether the curvature of the time between disc collisions stays finite near h/4."""

    def curvature(distance):
        step = distance / 8
        before, here, after = (
            mean_time("disc_collision", MpScene(q.w, q.h, q.h / 4 + distance + shift))
            for shift in (-step, 0, step)
        )
        return (before - 2 * here + after) / step**2

    return all(
        abs(curvature(side * mpf("1e-14")) / curvature(side * mpf("1e-12")) - 1) < 0.1
        for side in (-1, 1)
    )


def hop_tails_are_exponential(q):
    """Whether no motion avoids vertical hops for long, so that an exponential tail is possible.

    Below h/4 discs that move along x pass clear of each other (``studies.single.tail_constant``).
    """
    return q.b <= q.r


# Statements ---------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Statement:
    """A formula or claim of the source.

    ``label`` is its label there or a short name, ``place`` the section or appendix. ``where`` names
    the regimes or limits for which it is stated; without ``where`` the radius does not matter.
    ``printed`` returns the printed value for a ``MpScene``; for a claim, it returns whether the
    claim holds. ``quantity`` is the measured quantity in which the formula enters; ``truth`` is
    this quantity over ``share`` unless it is given. ``correction`` is the right formula or a
    remark, with formulas between backticks. ``number`` is the number of the equation in the PDF of
    arXiv. ``severity`` is major (numbers are wrong), minor (a range or a part is wrong) or slip
    (nothing else becomes wrong by it).
    """

    label: str
    place: str
    where: tuple[str, ...]
    printed: Callable
    quantity: str | None = None
    correction: str | None = None
    share: int = 1
    truth: Callable | None = None
    number: str = ""
    severity: str | None = None

    def true(self, q):
        """Return the true value for a ``MpScene``."""
        return self.truth(q) if self.truth else QUANTITIES[self.quantity](q) / self.share

    @property
    def is_claim(self):
        """Whether the statement is a claim, without a value to divide by."""
        return self.truth is None and self.quantity is None


ALL, VERTICAL, NONE = ((name,) for name in REGIMES)
HOPS, BLOCKED, ANY = ALL + VERTICAL, VERTICAL + NONE, ALL + VERTICAL + NONE

#: The numerator that hop, disc and wall times share if all hops are open.
NUMERATOR = "N = 2a²b² − 2πabr² + (8/3)(a + b)r³ − r⁴"


def _scaled(function, factor):
    return lambda q: function(q) * factor


def _time_from(area, sides):
    """Return the mean time by the printed relation between time, volume and area."""
    return lambda q: published.mean_free_time(reference.volume(q), area(q), sides)


def _quarter_time(q):
    """A quarter of the time on the right wall, as if each of four components had the full wall."""
    return _time_from(reference.right_wall_area, 1)(q) / 4


def _half_of_before(q):
    """Half the time on the right wall just below h/4."""
    return mean_time("right_wall", MpScene(q.w, q.h, q.h / 4 - LIMIT_STEP)) / 2


STATEMENTS = (
    Statement("cambiocoor01", "II", (), published.rotation, truth=lambda q: mpf(1), number="1"),
    Statement(
        "axis of the cylinder", "II", (), cylinder_is_round_a_line,
        correction="the axis is the plane `x = y = 0` of all `X` and `Y`, not a diagonal in it",
        severity="slip",
    ),
    Statement(
        "meanfreetime", "III", ANY, _time_from(reference.disc_collision_area, 1),
        "disc_collision_time", number="2",
    ),
    Statement(
        "area of the sphere", "III", (), lambda q: published.sphere(4),
        truth=lambda q: reference.sphere(4), number="3",
    ),
    Statement(
        "condchoque", "III", HOPS, _time_from(reference.vertical_hop_area, 2), "vertical_hop_time",
        "taken with the factor s = 2 of a surface that is crossed from both sides", number="4",
    ),
    Statement("volindic", "IV A", ANY, published.volume_indicator, "volume", number="5"),
    Statement("integraltotal", "IV A", ANY, published.volume_separations, "volume", number="7"),
    Statement("V_free, X and Y done", "IV A", ANY, published.volume_quadrant, "volume", number="9"),
    Statement(
        "I_1", "IV A", ALL, published.volume_i1, "volume", truth=reference.beside_volume,
        number="11",
    ),
    Statement(
        "I_2", "IV A", ALL, published.volume_i2, "volume",
        truth=reference.volume_beyond_contact, number="13",
    ),
    Statement("volumeabd", "IV A", ALL, published.volume_abd, "volume", number="14"),
    Statement(
        "volumewhd", "IV A", ALL, published.volume_whd, "volume",
        "two terms differ: `(32/3)(w + h − 4r)r³` for `(32/3)(w + h − 2r)r³`, and `−8r⁴` for `−8⁴`",
        number="16", severity="major",
    ),
    Statement(
        "factor of 2 or 4", "IV A", NONE, _quarter_time, "right_wall_time",
        "only 2: of four components, disc 1 reaches a given wall in two, with half the volume",
        severity="major",
    ),
    Statement(
        "VolumenCasoFeo", "IV A", VERTICAL, published.volume_intermediate, "volume",
        "`16a²b² + 16b²r² + (64/3)ar³ − (8/3)b⁴ − 32abr² arcsin(b/r) − (32/3)a(2r² + b²)√(r² − "
        "b²)`; the printed form is complex where `a > 2r`, as in long boxes", number="17",
        severity="major",
    ),
    Statement(
        "eq:surface-area", "IV B", HOPS, published.surface_measure, "vertical_hop_area",
        "a factor `‖∇g‖` is missing: `√2` for `g = y_1 − y_2`, as here, and `4√2 r` for disc "
        "collisions", number="18", severity="major",
    ),
    Statement(
        "eq:surface-dirac", "IV B", ALL,
        lambda q: reference.disc_collision_area(q) / published.contact_norm(q),
        correction="taken for disc collisions", truth=reference.contact_density, number="19",
    ),
    Statement(
        "A_hop, integral", "IV B 1", HOPS, published.hop_integral, "vertical_hop_area", number="20",
    ),
    Statement(
        "AreaH", "IV B 1", HOPS, published.hop_area, "vertical_hop_area",
        "`8√2 b(a − r)²`, as appendix A has it", number="21", severity="major",
    ),
    Statement(
        "caption on the hop area", "IV B 1", VERTICAL, lambda q: mpf(0), "vertical_hop_area",
        "the area vanishes from `w/4` on, 3/8 in the box of the figure; 1/4 is `h/4`",
        severity="minor",
    ),
    Statement("g_coll", "IV B 2", (), contact_is_zero),
    Statement("gradient of g_coll", "IV B 2", (), gradient_is_right),
    Statement(
        "AreaChoque", "IV B 2", HOPS, published.collision_area, "disc_collision_area",
        "for `r ≤ min(w, h)/4`, not `w/4`; beyond that app:colgeneral", number="22",
        severity="minor",
    ),
    Statement("g_wall", "IV B 3", (), wall_is_zero),
    Statement("areaindic", "IV B 3", ANY, published.wall_integral, "right_wall_area", number="23"),
    Statement("areax1p", "IV B 3", ALL, published.wall_area, "right_wall_area", number="24"),
    Statement("areawalls", "IV B 3", ALL, published.walls_area, "any_wall_area", number="25"),
    Statement(
        "hoptau", "V A", ALL, published.hop_time, "vertical_hop_time",
        f"`(3π/(4√2)) N/(b(a − r)²)`, `{NUMERATOR}`: `√2` once", number="26", severity="major",
    ),
    Statement(
        "hoptaulimit", "V A", ("no radius",), published.hop_time_small, "vertical_hop_time",
        "`3πh/(4√2)`", number="27", severity="major",
    ),
    Statement(
        "hop time near w/4", "V A", ("w/4",), published.hop_time_threshold, "vertical_hop_time",
        "the exponent −2 is right; the constant has the volume at `w/4`, not that of the prism: "
        "`(3π/4) V(w/4)/(16√2 (h − w/2)(w/4 − r)²)`", severity="major",
    ),
    Statement(
        "colltau", "V B", HOPS, published.collision_time, "disc_collision_time",
        "for `r ≤ min(w, h)/4`, not `w/4`", number="28", severity="minor",
    ),
    Statement(
        "colltaulim0", "V B", ("no radius",), published.collision_time_small, "disc_collision_time",
        number="29",
    ),
    Statement(
        "collision time goes to zero", "V B", ("largest radius, w < 2h", "largest radius, w > 2h"),
        collision_time_vanishes,
        correction="for `w ≤ 2h`; in longer boxes it tends to `(3π/(4√2))(w − 2h)`",
        severity="minor",
    ),
    Statement(
        "collision time is smooth", "V B", ("h/4",), collision_time_is_smooth,
        correction="it is differentiable once: beyond `h/4` the area gains a term `∝ (4r − "
        "h)^(3/2)`", severity="minor",
    ),
    Statement(
        "impactwall", "V C", ALL, published.wall_time, "right_wall_time",
        f"`(3π/2) N/(ab² − (π/2)br² + (2/3)r³)`, `{NUMERATOR}`: no `√2`, and 2/3 for 16/3",
        number="30", severity="major",
    ),
    Statement(
        "wall time for small discs", "V C", ("no radius",), published.wall_time_small,
        "right_wall_time",
    ),
    Statement("wall time, jump at h/4", "V C", ("h/4",), _half_of_before, "right_wall_time"),
    Statement(
        "exponential tails", "VI", HOPS, hop_tails_are_exponential,
        correction="those of vertical hops fall as `t^(−3)` for `r < h/4`, where drifts along x "
        "avoid them; beyond, some look exponential as far as is seen", severity="major",
    ),
    Statement(
        "VolumenGeneral", "A 1", ANY, published.excluded_volume, "volume",
        truth=_scaled(reference.excluded_volume, mpf(1) / 16), number="A1",
    ),
    Statement("list of regimes", "A 1", (), regimes_are_as_listed),
    Statement(
        "largest radius", "A 1", ("largest radius, w < 2h",), published.largest_radius,
        truth=largest_radius,
    ),
    Statement(
        "app:volcyl", "A 1", ANY, published.sector_polar, "volume",
        truth=_scaled(reference.sector_volume, mpf(1) / 16), number="A2",
    ),
    Statement(
        "V_h, ρ done", "A 1", ANY, published.sector_angle, "volume",
        truth=_scaled(reference.sector_volume, mpf(1) / 16), number="A3",
    ),
    Statement(
        "Volrtheta", "A 1", ANY, published.sector_volume, "volume",
        truth=_scaled(reference.sector_volume, mpf(1) / 16), number="A4",
    ),
    Statement(
        "app:voldot", "A 1", BLOCKED, published.upper_volume, "volume",
        truth=reference.upper_volume, number="A5",
    ),
    Statement(
        "V_l", "A 1", NONE, published.lower_volume, "volume",
        truth=reference.lower_volume, number="A6",
    ),
    Statement(
        "range of two components", "A 1", VERTICAL, two_components_are_there,
        correction="`h/4 < r < w/4`: the two ends changed places", severity="slip",
    ),
    Statement(
        "range of four components", "A 1", NONE, four_components_are_there,
        correction="`w/4 ≤ r`, for `w ≥ h`", severity="slip",
    ),
    Statement("ahopcart", "A 2 a", HOPS, published.hop_integral, "vertical_hop_area", number="A7"),
    Statement(
        "hop surface orthogonal to Y", "A 2 a", (), hop_surface_is_across_y,
        correction="it is orthogonal to the `y` axis and contains the direction of `Y`",
        severity="slip",
    ),
    Statement(
        "pasoraro", "A 2 a", HOPS, published.hop_area_fourfold, "vertical_hop_area",
        "`y` starts at `−b√2`; as printed, without the sign, its range is empty", share=8,
        number="A8", severity="slip",
    ),
    Statement(
        "pasoraro, second line", "A 2 a", HOPS, published.hop_area_twofold, "vertical_hop_area",
        "the upper limit of `y` lost its `b`, which the delta function does not notice", share=8,
        number="A9",
    ),
    Statement(
        "pasoraro, third and fourth line", "A 2 a", HOPS, published.hop_area_line,
        "vertical_hop_area", share=8, number="A10, A11",
    ),
    Statement(
        "pasoraro, fifth line", "A 2 a", HOPS, published.hop_area_primitive, "vertical_hop_area",
        share=8, number="A12",
    ),
    Statement(
        "A_hopp", "A 2 a", HOPS, published.hop_area_appendix, "vertical_hop_area", number="A13",
    ),
    Statement(
        "A_col, fourfold integral", "A 2 b", ANY, published.collision_area_fourfold,
        "disc_collision_area", share=16, number="A14",
    ),
    Statement(
        "A_col, twofold integral", "A 2 b", ANY, published.collision_area_twofold,
        "disc_collision_area", share=16, number="A15",
    ),
    Statement(
        "polar coordinates", "A 2 b", ANY, published.circle_polar,
        correction="the delta function in polar coordinates, taken for the length of the arc",
        truth=lambda q: reference.circle_integral(q, lambda x, y: mpf(1)), number="A16, A17",
    ),
    Statement(
        "app:colgeneral, first line", "A 2 b", ANY, published.collision_area_polar,
        "disc_collision_area",
        "`ρ` has to pass `√2 r`, where the delta function stands; as printed it ends at `r`",
        share=16, number="A18", severity="slip",
    ),
    Statement(
        "app:colgeneral, second line", "A 2 b", ANY, published.collision_area_angle,
        "disc_collision_area", share=16, number="A19",
    ),
    Statement(
        "app:colgeneral", "A 2 b", ANY, published.collision_area_appendix, "disc_collision_area",
        number="A20",
    ),
    Statement(
        "app:colgeneral with b = 0", "A 2 b", ALL, published.collision_area_substituted,
        "disc_collision_area", "`β = 0` is meant", number="A20", severity="slip",
    ),
    Statement(
        "app:colgeneral as a quarter", "A 2 b", ANY, _scaled(published.collision_area_appendix, 4),
        "disc_collision_area", "it is the total area, not a quarter of it", number="A20",
        severity="minor",
    ),
    Statement(
        "A_(x2=a), integrals", "A 2 c", ANY, published.wall_integral, "right_wall_area",
        number="A21",
    ),
    Statement(
        "coordinates at the wall", "A 2 c", (), published.wall_coordinates,
        correction="with y_2 for y_y; taken for the factor √2 that they bring",
        truth=lambda q: mp.sqrt(2), number="A22",
    ),
    Statement(
        "areachoquexy", "A 2 c", ANY, published.wall_rotated, "right_wall_area", number="A23",
    ),
    Statement(
        "areachoquexy, second line", "A 2 c", ANY, published.wall_rotated_twofold,
        "right_wall_area", number="A24",
    ),
    Statement(
        "vertical hops excluded", "A 2 c", VERTICAL, lambda q: mpf(0), "vertical_hop_area",
        "horizontal hops are what is excluded there", severity="slip",
    ),
    Statement(
        "A_(x2=a), whole less excluded", "A 2 c", ANY, published.wall_whole_less_excluded,
        "right_wall_area", "the dY of the last integral is left over from the line before",
        number="A25, A26",
    ),
    Statement(
        "A_whole", "A 2 c", ANY, published.wall_whole, "right_wall_area",
        "`A_w = 8ab²` for the whole, without the 1/4", truth=reference.whole_wall, number="A27",
        severity="minor",
    ),
    Statement(
        "A_sector", "A 2 c", ANY, published.wall_sector, "right_wall_area",
        truth=reference.sector_wall, number="A28",
    ),
    Statement(
        "A_u", "A 2 c", BLOCKED, published.wall_upper, "right_wall_area",
        truth=reference.upper_wall, number="A29",
    ),
    Statement(
        "lower triangle of the wall", "A 2 c", NONE, published.wall_lower, "right_wall_area",
        "`8ab√(r² − a²) − (8/3)a(r² − a²)`: the weight is not symmetric in `x` and `y`",
        truth=reference.lower_wall, severity="major",
    ),
    Statement(
        "limit of thin shells", "B", HOPS, lambda q: published.hop_shell(q, LIMIT_STEP),
        "vertical_hop_area",
        "multiply by `‖∇g‖`, as the text around it says in other words; a shell of both sides is "
        "divided by `2ε` (here `|y_1 − y_2| ≤ ε`); for walls `g` is `a − x_1`, for `x_1 − a` is "
        "never positive", severity="major",
    ),
)  # fmt: skip
