"""A headless Chromium for tests, led by its DevTools."""

import base64
import http.client
import json
import socket
import subprocess
import time
import urllib.request

from touchstone.client import Client

OPTIONS = ("--headless", "--no-sandbox", "--disable-gpu-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
           "--no-first-run", "--disable-dev-shm-usage")


class Browser(Client):
    """The DevTools of a page, over the client's own frames."""

    def __init__(self, port, path):
        self._path = path
        self.wrong = []  # what the page threw, also before this was opened
        super().__init__(port, timeout=30.0)
        self._command("Runtime.enable")

    def _open(self, host, token):
        self._socket.sendall((f"GET {self._path} HTTP/1.1\r\nHost: {host}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
                              "Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\nSec-WebSocket-Version: 13\r\n\r\n").encode())
        self._buffer = b""
        while b"\r\n\r\n" not in self._buffer:
            self._more()
        self._buffer = self._buffer.split(b"\r\n\r\n", 1)[1]

    def _command(self, method, **parameters):
        self._asked += 1
        self.send(json.dumps({"id": self._asked, "method": method, "params": parameters}).encode())
        while True:
            message = self.receive()
            if message.get("method") == "Runtime.exceptionThrown":
                self.wrong.append(message["params"]["exceptionDetails"])
            if message.get("id") == self._asked:
                if "error" in message:  # as of a page that is being replaced, and so has no context yet
                    raise ValueError(f"{method}: {message['error']}")
                return message["result"]

    def run(self, script):
        """The value of an expression in the page."""
        return self._command("Runtime.evaluate", expression=script, returnByValue=True)["result"].get("value")

    def picture(self):
        """The bytes of a PNG of what the page shows."""
        return base64.b64decode(self._command("Page.captureScreenshot", format="png")["data"])


def until(what, seconds=120):
    """The first value that is not false. A value that cannot be had yet is asked for again."""
    end = time.monotonic() + seconds
    last = None
    while time.monotonic() < end:
        try:
            value = what()
        except (OSError, ValueError, TypeError, http.client.HTTPException) as error:
            value, last = None, error
        else:
            last = value
        if value:
            return value
        time.sleep(0.1)
    raise AssertionError(f"waited in vain; at last {last!r}")


def open_page(program, url, profile, *options):
    """Chromium with that page: its process, and a Browser. The caller ends both."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    process = subprocess.Popen([program, *OPTIONS, *options, f"--user-data-dir={profile}", f"--remote-debugging-port={port}", url],
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    def target():
        with urllib.request.urlopen(f"http://127.0.0.1:{port}/json", timeout=5) as answer:
            return [page["webSocketDebuggerUrl"] for page in json.load(answer) if page["type"] == "page" and page["url"].startswith(url.split("#")[0])]

    try:
        return process, Browser(port, "/" + until(target)[0].split("/", 3)[3])
    except BaseException:
        process.terminate()
        process.wait()
        raise
