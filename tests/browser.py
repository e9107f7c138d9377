"""A browser to drive: Chromium without a window, told what to do over a pair of pipes.

It speaks the DevTools protocol, a JSON message each way, ended by a zero byte.
"""

import fcntl
import json
import os
import shutil
import subprocess
from contextlib import contextmanager

BROWSERS = ("chromium", "chromium-browser", "google-chrome")
BROWSER = next(filter(None, map(shutil.which, BROWSERS)), None)
ABSENT = f"no Chromium is installed, none of {', '.join(BROWSERS)}"

#: Options that keep the browser from the network and from questions.
OPTIONS = (
    *("--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run"),
    *("--disable-background-networking", "--disable-component-update", "--disable-sync"),
    *("--hide-scrollbars", "--remote-debugging-pipe"),
)

#: Keys that move a slider, by their codes.
KEYS = {"ArrowLeft": 37, "ArrowRight": 39, "Home": 36, "End": 35, "Tab": 9}


class Page:
    """One page of a browser; ``problems`` collects what went wrong or was asked of the network."""

    def __init__(self, read, write):
        self.read, self.write = read, write
        self.sent, self.session, self.problems = 0, None, []
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        attached = self.call("Target.attachToTarget", targetId=target, flatten=True)
        self.session = attached["sessionId"]
        for domain in ("Page", "Runtime", "Network", "Log"):
            self.call(f"{domain}.enable")

    def call(self, method, **params):
        """Send a command and return its result; what happens meanwhile is looked at on the way."""
        self.sent += 1
        message = {"id": self.sent, "method": method, "params": params}
        if self.session:
            message["sessionId"] = self.session
        self.write.write(json.dumps(message).encode() + b"\0")
        self.write.flush()
        while True:
            answer = self.message()
            if answer.get("id") == self.sent:
                assert "error" not in answer, answer
                return answer["result"]
            self.note(answer)

    def message(self):
        """Return the next message."""
        text = bytearray()
        while (byte := self.read.read(1)) != b"\0":
            assert byte, "the browser has ended"
            text += byte
        return json.loads(text)

    def note(self, event):
        """Keep what an event says of a problem."""
        method, params = event.get("method"), event.get("params", {})
        if method in ("Runtime.exceptionThrown", "Log.entryAdded"):
            self.problems.append(json.dumps(params))
        elif method == "Network.requestWillBeSent":
            address = params["request"]["url"]
            if not address.startswith(("file:", "data:", "about:")):
                self.problems.append(address)

    def open(self, address, width=1280, height=1000, reduced=False):
        """Go to an address, in a window of some pixels, with motion maybe reduced."""
        self.call(
            "Emulation.setDeviceMetricsOverride",
            **{"width": width, "height": height, "deviceScaleFactor": 1, "mobile": False},
        )
        motion = {"name": "prefers-reduced-motion", "value": "reduce" if reduced else ""}
        self.call("Emulation.setEmulatedMedia", features=[motion])
        self.call("Page.navigate", url="about:blank")
        self.call("Page.navigate", url=address)
        self.look(
            "document.readyState === 'complete' || new Promise(d => addEventListener('load', d))"
        )

    def look(self, expression):
        """Return the value of an expression in JavaScript; a promise is waited for."""
        answer = self.call(
            "Runtime.evaluate", expression=expression, awaitPromise=True, returnByValue=True
        )
        assert "exceptionDetails" not in answer, answer["exceptionDetails"]
        return answer["result"].get("value")

    def until(self, condition, milliseconds=60000):
        """Wait until an expression is true; raise ``AssertionError`` after so long."""
        came = self.look(
            "new Promise(done => { const begun = performance.now(); (function ask() {"
            f" if ({condition}) done(true);"
            f" else if (performance.now() - begun > {milliseconds}) done(false);"
            " else setTimeout(ask, 20); })(); })"
        )
        assert came, f"not within {milliseconds} ms: {condition}"

    def press(self, key):
        """Press a key of ``KEYS``."""
        for kind in ("rawKeyDown", "keyUp"):
            self.call("Input.dispatchKeyEvent", type=kind, key=key, windowsVirtualKeyCode=KEYS[key])


@contextmanager
def browser(folder):
    """Yield a ``Page`` of a new browser, whose files are in ``folder``."""
    # The browser reads from 3 and writes to 4; the pipes that become these must have other numbers.
    pipes = [fcntl.fcntl(end, fcntl.F_DUPFD, 10) for end in (*os.pipe(), *os.pipe())]
    orders, order, said, say = pipes

    def moved():
        os.dup2(orders, 3)
        os.dup2(say, 4)

    process = subprocess.Popen(
        [BROWSER, *OPTIONS, f"--user-data-dir={folder / 'profile'}"],
        pass_fds=(3, 4),
        preexec_fn=moved,
        stderr=subprocess.DEVNULL,
    )
    os.close(orders)
    os.close(say)
    with open(said, "rb") as read, open(order, "wb") as write:
        try:
            yield Page(read, write)
        finally:
            process.terminate()
            process.wait()
