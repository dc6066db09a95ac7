"""`touchstone serve`: its page in a browser. Arguments as serving.py."""

import os
import pathlib
import sys
import unittest

from serving import BROWSER, Server
from touchstone.client import token_of

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "support"))
from browser import open_page, until


class Page(Server):
    @unittest.skipUnless(BROWSER, "there is no Chromium")
    def test_its_sliders_change_what_another_client_feels(self):
        watcher = self.client(self.path)
        self.touching(watcher)
        browser, page = open_page(BROWSER, f"http://127.0.0.1:{self.port}/#{token_of(self.port)}", self.folder / "sliders")
        self.addCleanup(browser.wait)
        self.addCleanup(browser.terminate)
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

    @unittest.skipUnless(BROWSER, "there is no Chromium")
    def test_shows_the_model_and_the_force(self):
        self.touching(self.client(self.path))
        browser, page = open_page(BROWSER, f"http://127.0.0.1:{self.port}/#{token_of(self.port)}", self.folder / "shown", "--window-size=1200,800")
        self.addCleanup(browser.wait)
        self.addCleanup(browser.terminate)
        self.addCleanup(page.close)
        until(lambda: page.run("model && model.count"))
        # The model fills much of the page: a picture of it takes more bytes than one of the panels alone.
        picture = until(lambda: next((p for p in [page.picture()] if len(p) > 20_000), None))
        self.assertEqual(page.wrong, [])
        keep = os.environ.get("TOUCHSTONE_KEEP_PICTURE")
        if keep:
            pathlib.Path(keep).write_bytes(picture)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
