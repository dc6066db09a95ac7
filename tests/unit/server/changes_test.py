"""`touchstone serve`: what clients change of a scene, and paths that it touches for them. Arguments as serving.py."""

import json
import struct
import subprocess
import sys
import time
import unittest

import numpy

from serving import PROGRAM, SCENES, Server
from touchstone.client import ServerError


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

        def later(ticks):
            """Where the objects are so many ticks later."""
            begin = watcher.state()["ticks"]
            while (state := watcher.state())["ticks"] < begin + ticks:
                pass
            return state["moved"]

        # Halted on its way, by who drives or because nobody does: it stays where it is.
        for stop in (lambda: driver.ask("halt"), driver.close):
            driver.ask("move", object=0, position=[0.5, 0, 0], speed=0.05)
            while watcher.state()["moved"][0]["position"][0] < 0.002:
                pass
            stop()
            for _ in range(20):  # the server comes to a closed connection when it can
                before = later(50)
                if later(50) == before:
                    break
            self.assertEqual(later(300), before)
            self.assertLess(before[0]["position"][0], 0.4)
        watcher.ask("drive")
        watcher.ask("record", file="")
        replay = subprocess.run([PROGRAM, "replay", str(self.folder / "root" / "moved.tsrec")], capture_output=True, text=True, timeout=120)
        self.assertEqual(replay.returncode, 0, replay.stdout + replay.stderr)
        watcher.ask("load", scene="box.glb")
        watcher.event("scene")
        self.assertNotIn("moved", watcher.state())


class OneIndex(Server):
    def test_materials_of_one_index_change_together(self):
        """Two squares of one material in the file, one of which has a friction of its own (KHR_physics_rigid_bodies): two of the scene."""
        corners = [(x + dx, 0, z) for x in (-0.05, 0.0) for dx, z in ((0, -0.05), (0, 0.05), (0.05, 0.05), (0.05, -0.05))]
        indices = (0, 1, 2, 0, 2, 3)
        (self.folder / "root" / "squares.bin").write_bytes(struct.pack("<24f6H", *sum(corners, ()), *indices))
        physics = "KHR_physics_rigid_bodies"
        accessors = [dict(bufferView=0, byteOffset=48 * i, componentType=5126, count=4, type="VEC3", min=[-0.05 + 0.05 * i, 0, -0.05],
                          max=[0.05 * i, 0, 0.05]) for i in range(2)] + [dict(bufferView=1, componentType=5123, count=6, type="SCALAR")]
        (self.folder / "root" / "squares.gltf").write_text(json.dumps(dict(
            asset=dict(version="2.0"), scene=0, scenes=[dict(nodes=[0, 1])], materials=[dict(name="one")], extensionsUsed=[physics],
            extensions={physics: dict(physicsMaterials=[dict(staticFriction=0.75, dynamicFriction=0.5)])},
            nodes=[dict(mesh=0), dict(mesh=1, extensions={physics: dict(collider=dict(physicsMaterial=0))})],
            meshes=[dict(primitives=[dict(attributes=dict(POSITION=i), indices=2, material=0)]) for i in range(2)],
            buffers=[dict(uri="squares.bin", byteLength=108)],
            bufferViews=[dict(buffer=0, byteLength=96), dict(buffer=0, byteOffset=96, byteLength=12)], accessors=accessors)))
        driver, watcher = self.client(), self.client(self.path)
        driver.event("scene")
        driver.ask("drive")
        driver.ask("load", scene="squares.gltf")
        driver.event("scene")
        before = watcher.ask("materials")["materials"]
        self.assertEqual(len(before), 2)
        self.assertEqual(before[1]["values"]["staticFriction"], 0.75)
        self.assertNotEqual(before[0]["values"]["staticFriction"], 0.75)
        driver.ask("move", object=1, position=[0.025, 0.001, 0])  # while it is moved, too
        for material in (1, 0):
            for name, value in (("stiffness", 250 + material), ("staticFriction", 0.25)):
                driver.ask("material", material=material, name=name, value=value)
                self.assertEqual([m["values"][name] for m in watcher.ask("materials")["materials"]], [value] * 2)
        told = [(event["material"], event["value"]) for event in watcher.events if event["event"] == "material" and event["name"] == "stiffness"]
        self.assertEqual(told, [(0, 251), (1, 251), (0, 250), (1, 250)])
        for name in ("stiffness", "staticFriction"):
            driver.ask("material", material=0, name=name, value=None)
        self.assertEqual(watcher.ask("materials")["materials"], before)


class Offline(Server):
    def test_touches_paths_for_clients(self):
        client, other = self.client(), self.client(self.path)
        self.touching(client)
        program = [PROGRAM, "touch", str(SCENES / "doughnut.glb"), "--fit", "workspace", "--out", str(self.folder / "ticks.csv")]

        def touched(*options):
            """Positions and forces of `touchstone touch`."""
            subprocess.run([*program, *options], check=True, stdout=subprocess.DEVNULL)
            names = (self.folder / "ticks.csv").read_text().split("\n", 1)[0].split(",")
            rows = numpy.loadtxt(self.folder / "ticks.csv", delimiter=",", skiprows=1)
            return (rows[:, [names.index(f"{what}_{axis}") for axis in "xyz"]] for what in ("hip", "force"))

        path, force = touched("--stroke", "circle")
        ticks = client.touch(stroke="circle")
        self.assertTrue(numpy.array_equal(ticks["force"], force))
        self.assertTrue(numpy.array_equal(ticks["hip"], path))
        self.assertGreater(numpy.abs(force).max(), 0.1)
        # Whatever clients have changed of the scene that is felt.
        other.ask("drive")
        other.ask("material", material=0, name="stiffness", value=100)
        other.ask("move", object=0, position=[0, 0.01, 0])
        _, plain = touched("--stroke", "circle", "--set", "friction=off")
        self.assertTrue(numpy.array_equal(client.touch(positions=path, settings={"friction": "off"})["force"], plain))
        self.assertFalse(numpy.array_equal(plain, force))
        self.assertEqual(len(client.touch(positions=[])), 0)
        for part, wrong in (("either", {}), ("either", dict(stroke="circle", positions=[])), ("three numbers", dict(positions=[[0, 0]])),
                            ("wrong type", dict(stroke=3)), ("'rate'", dict(stroke="circle", rate=0)), ("100000", dict(positions=[[0, 0, 0]] * 100_001)),
                            ("wrong type", dict(stroke="circle", settings={"friction": 1})), ("'hard'", dict(stroke="circle", settings={"stiffness": "hard"})),
                            ("no setting", dict(positions=[[0, 0, 0]], settings={"nothing": "1"})), ("none such", dict(stroke="none such")),
                            ("100000 are the most", dict(stroke="circle", rate=1e6))):
            with self.assertRaises(ServerError) as refusal:
                client.touch(**wrong)
            self.assertIn(part, str(refusal.exception))
        client.send(b'{"do":"touch","stroke":"circle"}')  # without a number the ticks could not be told apart
        while True:
            answer = client.receive()
            if answer.get("ok") is False:
                break
        self.assertIn("'id'", answer["error"])

    def test_one_at_a_time_and_none_for_who_has_gone(self):
        client, other = self.client(), self.client(self.path)
        self.touching(client)
        many = numpy.repeat([[0.0, 0.05, 0.0]], 100_000, axis=0).tolist()
        for _ in range(20):  # a path may be over before the other client asks
            other.ask("touch", positions=many)
            try:
                client.touch(stroke="circle")
            except ServerError as error:
                self.assertIn("another path", str(error))
                break
            other.event("touched")
        else:
            self.fail("two paths at a time")
        other.close()
        end = time.monotonic() + 60
        while time.monotonic() < end:
            try:
                self.assertGreater(len(client.touch(stroke="circle")), 1000)
                break
            except ServerError as error:
                self.assertIn("another path", str(error))
                time.sleep(0.01)
        else:
            self.fail("the path of a client that has gone stays")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
