#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Pages of runs in headless Chromium, against dem_plot's pictures and what h5py reads from the same files:
`test_page.py DEM_BATCH DEM_PLOT INPUTS`."""
import base64
import functools
import io
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import time
import unittest
import xml.etree.ElementTree

try:
    import h5py
    import matplotlib.image
    import numpy as np
except ImportError as error:
    print(f"skipped: the Python packages h5py, numpy and matplotlib are needed ({error})")
    sys.exit(77)

import plots
from browser import Browser

DEM_BATCH, DEM_PLOT, INPUTS = (pathlib.Path(word).resolve() for word in sys.argv[1:4])
SVG = "{http://www.w3.org/2000/svg}"
TITLE = "Less </script><b> & \"quotes\" <!-- é"

# A disc that breaks on an obstacle that moves, with a title that HTML would take for its own.
BREAKS = """
&run t_end = 4e-4, title = 'Less </script><b> & "quotes" <!-- é' /
&material youngs_modulus = 1e9, density = 1000, fracture = 'stress', strength = 5e6 /
&body shape = 'disc', radius = 0.02, spacing = 2e-3, velocity = 0, -30, clearance = 1e-4, outline = 'smooth' /
&obstacle points = -0.3, -0.02, 0, 0.002, 0.3, -0.02, motion = 'translate', velocity = 0, 10 /
&output name = 'breaks', frame_interval = 4e-5, fields = 'velocity', 'von_mises' /
"""
FAILS = """
&run t_end = 4e-4 /
&material youngs_modulus = 1e5, density = 1050 /
&body shape = 'rectangle', size = 0.05, 0.05, spacing = 4e-3, velocity = 0, -4000, clearance = 1e-3 /
&obstacle points = -0.3, -0.02, 0, 0.02, 0.3, -0.02 /
&output name = 'fails', frame_interval = 5e-7 /
"""


run_plot = functools.partial(plots.run_plot, DEM_PLOT)


def rgb(image):
    return np.round(255 * image[:, :, :3]).astype(int)


def block(text, name):
    """The bytes of a block of a page."""
    return base64.b64decode(re.search(f'<script type="text/plain" id="{name}">([^<]*)</script>', text).group(1))


def content(text, name="content"):
    return json.loads(re.search(f'<script type="application/json" id="{name}">([^<]*)</script>', text).group(1))


class Pages(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.keep = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.keep.cleanup)
        cls.folder = pathlib.Path(cls.keep.name)
        cls.made = {}
        with h5py.File(cls.folder / "point.h5", "w") as file:
            file["lattice/x"], file["lattice/mass"] = [[0.0, 0.0]], [2.0]
        for name, text, code in (("breaks", BREAKS, 0), ("fails", FAILS, 4), ("point", plots.POINT, 0)):
            (cls.folder / f"{name}.nml").write_text(text, encoding="utf-8")
            cls.batch(f"{name}.nml", expect=code)
        cls.batch(INPUTS / "rectangle.nml", "--set", "body.spacing=6e-3", "--set", "run.t_end=6e-3", "--set", "output.frame_interval=4e-4")
        cls.browser = Browser()
        cls.addClassCleanup(cls.browser.close)

    @classmethod
    def batch(cls, *words, expect=0):
        result = subprocess.run([DEM_BATCH, *words], cwd=cls.folder, capture_output=True, text=True, timeout=plots.SECONDS, check=False)
        if result.returncode != expect:
            raise AssertionError(f"{words}: exit code {result.returncode}: {result.stderr}")

    def tearDown(self):
        self.assertEqual(self.browser.faults, [])
        self.assertEqual([url for url in self.browser.requests if not url.startswith(("file:", "data:", "about:"))], [])

    def make(self, name, *words):
        if (name, words) not in self.made:
            path = self.folder / f"page_{len(self.made)}.html"
            said = run_plot(self.folder / f"{name}.vtkhdf", "--html", path, *words).stdout
            self.made[name, words] = path, said
        path, self.said = self.made[name, words]
        return path

    def show(self, name, *words, fragment="", size=(1200, 400), dark=False):
        path = self.make(name, *words)
        self.browser.resize(*size, dark)
        self.browser.open(path, fragment)
        return path.read_text(encoding="utf-8")

    def canvas(self):
        data = self.browser.run('document.getElementById("body").toDataURL("image/png")')
        return rgb(matplotlib.image.imread(io.BytesIO(base64.b64decode(data.split(",")[1]))))

    def picture(self, name, frame, color, values):
        """The panel of dem_plot's picture of what the page shows, in as many pixels."""
        view = [float(x) for x in self.browser.run('document.getElementById("body").dataset.view').split()]
        width = self.browser.run('document.getElementById("body").width')
        words = ["--frames", frame, "--color", color, "--range", f"{values[0]!r}:{values[1]!r}", "--width", width + 24,
                 "--zoom", f"{view[0]!r}:{view[2]!r},{view[1]!r}:{view[3]!r}", "--columns", "1"]
        for ending in ("svg", "png"):
            run_plot(self.folder / f"{name}.vtkhdf", "-o", self.folder / f"a.{ending}", *words)
        root = xml.etree.ElementTree.parse(self.folder / "a.svg").getroot()
        group = next(g for g in root.iter(f"{SVG}g") if g.get("id") == f"frame-{frame}")
        x0, y0, x1, y1 = (int(round(float(word))) for word in group.get("data-place").split())
        return rgb(matplotlib.image.imread(self.folder / "a.png"))[y0:y1, x0:x1]

    def differing(self, name, frame, color, values):
        """The share of pixels that differ by more than half-covered edges of springs do, among those of the body in
        either; without the border and the bar of the scale."""
        page, drawn = self.canvas(), self.picture(name, frame, color, values)
        self.assertEqual(page.shape, drawn.shape)
        page, drawn = page[45:-3, 3:-3], drawn[45:-3, 3:-3]
        seen = (page.min(axis=2) < 250) | (drawn.min(axis=2) < 250)
        self.assertGreater(seen.sum(), 2000)
        return (np.abs(page - drawn).max(axis=2) > 64)[seen].mean()

    def number(self):
        return int(self.browser.run('document.getElementById("body").dataset.frame'))

    def test_the_slider_moves_the_body_to_where_dem_plot_has_it(self):
        """Cairo smooths edges otherwise: 0.2 to 0.3 % of the pixels differ; from those two frames later 8 % and more."""
        for name, color, bound in (("rectangle", "von_mises", 0.01), ("rectangle", "strain", 0.01), ("breaks", "von_mises", 0.01)):
            facts = content(self.show(name, "--color", color))
            values = facts["quantities"][0]["range"]
            self.assertEqual((facts["quantities"][0]["name"], self.number()), (color, 0))
            self.browser.run('document.getElementById("frame").focus()')
            for frame in range(1, 6):
                self.browser.press("ArrowRight", 39)
                self.assertEqual(self.number(), frame)
            same, other = (self.differing(name, frame, color, values) for frame in (5, 7))
            self.assertLess(same, bound)
            self.assertGreater(other, 4 * bound)

    def test_charts_have_the_rows_of_the_history(self):
        for name in ("rectangle", "breaks"):
            text = self.show(name)
            facts = content(text)
            with h5py.File(self.folder / f"{name}.vtkhdf") as file:
                history = {key: column[...] for key, column in file["history"].items()}
            n = len(history["t"])
            self.assertEqual(np.frombuffer(block(text, "times0"), "<f8").tolist(), history["t"].tolist())
            rows = self.browser.run('[...document.querySelectorAll("svg.chart")].map(c => Number(c.dataset.rows))')
            self.assertEqual((rows, facts["rows"]), ([n] * len(facts["charts"]), n))
            lines = {(chart["label"], line["name"]): np.frombuffer(block(text, f"line{line['block']}"), "<f4")
                     for chart in facts["charts"] for line in chart["lines"]}
            for key, column in ((("energy", "kinetic"), history["kinetic"]), (("energy", "springs"), history["elastic"]),
                                (("contacts", ""), history["contacts"]), (("reaction", "along y"), history["obstacle_reaction"][:, 0, 1])):
                np.testing.assert_array_equal(lines[key], column.astype("<f4"))
            # what stands beside a chart is of the row at the frame's time
            t = facts["frames"][3]["t"]
            self.browser.run("show(3)")
            row = np.searchsorted(history["t"], t, side="right") - 1
            shown = self.browser.run("charts[0].chart.lines.find(l => l.name === 'kinetic').value.textContent")
            self.assertEqual(shown, self.browser.run(f"withUnit({float(np.float32(history['kinetic'][row]))!r}, 'J')"))

    def test_places_are_within_half_a_step_of_16_bits(self):
        text = self.make("rectangle").read_text(encoding="utf-8")
        facts = content(text)
        with h5py.File(self.folder / "rectangle.vtkhdf") as file:
            x = file["VTKHDF/Points"][...].reshape(len(facts["frames"]), facts["nodes"], 3)[:, :, :2]
        raw = np.frombuffer(block(text, "places0"), "<u2").reshape(x.shape)
        for frame, facts_of_it in enumerate(facts["frames"]):
            box = np.array(facts_of_it["box"])
            sides = box[2:] - box[:2]
            off = np.abs(box[:2] + sides * raw[frame] / 65535 - x[frame])
            self.assertLessEqual((off / sides).max(), 1.0001 * 0.5 / 65535)

    def test_zoom_and_colours(self):
        self.show("rectangle", "--color", "speed", fragment="#frame=4&color=stress_yy")
        self.assertEqual((self.number(), self.browser.run("run.quantities[state.quantity].name")), (4, "stress_yy"))
        whole = self.canvas()
        self.browser.run('document.getElementById("body").focus()')
        for key, code in (("+", 187), ("+", 187), ("ArrowLeft", 37), ("ArrowUp", 38)):
            before = self.browser.run("[state.x, state.y, state.zoom]")
            self.browser.press(key, code)
            self.assertNotEqual(self.browser.run("[state.x, state.y, state.zoom]"), before)
        self.assertFalse((self.canvas() == whole).all())
        self.browser.press("0", 48)
        np.testing.assert_array_equal(self.canvas(), whole)
        self.browser.run('const s = document.getElementById("quantity"); s.value = 0; s.dispatchEvent(new Event("change"))')
        self.assertIn("speed, m/s", self.browser.run('document.getElementById("scale").textContent'))
        self.assertFalse((self.canvas() == whole).all())

    def test_a_click_in_a_chart_sets_the_time_and_play_runs_to_the_end(self):
        self.show("rectangle", size=(1200, 900))
        box = self.browser.run("(({left, top, width, height}) => [left, top, width, height])("
                               'document.querySelector("svg.chart").getBoundingClientRect())')
        for kind in ("mousePressed", "mouseReleased"):
            self.browser.call("Input.dispatchMouseEvent", type=kind, x=box[0] + 58 + 0.5 * (box[2] - 68), y=box[1] + 40, button="left",
                              clickCount=1)
        middle = self.number()
        self.assertIn(middle, (7, 8))
        self.browser.run('document.getElementById("body").focus()')
        self.browser.press(" ", 32)
        self.assertEqual(self.browser.run('document.getElementById("play").textContent'), "Pause")
        until = time.monotonic() + 20
        while self.browser.run("state.playing") and time.monotonic() < until:
            time.sleep(0.1)
        self.assertEqual(self.number(), 15)
        self.assertEqual(self.browser.run('document.getElementById("play").textContent'), "Play")

    def test_screen_readers_are_given_names_and_values(self):
        self.show("rectangle", fragment="#frame=5")
        nodes = self.browser.call("Accessibility.getFullAXTree")["nodes"]
        names = {(n["role"]["value"], n["name"]["value"]) for n in nodes if not n["ignored"] and n.get("name")}
        wanted = {("button", "Play"), ("slider", "Frame"), ("combobox", "Colour"), ("button", "Zoom in"), ("button", "Zoom out"),
                  ("image", "The body at 2.000 ms, coloured by von Mises stress")}
        self.assertLessEqual(wanted, names)
        charts = [name for role, name in names if role == "image" and name.startswith(("energy over 6", "reaction over", "contacts", "step"))]
        self.assertEqual(len(charts), 4)
        self.assertEqual(self.browser.run('document.getElementById("frame").getAttribute("aria-valuetext")'), "frame 5, 2.000 ms")

    def test_light_dark_and_narrow(self):
        for dark in (False, True):
            self.show("breaks", size=(400, 800), dark=dark)
            self.assertLessEqual(self.browser.run("document.documentElement.scrollWidth"), 400)
            ground, ink = (self.browser.run(f"getComputedStyle(document.body).{what}") for what in ("backgroundColor", "color"))
            light = [np.mean([int(x) for x in re.findall(r"\d+", colour)[:3]]) for colour in (ground, ink)]
            self.assertGreater((light[1] - light[0]) * (1 if dark else -1), 150)

    def test_texts_of_the_deck_are_texts(self):
        text = self.show("breaks")
        self.assertNotIn(TITLE, text)
        self.assertEqual(self.browser.run("[document.title, document.querySelector('h1').textContent]"), [TITLE, TITLE])
        self.assertEqual(self.browser.run("document.querySelectorAll('b').length"), 0)
        decks = self.browser.run("[...document.querySelectorAll('pre')].map(p => p.textContent)")
        with h5py.File(self.folder / "breaks.vtkhdf") as file:
            kept = [file[f"provenance/{name}"].asstr()[()] for name in ("deck", "resolved", "versions")]
        self.assertEqual(decks, kept[:2])
        tables = self.browser.run("document.getElementById('tables').textContent")
        result = json.loads((self.folder / "breaks.json").read_text(encoding="utf-8"))
        self.assertIn(kept[2], tables)
        self.assertIn(f"broken triangles{result['broken_triangles']}", tables)
        self.assertGreater(result["broken_triangles"], 0)

    def test_a_failed_run_says_so_and_a_summary_of_another_run_is_left_out(self):
        path = self.folder / "fails.html"
        run_plot(self.folder / "fails.part.vtkhdf", "--html", path)
        self.browser.resize(1200, 900)
        self.browser.open(path)
        message = json.loads((self.folder / "fails.json").read_text(encoding="utf-8"))["message"]
        self.assertEqual(self.browser.run("[document.getElementById('fault').hidden, document.getElementById('fault').textContent]"),
                         [False, f"The run failed: {message}"])
        kept = (self.folder / "rectangle.json").read_text(encoding="utf-8")
        for other in ((self.folder / "breaks.json").read_text(encoding="utf-8"), "{ no JSON <"):
            (self.folder / "rectangle.json").write_text(other, encoding="utf-8")
            self.made.clear()
            self.show("rectangle")
            self.assertIn("no NAME.json of this run", self.browser.run("document.getElementById('tables').textContent"))
        (self.folder / "rectangle.json").write_text(kept, encoding="utf-8")
        self.made.clear()

    def test_a_point_without_springs_is_a_dot(self):
        self.show("point", fragment="#frame=2")
        ink = self.canvas()
        self.assertEqual(self.number(), 2)
        self.assertGreater(((ink.max(axis=2) - ink.min(axis=2)) > 40).sum(), 20)  # of a colour; all else is grey

    def test_without_history_and_notes_there_is_still_the_body(self):
        bare = self.folder / "bare.vtkhdf"
        bare.write_bytes((self.folder / "rectangle.vtkhdf").read_bytes())
        with h5py.File(bare, "r+") as file:
            del file["history"], file["provenance"]
        self.show("bare", "--frames", "5,2")
        seen = self.browser.run("[document.title, charts.length, run.frames.length, document.getElementById('decks').hidden]")
        self.assertEqual((seen, self.number()), (["bare.vtkhdf", 0, 2, True], 5))
        first = self.canvas()
        self.browser.run("show(1)")
        self.assertEqual(self.number(), 2)
        self.assertFalse((self.canvas() == first).all())

    def test_a_page_is_no_larger_than_asked_for(self):
        whole = self.make("rectangle").stat().st_size
        self.assertIn("16 frames, coloured by 12 quantities", self.said)
        for size in (0.25, 0.2, 0.12):
            text = self.show("rectangle", "--max-size", size)
            facts = content(text)
            self.assertLess(len(text.encode()), 1e6 * size)
            self.assertGreater(whole, 1e6 * size)
            self.assertIn(": the rest is beyond --max-size", self.said)
            self.assertIn(f"For a page of {size} MB", self.browser.run("document.getElementById('thinned').textContent"))
            self.assertEqual([facts["frames"][k]["number"] for k in (0, -1)], [0, 15])
            self.assertLess(len(facts["quantities"]), 12)
            self.assertLess(0.4 * size * 1e6, len(text.encode()))
            self.browser.run("show(run.frames.length - 1)")
            self.assertEqual(self.number(), 15)
        # of bins of rows none loses its peak
        kinetic = np.frombuffer(block(text, "line1"), "<f4")
        with h5py.File(self.folder / "rectangle.vtkhdf") as file:
            column = file["history/kinetic"][...].astype("<f4")
        self.assertLess(len(kinetic), len(column))
        self.assertEqual((kinetic.min(), kinetic.max()), (column.min(), column.max()))

    def test_faults_are_one_line_and_leave_nothing(self):
        run, out = self.folder / "rectangle.vtkhdf", self.folder / "none.html"
        (self.folder / "full.html.part").symlink_to("/dev/full")
        cases = (([run, "--html"], 2), ([run, "--html", "a.png"], 2), ([run, "--html", out, "-o", "a.png"], 2),
                 ([run, "--html", out, "--history"], 2), ([run, "--html", out, "--cracks"], 2), ([run, "--html", out, "--max-size", "0"], 2),
                 ([run, "-o", "a.png", "--max-size", "3"], 2), ([run, "--html", out, "--frames", "99"], 3),
                 ([run, "--html", out, "--color", "fragment"], 3),
                 ([self.folder / "no.vtkhdf", "--html", out], 5), ([run, "--html", self.folder / "no/where.html"], 5),
                 ([run, "--html", self.folder / "full.html"], 5))
        for words, code in cases:
            result = run_plot(*words, expect=code)
            self.assertEqual((result.stdout, result.stderr.count("\n")), ("", 1), (words, result.stderr))
            self.assertTrue(result.stderr.startswith("dem_plot: error: "))
        self.assertEqual([path.name for path in self.folder.iterdir() if path.name in ("none.html", "full.html") or path.suffix == ".part"], [])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
