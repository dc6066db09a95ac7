"""The Python module: the program's touch to the last bit, arrays, errors, threads, real time. Run by CTest with PYTHONPATH and the
arguments PROGRAM SCENES."""

import math
import pathlib
import subprocess
import sys
import tempfile
import threading
import unittest

import numpy

import touchstone

PROGRAM, SCENES = sys.argv[1], pathlib.Path(sys.argv[2])


def ticks_of(file):
    rows = numpy.genfromtxt(file, delimiter=",", names=True)
    return rows, numpy.stack([rows[f"force_{axis}"] for axis in "xyz"], axis=1)


class Offline(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.at = pathlib.Path(self.folder.name)

    def test_is_the_programs_touch(self):
        model = SCENES / "doughnut.glb"
        scene = touchstone.Scene(model)
        positions = scene.stroke("circle")
        times = numpy.arange(len(positions)) * 1e-3
        with open(self.at / "hip.csv", "w") as out:
            out.write("t,x,y,z\n")
            for t, p in zip(times.tolist(), positions.tolist()):
                out.write(",".join(map(repr, [t, *p])) + "\n")
        program = [PROGRAM, "touch", str(model), "--path", str(self.at / "hip.csv"), "--set", "friction=ho"]
        subprocess.run([*program, "--out", str(self.at / "program.csv")], check=True, stdout=subprocess.DEVNULL)
        _, force = ticks_of(self.at / "program.csv")
        ticks = touchstone.touch(scene, positions, times, settings={"friction": "ho"})
        self.assertTrue(numpy.array_equal(ticks.force, force))
        self.assertGreater(numpy.abs(force).max(), 0.1)
        subprocess.run([sys.executable, "-m", "touchstone", *program[1:], "--out", str(self.at / "module.csv")],
                       check=True, stdout=subprocess.DEVNULL)
        ours = (self.at / "module.csv").read_text().splitlines()
        theirs = (self.at / "program.csv").read_text().splitlines()
        self.assertEqual(ours[0], theirs[0])
        # Each number is the same, whatever its digits; the time of a step is no result.
        self.assertEqual(len(ours), len(theirs))
        for a, b in zip(ours[1:], theirs[1:]):
            a, b = list(map(float, a.split(","))), list(map(float, b.split(",")))
            del a[16], b[16]
            self.assertEqual(a, b)

    def test_takes_any_array_of_numbers(self):
        scene = floor()
        path = press(500)
        wanted = touchstone.touch(scene, path).force
        self.assertTrue(numpy.array_equal(touchstone.touch(scene, numpy.asfortranarray(path)).force, wanted))
        self.assertTrue(numpy.array_equal(touchstone.touch(scene, numpy.repeat(path, 2, axis=0)[::2]).force, wanted))
        self.assertTrue(numpy.array_equal(touchstone.touch(scene, path.tolist()).force, wanted))
        self.assertEqual(len(touchstone.touch(scene, path.astype(int))), 500)
        self.assertAlmostEqual(wanted[-1, 1], 800 * 0.005, delta=1e-3)
        self.assertEqual(len(touchstone.touch(scene, numpy.zeros((0, 3)))), 0)

    def test_names_the_argument(self):
        scene = floor()
        good = press(10)
        bad = good.copy()
        bad[3, 1] = numpy.nan
        for call, part in [
                (lambda: touchstone.touch(scene, bad), "positions[3]"),
                (lambda: touchstone.touch(scene, good[:, :2]), "positions: its shape is (10, 2)"),
                (lambda: touchstone.touch(scene, good[0]), "positions: its shape is (3,)"),
                (lambda: touchstone.touch(scene, good.astype(complex)), "positions: its type is complex128"),
                (lambda: touchstone.touch(scene, [["a", "b", "c"]]), "positions"),
                (lambda: touchstone.touch(scene, good, numpy.zeros(9)), "times: has 9"),
                (lambda: touchstone.touch(scene, good, numpy.zeros(10)), "path.times[1]"),
                (lambda: touchstone.touch(scene, good, rate=0.001), "rate"),
                (lambda: touchstone.touch(scene, good, settings={"stiffness": "hard"}), "'hard'"),
                (lambda: touchstone.touch(scene, good, settings={"nothing": 1}), "there is no setting 'nothing'"),
                (lambda: touchstone.Scene(SCENES / "box.glb", fit="tight"), "fit"),
                (lambda: touchstone.Scene.from_arrays(good, [[0, 1, 10]]), "indices[2]"),
                (lambda: touchstone.Scene.from_arrays(good, [[0, 1, -1]]), "triangles"),
                (lambda: touchstone.Scene.from_arrays(good, [[0.0, 1.0, 2.0]]), "triangles"),
                (lambda: touchstone.Scene.from_arrays(good, [[0, 1, 2]], normals=good[:4]), "normals"),
                (lambda: touchstone.Scene.from_arrays(good, [[0, 1, 2]],
                                                      material=touchstone.Material(stiffness=-1)), "stiffness"),
        ]:
            with self.subTest(part), self.assertRaises(touchstone.ArgumentError) as refused:
                call()
            self.assertIn(part, str(refused.exception))
        with self.assertRaises(touchstone.InputError):
            touchstone.Scene("/nowhere.glb")
        with self.assertRaises(OSError):
            touchstone.Recording(SCENES / "box.glb")
        with self.assertRaises(TypeError):
            touchstone.Scene.from_bytes(3.5)

    def test_several_hands_touch_one_world(self):
        scene = touchstone.Scene(SCENES / "doughnut.glb")
        paths = numpy.stack([scene.stroke("circle")[:1500], scene.stroke("tour")[:1500]])
        for together in (touchstone.touch(scene, paths), touchstone.touch(scene, list(paths), numpy.arange(1500) / 1000.0)):
            for path, ticks in zip(paths, together, strict=True):
                self.assertTrue(numpy.array_equal(ticks.force, touchstone.touch(scene, path).force))
                self.assertGreater(int((ticks.contacts > 0).sum()), 500)
        cradle = touchstone.Scene(SCENES / "cradle.glb")
        path = cradle.stroke()[:3000]
        alone = touchstone.touch(cradle, path).force
        self.assertTrue(numpy.array_equal(touchstone.touch(cradle, [path, numpy.full_like(path, 0.5)])[0].force, alone))
        self.assertFalse(numpy.array_equal(touchstone.touch(cradle, [path, path])[0].force, alone))
        for call, part in [(lambda: touchstone.touch(scene, [path] * 5), "hands"), (lambda: touchstone.Hand(scene, hands=0), "hands"),
                           (lambda: touchstone.Hand(scene, hands=2).touch([path]), "1 paths"),
                           (lambda: touchstone.touch(scene, [path, path[:9]]), "paths[1].count"),
                           (lambda: touchstone.touch(scene, [path, path[:, :2]]), "positions: its shape")]:
            with self.assertRaises(touchstone.ArgumentError) as refused:
                call()
            self.assertIn(part, str(refused.exception))

    def test_closed_objects_say_so(self):
        scene = floor()
        hand = touchstone.Hand(scene)
        scene.close()
        self.assertEqual(len(hand.touch(press(10))), 10)
        with self.assertRaises(touchstone.ClosedError):
            touchstone.touch(scene, press(10))
        hand.close()
        with self.assertRaises(touchstone.ClosedError):
            hand.touch(press(10))

    def test_threads_share_a_scene(self):
        scene = touchstone.Scene(SCENES / "doughnut.glb")
        path = scene.stroke("circle")
        wanted = touchstone.touch(scene, path).force
        equal = []
        threads = [threading.Thread(target=lambda: equal.append(numpy.array_equal(touchstone.touch(scene, path).force, wanted)))
                   for _ in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(equal, [True] * 4)

    def test_settings_are_the_programs(self):
        names = [setting.name for setting in touchstone.settings()]
        self.assertIn("stiffness", names)
        text = subprocess.run([PROGRAM, "touch", "--help"], capture_output=True, text=True, check=True).stdout
        for setting in touchstone.settings():
            self.assertIn(f"{setting.name}={setting.initial}", text)


class Live(unittest.TestCase):
    def test_calls_back_and_records(self):
        with tempfile.TemporaryDirectory() as folder, touchstone.Session("stroke:circle", keep=100_000) as session:
            session.touch(touchstone.Scene(SCENES / "doughnut.glb", fit="workspace"))
            session.record(f"{folder}/a.tsrec")
            states = []
            session.run(3.0, states.append)
            session.record(None)
            self.assertGreater(len(states), 10)
            self.assertGreater(max(state.contacts for state in states), 0)
            kept = session.take()
            read = touchstone.Recording(f"{folder}/a.tsrec").read()
            self.assertTrue(numpy.array_equal(kept.force, read.force))
            self.assertIsNone(read.normal)
            self.assertEqual(touchstone.Recording(f"{folder}/a.tsrec").hands, 1)
            replay = subprocess.run([PROGRAM, "replay", f"{folder}/a.tsrec"], capture_output=True, text=True)
            self.assertEqual(replay.returncode, 0, replay.stderr)

    def test_a_recording_has_every_hand(self):
        with tempfile.TemporaryDirectory() as folder, touchstone.Session("stroke:circle", others=["stroke:spiral", "stroke:circle"],
                                                                         keep=100_000) as session:
            session.touch(touchstone.Scene(SCENES / "doughnut.glb", fit="workspace"))
            session.record(f"{folder}/a.tsrec")
            session.run(60, lambda state: bool(min(session.hand(i).contacts for i in range(3)) == 0))
            session.record(None)
            recording = touchstone.Recording(f"{folder}/a.tsrec")
            self.assertEqual(recording.hands, 3)
            for hand in (2, 0, 1):  # each from the beginning, in any order
                kept, read = session.take(hand=hand), recording.read(hand=hand)
                self.assertTrue(numpy.array_equal(kept.force, read.force))
                self.assertTrue(numpy.array_equal(kept.hip, read.hip))
                self.assertGreater(int((read.contacts > 0).sum()), 0)
                self.assertEqual(len(recording.read(hand=hand)), 0)
            with self.assertRaisesRegex(touchstone.ArgumentError, "there are 3"):
                recording.read(hand=3)

    def test_ends_on_false_and_on_exceptions(self):
        with touchstone.Session() as session:
            session.touch(touchstone.Scene(SCENES / "box.glb", fit="workspace"))
            calls = []
            session.run(600, lambda state: calls.append(state) or len(calls) < 3)
            self.assertEqual(len(calls), 3)
            with self.assertRaises(ZeroDivisionError):
                session.run(600, lambda state: 1 / 0)
        with self.assertRaises(touchstone.ClosedError):
            session.start()
        with self.assertRaises(touchstone.StateError):
            touchstone.Session().start()


    def test_a_device_is_two_functions(self):
        felt, calls = [], []

        def position():  # begins far above the floor, and presses 2 mm into it
            calls.append(threading.get_ident())
            return numpy.array([0.01, max(0.1 - 0.001 * len(calls), -0.002), 0.003])

        session = touchstone.Session(position=position, force=lambda force: felt.append(force[1]), device_rate=200, max_force=1, stale_age=10)
        with session:
            session.touch(floor())
            session.run(60, lambda state: bool(max(felt, default=0) < 0.99))
            self.assertGreater(session.pump().force[1], 1.5)  # 800 N/m, 2 mm; no command is above the limit
        self.assertEqual(len(set(calls)), 1)
        self.assertNotEqual(calls[0], threading.get_ident())
        self.assertLessEqual(max(felt), 1 + 1e-12)
        self.assertEqual(felt[-1], 0)
        for wrong, error, part in ((lambda: [1, 2], touchstone.ArgumentError, "2 numbers"), (lambda: "here", touchstone.ArgumentError, "three numbers"),
                                   (lambda: 1 / 0, ZeroDivisionError, "division")):
            session = touchstone.Session(position=wrong, force=felt.append)
            session.touch(floor())
            with self.assertRaisesRegex(error, part):
                session.run(60, lambda state: None)
            session.close()
        for arguments in (dict(position=position), dict(force=felt.append), dict(position=3, force=felt.append), dict(position=position, force=felt.append, device_rate=0),
                          dict(device="stroke", position=position, force=felt.append)):
            with self.assertRaises(touchstone.ArgumentError):
                touchstone.Session(**arguments)
        nowhere = touchstone.Session(position=lambda: None, force=felt.append)  # and closed by nobody
        nowhere.touch(floor())
        nowhere.run(0.2)
        self.assertEqual(nowhere.pump().contacts, 0)
        del nowhere

    def test_several_hands(self):
        felt = {name: [0.0] for name in "ab"}

        def hand(name):
            calls = []

            def position():
                calls.append(None)  # in and out: a hand that begins in the model feels nothing before it has left
                return [0.01, max(0.01 * math.cos(0.02 * len(calls)), -0.002), 0.003]

            return position, lambda force: felt[name].append(force[1])

        forces = [0.0]

        def goes_on(state):
            forces.append(session.hand(1).force[1])
            touched = session.hand(2).contacts > 0
            return bool(min(map(max, felt.values())) < 0.99 or max(forces) < 1.5 or not touched)

        with touchstone.Session(position=hand("a")[0], force=hand("a")[1], others=[hand("b"), "stroke"], device_rate=200, max_force=1,
                                stale_age=10, keep=1000) as session:
            session.touch(floor())
            session.run(60, goes_on)
            self.assertGreater(max(forces), 1.5)  # 800 N/m, 2 mm; no command is above 1 N
            self.assertLessEqual(max(map(max, felt.values())), 1 + 1e-12)
            self.assertTrue(numpy.array_equal(session.take().time, session.take(hand=1).time))
            self.assertGreater(int((session.take(hand=2).contacts > 0).sum()), 0)
            with self.assertRaisesRegex(touchstone.ArgumentError, "there are 3"):
                session.hand(3)
        self.assertEqual((felt["a"][-1], felt["b"][-1]), (0, 0))
        for others, part in ((["stroke"] * 4, "other_count"), ([3], "others"), ([(3, 4)], "others"), (["stroke:nothing"], "others.0.")):
            with self.assertRaisesRegex(touchstone.ArgumentError, part):
                touchstone.Session("stroke", others=others)
        with self.assertRaisesRegex(touchstone.ArgumentError, "control loop"):
            touchstone.Session("stroke", others=["stroke"], control=1000)

    def test_moves_objects_and_materials(self):
        heights = [0.1] * 20  # far above the floor, and then 1 cm

        def position():
            return [0.01, heights.pop() if heights else 0.01, 0.003]

        with touchstone.Session(position=position, force=lambda force: None, device_rate=200, stale_age=10) as session:
            with self.assertRaises(touchstone.StateError):
                session.move(0, [0, 0, 0])
            session.touch(floor())
            session.start()
            session.run(60, lambda state: not state.touching)
            rest, turned = session.pose(0)
            self.assertTrue(numpy.array_equal(turned, [1, 0, 0, 0]))
            with self.assertRaisesRegex(touchstone.ArgumentError, "speed"):
                session.move(0, [0, 0, 0], speed=1)
            with self.assertRaisesRegex(touchstone.ArgumentError, "object"):
                session.move(1, [0, 0, 0])
            session.move(0, rest + [0, 0.012, 0], speed=0.05)  # lifts the hand by 2 mm: 1.6 N
            session.run(60, lambda state: bool(state.force[1] < 1.59))
            self.assertGreater(session.pump().force[1], 1.5)
            self.assertIsNone(session.material_number(0, "damping"))
            session.material(0, "stiffness", 400)
            self.assertEqual(session.material_number(0, "stiffness"), 400)
            session.run(60, lambda state: bool(state.force[1] > 0.81))
            self.assertLess(session.pump().force[1], 0.85)
            session.halt()
            self.assertAlmostEqual(session.pose(0)[0][1], rest[1] + 0.012, places=12)

    def test_renders_contact(self):
        felt = []
        with touchstone.Session(position=lambda: [0.01, 0.01, 0.003], force=lambda force: felt.append(force[1]), control=1000, device_rate=200, stale_age=10) as session:
            session.touch(floor())
            session.start()
            session.render(True)
            with self.assertRaisesRegex(touchstone.ArgumentError, "planes"):
                session.goal([0, 0, 0], planes=[[0, 1, 0]] * 4)

            def push(state):
                session.goal([0.01, 0.011, 0.003], stiffness=300)
                return bool(max(felt, default=0) < 0.001)  # without energy of its own it takes what its damper lends

            session.run(2, push)
            self.assertEqual(session.pump().object, -1)
            session.goal(None)


def floor():
    return touchstone.Scene.from_arrays([[-.1, 0, -.1], [-.1, 0, .1], [.1, 0, .1], [.1, 0, -.1]], [[0, 1, 2], [0, 2, 3]],
                                        material=touchstone.Material(stiffness=800))


def press(rows):
    return numpy.stack([numpy.full(rows, 0.01), numpy.linspace(0.005, -0.005, rows), numpy.full(rows, 0.003)], axis=1)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
