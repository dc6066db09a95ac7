"""A `touchstone serve` of a test's own. Run by CTest with PYTHONPATH and the arguments PROGRAM SCENES [BROWSER]. Loopback only; no time is
asserted."""

import os
import pathlib
import socket
import subprocess
import sys
import tempfile
import unittest

from touchstone.client import Client, ServerError

PROGRAM, SCENES = sys.argv[1], pathlib.Path(sys.argv[2])
BROWSER = sys.argv[3] if len(sys.argv) > 3 else ""


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class Server(unittest.TestCase):
    options = ()
    address = "http://127.0.0.1"

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder, self.port = pathlib.Path(folder.name), free_port()
        os.environ["XDG_RUNTIME_DIR"] = str(self.folder)
        root = self.folder / "root"
        root.mkdir()
        for name in ("doughnut.glb", "box.glb"):
            (root / name).write_bytes((SCENES / name).read_bytes())
        (self.folder / "secret.glb").write_bytes((SCENES / "box.glb").read_bytes())
        (root / "link.glb").symlink_to(self.folder / "secret.glb")
        self.path = str(self.folder / "touch.sock")
        self.server = subprocess.Popen([PROGRAM, "serve", str(root / "doughnut.glb"), "--root", str(root), "--port", str(self.port),
                                        "--socket", self.path, *self.options],
                                       stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.addCleanup(self.end)
        self.assertIn(self.address, self.server.stdout.readline())

    def end(self):
        self.server.terminate()
        _, errors = self.server.communicate(timeout=30)
        self.assertEqual(self.server.returncode, 0, errors)

    def client(self, where=None):
        client = Client(where or self.port, timeout=120)  # a busy machine takes seconds to load the model
        self.addCleanup(client.close)
        return client

    def touching(self, client):
        """A state in contact."""
        for _ in range(3000):
            state = client.event("state")
            if state["contacts"] > 0:
                return state
        self.fail("no contact")

    def opens(self, **headers):
        """Whether the WebSocket is opened: 101, and else an error or a closed connection."""
        upgrade = dict(Upgrade="websocket", Connection="Upgrade", Sec_WebSocket_Key="AAAAAAAAAAAAAAAAAAAAAA==", Sec_WebSocket_Version="13")
        try:
            connection = socket.create_connection(("127.0.0.1", self.port), 10)
            lines = "".join(f"{name.replace('_', '-')}: {value}\r\n" for name, value in {**upgrade, **headers}.items())
            connection.sendall(f"GET / HTTP/1.1\r\n{lines}\r\n".encode())
            return b" 101 " in connection.recv(1000)
        except ConnectionError:
            return False
        finally:
            connection.close()

    def refused(self, client, part, verb, **members):
        with self.assertRaises(ServerError) as refusal:
            client.ask(verb, **members)
        self.assertIn(part, str(refusal.exception))
