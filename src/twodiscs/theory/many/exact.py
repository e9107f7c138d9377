"""The exact numbers of N discs, where there are any: which method has them.

Two discs have the plain theory, three the quadrature between its kinks, and any number in a channel
so low that they keep their order the transfer operator. Of all others no exact value is known here,
which is not to say that an event is impossible.
"""

import math

from twodiscs.model.scene import Scene
from twodiscs.theory import plain
from twodiscs.theory.many import channel, three
from twodiscs.theory.many.rates import Measures, rates


def method(gas):
    """Return which theory knows a ``Gas``: "plain", "three", "channel", or None."""
    if gas.periodic:
        return None
    if gas.discs < 4:
        return "plain" if gas.discs == 2 else "three"
    return "channel" if gas.is_ordered or gas.turned().is_ordered else None


def measures(gas, hops=True):
    """Return the ``Measures`` of a ``Gas``, None where no exact value is known here.

    ``hops`` False leaves out the hops in a channel, which take longest.
    """
    known = method(gas)
    if known == "plain":
        volume, areas = plain.exact(Scene(gas.width, gas.height, gas.radius))
        root = math.sqrt(2)
        return Measures(
            math.log(volume),
            2 * areas["right_wall"] / volume,
            2 * areas["top_wall"] / volume,
            areas["disc_collision"] / root / volume,
            areas["horizontal_hop"] / root / volume,
            areas["vertical_hop"] / root / volume,
        )
    if known == "three":
        return three.measures(gas)
    if known == "channel":
        if gas.is_ordered:
            return channel.measures(gas, hops)
        return channel.measures(gas.turned(), hops).turned()
    return None


def mean_times(gas):
    """Return {class of events: mean time between two events that share its rate}.

    For walls that is one disc at one wall, averaged over all initial conditions; for collisions and
    hops any pair. None where the event is impossible; an empty dict where no exact value is known.
    """
    known = measures(gas)
    if known is None:
        return {}
    return {
        event: gas.multiplicity(event) / rate if rate else None
        for event, rate in rates(gas, known).items()
    }
