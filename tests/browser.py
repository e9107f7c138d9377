"""A browser to drive: Chromium without a window, told what to do over a pair of pipes.

It speaks the DevTools protocol, a JSON message each way, ended by a zero byte.
"""

import json
import shutil
import subprocess
from contextlib import contextmanager
from itertools import takewhile
from pathlib import Path

import axe_core_python

BROWSERS = ("chromium", "chromium-browser", "google-chrome")
BROWSER = next(filter(None, map(shutil.which, BROWSERS)), None)
ABSENT = f"no Chromium is installed, none of {', '.join(BROWSERS)}"

#: Options that keep the browser from the network and from questions.
OPTIONS = (
    *("--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run"),
    *("--disable-background-networking", "--disable-component-update", "--disable-sync"),
    *("--hide-scrollbars", "--remote-debugging-pipe"),
)

#: The browser reads messages from 3 and writes them to 4.
PIPES = 'exec "$0" "$@" 3<&0 4>&1 </dev/null >/dev/null 2>&1'


class Page:
    """One page of a browser; ``problems`` collects what went wrong or was asked of the network."""

    def __init__(self, process):
        self.process, self.sent, self.session, self.problems = process, 0, {}, []
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        attached = self.call("Target.attachToTarget", targetId=target, flatten=True)
        self.session = {"sessionId": attached["sessionId"]}
        for domain in ("Page", "Runtime", "Network", "Log"):
            self.call(f"{domain}.enable")

    def call(self, method, **params):
        """Send a command and return its result; problems meanwhile are kept."""
        self.sent += 1
        message = {"id": self.sent, "method": method, "params": params} | self.session
        self.process.stdin.write(json.dumps(message).encode() + b"\0")
        self.process.stdin.flush()
        while (answer := self.message()).get("id") != self.sent:
            event, params = answer.get("method"), answer.get("params", {})
            address = params.get("request", {}).get("url", "file:")
            if event in ("Runtime.exceptionThrown", "Log.entryAdded"):
                self.problems.append(json.dumps(params))
            elif not address.startswith(("file:", "data:", "about:")):
                self.problems.append(address)
        assert "error" not in answer, answer
        return answer["result"]

    def message(self):
        """Return the next message; a browser that has ended sends an empty text."""
        letters = iter(lambda: self.process.stdout.read(1), b"")
        return json.loads(b"".join(takewhile(b"\0".__ne__, letters)))

    def open(self, address, width=1280, height=1000, reduced=False, scheme="light"):
        """Go to an address, in a window of some pixels and a scheme, with motion maybe reduced."""
        size = {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": False}
        self.call("Emulation.setDeviceMetricsOverride", **size)
        media = {"reduced-motion": "reduce" if reduced else "", "color-scheme": scheme}
        features = [{"name": f"prefers-{name}", "value": value} for name, value in media.items()]
        self.call("Emulation.setEmulatedMedia", features=features)
        for place in ("about:blank", address):
            self.call("Page.navigate", url=place)
        self.until("document.readyState === 'complete'")

    def look(self, expression):
        """Return the value of an expression in JavaScript; a promise is waited for."""
        how = {"awaitPromise": True, "returnByValue": True}
        answer = self.call("Runtime.evaluate", expression=expression, **how)
        assert "exceptionDetails" not in answer, answer["exceptionDetails"]
        return answer["result"].get("value")

    def violations(self):
        """Return what axe-core finds on the page, without frames: [[rule, impact, element], …]."""
        axe = Path(axe_core_python.__file__).with_name("axe.min.js").read_text(encoding="utf-8")
        self.look(f"{axe}; 1")
        found = "violations.map(one => [one.id, one.impact, one.nodes[0].html])"
        return self.look(f"axe.run({{iframes: false}}).then(result => result.{found})")

    def until(self, condition, milliseconds=60000):
        """Wait until an expression is true; raise ``AssertionError`` after so long."""
        came = self.look(
            f"new Promise(done => {{ setTimeout(done, {milliseconds});"
            f" (function ask() {{ {condition} ? done(true) : setTimeout(ask, 20); }})(); }})"
        )
        assert came, f"not within {milliseconds} ms: {condition}"


@contextmanager
def browser(folder):
    """Yield a ``Page`` of a new browser, whose files are in ``folder``."""
    words = ["sh", "-c", PIPES, BROWSER, *OPTIONS, f"--user-data-dir={folder / 'profile'}"]
    pipe = subprocess.PIPE
    with subprocess.Popen(words, stdin=pipe, stdout=pipe) as process:
        yield Page(process)
        process.terminate()
