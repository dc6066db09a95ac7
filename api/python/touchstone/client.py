"""A client of `touchstone serve` (docs/server.md), with nothing but the standard library and NumPy.

    from touchstone.client import Client
    with Client(8790) as server:                 # or Client("/run/user/1000/touch.sock"), or Client("https://lab:8790", token)
        server.ask("drive")
        server.ask("set", name="stiffness", value="900")
        print(server.state()["force"])
"""

import base64
import ipaddress
import json
import os
import pathlib
import select
import socket
import ssl
import struct
import tempfile
import urllib.parse

import numpy

TICK = numpy.dtype([("time", "<f8"), ("hip", "<f8", 3), ("proxy", "<f8", 3), ("force", "<f8", 3), ("command", "<f8", 3),
                    ("contacts", "<u4"), ("flags", "<u4")])


class ServerError(Exception):
    """The server refused a message, or closed the connection."""


def token_of(port, address="127.0.0.1"):
    """The token of the server on that port (and address of this machine), out of the file that only its user may read."""
    runtime = os.environ.get("XDG_RUNTIME_DIR", "")
    folder = (pathlib.Path(runtime) / "touchstone" if runtime.startswith("/")
              else pathlib.Path(tempfile.gettempdir()) / f"touchstone-{os.getuid()}")
    usual = address in ("127.0.0.1", "0.0.0.0", "localhost")
    return (folder / (f"serve-{port}.token" if usual else f"serve-{address}-{port}.token")).read_text()


class Client:
    def __init__(self, where, token=None, *, timeout=10.0, certificate=None):
        """`where`: a port of this machine, the path of a Unix socket, the http address of a server on loopback ("http://127.0.0.2:8790"), or
        the https address of one with TLS, which needs `token` (the server's file has it). `certificate`: file of the certificates that are
        trusted (PEM); None: the system's. Authenticates; `self.hello` is the answer."""
        self.events, self.ticks, self._asked, self._touched = [], [], 0, {}
        where = f"http://127.0.0.1:{where}" if isinstance(where, int) else os.fspath(where)
        if where.startswith(("http://", "https://")):
            address = urllib.parse.urlsplit(where)
            secure, host = address.scheme == "https", address.netloc
            if secure and token is None:
                raise ValueError("token: is missing; it is in a file on the server's machine")
            self._place = (address.port or (443 if secure else 80), address.hostname)
            self._socket = socket.create_connection((address.hostname, self._place[0]), timeout)
            if not secure and not ipaddress.ip_address(self._socket.getpeername()[0].split("%")[0]).is_loopback:
                self._socket.close()
                raise ValueError(f"where: {address.hostname} is another machine, to which the token would go in clear; use https")
        else:
            token, host, secure = "", "unix", False
            self._socket = socket.socket(socket.AF_UNIX)
            self._socket.settimeout(timeout)
            self._socket.connect(where)
        try:
            if secure:
                context = ssl.create_default_context(cafile=certificate)
                self._socket = context.wrap_socket(self._socket, server_hostname=address.hostname)
            self._open(host, token)
        except BaseException:
            self.close()
            raise

    def _open(self, host, token):
        self._socket.sendall((f"GET / HTTP/1.1\r\nHost: {host}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
                              f"Sec-WebSocket-Key: {base64.b64encode(os.urandom(16)).decode()}\r\n"
                              "Sec-WebSocket-Version: 13\r\n\r\n").encode())
        self._buffer = b""
        while b"\r\n\r\n" not in self._buffer:
            self._more()
        head, self._buffer = self._buffer.split(b"\r\n\r\n", 1)
        if b" 101 " not in head.split(b"\r\n")[0]:
            raise ServerError(head.split(b"\r\n")[0].decode(errors="replace"))
        self.hello = self.ask("authenticate", token=token_of(*self._place) if token is None else token)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def close(self):
        self._socket.close()

    def _more(self):
        part = self._socket.recv(1 << 16)
        if not part:
            raise ServerError("the server closed the connection")
        self._buffer += part

    def _bytes(self, count):
        while len(self._buffer) < count:
            self._more()
        part, self._buffer = self._buffer[:count], self._buffer[count:]
        return part

    def send(self, payload, opcode=1):
        """A frame; a client masks its own (RFC 6455)."""
        size = len(payload)
        head = bytes([0x80 | opcode]) + (bytes([0x80 | size]) if size < 126 else struct.pack("!BH", 0xFE, size) if size < 65536
                                         else struct.pack("!BQ", 0xFF, size))
        mask = os.urandom(4)
        words = numpy.frombuffer(payload, numpy.uint8)
        key = numpy.resize(numpy.frombuffer(mask, numpy.uint8), size)
        self._socket.sendall(head + mask + (words ^ key).tobytes())

    def receive(self):
        """The next message: a dict, or an array of ticks."""
        payload = b""
        while True:
            first, second = self._bytes(2)
            size = second & 127
            if size > 125:
                size = struct.unpack("!H" if size == 126 else "!Q", self._bytes(2 if size == 126 else 8))[0]
            part = self._bytes(size)
            opcode = first & 15
            if opcode == 8:
                raise ServerError("the server closed the connection")
            if opcode == 9:
                self.send(part, 10)
            elif opcode < 3:
                kind = opcode or kind
                payload += part
                if first & 0x80:
                    break
        if kind == 2:
            ticks, answers = numpy.frombuffer(payload, TICK, offset=16), struct.unpack_from("<I", payload, 12)[0]
            if answers == 0:
                return ticks
            self._touched.setdefault(answers, []).append(ticks)
            return self.receive()
        return json.loads(payload)

    def ask(self, verb, **members):
        """Sends a message and returns its answer; what comes before it is kept in `events` and `ticks`."""
        self._asked += 1
        self.send(json.dumps({"id": self._asked, "do": verb, **members}).encode())
        while True:
            message = self.receive()
            if isinstance(message, numpy.ndarray):
                self.ticks.append(message)
            elif message.get("id") == self._asked:
                if not message["ok"]:
                    raise ServerError(message["error"])
                return message
            else:
                self.events.append(message)

    def touch(self, **members):
        """The ticks of a path that the server touches offline: `stroke`, or `positions` (N, 3) m, and optional `rate` (Hz) and `settings`:
        what `touchstone touch` computes, to the last bit (docs/server.md)."""
        if "positions" in members:
            members["positions"] = numpy.asarray(members["positions"], float).tolist()
        self.ask("touch", **members)
        number = self._asked
        kept = []
        while True:
            message = self.events.pop(0) if self.events else self.receive()
            if isinstance(message, numpy.ndarray):
                self.ticks.append(message)
            elif message.get("id") != number:
                kept.append(message)
            else:
                self.events = kept + self.events
                if message["event"] == "error":
                    raise ServerError(message["error"])
                return numpy.concatenate(self._touched.pop(number, [numpy.empty(0, TICK)]))

    def event(self, name):
        """The next event of that name."""
        while True:
            message = self.events.pop(0) if self.events else self.receive()
            if isinstance(message, numpy.ndarray):
                self.ticks.append(message)
            elif message.get("event") == name:
                return message

    def state(self):
        """The newest tick, of those that come 60 times a second: what has piled up is read first."""
        newest = None
        while newest is None or self.events or self._buffer or self._waiting():
            newest = self.event("state")
        return newest

    def _waiting(self):
        deciphered = self._socket.pending() if isinstance(self._socket, ssl.SSLSocket) else 0
        return deciphered > 0 or bool(select.select([self._socket], [], [], 0)[0])
