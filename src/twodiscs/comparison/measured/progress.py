"""How far it is, for who waits: a bar with the time left, in a terminal or a notebook."""

import sys
from contextlib import contextmanager

from twodiscs.model.checks import InputError, quote

#: Seconds before a bar is shown: what is done sooner needs none.
PATIENCE = 1.0

BAR = "{desc}: {percentage:3.0f}% |{bar}| {elapsed}, {remaining} left"


@contextmanager
def progress_bar(progress, what):
    """Give a function that takes what is done (None: as before) and how much it will be, or None.

    ``progress`` says whether a bar with the name ``what`` shows it; None means in a terminal or a
    notebook alone, so that logs stay clean.
    """
    if progress is None:
        progress = sys.stderr.isatty() or "ipykernel" in sys.modules
    elif not isinstance(progress, bool):
        raise InputError(f"progress must be True, False or None, not {quote(progress)}")
    if not progress:
        yield None
        return
    import warnings
    from time import monotonic

    with warnings.catch_warnings():
        # A notebook without widgets has a line of text instead, which is fine.
        warnings.simplefilter("ignore")
        from tqdm.auto import tqdm

    start = monotonic()
    with tqdm(desc=what, total=1, leave=False, delay=PATIENCE, bar_format=BAR) as bar:

        def progress(done, total):
            bar.total = max(total, bar.n if done is None else done)
            if done is not None:
                bar.update(done - bar.n)
            elif monotonic() - start > PATIENCE:
                bar.refresh()

        yield progress
