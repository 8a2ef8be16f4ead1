"""Chromium without a window, spoken to through its debugging pipe: no port, no driver.

    with Browser() as browser:
        page = browser.open(path)
        page.value("document.title")
"""

import base64
import fcntl
import io
import json
import os
import select
import shutil
import subprocess
import tempfile
import time

import numpy as np
from PIL import Image

PROGRAMS = ("chromium", "chromium-browser", "google-chrome")
SOFTWARE = (
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
)  # WebGL without a graphics card
NO_WEBGL = ("--disable-3d-apis", "--disable-gpu")
PATIENCE = 60  # s


def program():
    """Chromium's path, or None."""
    return next(filter(None, map(shutil.which, PROGRAMS)), None)


class Browser:
    """``webgl``: whether pages have it; ``size``: of the window, pixels."""

    def __init__(self, webgl=True, size=(1366, 768)):
        self.home = tempfile.mkdtemp()
        ours, its = os.pipe(), os.pipe()  # commands to it, answers from it

        def connect():  # it reads descriptor 3 and writes descriptor 4
            read, write = (fcntl.fcntl(one, fcntl.F_DUPFD, 5) for one in (ours[0], its[1]))
            os.dup2(read, 3)
            os.dup2(write, 4)
            os.close(read), os.close(write)

        self.process = subprocess.Popen(
            [
                program(),
                "--headless=new",
                "--no-sandbox",
                "--remote-debugging-pipe",
                "--no-first-run",
                "--disable-background-networking",
                "--disable-component-update",
                "--disable-sync",
                "--force-device-scale-factor=1",
                "--force-color-profile=srgb",
                "--hide-scrollbars",
                f"--window-size={size[0]},{size[1]}",
                f"--user-data-dir={self.home}",
                *(SOFTWARE if webgl else NO_WEBGL),
                "about:blank",
            ],
            env={**os.environ, "HOME": self.home},
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            preexec_fn=connect,
            close_fds=False,
        )
        os.close(ours[0]), os.close(its[1])
        self.out, self.back = ours[1], its[0]
        self.kept, self.number, self.events = b"", 0, []

    def __enter__(self):
        return self

    def __exit__(self, *_):
        try:
            self.call("Browser.close")
        except (OSError, AssertionError):
            pass
        try:
            self.process.wait(10)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
        os.close(self.out), os.close(self.back)
        shutil.rmtree(self.home, ignore_errors=True)

    def call(self, method, session=None, **given):
        """What Chromium answers to a command of its protocol."""
        self.number += 1
        asked = {"id": self.number, "method": method, "params": given}
        if session:
            asked["sessionId"] = session
        os.write(self.out, json.dumps(asked).encode() + b"\0")
        end = time.monotonic() + PATIENCE
        while True:
            found = self._message(end)
            if found.get("id") == self.number:
                assert "error" not in found, f"{method}: {found['error']}"
                return found["result"]
            self.events.append(found)

    def _message(self, end):
        while b"\0" not in self.kept:
            ready, _, _ = select.select([self.back], [], [], max(end - time.monotonic(), 0))
            assert ready, "Chromium does not answer"
            data = os.read(self.back, 1 << 20)
            assert data, "Chromium has ended"
            self.kept += data
        text, _, self.kept = self.kept.partition(b"\0")
        return json.loads(text)

    def open(self, path, dark=False, size=None):
        """The ``Page`` of a file."""
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        return Page(self, session, target, path, dark, size)


class Page:
    """A page that is loaded. ``requests``: all addresses that it asked for, but for what it holds itself; ``faults``: what its console told."""

    def __init__(self, browser, session, target, path, dark, size):
        self.browser, self.session, self.target = browser, session, target
        for domain in ("Page", "Runtime", "Network", "Log"):
            self.call(f"{domain}.enable")
        scheme = {"name": "prefers-color-scheme", "value": "dark" if dark else "light"}
        self.call("Emulation.setEmulatedMedia", features=[scheme])
        if size:
            metrics = {"width": size[0], "height": size[1], "deviceScaleFactor": 1, "mobile": False}
            self.call("Emulation.setDeviceMetricsOverride", **metrics)
        self.call("Page.navigate", url=f"file://{path}")
        self.wait("document.readyState === 'complete'")

    def call(self, method, **given):
        return self.browser.call(method, self.session, **given)

    def value(self, expression):
        """What an expression of JavaScript gives, promises awaited."""
        found = self.call(
            "Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True
        )
        assert "exceptionDetails" not in found, found["exceptionDetails"]
        return found["result"].get("value")

    def wait(self, expression, patience=PATIENCE):
        """Until an expression is true."""
        end = time.monotonic() + patience
        while not self.value(expression):
            assert time.monotonic() < end, f"never: {expression}; {self.faults}"
            time.sleep(0.02)

    def settle(self):
        """Until what was asked for is drawn."""
        self.value(
            "new Promise(d => requestAnimationFrame(() => requestAnimationFrame(() => d(1))))"
        )

    def _told(self, *methods):
        mine = (e for e in self.browser.events if e.get("sessionId") == self.session)
        return [event["params"] for event in mine if event["method"] in methods]

    @property
    def requests(self):
        self.value("1")  # takes in what has come meanwhile
        asked = [one["request"]["url"] for one in self._told("Network.requestWillBeSent")]
        return [address for address in asked if not address.startswith("data:")]

    @property
    def faults(self):
        kinds = ("error", "warning", "assert")
        calls = [one for one in self._told("Runtime.consoleAPICalled") if one["type"] in kinds]
        logs = [one["entry"] for one in self._told("Log.entryAdded")]
        # swiftshader's own remarks on how fast the test itself reads pixels
        logs = [one for one in logs if "GPU stall due to ReadPixels" not in one["text"]]
        return [
            *calls,
            *[one for one in logs if one["level"] in kinds],
            *self._told("Runtime.exceptionThrown"),
        ]

    def picture(self, box=None):
        """(rows, columns, 3) uint8 of the window, or of a box [x, y, width, height] of it."""
        self.settle()
        clip = {}
        if box:
            clip["clip"] = dict(zip(("x", "y", "width", "height"), box), scale=1)
        data = base64.b64decode(self.call("Page.captureScreenshot", format="png", **clip)["data"])
        return np.asarray(Image.open(io.BytesIO(data)).convert("RGB"))

    def box(self, selector):
        """[x, y, width, height] of an element in the window."""
        return self.value(
            f"(b => [b.x, b.y, b.width, b.height])(document.querySelector({selector!r})"
            ".getBoundingClientRect())"
        )

    def mouse(self, kind, x, y, **more):
        self.call("Input.dispatchMouseEvent", type=f"mouse{kind}", x=x, y=y, **more)

    def hover(self, x, y):
        self.mouse("Moved", x, y)
        self.settle()

    def click(self, selector):
        """On the middle of an element, which is scrolled to."""
        self.value(f"document.querySelector({selector!r}).scrollIntoView({{block: 'center'}}), 1")
        x, y, width, height = self.box(selector)
        self.press(x + 0.5 * width, y + 0.5 * height)

    def press(self, x, y):
        for kind in ("Pressed", "Released"):
            self.mouse(kind, x, y, button="left", clickCount=1, buttons=1)
        self.settle()

    def drag(self, x, y, dx, dy, button="left", **more):
        held = {"left": 1, "right": 2}[button]
        self.mouse("Pressed", x, y, button=button, buttons=held, clickCount=1, **more)
        for k in range(1, 6):
            self.mouse("Moved", x + dx * k / 5, y + dy * k / 5, button=button, buttons=held, **more)
        self.mouse("Released", x + dx, y + dy, button=button, clickCount=1, **more)
        self.settle()

    def choose(self, selector, value):
        """Sets a field, as a hand does."""
        self.value(
            f"(e => {{ e.value = {json.dumps(value)}; e.dispatchEvent(new Event('input', {{bubbles: true}}));"
            f" e.dispatchEvent(new Event('change', {{bubbles: true}})); return 1; }})"
            f"(document.querySelector({selector!r}))"
        )
        self.settle()

    def close(self):
        self.browser.call("Target.closeTarget", targetId=self.target)
