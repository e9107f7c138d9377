"""A number could be returned where there is none: each case is refused in a sentence."""

import pytest

from twodiscs.model.box import Box
from twodiscs.model.checks import InputError
from twodiscs.model.scene import Scene
from twodiscs.theory import channel, exact, laws, three, virial
from twodiscs_paper.studies.stability.closed_form import closed_form
from twodiscs_paper.studies.thresholds.measure import leading_law

PAPER = Scene(1.5, 1.0, 0.2)
UNEQUAL = Scene(1.5, 1.0, 0.2, radius_ratio=0.5, field=0.1)
NOT_PLAIN = r"must be plain .* it has radius_ratio, field"
CASES = [
    (lambda: channel.derivatives(Scene(3.0, 1.0, 0.2, discs=4)), "ordered channel"),
    (lambda: channel.limit(1.0, 0.2, 1.0), "2 \\+ √3 radii"),
    (lambda: channel.limit(0.6, 0.18, 0.0), "force must"),
    (lambda: three.derivatives(Scene(1.5, 1.0, 0.1, discs=4)), "three discs"),
    (lambda: three.derivatives(Scene(1.5, 1.0, 0.1, discs=3, periodic="x")), "three discs"),
    (lambda: virial.weights(0.2), "scene must be"),
    (lambda: exact.fraction_near(PAPER, "any_wall", 0.1), "must"),
    (lambda: exact.fraction_near(PAPER, "horizontal_hop", 0.3), "must"),
    (lambda: exact.fraction_near(PAPER, "horizontal_hop", 0.0), "must"),
    (lambda: exact.fraction_near(PAPER, "vertical_hop", None), "must"),
    (lambda: closed_form(UNEQUAL), NOT_PLAIN),
    (lambda: laws.threshold_time(UNEQUAL, "any_wall"), NOT_PLAIN),
    (lambda: laws.small_radius_time(Box.of(UNEQUAL), "any_wall"), NOT_PLAIN),
    (lambda: leading_law(Box.of(UNEQUAL), "any_wall"), NOT_PLAIN),
    (lambda: laws.density_at_zero(UNEQUAL, "vertical_hop"), NOT_PLAIN),
    (lambda: laws.tail_constant(UNEQUAL, "disc_collision"), NOT_PLAIN),
]


@pytest.mark.parametrize(("call", "sentence"), CASES)
def test_what_has_no_number_is_refused(call, sentence):
    with pytest.raises(InputError, match=sentence):
        call()
