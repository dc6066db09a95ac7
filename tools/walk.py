"""A new user's first minutes (tools/walk). They know what a mouse is, and read what the window says.
Each step is what they want, what they do, and what the window must show them for it: a fact of --status-json or of the pixels."""

import math, sys, time

from workbench_driver import Workbench, run


class Walk:
    def __init__(self, window, pictures):
        self.window, self.pictures = window, pictures
        self.begin, self.steps, self.failed = time.monotonic(), 0, 0
        self.clicks = self.keys = self.all_clicks = self.all_keys = 0

    # What a person's hands do, counted.

    def click(self, widget, share=None):
        self.window.click(widget, share)
        self.clicks += 1

    def key(self, *names):
        self.window.key(*names)
        self.keys += len(names)

    def type(self, text):
        run("xdotool", "type", "--delay", "60", text)
        time.sleep(0.7)
        self.keys += len(text)

    def wheel(self, notches):
        for _ in range(abs(notches)):
            run("xdotool", "click", "4" if notches > 0 else "5")
            time.sleep(0.1)

    def rest_on(self, widget):
        rect = self.window.widgets()[widget]
        self.window.move(rect["x"] + rect["width"] / 2, rect["y"] + rect["height"] / 2)
        time.sleep(1.0)

    def drag(self, begin, end, button="1", turns=1):
        """To and fro between two places of the picture; the largest tangential force that the charts held meanwhile."""
        (x0, y0), (x1, y1) = self.window.in_picture(*begin), self.window.in_picture(*end)
        run("xdotool", "mousemove", str(int(x0)), str(int(y0)))
        time.sleep(0.3)
        run("xdotool", "mousedown", button)
        self.clicks += 1
        tangential = force = 0.0
        for step in range(1, int(30 * turns) + 1):
            share = 0.5 - 0.5 * math.cos(step * math.pi / 15)
            self.window.move(x0 + share * (x1 - x0), y0 + share * (y1 - y0))
            if step > 6 and step % 4 == 0:  # the peaks are those of the last half second
                peaks = self.window.peek()["charts"]["peaks"]
                tangential, force = max(tangential, peaks["tangential"]), max(force, peaks["force"])
        self.button = button
        return tangential, force

    def let_go(self):
        run("xdotool", "mouseup", self.button)
        time.sleep(0.7)

    # What they saw.

    def step(self, wanted, saw, right=True):
        self.steps += 1
        seconds = time.monotonic() - self.begin
        run("import", "-window", "root", f"{self.pictures}/{self.steps:02}.png")
        mark = "" if right else "  ** NOT SHOWN **"
        print(f"| {self.steps} | {seconds:.0f} s | {wanted} | {saw}{mark} | {self.clicks} | {self.keys} |", flush=True)
        self.failed += not right
        self.all_clicks += self.clicks
        self.all_keys += self.keys
        self.clicks = self.keys = 0

    def until(self, condition, seconds=60):
        for _ in range(int(seconds / 1.2)):
            status = self.window.status()
            if condition(status):
                return status
        return self.window.status()


def first_minute(walk):
    """Each tile with its effect and without: the chart of the tangential force must tell them apart."""
    window = walk.window
    status = walk.until(lambda s: s["model"] and not s["loading"] and s["picture"]["state"] == "kept")
    walk.begin = time.monotonic()
    walk.step("see what this is", f"a board of three tiles, and a strip: how to touch ({status['model']})", "gotIt" in status["widgets"])
    tiles = (("friction", "the sandy tile", (0.68, 0.48), (0.86, 0.53)), ("texture", "the ribs", (0.43, 0.46), (0.58, 0.50)),
             ("forceShading", "the facets", (0.22, 0.42), (0.34, 0.44)))
    for effect, tile, begin, end in tiles:
        on, _ = walk.drag(begin, end)
        walk.step(f"stroke {tile}", f"*tangential* rises to {on:.2f} N", on > 0.02)
        walk.let_go()
        walk.click(effect)
        off, _ = walk.drag(begin, end)
        walk.step(f"the same without {effect.removeprefix('force').lower()}", f"{off:.3f} N: the strip is flat", off < 0.25 * on)
        walk.let_go()
        walk.click(effect)


def looking(walk):
    window = walk.window
    before = window.status()["view"]["yaw"]
    walk.drag((0.5, 0.75), (0.7, 0.7), button="3", turns=0.5)
    walk.let_go()
    walk.step("see it from the side", "the board turns", abs(window.status()["view"]["yaw"] - before) > 0.1)
    walk.key("Home")
    walk.rest_on("passivity")
    tip = window.status()["tooltip"]
    walk.step("know what *Passivity control* is", f"a tooltip of {len(tip.split())} words", len(tip) > 20)
    walk.key("F1")
    walk.step("know the keys", "a card with all keys", window.status()["help"])
    walk.key("Escape")
    _, force = walk.drag((0.63, 0.47), (0.72, 0.50))
    walk.wheel(3)
    time.sleep(0.7)
    now = window.status()
    walk.step("press harder (the help says: wheel)", f"{force:.2f} N, then {now['mouse']['press_n']:.2f} N", now["mouse"]["press_n"] > force)
    walk.key("space")
    sent = window.status()["tick"]["command_n"]
    walk.step("be rid of the force", f"the force is grey, {sent:.2f} N are sent", sent == 0.0)
    walk.key("space")
    walk.let_go()
    walk.click("gotIt")
    walk.step("have the strip's room", "the strip has gone", "gotIt" not in window.widgets())


def other_models(walk):
    window = walk.window
    walk.key("ctrl+g")
    status = walk.until(lambda s: sum(e["state"] == "shown" for e in s["gallery"]["entries"]) >= 3)
    walk.step("something rounder", f"the gallery: {len(status['gallery']['entries'])} scenes, and what there is to feel in each", len(status["gallery"]["entries"]) > 3)
    walk.click("gallery:doughnut.glb", 0.5)
    status = walk.until(lambda s: s["model"] == "doughnut.glb" and s["picture"]["state"] == "kept")
    walk.step("the doughnut", "it is there", status["model"] == "doughnut.glb")
    tangential, force = walk.drag((0.30, 0.50), (0.34, 0.42))
    status = window.status()
    walk.step("touch it", f"{force:.2f} N, {tangential:.2f} N along the surface; a tick takes {status['stages']['step']['p50_us']:.1f} µs", force > 0.1)
    walk.let_go()


def settings(walk):
    window = walk.window
    walk.click("viewMenu")
    walk.step("see more than the surface", "the menu of views", "wireframe" in window.widgets())
    walk.click("wireframe")
    walk.key("Escape")
    walk.step("its triangles", "their edges on the surface", window.status()["view"]["wireframe"])
    walk.key("z", "alt+b")
    status = walk.until(lambda s: s["view"]["clipped"] and s["picture"]["state"] == "kept", 20)
    walk.step("look inside (Alt + B, of the help)", "the doughnut is cut, and its inner wall is seen", status["view"]["clipped"])
    walk.key("alt+b")
    walk.until(lambda s: not s["view"]["clipped"], 20)
    walk.click("editMaterials")
    walk.click("edit.staticFriction", 0.8)
    status = window.status()
    walk.step("make it rougher", "the material editor; the friction's bar follows the click", status["materials"]["edited"])
    walk.key("e")
    on, _ = walk.drag((0.30, 0.50), (0.34, 0.42))
    walk.step("feel that", f"{on:.2f} N along the surface", on > 0.05)
    walk.let_go()


def recording(walk):
    window = walk.window
    walk.click("record")
    _, force = walk.drag((0.30, 0.50), (0.34, 0.42))
    walk.let_go()
    walk.click("record")
    status = walk.until(lambda s: not s["recording"]["on"], 10)
    walk.step("keep what they felt", f"*Record* and *Stop* in one place; {force:.2f} N recorded", not status["recording"]["on"])
    walk.click("recorded")
    status = walk.until(lambda s: any(name.startswith("recording:") for name in s["widgets"]), 10)
    name = next((name for name in status["widgets"] if name.startswith("recording:")), None)
    walk.step("find it again", "the list: name, date, length, model", name is not None)
    if name is None:
        return
    walk.click(name)
    status = walk.until(lambda s: s["timeline"]["looking"], 20)
    walk.step("look at it", "its timeline; the picture says that a recording is looked at", status["timeline"]["looking"])
    walk.click("friction")
    walk.click("touchAgain")
    walk.until(lambda s: "backToLive" in s["widgets"], 20)
    walk.step("what it were without friction (*Touch again*)", "both forces over each other", True)
    walk.click("friction")
    walk.click("backToLive")
    status = walk.until(lambda s: not s["timeline"]["looking"], 20)
    walk.step("go back", "the live charts", not status["timeline"]["looking"])


def own_model(walk):
    window = walk.window
    walk.key("ctrl+o")
    status = walk.until(lambda s: "openPath" in s["widgets"] or s["leaving"], 10)
    walk.step("open a model of their own", "the browser", "openPath" in status["widgets"])
    walk.click("place:Downloads")
    walk.type("ri")
    walk.step("the ring that they downloaded", "*Downloads* on the left; the list narrows to the ring", "file:ring.glb" in window.widgets())
    walk.key("Return")
    status = walk.until(lambda s: s["leaving"] or s["model"] == "ring.glb", 20)
    if status["leaving"]:
        walk.step("(they had forgotten the rougher doughnut)", "the question: *Save*, *Discard* or *Stay*", True)
        walk.key("d")
    status = walk.until(lambda s: s["model"] == "ring.glb" and s["picture"]["state"] == "kept", 30)
    walk.step("see it", "the ring, fitted to the hand's workspace", status["model"] == "ring.glb")
    _, force = walk.drag((0.30, 0.50), (0.34, 0.42))
    walk.step("touch it", f"{force:.2f} N", force > 0.1)
    walk.let_go()


def pictures(walk):
    window = walk.window
    walk.key("F12")
    status = walk.until(lambda s: s["view"]["picture"], 10)
    walk.step("a picture for a friend", "where it was saved stands on the picture", bool(status["view"]["picture"]))
    walk.click("saveSvg")
    status = walk.until(lambda s: s["charts"]["saved"].endswith(".svg"), 20)
    walk.step("the charts for a paper", "*saved* beside the buttons", status["charts"]["saved"].endswith(".svg"))
    walk.key("ctrl+shift+plus")
    status = walk.until(lambda s: s["ui_scale"]["asked"] > 1.0, 5)
    walk.step("larger type", f"scale {status['ui_scale']['scale']:g}" + ("" if status["ui_scale"]["fits"] else ", the largest that fits, and a note says so"),
              status["ui_scale"]["asked"] == 1.25)


def main(program, state, pictures_folder, size):
    width, height = (int(n) for n in size.split("x"))
    print(f"\n## {size}\n\n| | at | they want | they see | clicks | keys |\n|---|---|---|---|---|---|", flush=True)
    with Workbench(program, state, pictures_folder, introduced=False, size=(width, height)) as window:
        walk = Walk(window, pictures_folder)
        for part in (first_minute, looking, other_models, settings, recording, own_model, pictures):
            part(walk)
    print(f"\n{walk.steps} steps, {time.monotonic() - walk.begin:.0f} s, {walk.all_clicks} clicks, {walk.all_keys} keys; {walk.failed} not shown")
    return 1 if walk.failed else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
