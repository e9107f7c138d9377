"""The style of all figures: size, fonts, colours, looks of events, and files of the same bytes.

The bytes of a file depend only on its content.

Everything is drawn and saved inside ``context()``, which overrides the matplotlib settings of the
machine. pyplot is not used: nothing here needs windows, and its import takes time.
"""

import logging
import threading
from contextlib import contextmanager
from io import BytesIO
from pathlib import Path

import matplotlib
from matplotlib import rc_params_from_file
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.font_manager import findfont, fontManager

from twodiscs.model.checks import InputError, path_text, writing_to
from twodiscs.model.events import EVENTS

#: Width of one column of a two-column journal, in inches.
COLUMN_WIDTH = 3.4

# The palette of Okabe and Ito, distinguishable with any colour vision.
BLACK, ORANGE, SKY, GREEN = "#000000", "#E69F00", "#56B4E9", "#009E73"
BLUE, VERMILLION, PURPLE = "#0072B2", "#D55E00", "#CC79A7"
GREY = "#6E6E6E"

#: (colour, marker) of the first, second, … series of a figure: all differ in both.
SERIES = ((BLUE, "o"), (VERMILLION, "s"), (GREEN, "^"), (PURPLE, "D"))

#: Sizes of the markers, in points: if two series coincide, both are visible.
MARKER_SIZES = {"o": 3.7, "s": 2.5, "^": 3.0, "D": 2.3, "v": 3.0, "P": 3.2}

#: The settings of matplotlib, from the file beside this one.
RC_PARAMS = rc_params_from_file(Path(__file__).with_name("figures.mplstyle"), False, False)


def _have_fonts():
    """Add the fonts that come with matplotlib if its list of fonts in the user's home lacks them.

    A partly removed installation leaves such a list, and texts would have different sizes.
    """
    try:
        for family in RC_PARAMS["font.family"]:
            findfont(family, fallback_to_default=False)
    except ValueError:
        for path in sorted(Path(matplotlib.get_data_path(), "fonts", "ttf").glob("*.ttf")):
            fontManager.addfont(path)


#: Settings of matplotlib and loggers belong to the process: one thread at a time changes them.
_ONE_AT_A_TIME = threading.RLock()


@contextmanager
def context():
    """Draw and save in the style of this package, and restore the user's settings afterwards."""
    with _ONE_AT_A_TIME, matplotlib.rc_context():
        _have_fonts()
        matplotlib.rcdefaults()
        matplotlib.rcParams.update(RC_PARAMS)
        # The files of Computer Modern have dates that fontTools warns about, once for each file.
        logger = logging.getLogger("fontTools")
        level = logger.level
        logger.setLevel(logging.ERROR)
        try:
            yield
        finally:
            logger.setLevel(level)


class StyledFigure(Figure):
    """A figure that is also drawn and saved in the style of this package by its own methods."""

    def draw(self, renderer):
        with context():
            super().draw(renderer)

    def savefig(self, *args, **options):
        with context():
            super().savefig(*args, **options)

    def settle(self):
        """Place all parts for good: a layout that is computed again moves them by a pixel."""
        if self.get_layout_engine() is not None:
            with context():
                self.get_layout_engine().execute(self)
            self.set_layout_engine("none")

    def _repr_png_(self):
        """Return the picture that a notebook shows."""
        stream = BytesIO()
        self.savefig(stream, format="png", dpi=150)
        return stream.getvalue()


def new_figure(height, width=COLUMN_WIDTH, **options):
    """Return an empty figure of ``width`` × ``height`` inches, with ``options`` of matplotlib."""
    figure = StyledFigure(figsize=(width, height), **options)
    FigureCanvasAgg(figure)
    return figure


def save(figure, path, origin=None):
    """Write ``figure`` to ``path`` (.pdf, .png or .svg) without dates or names of programs in it.

    ``origin``, a line about its origin, goes into its metadata.

    Raises ``InputError`` for a file name with another ending, and if it cannot be written.
    """
    kind = path_text(path).rpartition(".")[2].lower()
    metadata = {
        "pdf": {"Creator": None, "Producer": None, "CreationDate": None, "Subject": origin},
        "png": {"Software": None, "Description": origin},
        "svg": {"Creator": None, "Date": None, "Description": origin},
    }
    if kind not in metadata:
        raise InputError(f"path must be a .pdf, .png or .svg file, not {path_text(path)!r}")
    if isinstance(figure, StyledFigure):
        figure.settle()
    stream = BytesIO()  # a full disk ends savefig() of a PDF by an error of zlib
    figure.savefig(stream, format=kind, metadata=metadata[kind])
    with writing_to(path) as new:
        Path(new).write_bytes(stream.getvalue())


#: (colour, marker) of the events in their order; all colours differ, and all markers.
_LOOKS = (*SERIES, (ORANGE, "v"), (SKY, "P"), (PURPLE, "v"), (GREEN, "D"))
if len(EVENTS) > len(_LOOKS):
    raise TypeError(f"figures/style.py has {len(_LOOKS)} looks, too few for {len(EVENTS)} events")

#: {event: (colour, marker)}
EVENT_LOOKS = dict(zip(EVENTS, _LOOKS, strict=False))


def event_name(event):
    """Return the name of an event for people: "vertical hops", "disc collisions", "right wall"."""
    words = event.replace("_", " ")
    return words if words.endswith("wall") else f"{words}s"
