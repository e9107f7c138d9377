"""The formulas of the paper that this work checks, computed as they are printed there.

W. P. K. Zapfe, D. P. Sanders and R. Rodríguez-Mota, Exact hopping and collision times for two hard
discs in a box, arXiv:1908.04749. A function stands for one formula; its docstring begins with the
formula's label if there is one. It takes a ``MpScene`` and returns the printed value, with its
misprints, at the working precision of mpmath. Do not use these functions as physics: ``errata``
says which are right.

Integrals are evaluated over the printed limits. If all hops are open, the source has α = π/2 and
β = 0, and otherwise sin α = b/r and cos β = a/r.
"""

from mpmath import mp, mpf

from twodiscs_paper.reference import circle_integral, inside, line, outside, rectangle, smooth

# Section II: model --------------------------------------------------------------------------------


def rotation(q):
    """cambiocoor01: the Jacobian of (x, X, y, Y) with respect to (x1, x2, y1, y2)."""
    s = 1 / mp.sqrt(2)
    return abs(mp.det(mp.matrix([[s, -s, 0, 0], [s, s, 0, 0], [0, 0, s, -s], [0, 0, s, s]])))


# Section III: mean collision time -----------------------------------------------------------------


def sphere(d):
    """The area of the unit sphere in d dimensions."""
    return 2 * mp.pi ** (mpf(d) / 2) / mp.gamma(mpf(d) / 2)


def mean_free_time(volume, area, sides):
    """meanfreetime in four dimensions, with the ball as given below it."""
    d = 4
    return volume / area * sphere(d) / (sphere(d - 1) / (d - 1)) / sides


# Section IV A: volume -----------------------------------------------------------------------------


def integrate_over_y(q, power):
    """Return 2 ∫ (2b − v) (2a − √(4r² − v²)₊)₊^power dv over [0, 2b]: v = |y1 − y2| is last."""
    contact, x_range, y_range = 2 * q.r, 2 * q.a, 2 * q.b

    def strip(t):  # v = 2 r sin t
        open_x = max(x_range - contact * mp.cos(t), 0)
        return contact * mp.cos(t) * (y_range - contact * mp.sin(t)) * open_x**power

    ends = mp.asin(mp.sqrt(max(1 - (x_range / contact) ** 2, mpf(0))))
    free = mpf(0)
    if y_range > contact:
        free = line(lambda v: (y_range - v) * x_range**power, contact, y_range)
    return 2 * (smooth(strip, ends, mp.asin(min(y_range / contact, mpf(1)))) + free)


def volume_indicator(q):
    """volindic: the coordinates that are not fixed first run along y, then along x."""
    return integrate_over_y(q, 2)


def volume_separations(q):
    """integraltotal and the display after it: X and Y done, four quadrants of x and y."""

    def lengths(x, y):
        return 2 * (q.a * mp.sqrt(2) - x) * 2 * (q.b * mp.sqrt(2) - y)

    return 4 * outside(lengths, q.a * mp.sqrt(2), q.b * mp.sqrt(2), q.r * mp.sqrt(2))


def volume_quadrant(q):
    """The display after integraltotal, last line: sixteen times one quadrant."""
    return 16 * outside(q.weight, q.a * mp.sqrt(2), q.b * mp.sqrt(2), q.r * mp.sqrt(2))


def volume_i1(q):
    """I₁, the part in which the discs limit y."""
    a, b, r = q.a, q.b, q.r
    return (
        2 * a * b**2 * r
        + (a + b) * (2 * r) ** 3 / 6
        - (2 * r) ** 4 / 32
        - (mp.pi * a * b + b**2) * (2 * r) ** 2 / 4
    )


def volume_i2(q):
    """I₂, the part in which they do not."""
    return (q.a**2 - 2 * q.a * q.r + q.r**2) * q.b**2


def volume_abd(q):
    """volumeabd."""
    a, b, r = q.a, q.b, q.r
    return 16 * (a * b) ** 2 - 16 * mp.pi * a * b * r**2 + mpf(64) / 3 * (a + b) * r**3 - 8 * r**4


def volume_whd(q):
    """volumewhd, whose last term has no radius."""
    w, h, r = q
    return (
        (w - 2 * r) ** 2 * (h - 2 * r) ** 2
        - mp.pi * (w - 2 * r) * (h - 2 * r) * 4 * r**2
        + mpf(32) / 3 * (w + h - 2 * r) * r**3
        - 8**4
    )


def volume_intermediate(q):
    """VolumenCasoFeo, between h/4 and w/4; complex where a > 2r."""
    a, b, r = q.a, q.b, q.r
    c = mp.sqrt(4 * r**2 - b**2)
    root = mp.sqrt(2)
    return (
        32 * a * b * r**2 * (mp.acos(b / (2 * r)) - mp.acos(a / (2 * r)))
        + 64 * r**3 / 3 * (a * (b - a) - b * (c + mp.sqrt(4 * r**2 - a**2))) / (2 * r)
        + 16 * (a * b**2 * c * (4 * root - 1 - root / 3) + c**2 * b**2 * (root / 3 - 1))
        - 2 * r**2 * (b**2 - a**2)
    )


# Section IV B: areas ------------------------------------------------------------------------------


def surface_measure(q):
    """eq:surface-area for g = y1 − y2, whose gradient has the norm √2."""
    return 2 * q.b * 2 * line(lambda u: 2 * q.a - u, 2 * q.r, 2 * q.a)


def hop_integral(q):
    """The integrals over δ((y1 − y2)/√2), in section IV B and ahopcart in appendix A."""
    return mp.sqrt(2) * surface_measure(q)


def hop_area(q):
    """AreaH."""
    return 16 * mp.sqrt(2) * q.b * (q.a - q.r) ** 2


def contact(x1, x2, y1, y2, r):
    """g_coll."""
    return (x1 - x2) ** 2 + (y1 - y2) ** 2 - 4 * r**2


def contact_gradient(x1, x2, y1, y2):
    """∇g_coll."""
    return 2 * (x1 - x2), -2 * (x1 - x2), 2 * (y1 - y2), -2 * (y1 - y2)


def contact_norm(q):
    """‖∇g_coll‖ at contact."""
    return 2 * mp.sqrt(2) * 2 * q.r


def collision_area(q):
    """AreaChoque."""
    a, b, r = q.a, q.b, q.r
    return mp.sqrt(2) * (16 * mp.pi * a * b * r - 32 * (a + b) * r**2 + 16 * r**3)


def wall(x1, q):
    """g_wall."""
    return x1 - q.a


def wall_integral(q):
    """areaindic, and the first display on walls in appendix A: along x first."""
    return integrate_over_y(q, 1)


def wall_area(q):
    """areax1p."""
    return 8 * q.a * q.b**2 - 4 * mp.pi * q.b * q.r**2 + mpf(16) / 3 * q.r**3


def walls_area(q):
    """areawalls."""
    a, b, r = q.a, q.b, q.r
    return 32 * a * b * (a + b) - 16 * mp.pi * r**2 * (a + b) + mpf(128) / 3 * r**3


# Section V: mean times ----------------------------------------------------------------------------


def numerator(q):
    """The numerator that hoptau, colltau and impactwall share."""
    a, b, r = q.a, q.b, q.r
    return 2 * (a * b) ** 2 - 2 * mp.pi * a * b * r**2 + (a + b) / 3 * (2 * r) ** 3 - r**4


def hop_time(q):
    """hoptau."""
    return 3 * mp.pi / (4 * mp.sqrt(2)) * numerator(q) / (q.b * mp.sqrt(2) * (q.a - q.r) ** 2)


def hop_time_small(q):
    """hoptaulimit."""
    return 3 * mp.pi / (8 * mp.sqrt(2)) * q.h


def hop_time_threshold(q):
    """The law near r = w/4 with the volume that the text says leads, and the right area."""
    volume = q.w**2 * (q.h / 2 - q.w / 4) ** 2
    return mean_free_time(volume, 8 * mp.sqrt(2) * q.b * (q.a - q.r) ** 2, 2)


def collision_time(q):
    """colltau."""
    a, b, r = q.a, q.b, q.r
    denominator = 2 * mp.pi * a * b * r - 4 * (a + b) * r**2 + 2 * r**3
    return 3 * mp.pi / (2 * mp.sqrt(2)) * numerator(q) / denominator


def collision_time_small(q):
    """colltaulim0."""
    return 3 / (8 * mp.sqrt(2)) * q.w * q.h / q.r


def wall_time(q):
    """impactwall, with π/2b r² read as (π/2) b r²."""
    a, b, r = q.a, q.b, q.r
    denominator = a * b**2 - mp.pi / 2 * b * r**2 + mpf(16) / 3 * r**3
    return 3 * mp.pi / (2 * mp.sqrt(2)) * numerator(q) / denominator


def wall_time_small(q):
    """The limit of the wall time for small discs."""
    return 3 * mp.pi * q.w / 2


# Appendix A 1: volume -----------------------------------------------------------------------------


def excluded_weight(q, x, y):
    """The square bracket of VolumenGeneral and what follows."""
    return 2 * q.a * q.b - mp.sqrt(2) * (q.a * y + q.b * x) + x * y


def excluded_volume(q):
    """VolumenGeneral, over 16."""
    root = mp.sqrt(2)
    return inside(lambda x, y: excluded_weight(q, x, y), root * q.a, root * q.b, root * q.r)


def largest_radius(q):
    """The end of the last range in the list of regimes, and the figure on the largest radius."""
    return (q.h + q.w - mp.sqrt(2 * q.h * q.w)) / 2


def sector_polar(q):
    """app:volcyl, over 16: the hatched sector in polar coordinates."""

    def ray(theta):
        sin, cos = mp.sin(theta), mp.cos(theta)

        def along(rho):
            linear = mp.sqrt(2) * (q.a * rho * sin + q.b * rho * cos)
            return rho * (2 * q.a * q.b - linear + rho**2 * cos * sin)

        return line(along, mpf(0), q.r * mp.sqrt(2))

    return smooth(ray, q.beta, q.alpha)


def sector_angle(q):
    """The display before Volrtheta, over 16: ρ is done."""

    def ray(theta):
        sin, cos = mp.sin(theta), mp.cos(theta)
        return (
            2 * q.a * q.b * q.r**2 - q.r**3 * 4 / 3 * (q.a * sin + q.b * cos) + q.r**4 * (cos * sin)
        )

    return smooth(ray, q.beta, q.alpha)


def sector_volume(q):
    """Volrtheta, over 16."""
    a, b, r = q.a, q.b, q.r

    def primitive(theta):
        sin, cos = mp.sin(theta), mp.cos(theta)
        cubic = mpf(4) / 3 * r**3 * (a * cos - b * sin)
        return 2 * r**2 * a * b * theta + cubic + r**4 * sin**2 / 2

    return primitive(q.alpha) - primitive(q.beta)


def upper_volume(q):
    """V_u, the last line of app:voldot."""
    a, b, root = q.a, q.b, q.upper
    cross = mpf(32) / 3 * b**2 * (root**2 + 2 * a * root)
    return 32 * a * b**2 * root - cross + 8 * b**2 * root**2


def lower_volume(q):
    """V_l."""
    a, b, root = q.a, q.b, q.lower
    cross = mpf(32) / 3 * a**2 * (root**2 + 2 * b * root)
    return 32 * a**2 * b * root - cross + 8 * a**2 * root**2


# Appendix A 2: areas ------------------------------------------------------------------------------


def hop_area_fourfold(q):
    """pasoraro, over 8: δ(y) within the printed limits of y, from b√2 to b√2."""
    return hop_area_between(q, q.b * mp.sqrt(2), q.b * mp.sqrt(2))


def hop_area_twofold(q):
    """The line after pasoraro, over 8: y from −b√2 to √2."""
    return hop_area_between(q, -q.b * mp.sqrt(2), mp.sqrt(2))


def hop_area_between(q, low, high):
    """Return ∬ (a√2 − x)(b√2 − y) δ(y) with x from r√2 and y from ``low`` to ``high``."""
    if not low < 0 < high:
        return mpf(0)
    return line(lambda x: q.weight(x, 0), q.r * mp.sqrt(2), q.a * mp.sqrt(2))


def hop_area_line(q):
    """The third and fourth line after pasoraro, over 8."""
    root = mp.sqrt(2)
    return line(lambda x: 2 * q.a * q.b - x * q.b * root, q.r * root, q.a * root)


def hop_area_primitive(q):
    """The fifth line after pasoraro, over 8."""

    def primitive(x):
        return 2 * q.a * q.b * x - x**2 * q.b / mp.sqrt(2)

    return primitive(q.a * mp.sqrt(2)) - primitive(q.r * mp.sqrt(2))


def hop_area_appendix(q):
    """The last line after pasoraro."""
    return 8 * mp.sqrt(2) * q.b * (q.a - q.r) ** 2


def collision_area_fourfold(q):
    """A_col over 16 as a fourfold integral; X and Y run over their ranges."""
    return circle_integral(q, q.weight)


def collision_area_twofold(q):
    """A_col over 16 as a twofold integral."""
    return circle_integral(q, lambda x, y: excluded_weight(q, x, y))


def circle_polar(q):
    """∬ δ(ρ − √2 r) ρ dρ dθ."""
    return mp.sqrt(2) * q.r * (q.alpha - q.beta)


def collision_area_polar(q):
    """app:colgeneral, over 16, with ρ from 0 to r under δ(ρ − √2 r), which is zero there."""
    return mpf(0)


def collision_area_angle(q):
    """The second line of app:colgeneral, over 16."""
    a, b, r = q.a, q.b, q.r

    def ray(theta):
        sin, cos = mp.sin(theta), mp.cos(theta)
        return mp.sqrt(2) * r * (2 * a * b - 2 * r * (a * sin + b * cos) + 2 * r**2 * cos * sin)

    return smooth(ray, q.beta, q.alpha)


def collision_area_general(a, b, r, alpha, beta):
    """The last line of app:colgeneral."""
    sin, cos = mp.sin, mp.cos
    return (
        16
        * mp.sqrt(2)
        * (
            2 * a * b * r * (alpha - beta)
            + 2 * r**2 * (a * (cos(alpha) - cos(beta)) - b * (sin(alpha) - sin(beta)))
            + r**3 * (sin(alpha) ** 2 - sin(beta) ** 2)
        )
    )


def collision_area_appendix(q):
    """The last line of app:colgeneral at the angles of the regime."""
    return collision_area_general(q.a, q.b, q.r, q.alpha, q.beta)


def collision_area_substituted(q):
    """The same with α = π/2 and b = 0, as stated below it."""
    return collision_area_general(q.a, mpf(0), q.r, mp.pi / 2, mpf(0))


def wall_coordinates(q):
    """The coordinates before areachoquexy: ∂(x1, y1, y2)/∂(x, y, Y)."""
    s = 1 / mp.sqrt(2)
    return 1 / abs(mp.det(mp.matrix([[s, 0, 0], [0, s, -s], [0, s, s]])))


def wall_rotated(q):
    """areachoquexy, first line: the range of Y for every x and y, and both signs of y."""
    root = mp.sqrt(2)

    def length(x, y):
        return 2 * (root * q.b - y)

    return root * 2 * outside(length, root * q.a, root * q.b, root * q.r)


def wall_rotated_twofold(q):
    """areachoquexy, second line: both signs of y."""
    root = mp.sqrt(2)
    half = outside(lambda x, y: root * q.b - y, root * q.a, root * q.b, root * q.r)
    return 2 * root * 2 * half


def wall_whole_less_excluded(q):
    """The display after areachoquexy, with the loose dY left out."""
    root = mp.sqrt(2)
    ends = root * q.a, root * q.b
    whole = rectangle(lambda x, y: root * q.b - y, *ends)
    excluded = inside(lambda x, y: root * q.b - y, *ends, root * q.r)
    return 4 * root * whole - 4 * root * excluded


def wall_whole(q):
    """A_whole; the source says that a quarter of it is 8ab²."""
    return 4 * (8 * q.a * q.b**2)


def wall_sector(q):
    """A_sector."""
    arc = 8 * q.b * q.r**2 * (q.alpha - q.beta)
    return arc + 16 * q.r**3 / 3 * (mp.cos(q.alpha) - mp.cos(q.beta))


def wall_upper(q):
    """A_u."""
    return mpf(8) / 3 * q.b**2 * q.upper


def wall_lower(q):
    """The lower triangle; the source says that it is A_u with a instead of b."""
    return mpf(8) / 3 * q.a**2 * q.lower


# Appendix B: shells -------------------------------------------------------------------------------


def hop_shell(q, half_width):
    """The volume with |y1 − y2| ≤ ε over ε, for a half-width ε ≪ r and vertical hops open."""

    def slice(v):
        return 2 * (2 * q.b - v) * (2 * q.a - mp.sqrt(4 * q.r**2 - v**2)) ** 2

    return smooth(slice, mpf(0), half_width) / half_width
