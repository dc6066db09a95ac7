"""Drives the real window on a virtual screen as a person would, and saves parts of it as pictures.
Used by tools/figure_window, tools/figure_tutorial and tools/walk, which pass PROGRAM, WORK (a folder for state) and FIGURES."""

import json, os, signal, subprocess, time


def run(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


class Workbench:
    def __init__(self, program, work, figures, *arguments, introduced=True, size=(1280, 800)):
        self.work, self.figures, self.size = work, figures, size
        with open(f"{work}/touchstone/window.json", "w") as memory:
            json.dump({"version": 1, "introduced": introduced}, memory)
        self.process = subprocess.Popen([program, "--size", f"{size[0]}x{size[1]}", "--status-json", f"{work}/status.json", *arguments])
        time.sleep(6)
        for _ in range(60):  # a busy machine
            if os.path.exists(f"{work}/status.json"):
                break
            time.sleep(1)
        run("xdotool", "windowfocus", run("xdotool", "search", "--onlyvisible", "--name", "Touchstone").split()[0])

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.send_signal(signal.SIGINT)
        self.process.wait()

    def status(self):
        time.sleep(0.3)  # it is written after each picture
        return self.peek()

    def peek(self):
        """As it was written last."""
        with open(f"{self.work}/status.json") as file:
            return json.load(file)

    def widgets(self):
        return self.status()["widgets"]

    def key(self, *names):
        for name in names:
            run("xdotool", "keydown", *name.split("+"))
            time.sleep(0.3)
            run("xdotool", "keyup", *reversed(name.split("+")))
            time.sleep(0.7)

    def press_at(self, x, y):
        run("xdotool", "mousemove", str(int(x)), str(int(y)))
        time.sleep(0.3)
        run("xdotool", "mousedown", "1")

    def release(self):
        time.sleep(0.3)
        run("xdotool", "mouseup", "1")
        time.sleep(0.7)

    def click(self, widget, share=None):
        """At the widget's left end, or at a share of its width."""
        rect = self.widgets()[widget]
        self.press_at(rect["x"] + (12 if share is None else share * rect["width"]), rect["y"] + rect["height"] / 2)
        self.release()

    def in_picture(self, x, y):
        """A place in the picture, by shares of its width and height."""
        rect = self.widgets()["picture"]
        return rect["x"] + x * rect["width"], rect["y"] + y * rect["height"]

    def move(self, x, y):
        run("xdotool", "mousemove", str(int(x)), str(int(y)))
        time.sleep(0.1)

    def wait_for_pictures(self):
        self.move(2, self.size[1] - 2)
        for _ in range(120):
            entries = self.status()["gallery"]["entries"]
            if entries and all(entry["state"] != "waiting" for entry in entries):
                break

    def parts(self):
        """Where bar, panels and picture are: x, y, width, height."""
        p = self.widgets()["picture"]
        right, below = p["x"] + p["width"], p["y"] + p["height"]
        width, height = self.size
        return {
            "window": (0, 0, width, height), "bar": (0, 0, width, p["y"]),
            "picture": (p["x"], p["y"], p["width"], p["height"]), "left": (0, p["y"], p["x"], height - p["y"]),
            "right": (right, p["y"], width - right, height - p["y"]),
            "bottom": (p["x"], below, p["width"], height - below),
            "middle": (p["x"], p["y"], p["width"], height - p["y"]),
        }

    def save(self, name, part):
        x, y, width, height = (int(v) for v in self.parts()[part])
        run("import", "-window", "root", f"{self.work}/all.png")
        run("convert", f"{self.work}/all.png", "-crop", f"{width}x{height}+{x}+{y}", "+repage", "+dither",
            "-colors", "240", f"PNG8:{self.figures}/{name}.png")
        print(f"{self.figures}/{name}.png")
