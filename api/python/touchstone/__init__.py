"""Touchstone: feel a model from Python (docs/python.md).

SI units; the workspace is right-handed, y up. Arrays are NumPy's, one row a tick; float64 arrays in C order are used without a
copy. Every function releases the GIL while it works. A call that is refused raises a subclass of Error with the message of the
program.

    import touchstone
    scene = touchstone.Scene("doughnut.glb")
    ticks = touchstone.touch(scene, scene.stroke("circle"))
    print(ticks.force.max(axis=0))
"""

from __future__ import annotations

import atexit
import os
import weakref

import numpy

from . import _touchstone
from ._touchstone import Material, SceneInfo, State

__version__ = _touchstone.version()
__all__ = ["Error", "ArgumentError", "ClosedError", "InputError", "StateError", "Cancelled", "Material", "SceneInfo", "State",
           "Scene", "Hand", "Session", "Recording", "Setting", "Ticks", "settings", "touch"]


class Error(Exception):
    """A call that failed."""


class ArgumentError(Error, ValueError):
    """An argument is wrong; the message names it."""


class ClosedError(Error, ValueError):
    """The object was closed."""


class InputError(Error, OSError):
    """A file or a device is missing, broken or not usable; the message has the remedy."""


class StateError(Error, RuntimeError):
    """Not now: the session has no scene."""


class Cancelled(Error):
    """A callback asked to stop."""


_touchstone.exceptions.update(Error=Error, TS_ARGUMENT=ArgumentError, TS_CLOSED=ClosedError, TS_INPUT=InputError,
                              TS_STATE=StateError, TS_CANCELLED=Cancelled, TS_MEMORY=MemoryError)

_FITS = {"none": 0, "workspace": 1}


def _fit(fit):
    if fit not in _FITS:
        raise ArgumentError(f"fit: '{fit}' is none of none, workspace")
    return _FITS[fit]


def _text(value):
    """A setting's value as --set takes it."""
    if isinstance(value, bool):
        return "on" if value else "off"
    return str(value)


def _texts(settings):
    return {str(name): _text(value) for name, value in (settings or {}).items()}


class Ticks:
    """One entry (or row of 3) a tick; workspace, SI.

    time (N,) s; hip, proxy (N, 3) m; normal (N, 3) unit, zero without contact; force (N, 3) N before safety; command (N, 3) N after
    it; penetration (N,) m; contacts, friction (0 free, 1 sticks, 2 slides), flags (N,) uint32; object, triangle (N,) int32, -1: none;
    step_ns (N,) int64. What a recording does not have is None."""

    __slots__ = ("time", "hip", "proxy", "normal", "force", "command", "penetration", "contacts", "friction", "flags", "object",
                 "triangle", "step_ns")

    def __init__(self, arrays):
        for name in self.__slots__:
            setattr(self, name, arrays.get(name))

    def __len__(self):
        return len(self.time)

    def __repr__(self):
        return f"<{len(self)} ticks, {int((self.contacts > 0).sum())} in contact>"


class Scene:
    """A model to touch; immutable. Any number of threads may touch it at once."""

    def __init__(self, file, *, fit="none", iso=None):
        """Reads any file that the program opens. `fit`: "none" (model metres are workspace metres) or "workspace" (its longest side
        becomes 0.15 m). `iso`: of a volume, the value at its surface."""
        self._scene = _touchstone.Scene(os.fspath(file), _fit(fit), iso)

    @classmethod
    def _of(cls, *arguments):
        scene = cls.__new__(cls)
        scene._scene = _touchstone.Scene(*arguments)
        return scene

    @classmethod
    def from_bytes(cls, data, *, folder="", fit="none"):
        """A .gltf or .glb in memory; its URIs are relative to `folder`."""
        return cls._of(bytes(data), os.fspath(folder), _fit(fit))

    @classmethod
    def from_arrays(cls, positions, triangles, *, normals=None, texture=None, material=None, name="", fit="none"):
        """A mesh: positions (N, 3) m, triangles (M, 3) indices, counter-clockwise seen from outside, normals (N, 3), texture
        coordinates (N, 2). Stored as float32."""
        mesh = dict(positions=positions, triangles=triangles, normals=normals, texture=texture, material=0, name=name)
        return cls._of([mesh], [material] if material is not None else [], _fit(fit))

    @classmethod
    def from_meshes(cls, meshes, materials=(), *, fit="none"):
        """Several: dicts with the arguments of `from_arrays`, `material` being an index into `materials`."""
        defaults = dict(normals=None, texture=None, material=0, name="")
        return cls._of([{**defaults, **mesh} for mesh in meshes], list(materials), _fit(fit))

    @property
    def info(self):
        """Numbers of objects, triangles and materials; bounds (low, high) in the workspace; whether it moves."""
        return self._scene.info()

    @property
    def warnings(self):
        """What the program would print about it."""
        return self._scene.warnings()

    @property
    def triangles(self):
        """Corners of the triangles at rest: (M, 3, 3) float32, m, workspace."""
        return self._scene.triangles()

    def stroke(self, name="tour", *, rate=1000.0, speed=0.0, depth=0.0):
        """Positions (N, 3) of a simulated hand that strokes it, `rate` a second for one period of the stroke. speed m/s and depth m:
        0 is the stroke's own."""
        return self._scene.stroke(name, rate, speed, depth)

    def close(self):
        """Later calls raise ClosedError; what touches it goes on."""
        self._scene.close()


class Hand:
    """A hand that touches offline, path after path; deterministic. `hands`: several in one world (1 to 4): what one moves the others feel."""

    def __init__(self, scene, settings=None, *, hands=1):
        if not 1 <= hands <= 4:
            raise ArgumentError("hands: is not within 1 .. 4")
        self._hand, self._hands = _touchstone.Hand(scene._scene, _texts(settings), hands), hands

    def set(self, name, value):
        """For the next tick; names and values as `touchstone --set`."""
        self._hand.set(name, _text(value))

    def touch(self, positions, times=None, *, rate=1000.0):
        """Touches along positions (N, 3) m; `times` (N,) s, increasing, or `rate` Hz. Goes on where the last path ended. Ctrl+C
        stops it. Several hands take a list of such positions, equally many each, and give a list of Ticks."""
        if self._hands == 1:
            return Ticks(self._hand.touch([positions], times, rate)[0])
        if len(positions) != self._hands:
            raise ArgumentError(f"positions: has {len(positions)} paths, and there are {self._hands} hands")
        return [Ticks(arrays) for arrays in self._hand.touch(list(positions), times, rate)]

    def close(self):
        self._hand.close()


def touch(scene, positions, times=None, *, rate=1000.0, settings=None):
    """Touches `scene` along positions (N, 3), from the beginning: what `touchstone touch` computes, to the last bit. Two to four hands in one
    world: a list of such positions, or an array (hands, N, 3); gives a list of Ticks."""
    lists = isinstance(positions, (list, tuple)) and len(positions) > 0 and numpy.ndim(positions[0]) == 2
    several = lists or getattr(positions, "ndim", 0) == 3
    return Hand(scene, settings, hands=len(positions) if several else 1).touch(positions, times, rate=rate)


_own_devices = weakref.WeakSet()


@atexit.register
def _close_own_devices():
    """Before the interpreter ends: their threads call into it."""
    for session in list(_own_devices):
        try:
            session.close()
        except Exception:
            pass


class Session:
    """Touch in real time, by a servo of the library's own. `device`: "stroke", "stroke:NAME" (a simulated hand), or a device
    as `touchstone run --device` takes ("stroke" in place of "hand"). `keep`: ticks kept for `take`. `control`: Hz of a
    control loop apart from contact, 100 to 4000.

    A device of your own is two functions: `position()` returns three numbers (m, device frame) or None where it is unknown,
    `force(newtons)` gets an array of 3. A thread calls them `device_rate` times a second; the servo waits for neither, and where no
    position comes for `stale_age` s (0: the device's usual one) the force fades. `max_force`: N, 0 for the usual one. What they throw
    ends them and comes out of `pump`, `run` or `close`.

    `others`: up to three further hands in the same world, each a device's name or a pair of such functions."""

    def __init__(self, device=None, *, position=None, force=None, others=(), device_rate=1000.0, max_force=0.0, stale_age=0.0, rate=1000.0,
                 keep=0, control=0.0):
        if (position is None) != (force is None) or (position is not None and device is not None):
            raise ArgumentError("device: give either a device, or both `position` and `force`")
        first = (position, force) if position is not None else "stroke" if device is None else device
        hands = [first, *([others] if isinstance(others, str) else others)]
        own = [hand for hand in hands if not isinstance(hand, str)]
        for hand in own:
            if not (isinstance(hand, (tuple, list)) and len(hand) == 2 and all(map(callable, hand))):
                raise ArgumentError("position: it and `force` have to be functions" if hand is first else
                                    "others: has to hold devices' names or pairs of functions")
        if own and not 1.0 <= device_rate <= 10_000.0:
            raise ArgumentError("device_rate: is not within 1 .. 10000 Hz")
        self._session = _touchstone.Session(hands, device_rate, max_force, stale_age, rate, keep, control)
        if own:
            _own_devices.add(self)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._session.close()

    def touch(self, scene):
        """From the next tick on."""
        self._session.touch(scene._scene)

    def set(self, name, value):
        self._session.set(name, _text(value))

    def force(self, on):
        """Takes the force away, or gives it back."""
        self._session.force(on)

    def material(self, material, name, value):
        """A number of a material of the scene from the next tick on (docs/materials.md); None: as in the file."""
        self._session.material(material, name, float("nan") if value is None else value)

    def material_number(self, material, name):
        """As it is felt now, before maps; None: the session's setting or the device's recommendation."""
        value = self._session.material_number(material, name)
        return None if value != value else value

    def move(self, object, position, orientation=(1.0, 0.0, 0.0, 0.0), *, speed=0.1, turn=1.0):
        """From the next tick on an object goes to a pose: `position` of its centre (m, workspace), `orientation` (w, x, y, z) its turn from
        how it stands at rest; at most `speed` (m/s, to 0.5) and `turn` (rad/s, to 6.3) fast. The hand is pushed along."""
        self._session.move(object, position, orientation, speed, turn)

    def halt(self):
        """All objects that were moved stop where they are."""
        self._session.halt()

    def pose(self, object):
        """(position, orientation) of an object in the newest tick."""
        return self._session.pose(object)

    def render(self, on):
        """The control loop follows `goal` from now on, or the servo's contact again (docs/control.md)."""
        self._session.render(on)

    def goal(self, proxy, *, stiffness=0.0, damping=0.0, planes=()):
        """The newest contact that you render: where the proxy is (m, workspace; None: no contact), the spring (N/m, 0: the device's) and the
        damping (N s/m) to it, and up to three unit normals of planes along which it slides."""
        self._session.goal(proxy, stiffness, damping, list(planes))

    def record(self, file):
        """From the next tick on to `file`, for `touchstone replay`; None ends the recording."""
        self._session.record(None if file is None else os.fspath(file))

    def start(self):
        self._session.start()

    def stop(self):
        """The device's last command is zero."""
        self._session.stop()

    def pump(self):
        """The newest State. At least every ten seconds while it runs."""
        return self._session.pump()

    def run(self, seconds, callback=None, *, rate=60.0):
        """Calls `callback(state)` `rate` times a second on this thread; it returns False to end. Starts and stops the servo unless
        it runs already."""
        self._session.run(seconds, callback, rate)

    def hand(self, number):
        """The newest State of a hand (0 is the first) at the last `pump` or callback."""
        return self._session.hand(number)

    def take(self, most=1_000_000, *, hand=0):
        """The kept ticks of a hand since the last call, as Ticks."""
        return Ticks(self._session.take(most, hand))

    def close(self):
        self._session.close()


class Recording:
    """A .tsrec file."""

    def __init__(self, file):
        self._recording = _touchstone.Recording(os.fspath(file))

    @property
    def hands(self):
        """How many hands it has ticks of."""
        return self._recording.hands()

    def read(self, most=1_000_000, *, hand=0):
        """The next ticks of a hand as Ticks; none at the end. Each hand is read on its own, from the beginning."""
        return Ticks(self._recording.read(most, hand))

    def text(self, what):
        """"version", "build", "processor", "command", "date", "scene" or "damage", of what has been read."""
        return self._recording.text(what)

    def close(self):
        self._recording.close()


class Setting:
    """A row of the table of settings: name, unit, meaning, allowed values, initial value, as texts."""

    __slots__ = ("name", "unit", "meaning", "allowed", "initial")

    def __init__(self, *texts):
        self.name, self.unit, self.meaning, self.allowed, self.initial = texts

    def __repr__(self):
        return f"{self.name}={self.initial} {self.unit} [{self.allowed}]: {self.meaning}"


def settings():
    """Every setting that `settings=` and `set` take."""
    return [Setting(*texts) for texts in _touchstone.settings()]
