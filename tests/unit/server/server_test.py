"""`touchstone serve`: who may connect, what clients may do, and that none of them harms the servo. Run by CTest with PYTHONPATH and the
arguments PROGRAM SCENES [BROWSER]. Loopback only; no time is asserted."""

import base64
import http.client
import json
import os
import pathlib
import socket
import ssl
import stat
import subprocess
import sys
import tempfile
import time
import unittest
import urllib.request

import numpy

from touchstone.client import Client, ServerError, token_of

PROGRAM, SCENES = sys.argv[1], pathlib.Path(sys.argv[2])


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def listening(port):
    """(address, port) of all sockets of this machine that listen at that port."""
    found = []
    for file, size in (("tcp", 4), ("tcp6", 16)):
        for row in pathlib.Path("/proc/net", file).read_text().splitlines()[1:]:
            local, state = row.split()[1], row.split()[3]
            address, number = local.split(":")
            if state == "0A" and int(number, 16) == port:
                raw = bytes.fromhex(address)
                words = b"".join(raw[i:i + 4][::-1] for i in range(0, size, 4))
                found.append((socket.inet_ntop(socket.AF_INET if size == 4 else socket.AF_INET6, words), port))
    return found


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
        client = Client(where or self.port)
        self.addCleanup(client.close)
        return client

    def touching(self, client):
        """A state in contact."""
        for _ in range(3000):
            state = client.event("state")
            if state["contacts"] > 0:
                return state
        self.fail("no contact")

    def refused(self, client, part, verb, **members):
        with self.assertRaises(ServerError) as refusal:
            client.ask(verb, **members)
        self.assertIn(part, str(refusal.exception))


class Access(Server):
    def test_needs_the_token_over_tcp(self):
        file = self.folder / "touchstone" / f"serve-{self.port}.token"
        self.assertEqual(stat.S_IMODE(file.stat().st_mode), 0o600)
        self.assertEqual(stat.S_IMODE(file.parent.stat().st_mode), 0o700)
        self.assertEqual(stat.S_IMODE(os.stat(self.path).st_mode), 0o600)
        self.assertEqual(len(token_of(self.port)), 64)
        for token in ("", "0" * 64, token_of(self.port)[:-1]):
            with self.assertRaises(ServerError):
                Client(self.port, token)
        silent = socket.create_connection(("127.0.0.1", self.port))
        self.addCleanup(silent.close)
        self.assertEqual(self.client().hello["protocol"], 1)
        self.assertEqual(self.client(self.path).hello["protocol"], 1)

    def test_listens_on_loopback_alone(self):
        self.assertEqual(listening(self.port), [("127.0.0.1", self.port)])

    def http(self, path, **headers):
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=10)
        connection.putrequest("GET", path, skip_host="Host" in headers)
        for name, value in headers.items():
            connection.putheader(name.replace("_", "-"), value)
        connection.endheaders()
        answer = connection.getresponse()
        body = answer.read()
        connection.close()
        return answer.status, body

    def test_checks_host_and_origin(self):
        upgrade = dict(Upgrade="websocket", Connection="Upgrade", Sec_WebSocket_Key="AAAAAAAAAAAAAAAAAAAAAA==", Sec_WebSocket_Version="13")
        own = f"127.0.0.1:{self.port}"
        self.assertEqual(self.http("/")[0], 200)
        self.assertEqual(self.http("/", Host="evil.example")[0], 403)
        self.assertEqual(self.http("/", Host=f"evil.example:{self.port}")[0], 403)

        def opens(**headers):
            """Whether the WebSocket is opened: 101, and else an error or a closed connection."""
            try:
                connection = socket.create_connection(("127.0.0.1", self.port), 10)
                lines = "".join(f"{name.replace('_', '-')}: {value}\r\n" for name, value in {**upgrade, **headers}.items())
                connection.sendall(f"GET / HTTP/1.1\r\n{lines}\r\n".encode())
                return b" 101 " in connection.recv(1000)
            except ConnectionError:
                return False
            finally:
                connection.close()

        self.assertTrue(opens(Host=own))
        self.assertTrue(opens(Host=own, Origin=f"http://{own}"))
        self.assertFalse(opens(Host=own, Origin="http://evil.example"))
        self.assertFalse(opens(Host=own, Origin="null"))
        self.assertFalse(opens(Host=f"evil.example:{self.port}"))
        self.assertFalse(opens(Host=f"127.0.0.1.evil.example:{self.port}"))
        # The server's own timer is a protocol with a name, too.
        self.assertFalse(opens(Host="evil.example", Origin="http://evil.example", Sec_WebSocket_Protocol="timer"))
        self.assertFalse(opens(Host=own, Sec_WebSocket_Protocol="timer"))

    def test_gives_the_scene_to_who_has_the_token(self):
        self.client().event("scene")
        self.assertEqual(self.http("/scene")[0], 403)
        self.assertEqual(self.http("/scene?token=" + "0" * 64)[0], 403)
        status, body = self.http("/scene?token=" + token_of(self.port))
        corners = numpy.frombuffer(body, "<f4").reshape(-1, 3, 3)
        self.assertEqual((status, len(corners)), (200, 64800))
        self.assertAlmostEqual(float(corners.max()), 0.075, places=6)
        for path in ("/../CMakeLists.txt", "/..%2faccess.cpp", "/%2e%2e/main.cpp", "//etc/passwd", "/scene/../../main.cpp"):
            self.assertNotIn(self.http(path)[0], (200,), path)


class OffLoopback(unittest.TestCase):
    """What is refused before anything listens. 192.0.2.1 is nobody's (RFC 5737)."""

    def refusal(self, *options):
        done = subprocess.run([PROGRAM, "serve", "--port", "8790", *options], capture_output=True, text=True, timeout=60)
        self.assertEqual(done.returncode, 1, done.stdout)
        return done.stderr

    def test_needs_tls(self):
        for address in ("192.0.2.1", "0.0.0.0"):
            refusal = self.refusal("--listen", address)
            for part in (address, "is not on loopback", "--certificate", "ssh -L 8790:127.0.0.1:8790", "stunnel"):
                self.assertIn(part, refusal)
        for address in ("lab.example", "127.1", "", "127.0.0.1.evil.example"):
            self.assertIn("is no IPv4 address", self.refusal("--listen", address))

    def test_needs_a_key_that_is_private(self):
        with tempfile.TemporaryDirectory() as folder:
            certificate, key = certify(pathlib.Path(folder))
            self.assertIn("need each other", self.refusal("--certificate", certificate))
            self.assertIn("need each other", self.refusal("--key", key))
            self.assertIn("cannot be listened to",  # nobody's address
                          self.refusal("--listen", "192.0.2.1", "--certificate", certificate, "--key", key))
            os.chmod(key, 0o644)
            self.assertIn("everybody may read it", self.refusal("--certificate", certificate, "--key", key))


def certify(folder):
    """A certificate for localhost and 127.0.0.2, and its key."""
    certificate, key = str(folder / "certificate.pem"), str(folder / "key.pem")
    subprocess.run(["openssl", "req", "-x509", "-newkey", "rsa:2048", "-nodes", "-days", "2", "-subj", "/CN=lab", "-addext",
                    "subjectAltName=DNS:localhost,IP:127.0.0.2", "-keyout", key, "-out", certificate], check=True, capture_output=True)
    os.chmod(key, 0o600)
    return certificate, key


class Tls(Server):
    """As off loopback, but on another address of it."""
    address = "https://localhost:"

    def setUp(self):
        keys = tempfile.TemporaryDirectory()
        self.addCleanup(keys.cleanup)
        self.certificate, key = certify(pathlib.Path(keys.name))
        self.options = ("--listen", "127.0.0.2", "--certificate", self.certificate, "--key", key, "--name", "localhost")
        super().setUp()

    def test_serves_by_tls_alone(self):
        url = f"https://127.0.0.2:{self.port}"
        with Client(url, token_of(self.port), certificate=self.certificate) as client:
            self.assertIn(client._socket.version(), ("TLSv1.2", "TLSv1.3"))
            self.touching(client)
            client.ask("drive")
            client.ask("set", name="stiffness", value="800")
            self.assertIn("force", client.state())
        with self.assertRaises(ValueError):
            Client(url)  # whose token is not here
        with self.assertRaises(ServerError):
            Client(url, "0" * 64, certificate=self.certificate)
        with self.assertRaises(ssl.SSLCertVerificationError):
            Client(url, token_of(self.port))
        connection = socket.create_connection(("127.0.0.2", self.port), 10)  # in clear
        self.addCleanup(connection.close)
        connection.sendall(f"GET / HTTP/1.1\r\nHost: 127.0.0.2:{self.port}\r\n\r\n".encode())
        try:
            self.assertNotIn(b" 200 ", connection.recv(1000))
        except ConnectionError:
            pass
        self.assertEqual(listening(self.port), [("127.0.0.2", self.port)])
        context = ssl.create_default_context(cafile=self.certificate)
        context.set_alpn_protocols(["h2", "http/1.1"])  # as browsers do
        for host, status in ((f"127.0.0.2:{self.port}", 200), (f"localhost:{self.port}", 200), (f"evil.example:{self.port}", 403)):
            request = http.client.HTTPSConnection("127.0.0.2", self.port, timeout=10, context=context)
            request.request("GET", "/", headers={"Host": host})
            self.assertEqual(request.getresponse().status, status, host)
            request.close()
        with Client(self.path) as client:
            client.ask("ping")


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

    def test_streams_every_tick(self):
        client = self.client()
        self.touching(client)
        client.ask("subscribe", ticks=True)
        while sum(map(len, client.ticks)) < 1000:
            client.event("state")
        times = numpy.concatenate(client.ticks)["time"]
        steps = numpy.diff(times)
        self.assertTrue((steps > 0).all())
        self.assertAlmostEqual(float(numpy.median(steps)), 1e-3, places=9)


class Materials(Server):
    def test_clients_change_what_is_felt(self):
        driver, watcher = self.client(), self.client(self.path)
        self.touching(driver)
        table = driver.ask("materials")
        self.assertEqual(len(table["materials"]), 1)
        self.assertIn("stiffness", [number["name"] for number in table["numbers"]])
        self.refused(watcher, "you do not drive", "material", material=0, name="stiffness", value=900)
        driver.ask("drive")
        for part, wrong in (("'material' is missing", dict(name="stiffness", value=1)), ("1, and there are 1", dict(material=1, name="stiffness", value=1)),
                            ("wrong type", dict(material="a", name="stiffness", value=1)), ("'hardness'", dict(material=0, name="hardness", value=1)),
                            ("not within", dict(material=0, name="stiffness", value=-1)), ("not within", dict(material=0, name="stiffness", value=1e300)),
                            ("'value' is missing", dict(material=0, name="stiffness")), ("wrong type", dict(material=0, name="stiffness", value="9")),
                            ("is negative", dict(material=-1, name="stiffness", value=1))):
            with self.assertRaisesRegex(ServerError, part):
                driver.ask("material", **wrong)

        def stiffness():
            """Force over depth, where the hand is in contact."""
            for _ in range(3000):
                state = watcher.state()
                if state["contacts"] == 1 and state["penetration"] > 2e-4 and numpy.linalg.norm(state["force"]) < 8:
                    normal = numpy.array(state["proxy"]) - state["hip"]
                    return float(numpy.dot(state["force"], normal) / numpy.dot(normal, normal))
            self.fail("no contact")

        driver.ask("set", name="damping", value="0")
        for name in ("staticFriction", "dynamicFriction"):
            driver.ask("material", material=0, name=name, value=0)
        for wanted in (300, 900):
            driver.ask("material", material=0, name="stiffness", value=wanted)
            self.assertEqual({**watcher.event("material"), "name": ""}.keys(), {"event", "material", "name", "value"})
            # A late tick slews the force for some ticks after it.
            for _ in range(50):
                felt = stiffness() / wanted
                if abs(felt - 1.0) < 0.01:
                    break
            self.assertAlmostEqual(felt, 1.0, delta=0.01)
        self.assertEqual(watcher.ask("materials")["materials"][0]["values"]["stiffness"], 900)
        driver.ask("material", material=0, name="stiffness", value=None)
        self.assertEqual(watcher.ask("materials")["materials"][0]["values"]["stiffness"], table["materials"][0]["values"]["stiffness"])
        driver.ask("load", scene="box.glb")
        driver.event("scene")
        self.assertNotEqual(watcher.ask("materials")["materials"][0]["values"].get("staticFriction"), 0)


class Moving(Server):
    options = ("--allow-write",)

    def test_clients_move_objects_under_the_hand(self):
        driver, watcher = self.client(), self.client(self.path)
        self.touching(driver)
        (rest,) = driver.ask("objects")["objects"]
        self.assertEqual((rest["first_triangle"], rest["triangles"], rest["movable"]), (0, 64800, True))
        self.refused(watcher, "you do not drive", "move", object=0, position=[0, 0, 0])
        driver.ask("drive")
        here = dict(object=0, position=[0, 0, 0])
        for part, wrong in (("'object' is missing", dict(position=[0, 0, 0])), ("'object' is negative", {**here, "object": -1}),
                            ("1, and there are 1", {**here, "object": 1}), ("wrong type", {**here, "object": "0"}),
                            ("'position' is missing", dict(object=0)), ("three numbers", {**here, "position": [0, 0]}),
                            ("wrong type", {**here, "position": [0, 0, None]}), ("within 1 m", {**here, "position": [0, 0, 1e9]}),
                            ("four numbers", {**here, "orientation": [1, 0, 0]}), ("unit quaternion", {**here, "orientation": [1, 1, 0, 0]}),
                            ("0.5 m/s", {**here, "speed": 1}), ("speed", {**here, "speed": -1}), ("6.3 rad/s", {**here, "turn": 7})):
            self.refused(driver, part, "move", **wrong)
        self.assertNotIn("moved", driver.state())
        driver.ask("record", file="moved.tsrec")
        # Up and down through the hand for some seconds: never faster than asked, never a force beyond the limit.
        driver.ask("subscribe", states=200)
        seen = []
        for i in range(6):
            height = 0.02 * (1 if i % 2 == 0 else -1)
            driver.ask("move", object=0, position=[0, height, 0], orientation=[numpy.cos(0.1 * i), 0, numpy.sin(0.1 * i), 0], speed=0.2, turn=1)
            end = time.monotonic() + 30
            while time.monotonic() < end:
                state = driver.event("state")
                if "moved" in state:
                    seen.append((state["time"], *state["moved"][0]["position"], state["contacts"], *state["command"]))
                    if abs(state["moved"][0]["position"][1] - height) < 1e-12:
                        break
            else:
                self.fail("it does not arrive")
        seen = numpy.array(seen)
        steps, ways = numpy.diff(seen[:, 0]), numpy.linalg.norm(numpy.diff(seen[:, 1:4], axis=0), axis=1)
        self.assertTrue((ways <= 0.2 * (steps + 0.25) + 1e-12).all(), (ways - 0.2 * steps).max())  # a pose may be newer than the state
        self.assertTrue((seen[:, 4] > 0).any())  # it was touched while it moved; a busy machine samples few states
        self.assertLessEqual(numpy.linalg.norm(seen[:, 5:8], axis=1).max(), 8.5 + 1e-9)
        # Halted on its way, by who drives or because nobody does: it stays where it is.
        for stop in (lambda: driver.ask("halt"), driver.close):
            driver.ask("move", object=0, position=[0.5, 0, 0], speed=0.05)
            while watcher.state()["moved"][0]["position"][0] < 0.002:
                pass
            stop()
            time.sleep(0.2)
            before = watcher.state()["moved"]
            time.sleep(0.3)
            self.assertEqual(watcher.state()["moved"], before)
        watcher.ask("drive")
        watcher.ask("record", file="")
        replay = subprocess.run([PROGRAM, "replay", str(self.folder / "root" / "moved.tsrec")], capture_output=True, text=True, timeout=120)
        self.assertEqual(replay.returncode, 0, replay.stdout + replay.stderr)
        watcher.ask("load", scene="box.glb")
        watcher.event("scene")
        self.assertNotIn("moved", watcher.state())


class Browser(Client):
    """The DevTools of a page, over the client's own frames."""

    def __init__(self, port, path):
        self.path = path
        super().__init__(port, timeout=30.0)

    def _open(self, host, where, token):
        self._socket.sendall((f"GET {self.path} HTTP/1.1\r\nHost: {host}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
                              "Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\nSec-WebSocket-Version: 13\r\n\r\n").encode())
        self._buffer = b""
        while b"\r\n\r\n" not in self._buffer:
            self._more()
        self._buffer = self._buffer.split(b"\r\n\r\n", 1)[1]

    def run(self, script):
        """The value of an expression in the page."""
        self._asked += 1
        self.send(json.dumps({"id": self._asked, "method": "Runtime.evaluate", "params": {"expression": script, "returnByValue": True}}).encode())
        while True:
            message = self.receive()
            if message.get("id") == self._asked:
                return message["result"]["result"].get("value")


class Page(Server):
    @unittest.skipUnless(len(sys.argv) > 3 and sys.argv[3], "there is no Chromium")
    def test_its_sliders_change_what_another_client_feels(self):
        watcher = self.client(self.path)
        self.touching(watcher)
        port = free_port()
        browser = subprocess.Popen([sys.argv[3], "--headless", "--no-sandbox", "--disable-gpu-sandbox", "--use-gl=angle", "--use-angle=swiftshader",
                                    "--enable-unsafe-swiftshader", f"--user-data-dir={self.folder}/sliders", f"--remote-debugging-port={port}",
                                    f"http://127.0.0.1:{self.port}/#{token_of(self.port)}"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.addCleanup(browser.wait)
        self.addCleanup(browser.terminate)

        def until(what, seconds=60):
            end = time.monotonic() + seconds
            while time.monotonic() < end:
                try:
                    value = what()
                except (OSError, ValueError):
                    value = None
                if value:
                    return value
                time.sleep(0.1)
            self.fail("waited in vain")

        def target():
            with urllib.request.urlopen(f"http://127.0.0.1:{port}/json", timeout=5) as answer:
                return [page["webSocketDebuggerUrl"] for page in json.load(answer) if page["type"] == "page" and str(self.port) in page["url"]]

        page = Browser(port, "/" + until(target)[0].split("/", 3)[3])
        self.addCleanup(page.close)
        until(lambda: page.run("document.querySelectorAll('#numbers input[type=range]').length") or 0)
        self.assertGreater(page.run("document.querySelectorAll('#settings input[type=range]').length"), 10)

        def drag(slider, to):
            page.run(f"(() => {{ const s = document.getElementById('{slider}'); s.value = {to}; s.dispatchEvent(new Event('input')); }})()")

        drag("slide-set-stiffness", 500)
        event = watcher.event("setting")
        self.assertEqual(event["name"], "stiffness")
        self.assertEqual(float(event["value"]), float(page.run("document.getElementById('set-stiffness').value")))
        drag("slide-mat-staticFriction", 800)
        event = watcher.event("material")
        self.assertEqual((event["material"], event["name"]), (0, "staticFriction"))
        self.assertGreater(event["value"], 0)
        self.assertEqual(watcher.ask("materials")["materials"][0]["values"]["staticFriction"], event["value"])
        self.assertEqual(watcher.state()["driver"], until(lambda: page.run("state.driver === me && me")))
        # Another client drives: the page shows what that one changes.
        page.run("document.getElementById('drive').click()")
        until(lambda: watcher.state()["driver"] is None)
        watcher.ask("drive")
        watcher.ask("set", name="stiffness", value="777")
        until(lambda: page.run("document.getElementById('set-stiffness').value") == "777")
        watcher.ask("material", material=0, name="staticFriction", value=0.25)
        until(lambda: page.run("document.getElementById('mat-staticFriction').value") == "0.25")
        drag("slide-set-stiffness", 100)  # who does not drive is told so
        until(lambda: "another client drives" in page.run("document.getElementById('status').textContent"))

    @unittest.skipUnless(len(sys.argv) > 3 and sys.argv[3], "there is no Chromium")
    def test_shows_the_model_and_the_force(self):
        self.touching(self.client(self.path))
        picture = self.folder / "page.png"
        browser = subprocess.run([sys.argv[3], "--headless", "--no-sandbox", "--disable-gpu-sandbox", "--use-gl=angle", "--use-angle=swiftshader",
                        "--enable-unsafe-swiftshader", "--window-size=1200,800", f"--user-data-dir={self.folder}/profile",
                        "--timeout=15000", f"--screenshot={picture}", "--enable-logging=stderr",
                        f"http://127.0.0.1:{self.port}/#{token_of(self.port)}"], check=True, capture_output=True, text=True, timeout=120)
        self.assertNotIn("Uncaught", browser.stderr)
        self.assertGreater(picture.stat().st_size, 20_000)
        keep = os.environ.get("TOUCHSTONE_KEEP_PICTURE")
        if keep:
            pathlib.Path(keep).write_bytes(picture.read_bytes())


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
