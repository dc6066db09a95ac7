"""`touchstone serve`: who may connect. Arguments as serving.py."""

import http.client
import os
import pathlib
import socket
import ssl
import stat
import subprocess
import sys
import tempfile
import unittest

import numpy

from serving import PROGRAM, SCENES, Server, free_port
from touchstone.client import Client, ServerError, token_of


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
        own = f"127.0.0.1:{self.port}"
        self.assertEqual(self.http("/")[0], 200)
        self.assertEqual(self.http("/", Host="evil.example")[0], 403)
        self.assertEqual(self.http("/", Host=f"evil.example:{self.port}")[0], 403)

        self.assertTrue(self.opens(Host=own))
        self.assertTrue(self.opens(Host=own, Origin=f"http://{own}"))
        self.assertFalse(self.opens(Host=own, Origin="http://evil.example"))
        self.assertFalse(self.opens(Host=own, Origin="null"))
        self.assertFalse(self.opens(Host=f"evil.example:{self.port}"))
        self.assertFalse(self.opens(Host=f"127.0.0.1.evil.example:{self.port}"))
        # The server's own timer is a protocol with a name, too.
        self.assertFalse(self.opens(Host="evil.example", Origin="http://evil.example", Sec_WebSocket_Protocol="timer"))
        self.assertFalse(self.opens(Host=own, Sec_WebSocket_Protocol="timer"))

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
        with Client(url, token_of(self.port, "127.0.0.2"), certificate=self.certificate) as client:
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
            Client(url, token_of(self.port, "127.0.0.2"))
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


class TwoAddresses(unittest.TestCase):
    def test_servers_at_one_port_have_each_its_token(self):
        with tempfile.TemporaryDirectory() as folder:
            os.environ["XDG_RUNTIME_DIR"] = folder
            port, addresses, servers = free_port(), ("127.0.0.2", "127.0.0.3"), []
            try:
                for address in addresses:
                    servers.append(subprocess.Popen([PROGRAM, "serve", "--listen", address, "--port", str(port)], stdin=subprocess.DEVNULL,
                                                    stdout=subprocess.PIPE, text=True))
                    self.assertIn(f"http://{address}:{port}/#", servers[-1].stdout.readline())
                first, second = (token_of(port, address) for address in addresses)
                self.assertNotEqual(first, second)
                for address, token in zip(addresses, (second, first)):
                    Client(f"http://{address}:{port}").close()
                    with self.assertRaises(ServerError):
                        Client(f"http://{address}:{port}", token)
                with self.assertRaises(FileNotFoundError):
                    token_of(port)  # nobody listens at 127.0.0.1
                servers[0].terminate()
                self.assertEqual(servers[0].wait(30), 0)
                with self.assertRaises(FileNotFoundError):
                    token_of(port, addresses[0])
                Client(f"http://{addresses[1]}:{port}").close()
            finally:
                for server in servers:
                    server.terminate()
                    server.wait(30)
                    server.stdout.close()


class OtherPages(Server):
    options = ("--origin", "http://localhost:8000", "--origin", "https://lab.example")

    def test_may_connect_where_they_are_named(self):
        for origin, allowed in (("http://localhost:8000", True), ("https://lab.example", True), (f"http://127.0.0.1:{self.port}", True),
                                ("http://localhost:8001", False), ("http://lab.example", False), ("null", False)):
            self.assertEqual(self.opens(Host=f"127.0.0.1:{self.port}", Origin=origin), allowed, origin)
        self.assertFalse(self.opens(Host="localhost:8000", Origin="http://localhost:8000"))
        for wrong in ("null", "*", "http://localhost:8000/"):
            done = subprocess.run([PROGRAM, "serve", "--origin", wrong], capture_output=True, text=True, timeout=60)
            self.assertEqual(done.returncode, 1)
            self.assertIn("is no origin", done.stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
