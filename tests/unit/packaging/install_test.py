"""Strangers' projects against an installed prefix: ten lines of CMake, one file by pkg-config, ten lines of Python, a page in a browser; each
prints the force of `touchstone touch` to the last bit. Arguments: BUILD SCENES CMAKE [BROWSER]; with --installed in place of BUILD against
the installed packages (tools/debian --packages)."""

import functools
import gzip
import http.server
import os
import pathlib
import socket
import subprocess
import sys
import tempfile
import threading
import unittest

BUILD, SCENES, CMAKE = sys.argv[1:4]
BROWSER = sys.argv[4] if len(sys.argv) > 4 else ""
HERE = pathlib.Path(__file__).resolve().parent

PROJECT = """cmake_minimum_required(VERSION 3.18)
project(stranger CXX)
find_package(Touchstone 0.1 REQUIRED)
add_executable(stranger main.cpp)
target_compile_features(stranger PRIVATE cxx_std_17)
target_link_libraries(stranger Touchstone::touchstone)
"""
MAIN = """#include <touchstone/touchstone.hpp>
#include <cstdio>
int main(int, char** arguments) {
    const ts::Scene scene(arguments[1]);
    for (const ts::Vector& force : ts::touch(scene, scene.stroke("circle")).force)
        std::printf("%a %a %a\\n", force[0], force[1], force[2]);
}
"""
SCRIPT = """import sys, touchstone
scene = touchstone.Scene(sys.argv[1])
for force in touchstone.touch(scene, scene.stroke("circle")).force.tolist():
    print(*map(float.hex, force))
"""


def run(*arguments, env=None):
    done = subprocess.run(arguments, capture_output=True, text=True, env={**os.environ, **(env or {})})
    if done.returncode != 0:
        raise AssertionError(f"{arguments}: {done.stdout}{done.stderr}")
    return done.stdout


STATUS = "document.getElementById('status').textContent"


class Quiet(http.server.SimpleHTTPRequestHandler):
    def log_message(self, *_):
        pass


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def numbers(text):
    return [tuple(map(float.fromhex, line.split())) for line in text.splitlines()]


class Installed(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        at = pathlib.Path(cls.folder.name)
        if BUILD == "--installed":
            cls.prefix = pathlib.Path("/usr")
        else:
            for component in ("program", "library", "development", "python"):
                run(CMAKE, "--install", BUILD, "--prefix", str(at / "first"), "--component", component)
            (at / "first").rename(at / "prefix")  # an installation may be moved
            cls.prefix = at / "prefix"
        cls.model = str(cls.prefix / "share/touchstone/scenes/doughnut.glb")
        cls.force = cls.touched(at)
        assert max(max(map(abs, force)) for force in cls.force) > 0.1
        cls.fitted = cls.touched(at, "--fit", "workspace")  # as the server has it
        cls.libraries = next(path for where in ("lib", "lib/*") for path in cls.prefix.glob(f"{where}/libtouchstone.so")).parent

    @classmethod
    def touched(cls, at, *options):
        """The force of each tick, by the program."""
        run(str(cls.prefix / "bin/touchstone"), "touch", cls.model, "--stroke", "circle", "--out", str(at / "ticks.csv"), *options)
        rows = [line.split(",") for line in (at / "ticks.csv").read_text().splitlines()]
        columns = [rows[0].index(f"force_{axis}") for axis in "xyz"]
        return [tuple(float(row[i]) for i in columns) for row in rows[1:]]

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_a_field_is_touched_and_drawn(self):
        """What makes a grid loads touchstone_grids.so out of the installation."""
        model = str(self.prefix / "share/touchstone/scenes/field_torus.glb")
        with tempfile.TemporaryDirectory() as folder:
            ticks = pathlib.Path(folder) / "ticks.csv"
            run(str(self.prefix / "bin/touchstone"), "touch", model, "--stroke", "circle", "--out", str(ticks),
                env={"XDG_CACHE_HOME": folder})
            rows = [line.split(",") for line in ticks.read_text().splitlines()]
            contacts = rows[0].index("contacts")
            self.assertGreater(sum(int(row[contacts]) > 0 for row in rows[1:]), 100)

    def test_a_project_of_cmake(self):
        with tempfile.TemporaryDirectory() as project:
            at = pathlib.Path(project)
            (at / "CMakeLists.txt").write_text(PROJECT)
            (at / "main.cpp").write_text(MAIN)
            run(CMAKE, "-S", project, "-B", f"{project}/build", f"-DCMAKE_PREFIX_PATH={self.prefix}")
            run(CMAKE, "--build", f"{project}/build")
            self.assertEqual(numbers(run(f"{project}/build/stranger", self.model)), self.force)

    def test_pkg_config(self):
        example = next(self.prefix.glob("share/doc/libtouchstone-dev/examples/c/stroke.c"))
        flags = run("pkg-config", "--cflags", "--libs", "touchstone", env={"PKG_CONFIG_PATH": str(self.libraries / "pkgconfig")})
        with tempfile.TemporaryDirectory() as folder:
            run("cc", "-Wall", "-Wextra", "-Werror", str(example), *flags.split(), "-lm", "-o", f"{folder}/stroke")
            out = run(f"{folder}/stroke", self.model, env={"LD_LIBRARY_PATH": str(self.libraries)})
            live = example.with_name("live.cpp")
            run("c++", "-std=c++17", "-Wall", "-Wextra", "-Werror", str(live), *flags.split(), "-o", f"{folder}/live")
        largest = max((x * x + y * y + z * z) ** 0.5 for x, y, z in self.force)
        self.assertAlmostEqual(float(out.split()[-2]), largest, places=12)

    def test_a_script_of_python(self):
        out = run(sys.executable, "-B", "-c", SCRIPT, self.model, env={"PYTHONPATH": str(self.prefix / "lib/python3/dist-packages")})
        self.assertEqual(numbers(out), self.force)

    @unittest.skipUnless(BROWSER, "there is no Chromium")
    def test_a_page_in_a_browser(self):
        for path in (self.prefix / "lib/python3/dist-packages", HERE, HERE.parents[1] / "support" if BUILD != "--installed" else HERE):
            sys.path.insert(0, str(path))
        from browser import open_page, until  # over the installed module's client
        pages = self.prefix / "share/doc/libtouchstone-dev/examples/web"
        handler = functools.partial(Quiet, directory=str(pages))
        with http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler) as host, tempfile.TemporaryDirectory() as folder:
            threading.Thread(target=host.serve_forever, daemon=True).start()
            origin = f"http://127.0.0.1:{host.server_port}"
            for allowed in (True, False):
                server = subprocess.Popen([str(self.prefix / "bin/touchstone"), "serve", self.model, "--port", str(free_port()),
                                           *(["--origin", origin] if allowed else [])], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, text=True)
                self.addCleanup(server.kill)
                address, token = server.stdout.readline().strip().removeprefix("http://").split("/#")
                browser, page = open_page(BROWSER, f"{origin}/force.html#{address},{token}", f"{folder}/{allowed}")
                try:
                    if allowed:
                        status = until(lambda: page.run(f"{STATUS} !== 'connecting' && {STATUS}"))
                        self.assertEqual(status, f"{len(self.fitted)} ticks")
                        printed = page.run("document.getElementById('force').textContent")
                        self.assertEqual([tuple(map(float, line.split())) for line in printed.splitlines()], self.fitted)
                    else:  # nobody's page drives a device
                        self.assertEqual(until(lambda: page.run(f"{STATUS} === 'closed' && {STATUS}")), "closed")
                finally:
                    page.close()
                    for process in (browser, server):
                        process.terminate()
                        process.wait()
                    server.stdout.close()
            host.shutdown()

    def test_what_it_needs_is_found(self):
        program = str(self.prefix / "bin/touchstone")
        with tempfile.TemporaryDirectory() as folder:
            pathlib.Path(folder, "a.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
            self.assertIn("triangles", run(program, "inspect", f"{folder}/a.obj"))
        self.assertIn("--allow-write", run(program, "serve", "--help"))
        manual = gzip.decompress((self.prefix / "share/man/man1/touchstone.1.gz").read_bytes()).decode()
        for name in ("--stroke", "forceShading", "EXIT STATUS", "TOUCHSTONE REPLAY"):
            self.assertIn(name.replace("-", "\\-"), manual)
        completion = str(self.prefix / "share/bash-completion/completions/touchstone")
        words = run("bash", "-c", f'source {completion}; COMP_WORDS=(touchstone touch --plan); COMP_CWORD=2; _touchstone; '
                    'echo "${COMPREPLY[@]}"; COMP_WORDS=(touchstone touch --set fricti); COMP_CWORD=3; _touchstone 2>/dev/null; echo "${COMPREPLY[@]}"')
        self.assertEqual(words.split("\n")[0], "--plant")
        self.assertIn("friction=", words)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
