# SPDX-License-Identifier: GPL-3.0-or-later
"""Drives Debian's Chromium without a window, by the DevTools protocol over pipes: the standard
library is enough."""

import json
import os
import shutil
import signal
import subprocess
import tempfile
import time

CHROMIUM = shutil.which("chromium")


class Browser:
    """A page in a window of width x height CSS pixels, each of `scale` x `scale` pixels of the screen,
    without a network. Call close() at the end.
    `errors` collects everything that the page writes to the console as an error or a warning, and
    all uncaught exceptions. Files that the page saves go to the folder `downloads`."""

    def __init__(self, url, width=1280, height=800, downloads=None, touch=False, scale=1):
        self.errors, self.number, self.buffer, self.answers = [], 0, b"", {}
        self.profile = tempfile.TemporaryDirectory(prefix="axial_browser_")
        to_browser, self.out = os.pipe()
        self.input, from_browser = os.pipe()
        self.process = subprocess.Popen(
            ["/bin/sh", "-c", f'exec 3<&{to_browser} 4>&{from_browser} "$@"', "sh", CHROMIUM,
             "--headless=new", "--no-sandbox", "--disable-gpu-sandbox", "--use-angle=swiftshader",
             "--enable-unsafe-swiftshader", "--no-first-run", "--disable-extensions",
             "--disable-dev-shm-usage", "--disable-breakpad", "--remote-debugging-pipe",
             f"--user-data-dir={self.profile.name}"],
            pass_fds=(to_browser, from_browser), stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True)
        os.close(to_browser)
        os.close(from_browser)
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        self.session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.send(f"{domain}.enable")
        self.send("Network.emulateNetworkConditions", offline=True, latency=0,
                  downloadThroughput=0, uploadThroughput=0)
        self.send("Emulation.setDeviceMetricsOverride", width=width, height=height,
                  deviceScaleFactor=scale, mobile=touch)
        if touch:
            self.send("Emulation.setTouchEmulationEnabled", enabled=True)
        if downloads:
            self.call("Browser.setDownloadBehavior", behavior="allow", downloadPath=downloads)
        self.send("Page.navigate", url=url)

    def close(self):
        try:
            self.call("Browser.close")
            self.process.wait(10)
        except (OSError, RuntimeError, subprocess.TimeoutExpired):
            pass
        try:
            os.killpg(self.process.pid, signal.SIGKILL)  # and its children, if any are left
        except ProcessLookupError:
            pass
        self.process.wait()
        os.close(self.out)
        os.close(self.input)
        for _ in range(50):  # processes of the browser may still write to the profile
            shutil.rmtree(self.profile.name, ignore_errors=True)
            if not os.path.exists(self.profile.name):
                break
            time.sleep(0.1)
        os.makedirs(self.profile.name, exist_ok=True)
        self.profile.cleanup()

    def call(self, method, session=None, **parameters):
        """Sends a command and returns its result. RuntimeError if the browser refuses it."""
        self.number += 1
        message = {"id": self.number, "method": method, "params": parameters}
        if session:
            message["sessionId"] = session
        os.write(self.out, json.dumps(message).encode() + b"\0")
        while self.number not in self.answers:
            self.receive()
        answer = self.answers.pop(self.number)
        if "error" in answer:
            raise RuntimeError(f"{method}: {answer['error']}")
        return answer["result"]

    def send(self, method, **parameters):
        return self.call(method, self.session, **parameters)

    def receive(self):
        while b"\0" not in self.buffer:
            data = os.read(self.input, 1 << 20)
            if not data:
                raise OSError("the browser ended")
            self.buffer += data
        text, self.buffer = self.buffer.split(b"\0", 1)
        message = json.loads(text)
        if "id" in message:
            self.answers[message["id"]] = message
        elif message["method"] == "Runtime.exceptionThrown":
            self.errors.append(message["params"]["exceptionDetails"])
        elif message["method"] == "Runtime.consoleAPICalled":
            if message["params"]["type"] in ("error", "warning", "assert"):
                self.errors.append(message["params"]["args"])
        elif message["method"] == "Log.entryAdded":
            if message["params"]["entry"]["level"] in ("error", "warning"):
                self.errors.append(message["params"]["entry"])

    def value(self, expression):
        """The value of a JavaScript expression, or of the promise that it returns."""
        result = self.send("Runtime.evaluate", expression=expression, returnByValue=True,
                           awaitPromise=True)
        if "exceptionDetails" in result:
            raise RuntimeError(f"{expression}: {result['exceptionDetails']}")
        return result["result"].get("value")

    def wait_for(self, expression, seconds=60):
        """Waits until the expression is true. TimeoutError after `seconds`."""
        end = time.monotonic() + seconds
        while not self.value(expression):
            if time.monotonic() > end:
                raise TimeoutError(f"{expression}; errors: {self.errors}")
            time.sleep(0.05)

    def click(self, x, y):
        for kind in ("mousePressed", "mouseReleased"):
            self.send("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", clickCount=1)

    def tap(self, x, y):
        self.send("Input.dispatchTouchEvent", type="touchStart", touchPoints=[{"x": x, "y": y}])
        self.send("Input.dispatchTouchEvent", type="touchEnd", touchPoints=[])

    def press(self, key, code=0, text=""):
        self.send("Input.dispatchKeyEvent", type="keyDown", key=key, windowsVirtualKeyCode=code,
                  text=text)
        self.send("Input.dispatchKeyEvent", type="keyUp", key=key, windowsVirtualKeyCode=code)

    def click_on(self, selector):
        """Clicks in the middle of an element."""
        self.click(*self.value(f"""(() => {{
            const box = document.querySelector({json.dumps(selector)}).getBoundingClientRect();
            return [box.x + box.width / 2, box.y + box.height / 2]; }})()"""))
