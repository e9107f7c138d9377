"""What Snakemake needs to begin: no lock of a run that was killed, a name, a cache; and to end."""

import fcntl
import getpass
import os
import signal
import socket
import sys
from pathlib import Path
from threading import Thread, current_thread, main_thread

#: The open file by which this process says, for as long as it lives, that it uses a folder.
_held = []


def make_do():
    """Give Snakemake a user's name where there is none, and a cache where no other can be."""
    try:
        getpass.getuser()
    except (KeyError, OSError):  # no variable, and no entry in the list of users
        os.environ["USER"] = str(os.getuid())
    cache = Path(os.environ.get("XDG_CACHE_HOME") or os.path.expanduser("~/.cache"), "snakemake")
    try:
        cache.mkdir(parents=True, exist_ok=True)
        writable = os.access(cache, os.W_OK)
    except OSError:
        writable = False
    if not writable:
        os.environ["XDG_CACHE_HOME"] = os.path.abspath(".snakemake/cache")


def release(folder=".snakemake"):
    """Remove the locks that no living run on this machine holds, with a word, and say that one is.

    A run shares a lock of the operating system on the file ``held``, which ends with the process
    however that ends. Where the file system knows no such locks, or another machine was the last to
    use the folder, Snakemake's own locks stay, and with them its advice. Returns whether no other
    run lives.
    """
    place, host = Path(folder), socket.gethostname()
    try:
        place.mkdir(exist_ok=True)
        held = open(place / "held", "a+")  # noqa: SIM115
        _held.append(held)
        held.seek(0)
        try:
            fcntl.flock(held, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:  # another run lives
            alone = False
        else:
            alone = True
            stale = sorted(place.glob("locks/*.lock"))
            if stale and held.read() == host:
                for path in stale:
                    os.remove(path)
                stale = []
                print("The lock of a run that was killed is removed.", file=sys.stderr)
            if not stale:
                held.truncate(0)
                held.write(host)
                held.flush()
        fcntl.flock(held, fcntl.LOCK_SH)
    except OSError:
        return False
    return alone


def end_aside():
    """Have the handler of SIGTERM run in a thread of its own.

    That of Snakemake waits for a lock. Where the signal interrupts the very code that holds it, the
    run would wait for ever.
    """
    handler = signal.getsignal(signal.SIGTERM)

    def aside(*received):
        Thread(target=handler, args=received).start()

    if callable(handler) and current_thread() is main_thread():
        signal.signal(signal.SIGTERM, aside)
