"""The rows of a trajectory: arrays that kernels fill, one row an event, and the names of events."""

from typing import NamedTuple

import numpy as np

from twodiscs.sampling.jit import inlined

#: Kinds of rows. After ``WALL`` there are the walls of x, y and z that disc 1 hits, then disc 2 …
START, END, KICK, VERTICAL_HOP, HORIZONTAL_HOP, COLLISION, WALL = range(7)

#: Numbers in the states of the rows that are made at a time, which stay in the cache. The length
#: of a column is no power of two: its rows would share a few lines of the cache, which takes seven
#: times as long.
CHUNK_NUMBERS, CHUNK_PADDING = 2**16, 8


class Rows(NamedTuple):
    """Some rows of a trajectory, in the order of time.

    ``discs`` are those of the event, 0 for none. ``states`` are those right after it.
    """

    times: np.ndarray  # (n,)
    kinds: np.ndarray  # (n,)
    discs: np.ndarray  # (2, n)
    states: np.ndarray  # (components, n)

    @classmethod
    def joined(cls, parts):
        """Return all rows of a list of ``Rows``, which is emptied: memory has no row twice."""
        end = sum(part.times.size for part in parts)
        whole = cls(*(np.empty((*array.shape[:-1], end), array.dtype) for array in parts[0]))
        while parts:
            last = parts.pop()
            start = end - last.times.size
            for array, some in zip(whole, last, strict=True):
                array[..., start:end] = some
            end = start
        return whole

    def first(self, number):
        """Return the first rows."""
        return Rows(*(array[..., :number] for array in self))

    def events(self):
        """Yield (time, name of the event, first disc, second disc, state) of each row."""
        names, states = event_names(self.states.shape[0]), zip(*self.states.tolist(), strict=True)
        plain = (array.tolist() for array in (self.times, self.kinds, *self.discs))
        for time, kind, first, second, state in zip(*plain, states, strict=True):
            yield time, names[kind], first or None, second or None, state


def event_names(discs):
    """Return the names of all that a row may be, for a number of ``discs`` at most."""
    walls = [f"wall_{axis}{disc}" for disc in range(1, discs + 1) for axis in "xyz"]
    hops = "vertical_hop", "horizontal_hop", "disc_collision"
    return np.array(["start", "end", "kick", *hops, *walls], object)


def new_rows(components, least=64):
    """Return ``Rows`` to fill, ``least`` or more, of states of a number of ``components``."""
    number = max(least, CHUNK_NUMBERS // components) + CHUNK_PADDING
    times, states = np.empty(number), np.empty((components, number))
    return Rows(times, np.empty(number, np.int64), np.empty((2, number), np.int64), states)


def start_row(state):
    """Return the first row of a trajectory, with its ``state``."""
    return Rows(np.zeros(1), np.array([START]), np.zeros((2, 1), np.int64), np.array([state]).T)


@inlined
def put_event(rows, n, time, kind, first, second):
    """Set row ``n``, except its state."""
    rows.times[n], rows.kinds[n] = time, kind
    rows.discs[0, n], rows.discs[1, n] = first, second
