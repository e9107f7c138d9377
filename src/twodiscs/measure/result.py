"""A result with its settings and sums: it can be saved, loaded, and taken to a smaller error."""

from __future__ import annotations

import sys
from collections.abc import Callable
from contextlib import contextmanager
from copy import deepcopy
from html import escape
from os import PathLike
from typing import ClassVar, Self

import twodiscs
from twodiscs.model.checks import InputError
from twodiscs.model.formats import quote
from twodiscs.model.scene import Scene
from twodiscs.points.base import file_content, write_json


class Settings:
    """The attribute ``settings``: a reader gets a copy, whose changes do not change the result."""

    def __get__(self, result, owner=None):
        if result is None:
            raise AttributeError("settings are those of a result")
        return deepcopy(vars(result)["settings"])

    def __set__(self, result, value):
        vars(result)["settings"] = value


class Immutable:
    """The base of what does not change: a copy is the object itself, with its correlations."""

    def __copy__(self) -> Self:
        return self

    def __deepcopy__(self, memo: dict) -> Self:
        return self


class Printed(Immutable):
    """The base of objects that print as their ``scene``, a table and maybe a ``note``.

    A class has a method ``_texts``, which returns the texts of the printed table.
    """

    scene: Scene
    #: The difference between the work that was asked for and the work that was done, None if none.
    note: str | None = None

    def __str__(self) -> str:
        parts = self.scene, self._texts().to_string(index=False), self.note
        return "\n\n".join(str(part) for part in parts if part)

    def __repr__(self) -> str:
        return str(self)

    def _repr_html_(self) -> str:
        note = f"<p>{escape(self.note)}</p>" if self.note else ""
        return f"<p>{escape(str(self.scene))}</p>{self._texts().to_html(index=False)}{note}"


class Result(Printed):
    """A result and how it was made: ``kind`` is the function of the face that made it.

    ``settings`` are its arguments beside the scene, {name: value}, with the seed and the error that
    was asked for; ``version`` is the version of the package. ``components`` are those of its run
    (see ``points.base``), from which it goes on. ``makers`` are the functions that make a result,
    {kind: function}: each takes the arguments of its call, and the components ``resume_from``. Its
    sums are numbers of the type ``sums``.
    """

    kind: ClassVar[str]
    makers: ClassVar[dict[str, Callable]]
    sums: ClassVar[type] = int
    settings = Settings()
    components: dict[str, dict]
    version: str = twodiscs.__version__

    def _again(self, larger, **how):
        """Return the result of the settings with ``larger`` ones, which goes on from this one."""
        asked = self.settings | larger
        return self.makers[self.kind](self.scene, **asked, **how, resume_from=self.components)

    def __eq__(self, other):
        """Return whether the other result has the same kind, scene, settings and rows."""
        if type(other) is not type(self):
            return NotImplemented
        ours, theirs = ((r.scene, r.settings, r.rows) for r in (self, other))
        return ours == theirs

    def more(
        self, amount: object = None, *, cores: int = 1, progress: bool | None = None, **larger
    ) -> Self:
        """Return a result from more work, which goes on from this one.

        It is the same, bit for bit, as the result of one call with the new arguments.

        Parameters
        ----------
        amount : optional
            The argument that says how much work there is: a smaller error, a longer duration, more
            samples, intervals (``number``), hops or replicas.
        cores : int, default 1
            Cores to work on.
        progress : bool, optional
            Whether to show a progress bar; if left out, only in a terminal or a notebook.
        **larger
            The same by name, or a larger ``budget``. A smaller one gives less. A result of
            ``observe`` from a file also takes its ``function`` again: the same one, which no file
            holds.

        Returns
        -------
        Measurements, Intervals, Transmission, Observed or Scan
            The result, which includes the work of this one.

        Raises
        ------
        InputError
            For an argument that is not among the ``settings`` of this result.

        Examples
        --------
        >>> some = td.simulate(scene, duration=1e3, seed=1, events="any_wall")
        >>> some.more(duration=1e4) == td.simulate(scene, duration=1e4, seed=1, events="any_wall")
        True
        """
        # Settings that can grow; the first one that is set is the amount.
        names = "error", "samples", "number", "hops", "replicas", "duration", "budget", "function"
        names = [name for name in names if name in self.settings]
        if amount is not None:
            first = next(name for name in names if self.settings[name] is not None)
            larger = {first: amount} | larger
        larger = {name: value for name, value in larger.items() if value is not None}
        if unknown := [name for name in larger if name not in names]:
            raise InputError(
                f"{unknown[0]} must be left out for a result of {self.kind}: to go on, give "
                f"{' or '.join(f'{name}=' for name in names)}"
            )
        return self._again(larger, cores=cores, progress=progress)

    def to_dict(self) -> dict[str, object]:
        """Return the result as ``save`` writes it.

        Returns
        -------
        dict
            Numbers, texts, lists and dicts.

        Examples
        --------
        >>> content = td.simulate(scene, duration=1e3, seed=7).to_dict()
        >>> content["kind"], content["settings"]["seed"]
        ('simulate', 7)
        """
        return file_content(self.kind, self.scene.parameters(), self.settings, self.components)

    def save(self, path: str | PathLike[str]) -> None:
        """Write the result to a JSON file that ``load_result`` reads.

        Parameters
        ----------
        path : path-like
            The file.

        Raises
        ------
        InputError
            For a path that cannot be written.

        Examples
        --------
        >>> md = td.simulate(scene, duration=1e3, seed=1)
        >>> md.save("md.json")
        >>> td.load_result("md.json") == md
        True
        """
        write_json(path, self.to_dict())


def data_frame(rows, columns=None, index=None):
    """Return a ``DataFrame`` of some rows; its ``index`` may be one or more of its columns."""
    import pandas as pd

    frame = pd.DataFrame(rows, columns=columns)
    return frame if index is None else frame.set_index(index)


def work(kind, run, cores=1, progress=None, resume_from=None):
    """Return the point of a ``run`` of a ``kind`` of result, with a progress bar.

    The components ``resume_from`` of an earlier run are not done again.
    """
    with progress_bar(progress, f"{kind} r = {run.scene.radius:g}") as progress:
        return run.run(progress, cores, resume_from)


def note_of_number(what, asked, done, fewer="the budget ended the run"):
    """Return the note that a number was rounded up, or why ``fewer`` were done; None if neither."""
    why = "work is done in whole blocks" if done > asked else fewer
    return None if done == asked else f"You asked for {asked} {what} and got {done}, because {why}."


#: Seconds before a bar appears: shorter work needs none.
BAR_DELAY = 1.0

BAR_FORMAT = "{desc}: {percentage:3.0f}% |{bar}| {elapsed}, {remaining} left"


@contextmanager
def progress_bar(progress, what):
    """Give a function of the work done (None: as before) and the work in all, or None.

    ``progress`` says whether it shows a bar with the name ``what``; None means only in a terminal
    or a notebook, so that logs stay clean. Without a bar there is no function, but None.
    """
    if progress is None:
        terminal = getattr(sys.stderr, "isatty", bool)  # a logger in its place may have none
        progress = terminal() or "ipykernel" in sys.modules
    elif not isinstance(progress, bool):
        raise InputError(f"progress must be True, False or None, not {quote(progress)}")
    if not progress or sys.stderr is None:
        yield None
        return
    from importlib.util import find_spec
    from time import monotonic

    from twodiscs.sampling.jit import compiling

    # A notebook without widgets shows a line of text, which is enough. tqdm.auto would warn of it.
    if "ipykernel" in sys.modules and find_spec("ipywidgets"):
        from tqdm.notebook import tqdm
    else:
        from tqdm import tqdm

    shown = monotonic()
    with tqdm(desc=what, total=1, leave=False, delay=BAR_DELAY, bar_format=BAR_FORMAT) as bar:

        def progress(done, total):
            nonlocal shown
            bar.total = max(total, bar.n if done is None else done)
            if done is not None:
                bar.set_description_str(what, refresh=False)
                bar.update(done - bar.n)
            elif monotonic() - shown > BAR_DELAY:
                shown = monotonic()
                bar.set_description_str(f"{what}, compiling" if compiling() else what)

        yield progress
