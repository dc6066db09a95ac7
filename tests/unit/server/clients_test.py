"""`touchstone serve`: what clients may do, and that none of them harms the servo. Arguments as serving.py."""

import base64
import json
import os
import pathlib
import socket
import subprocess
import sys
import time
import unittest

import numpy

from serving import PROGRAM, SCENES, Server
from touchstone.client import Client, ServerError


class Driving(Server):
    def test_one_drives_and_the_person_takes_it_back(self):
        first, second = self.client(), self.client(self.path)
        self.touching(first)
        self.refused(first, "you do not drive", "set", name="stiffness", value="900")
        first.ask("drive")
        self.refused(second, "another client drives", "drive")
        first.ask("set", name="stiffness", value="900")
        self.assertEqual(second.event("setting")["value"], "900")
        self.refused(first, "'hard' is not a value", "set", name="stiffness", value="hard")
        second.ask("force", on=False)  # anybody may
        for _ in range(600):
            if first.state()["command"] == [0.0, 0.0, 0.0]:
                break
        self.assertFalse(first.state()["force_on"])
        first.ask("force", on=True)
        self.assertTrue(first.state()["force_on"])
        self.server.stdin.write(" ")
        self.server.stdin.flush()
        event = second.event("driver")
        while not event.get("taken_back"):
            event = second.event("driver")
        self.assertEqual(event, {"event": "driver", "driver": None, "taken_back": True, "force_on": False})
        self.refused(first, "you do not drive", "set", name="stiffness", value="500")
        second.ask("drive")
        second.close()  # who vanishes drives no more
        for _ in range(600):
            if first.state()["driver"] is None:
                break
        first.ask("drive")

    def test_scenes_lie_below_the_root_and_nothing_is_written(self):
        client = self.client()
        client.event("scene")
        client.ask("drive")
        for name in ("../secret.glb", "/etc/passwd", "link.glb", "nothing.glb", ".", "", "box.glb\0"):
            self.refused(client, "below the root", "load", scene=name)
        client.ask("load", scene="box.glb")
        self.assertTrue(client.event("scene")["file"].endswith("box.glb"))
        self.touching(client)
        client.ask("load", bytes=base64.b64encode((SCENES / "plane.glb").read_bytes()).decode())
        self.assertEqual(client.event("scene")["file"], "")
        client.ask("load", bytes=base64.b64encode(b"no model").decode())
        self.assertIn("error", client.event("error"))
        # No stroke can be laid on a model without triangles: it is refused, and the plane is touched on.
        empty = {"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{}], "scene": 0}
        client.ask("load", bytes=base64.b64encode(json.dumps(empty).encode()).decode())
        self.assertIn("error", client.event("error"))
        self.touching(client)
        self.refused(client, "--allow-write", "record", file="a.tsrec")

    def test_refuses_what_is_no_message(self):
        client = self.client()
        client.ask("drive")
        self.refused(client, "there is no message 'fly'", "fly")
        self.refused(client, "'name' is missing", "set", value="1")
        self.refused(client, "'value' is of the wrong type", "set", name="stiffness", value=1)
        for text in (b"", b"[]", b"nonsense", b"[" * 100_000, b'{"do":3}', b'{"do":"\xff"}', b'{"do":null}'):
            client.send(text)
        client.ask("ping")
        client.send(b"binary", 2)
        with self.assertRaises((ServerError, OSError)):
            while True:
                client.receive()


class Recording(Server):
    options = ("--allow-write",)

    def test_writes_new_files_below_the_root(self):
        client = self.client()
        self.touching(client)
        client.ask("drive")
        for name in ("../a.tsrec", "box.glb", "/tmp/a.tsrec", "link.glb", "nowhere/a.tsrec"):
            self.refused(client, "new file below the root", "record", file=name)
        client.ask("record", file="a.tsrec")
        time.sleep(0.3)
        client.ask("material", material=0, name="stiffness", value=431.5)
        time.sleep(0.3)
        client.ask("record", file="")
        replay = subprocess.run([PROGRAM, "replay", str(self.folder / "root" / "a.tsrec")], capture_output=True, text=True)
        self.assertEqual(replay.returncode, 0, replay.stdout + replay.stderr)


class Rendering(Server):
    """A client is the contact renderer [000 §8]; the control loop holds the hand."""
    options = ("--control", "4000")

    def setUp(self):
        super().setUp()
        self.renderer = self.client(self.path)
        self.touching(self.renderer)
        self.renderer.ask("subscribe", states=1000)
        self.renderer.ask("drive")

    def floor(self, state):
        """A plane 1 mm above the hand, wherever it is."""
        x, y, z = state["hip"]
        return dict(touching=True, proxy=[x, y + 0.001, z], stiffness=500, planes=[[0, 1, 0]])

    def test_holds_the_hand_by_the_contact_of_a_client(self):
        self.refused(self.renderer, "you do not render", "contact", touching=False)
        self.assertFalse(self.renderer.state()["rendered"])
        self.renderer.ask("render", on=True)
        state = self.renderer.state()
        while not state["rendered"]:
            state = self.renderer.state()
        height = state["hip"][1] + 0.002
        pushed = 0
        for _ in range(5000):
            if pushed > 50:
                break
            x, y, z = state["hip"]
            self.renderer.ask("contact", touching=y < height, proxy=[x, height, z], stiffness=500, planes=[[0, 1, 0]])
            state = self.renderer.state()
            if state["contacts"] and state["hip"][1] < height - 1e-4:
                pushed += state["force"][1] > 0
                self.assertLess(abs(state["force"][0]), 1e-6)  # along the plane it is free
                self.assertLessEqual(state["force"][1], 500 * (height - state["hip"][1]) + 1e-6)
        self.assertEqual(pushed, 51)
        # Silence: the hand is let go.
        deadline = time.monotonic() + 20
        while self.renderer.state()["command"] != [0.0, 0.0, 0.0] and time.monotonic() < deadline:
            pass
        self.assertEqual(self.renderer.state()["command"], [0.0, 0.0, 0.0])
        self.renderer.ask("render", on=False)
        state = self.renderer.state()
        while state["rendered"]:
            state = self.renderer.state()
        self.touching(self.renderer)  # the server's own contact again

    def test_bears_wrong_late_and_random_contact(self):
        watcher = self.client()
        self.refused(watcher, "another client drives", "render", on=True)
        self.renderer.ask("render", on=True)
        self.refused(watcher, "another client drives", "contact", touching=False)
        good = dict(touching=True, proxy=[0, 0, 0])
        for part, wrong in (("'touching' is missing", {}), ("'proxy' is missing", dict(touching=True)),
                            ("three numbers", {**good, "proxy": [1, 2]}), ("wrong type", {**good, "proxy": [1, 2, "3"]}),
                            ("wrong type", {**good, "proxy": [1, 2, None]}), ("within 1 km", {**good, "proxy": [1e300, 0, 0]}),
                            ("'stiffness'", {**good, "stiffness": -1}), ("'stiffness'", {**good, "stiffness": 1e9}),
                            ("'damping'", {**good, "damping": -1}), ("'planes'", {**good, "planes": [[0, 2, 0]]}),
                            ("'planes'", {**good, "planes": [[0, 0, 0]]}), ("'planes'", {**good, "planes": [[0, 1, 0]] * 4}),
                            ("'planes'", {**good, "planes": [[0, 1]]}), ("wrong type", {**good, "planes": 7})):
            self.refused(self.renderer, part, "contact", **wrong)
        generator = numpy.random.default_rng(5)
        for i in range(400):  # proxies anywhere, now and then late
            plane = generator.normal(size=3)
            self.renderer.ask("contact", touching=True, proxy=list(generator.normal(size=3)), stiffness=3000, damping=1,
                              planes=[list(plane / numpy.linalg.norm(plane))] if i % 2 else [])
            if i % 100 == 50:
                time.sleep(0.1)
            self.assertLessEqual(numpy.linalg.norm(self.renderer.state()["command"]), 8.5 + 1e-9)
        self.renderer.close()  # who vanishes renders no more
        for _ in range(2000):
            if not watcher.state()["rendered"]:
                break
        state = watcher.state()
        self.assertFalse(state["rendered"])
        self.assertIsNone(state["driver"])
        self.touching(watcher)

    def test_the_person_takes_the_force_away_from_it(self):
        self.renderer.ask("render", on=True)
        self.renderer.ask("contact", **self.floor(self.renderer.state()))
        self.server.stdin.write(" ")
        self.server.stdin.flush()
        while not self.renderer.event("driver").get("taken_back"):
            pass
        self.refused(self.renderer, "you do not drive", "contact", **self.floor(self.renderer.state()))
        for _ in range(600):
            if self.renderer.state()["command"] == [0.0, 0.0, 0.0]:
                break
        self.assertEqual(self.renderer.state()["command"], [0.0, 0.0, 0.0])


class WithoutControlLoop(Server):
    def test_says_what_is_missing(self):
        client = self.client()
        self.touching(client)
        client.ask("drive")
        self.refused(client, "no control loop", "render", on=True)
        for rate in (0, 1001, "fast"):
            self.refused(client, "'states'", "subscribe", states=rate)


class Abuse(Server):
    def test_no_client_stops_the_others_or_the_servo(self):
        watcher = self.client(self.path)
        self.touching(watcher)
        before = watcher.state()
        sockets = []
        for i in range(64):  # more than there is room for; each sends something else
            try:
                connection = socket.create_connection(("127.0.0.1", self.port), 5)
                connection.sendall([b"\0" * 1000, b"GET / HTTP/1.1\r\n", b"\x16\x03\x01", os.urandom(4096)][i % 4])
                sockets.append(connection)
            except OSError:
                pass
        clients = []
        for _ in range(64):
            try:
                clients.append(Client(self.port))
            except (ServerError, OSError):
                break
        self.assertLess(len(clients), 16)
        self.assertGreater(len(clients), 4)
        flood, deaf = clients[0], clients[1]
        deaf.ask("subscribe", ticks=True)  # and never reads
        with self.assertRaises((ServerError, OSError)):
            for _ in range(200_000):
                flood.send(b'{"do":"ping"}')
            while True:
                flood.receive()
        for client in clients[2:]:
            client._socket.sendall(b"\xc1\x7f" + os.urandom(64))  # no frame
        for connection in sockets + clients[2:]:
            connection.close()
        memory = int(pathlib.Path(f"/proc/{self.server.pid}/statm").read_text().split()[1])
        time.sleep(1.0)
        after = watcher.state()
        self.assertGreater(after["ticks"], before["ticks"] + 500)
        limit = 8.5 + 1e-9
        self.assertLessEqual(numpy.linalg.norm(after["command"]), limit)
        grown = int(pathlib.Path(f"/proc/{self.server.pid}/statm").read_text().split()[1]) - memory
        self.assertLess(grown * 4096, 64 << 20)
        self.touching(self.client(self.path))

    def test_broken_requests_fill_no_log(self):
        """The server's errors go into a pipe of 64 KiB that is read at the end: one that is full would stop the server."""
        watcher = self.client(self.path)
        self.touching(watcher)
        request = f"GET / HTTP/1.1\r\nHost: 127.0.0.1:{self.port}\r\nX: {'x' * 6000}\r\n\r\n".encode()
        for _ in range(1500):
            with socket.create_connection(("127.0.0.1", self.port), 60) as connection:
                try:
                    connection.sendall(request)
                    connection.recv(100)
                except ConnectionError:
                    pass
        before = watcher.state()["ticks"]
        self.touching(self.client(self.path))
        self.assertGreater(watcher.state()["ticks"], before)

    def test_streams_every_tick(self):
        client = self.client()
        self.touching(client)
        client.ask("subscribe", ticks=True)
        states = []
        while sum(map(len, client.ticks)) < 1000:
            states.append(client.event("state"))
        times = numpy.concatenate(client.ticks)["time"]
        steps = 1e3 * numpy.diff(times)  # a late servo passes over some
        self.assertGreater(steps.min(), 0.5)
        self.assertLess(numpy.abs(steps - numpy.rint(steps)).max(), 1e-6)
        # None is missing: of the ticks that a state counts the stream lacks those before it alone, as many at its end as at its beginning. The counter
        # is read just behind the state and may count some more.
        lacking = [state["ticks"] - int(numpy.searchsorted(times, state["time"], "right")) for state in states
                   if times[0] <= state["time"] <= times[-1]]
        self.assertGreater(len(lacking), 5)
        third = len(lacking) // 3
        self.assertAlmostEqual(min(lacking[:third]), min(lacking[-third:]), delta=5)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
