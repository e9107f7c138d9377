"""A progress bar with the time left, in a terminal or a notebook."""

import sys
from contextlib import contextmanager

from twodiscs.model.checks import InputError, quote

#: Seconds before a bar appears: shorter work needs none.
PATIENCE = 1.0

BAR = "{desc}: {percentage:3.0f}% |{bar}| {elapsed}, {remaining} left"


@contextmanager
def progress_bar(progress, what):
    """Give a function of the work done (None: as before) and the work in all, or None.

    ``progress`` says whether it shows a bar with the name ``what``; None means only in a terminal
    or a notebook, so that logs stay clean. Without a bar there is no function, but None.
    """
    if progress is None:
        terminal = sys.stderr is not None and sys.stderr.isatty()
        progress = terminal or "ipykernel" in sys.modules
    elif not isinstance(progress, bool):
        raise InputError(f"progress must be True, False or None, not {quote(progress)}")
    if not progress:
        yield None
        return
    from importlib.util import find_spec
    from time import monotonic

    # A notebook without widgets shows a line of text, which is enough. tqdm.auto would warn of it.
    if "ipykernel" in sys.modules and find_spec("ipywidgets"):
        from tqdm.notebook import tqdm
    else:
        from tqdm import tqdm

    start = monotonic()
    with tqdm(desc=what, total=1, leave=False, delay=PATIENCE, bar_format=BAR) as bar:

        def progress(done, total):
            bar.total = max(total, bar.n if done is None else done)
            if done is not None:
                bar.update(done - bar.n)
            elif monotonic() - start > PATIENCE:
                bar.refresh()

        yield progress
