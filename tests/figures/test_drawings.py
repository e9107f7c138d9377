"""Drawings are to scale: discs touch, lines end and shells are as wide as the theory says."""

import math

import numpy as np
import pytest
from figure_cases import BOXES, PAPER, draw, shown_texts
from matplotlib.patches import Arc, Circle, Polygon, Rectangle, Wedge
from scipy.spatial.distance import cdist

from twodiscs.figures import configuration_space, drawing, style
from twodiscs.model.scene import Box
from twodiscs.theory import exact


@pytest.mark.parametrize("box", [PAPER, BOXES["tall"], Box(3.0, 1.0), Box(1.0, 4.0)], ids=str)
def test_the_largest_discs_touch_each_other_and_walls(box):
    jammed, regimes = draw("largest_radius", box, {}).axes
    discs = [patch for patch in jammed.patches if isinstance(patch, Circle)]
    (one, two), radius = (np.array(disc.center) for disc in discs), discs[0].radius
    assert radius == box.largest_radius
    room = np.array([box.width, box.height]) / 2 - radius
    np.testing.assert_allclose([-one, two], [room, room], rtol=1e-12)
    longer = max(box.width, box.height) >= 2 * min(box.width, box.height)
    assert longer or math.dist(one, two) == pytest.approx(2 * radius, rel=1e-12)
    if min(room) > 0:
        lines = [line.get_xydata().tolist() for line in jammed.lines]
        assert [[*one], [*two]] in lines
        assert [[*one], [two[0], one[1]], [*two]] in lines
    # The map: all limits at every shape, and this box.
    either, passing, largest, *_ = (line.get_data() for line in regimes.lines)
    high = box.width < box.height
    for (shapes, radii), limit in (
        (either, lambda b: 0.25),
        (passing, lambda b: b.threshold("horizontal_hop" if high else "vertical_hop")),
        (largest, lambda b: b.largest_radius),
    ):
        due = [limit(Box(1.0, x) if high else Box(x, 1.0)) for x in shapes]
        np.testing.assert_allclose(radii, due, rtol=1e-12)
    shape = max(box.width, box.height) / min(box.width, box.height)
    marks = [line.get_data() for line in regimes.lines if line.get_marker() == "o"]
    assert marks == [([shape], [radius / min(box.width, box.height)])] * (shape < 3.4)
    assert bool(regimes.get_legend()) == (shape < 3.4)
    assert ("$2r$" in {text.get_text() for text in jammed.texts}) == (shape < 2)


@pytest.mark.parametrize("box", [PAPER, BOXES["tall"], Box(2.5, 1.0)], ids=str)
def test_the_regimes_have_the_areas_of_their_hops(box):
    """The coloured segments on the axes are A − σ and B − σ long; the arc ends on the rectangle."""
    for axes in draw("integration_regimes", box, {}).axes:
        wide, high = axes.get_xlim()[1], axes.get_ylim()[1]
        areas = exact.areas(box.scene((box.width - wide) / 2))
        arc, *marked = (patch for patch in axes.patches if isinstance(patch, Arc))
        sigma = arc.width / 2
        assert {one.theta2 for one in marked} == {arc.theta1, arc.theta2} - {0, 90}
        assert sigma == pytest.approx(box.width - wide, rel=1e-12)
        for angle, along_x in ((arc.theta1, False), (arc.theta2, True)):
            x, y = (sigma * f(math.radians(angle)) for f in (math.cos, math.sin))
            assert (x if along_x else y) == pytest.approx(0, abs=1e-12) or (
                y / high if along_x else x / wide
            ) == pytest.approx(1, rel=1e-12)
        for cut in (patch for patch in axes.patches if type(patch) is Polygon):
            assert np.hypot(*cut.xy.T).max() == pytest.approx(sigma, rel=1e-12)
        lines = {line.get_color(): line.get_data() for line in axes.lines}
        for colour, hop, across in (
            (style.BLUE, "vertical_hop", high), (style.VERMILLION, "horizontal_hop", wide)
        ):  # fmt: skip
            length = np.ptp(lines[colour], axis=1).max() if colour in lines else 0.0
            due = math.sqrt(areas[hop] / (math.sqrt(2) * across))
            assert length == pytest.approx(due, rel=1e-9)


def arrows(axes):
    """Return the (tail, head) of all arrows."""
    return [(text.xyann, text.xy) for text in axes.texts if not text.get_text()]


@pytest.mark.parametrize("box", [PAPER, BOXES["tall"]], ids=str)
def test_both_shells_are_equally_thick(box):
    """Arrows go as far as their names say: ε and √2 ε from one surface, √2 r and ε at the other."""
    hop, collision = draw("surface_shell", box, {}).axes
    lines = [line.get_xydata() for line in hop.lines]
    diagonal, *edges = sorted(lines, key=lambda ends: abs(ends[0] @ (1, -1)))
    wedges = {bool(one.width): one for one in collision.patches if isinstance(one, Wedge)}
    rim, shell = wedges[False], wedges[True]
    assert abs(diagonal[0] @ (1, -1)) < 1e-12
    np.testing.assert_allclose(np.abs(np.dot(edges, (1, -1))) / math.sqrt(2), shell.width, 1e-12)
    assert shell.r - shell.width == pytest.approx(rim.r, rel=1e-12)
    assert {(one.center, one.theta1, one.theta2) for one in (rim, shell)} == {((0, 0), 0, 90)}
    arcs = [(one.width / 2, one.height / 2) for one in collision.patches if isinstance(one, Arc)]
    assert sorted(arcs) == [(rim.r, rim.r), (shell.r, shell.r)]
    across, around = (np.vstack(arrows(axes)) for axes in (hop, collision))
    depths = abs(across @ (1, -1)) / math.sqrt(2)
    assert depths == pytest.approx([0, shell.width, 0, shell.width])
    assert np.hypot(*around.T) == pytest.approx([0, rim.r, rim.r, shell.r])


@pytest.mark.parametrize(("azimuth", "elevation"), [(-112.0, 24.0), (35.0, 60.0), (170.0, -10.0)])
def test_a_prism_hides_three_edges_and_a_cylinder_its_other_half(monkeypatch, azimuth, elevation):
    monkeypatch.setattr(configuration_space, "AZIMUTH", azimuth)
    monkeypatch.setattr(configuration_space, "ELEVATION", elevation)
    axes = draw("configuration_space", PAPER, {}).axes[0]
    edges = [line for line in axes.lines if len(line.get_xdata()) == 2]
    assert len(edges) == 12
    assert sum(line.is_dashed() for line in edges) == 3
    strips = [patch for patch in axes.patches if len(patch.get_xy()) == 5]
    assert abs(len(strips) - configuration_space.CYLINDER_STRIPS / 2) <= 1
    # An end of the cylinder lies in two faces each; three of the six faces are seen.
    ends = [patch for patch in axes.patches if len(patch.get_xy()) > 5]
    hidden = [line for line in axes.lines if len(line.get_xdata()) > 2]
    assert len(ends) == len(hidden) == 2
    # The side hides no part of an end that is drawn.
    middles = [patch.get_xy().mean(axis=0) for patch in ends]
    assert not any(strip.get_path().contains_point(at) for strip in strips for at in middles)
    # The hidden halves are the images of the visible ones by reflection at the centre.
    seen = np.vstack([patch.get_xy() for patch in ends])
    opposite = -np.vstack([line.get_xydata() for line in hidden])
    for axis in (0, 1):
        assert cdist(seen, opposite).min(axis).max() < 1e-12


def test_the_marked_point_lies_outside_the_bands_that_its_coordinates_give():
    """x is beyond √(2r² − y²) and y beyond √(2r² − x²); arrows end near the corners."""
    depths, bands = [], []
    for axes in draw("configuration_space", PAPER, {}).axes[1:]:
        along, across, depth = (np.subtract(head, tail) for tail, head in arrows(axes))
        assert along[0] == along[1] == across[0] == -across[1] < axes.get_xlim()[1] < 1.1 * along[0]
        assert depth[0] == pytest.approx(-depth[1])
        assert np.ptp(arrows(axes)[2][0]) == 0
        depths.append(math.hypot(*depth))
        halves = [abs(patch.get_xy() @ (1, -1)).max() / math.sqrt(2) for patch in axes.patches[1:4]]
        assert halves[0] == halves[1]
        bands.append(halves[1:])
    for (band, widest), other, own in zip(bands, depths[::-1], depths, strict=True):
        assert band < own < widest
        assert math.hypot(band, other) == pytest.approx(widest)


def test_the_page_is_at_right_angles_to_the_view():
    """Points along the line of sight coincide, and those on the page keep their distance."""
    sight = np.array([configuration_space._towards(axis) for axis in np.eye(3)])
    assert sight @ sight == pytest.approx(1)
    assert configuration_space._seen(0.7 * sight) == pytest.approx((0, 0), abs=1e-12)
    across = np.cross(sight, [0.3, -0.2, 0.9])
    assert math.hypot(*configuration_space._seen(across)) == pytest.approx(np.linalg.norm(across))


#: {drawing: what it names}, numbers of a scale left out.
NAMED = {
    "model": r"0 \mathbf{v}_1 \mathbf{v}_2 \mathbf{x}_1 \mathbf{x}_2 a=w/2-r b=h/2-r h r w x y",
    "configuration_space": r"(a) (b) -a -b X Y \times a b x x_1 x_2 y y_1 y_2"
    r" |x|<\sqrt{2r^2-y^2} |y|<\sqrt{2r^2-x^2}",
    "largest_radius": r"(a) (b) 2r h-2r r r/h r=h/4 r=w/4 r_{\mathrm{max}}=h/2 w-2r w/h",
    "integration_regimes": r"(a) (b) (c) 0 A B \alpha \beta \sigma u v",
    "surface_shell": r"(a) (b) -b 0 \sqrt{2}\,\varepsilon \sqrt{2}\,a \sqrt{2}\,b \sqrt{2}\,r"
    r" \varepsilon b x x^2+y^2=2r^2 y y_1 y_1=y_2 y_2",
}


@pytest.mark.parametrize("name", NAMED)
def test_a_drawing_names_its_lengths(name):
    texts = {text.get_text() for text, _ in shown_texts(draw(name, PAPER, {}))}
    formulas = {t for t in texts if t.startswith("$") and not t.startswith(r"$\mathdefault")}
    letters = {t[:3] for t in texts if t.startswith("(")}
    assert formulas | letters == {n if n[0] == "(" else f"${n}$" for n in NAMED[name].split()}


def test_marks_of_a_dimension_begin_beside_its_side_and_go_on_beyond_its_arrow():
    axes = style.new_figure(2.0).subplots(subplot_kw={"xlim": (0, 2)})
    drawing.dimensions(axes, lambda x, away: (x, -away), (0, 0.5, 1), "ab", (0, -6), beyond=4)
    point = drawing.points(axes)
    assert [line.get_xdata().tolist() for line in axes.lines] == [[0, 0], [0.5, 0.5], [1, 1]]
    for line in axes.lines:
        assert line.get_ydata() == pytest.approx([-4 * point, -15 * point])
    assert [text.get_text() for text in axes.texts if text.get_text()] == ["$a$", "$b$"]


@pytest.mark.parametrize(("name", "panels"), [*zip(NAMED, (1, 2, 1, 3, 2), strict=True)])
def test_a_rectangle_fills_panels(name, panels):
    """In the model another rectangle, for the centres, is a radius inside.

    There the radius and the velocity of a disc begin at its centre.
    """
    filled = 0
    for axes in draw(name, PAPER, {}).axes:
        boxes = [patch.get_bbox() for patch in axes.patches if isinstance(patch, Rectangle)]
        filled += any(box.extents == pytest.approx(axes.viewLim.extents) for box in boxes)
        if name == "model":
            at = {text.get_text(): text.xy for text in axes.texts}
            assert at["$h$"][0] < -0.75
            assert at["$w$"][1] < -0.5
            discs = [patch for patch in axes.patches if isinstance(patch, Circle)]
            radius, own = discs[0].radius, arrows(axes)[2:6]
            assert [tail for tail, _ in own] == [disc.center for disc in discs for _ in "rv"]
            assert boxes[1].extents == pytest.approx(boxes[0].padded(-radius).extents)
    assert filled == panels
