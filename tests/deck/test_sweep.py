#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Many runs by one command, and what programs see of them: `test_sweep.py DEM_BATCH`.

Lists, --index, --set, results as JSON, locks, --overwrite. Standard library only: never skipped."""
import fcntl
import json
import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import time
import unittest

DEM_BATCH = None
SECONDS = 120  # more than any of these runs takes, under a sanitizer too

DECK = """
&run t_end = 2e-4, title = 'bounce' /
&material youngs_modulus = 1e7, density = 1050 /
&body shape = 'rectangle', size = 0.02, 0.02, spacing = 1e-2, velocity = 0, -10, clearance = 1e-4, outline = 'lattice' /
&obstacle points = -0.3, -0.02, 0, 0.02, restitution = 0.5 /
&obstacle points = 0, 0.02, 0.3, -0.02, restitution = 0.25 /
&output name = 'a', frame_interval = 1e-4 /
"""
STORM = DECK.replace("'a'", "'storm'") + "&contact max_impacts = 1, window = 0 /\n"
BROKEN = DECK.replace("t_end", "tend")
FILES = {"a.vtkhdf", "a.obstacle.vtkhdf", "a.body.vtkhdf", "a.json", "a.checkpoint"}


def named(name, text=DECK):
    return text.replace("'a'", f"'{name}'")


def lines_of(out):
    """The results among what is printed."""
    return [json.loads(line) for line in out.splitlines() if line.startswith("{")]


def lasting(result):
    """A result without its times on the wall."""
    return {key: value for key, value in result.items() if not key.startswith("wall_")}


class Case(unittest.TestCase):
    maxDiff = None

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.put("a.nml", DECK)

    def put(self, name, text):
        (self.folder / name).parent.mkdir(parents=True, exist_ok=True)
        (self.folder / name).write_text(text, encoding="utf-8")

    def files(self):
        return {path.name for path in self.folder.iterdir() if path.suffix not in (".nml", ".txt")}

    def call(self, code, *arguments, stderr=""):
        done = subprocess.run([DEM_BATCH, *arguments], cwd=self.folder, stdin=subprocess.DEVNULL, capture_output=True,
                              text=True, errors="surrogateescape", timeout=SECONDS, check=False)
        self.assertEqual(done.stderr, stderr)
        self.assertEqual(done.returncode, code)
        return done.stdout

    def results(self, code, *arguments, stderr=""):
        return lines_of(self.call(code, *arguments, stderr=stderr))

    def result(self, name="a"):
        return json.loads((self.folder / f"{name}.json").read_text(encoding="utf-8"))


class Sweeps(Case):
    def test_it_goes_on_after_a_failed_case(self):
        self.put("b.nml", BROKEN)
        self.put("c.nml", named("c"))
        fault = "b.nml:2:6: error: unknown key 'tend' in &run (did you mean 't_end'?)"
        results = self.results(3, "a.nml", "b.nml", "c.nml", stderr=fault + "\n")
        self.assertEqual([(r["deck"], r["name"], r["status"], r["exit_code"], r["message"]) for r in results],
                         [("a.nml", "a", "done", 0, ""), ("b.nml", None, "failed", 3, fault),
                          ("c.nml", "c", "done", 0, "")])
        self.assertEqual(results[0], self.result("a"))
        self.assertEqual(results[2], self.result("c"))

    def test_the_largest_code_is_the_worst(self):
        self.put("storm.nml", STORM)
        done = subprocess.run([DEM_BATCH, "missing.nml", "storm.nml", "a.nml"], cwd=self.folder, capture_output=True,
                              text=True, timeout=SECONDS, check=False)
        self.assertEqual(done.returncode, 4)
        self.assertEqual([r["exit_code"] for r in lines_of(done.stdout)], [3, 4, 0])
        self.assertEqual(len(done.stderr.splitlines()), 2)

    def test_a_list_names_decks_from_its_folder(self):
        self.put("deep/b.nml", named("b"))
        self.put("deep/with blank.nml", named("w"))
        self.put("deep/list.txt", f"# all\n\n  b.nml\t\r\nwith blank.nml\n../a.nml\n{self.folder}/a.nml")
        results = self.results(0, "@deep/list.txt", "--index", "4")
        results += self.results(0, "@deep/list.txt")
        self.assertEqual([r["deck"] for r in results], [f"{self.folder}/a.nml", "deep/b.nml", "deep/with blank.nml"] +
                         2 * [f"{self.folder}/a.nml"], "done already: as it was run")
        self.assertEqual([r["name"] for r in results], ["a", "b", "w", "a", "a"])

    def test_lists_that_are_none(self):
        self.call(3, "@no.txt", "a.nml", stderr="no.txt: error: No such file or directory\n")
        self.put("none.txt", "# nothing\n\n")
        self.call(3, "@none.txt", stderr="none.txt: error: the list names no deck\n")
        self.call(3, "@", stderr=": error: No such file or directory\n")
        self.assertEqual(self.files(), set())

    def test_an_index_picks_one_deck(self):
        self.put("list.txt", "b.nml\nc.nml\n")
        for name in "bc":
            self.put(f"{name}.nml", named(name))
        for index, name in enumerate("abc", 1):
            self.assertEqual([r["name"] for r in self.results(0, "--index", str(index), "a.nml", "@list.txt")], [name])
            self.assertEqual({path.stem for path in self.folder.glob("*.json")}, set("abc"[:index]))
        self.call(2, "--index", "4", "a.nml", "@list.txt", stderr="dem_batch: error: '--index' is 4, but there are 3 decks\n")
        self.call(2, "--index", "2", "a.nml", stderr="dem_batch: error: '--index' is 2, but there is 1 deck\n")

    def test_two_decks_of_one_name(self):
        self.put("b.nml", DECK.replace("1050", "1060"))
        done = subprocess.run([DEM_BATCH, "a.nml", "b.nml"], cwd=self.folder, capture_output=True, text=True,
                              timeout=SECONDS, check=False)
        self.assertEqual(done.returncode, 7)
        self.assertEqual([r["exit_code"] for r in lines_of(done.stdout)], [0, 7])
        self.assertEqual(self.result()["deck"], "a.nml")

    def test_checks_and_echoes_of_several(self):
        self.put("b.nml", named("b", BROKEN))
        fault = "b.nml:2:6: error: unknown key 'tend' in &run (did you mean 't_end'?)\n"
        self.assertEqual(self.call(3, "--check", "b.nml", "a.nml", stderr=fault).count("\ntime       "), 1)
        self.assertEqual(self.call(0, "--echo", "a.nml", "a.nml").count("&run\n"), 2)
        self.assertEqual(self.files(), set())


class Jobs(Case):
    """Twenty decks, two at once."""
    NAMES = [f"r{k:02}" for k in range(20)]

    def setUp(self):
        super().setUp()
        for k, name in enumerate(self.NAMES):
            self.put(f"{name}.nml", named(name, BROKEN if k == 7 else DECK.replace("1050", str(1050 + k))))
        self.decks = [f"{name}.nml" for name in self.NAMES]
        self.fault = "r07.nml:2:6: error: unknown key 'tend' in &run (did you mean 't_end'?)\n"

    def content(self, folder):
        """Of the files of all cases: the bytes, but for times on the wall."""
        found = {}
        for path in sorted((self.folder / folder).iterdir()):
            text = path.read_bytes()
            text = re.sub(rb"2\d\d\d-\d\d-\d\dT\d\d:\d\d:\d\dZ", b"then", text)
            found[path.name] = lasting(json.loads(text)) if path.suffix == ".json" else text
        for result in found.values():
            if isinstance(result, dict):
                result["output"] = pathlib.Path(result["output"]).name
        return found

    def printed(self, out, folder):
        """Without what depends on the wall's clock."""
        return re.sub(r'\d+ steps/s.*|wall time .* s|"wall_\w*":[^,}]*|then', "", out.replace(folder + "/", ""))

    def test_files_and_output_are_as_from_one_after_the_other(self):
        one = self.call(3, "--outdir", "one", *self.decks, stderr=self.fault)
        two = self.call(3, "--outdir", "two", "--jobs", "2", *self.decks, stderr=self.fault)
        self.assertEqual(self.printed(two, "two"), self.printed(one, "one"))
        self.assertEqual(len(self.content("two")), 5 * 19)
        self.assertEqual(self.content("two"), self.content("one"))

    def test_a_killed_case_holds_up_no_other(self):
        self.put("r04.nml", named("r04", DECK.replace("2e-4", "0.2")))  # takes its time
        self.call(3, "--outdir", "one", *self.decks, stderr=self.fault)
        arguments = ["--outdir", "two", "--jobs", "2", *self.decks]
        two = self.begin(*arguments)
        os.kill(self.holder_of("two/r04.lock"), signal.SIGKILL)
        out, err = two.communicate(timeout=SECONDS)
        self.assertEqual(two.returncode, 75)
        self.assertEqual(err, "r04.nml: error: its process ended by signal 9 (Killed); the same command goes on with "
                              "it\n" + self.fault)
        self.assertEqual([r["name"] for r in lines_of(out)],
                         [None if k == 7 else name for k, name in enumerate(self.NAMES) if k != 4])
        self.call(3, *arguments, stderr=self.fault)
        self.assertEqual(self.content("two"), self.content("one"))

    def test_the_end_is_asked_for_of_all(self):
        decks = [*self.decks[:4], "--set", "run.t_end=10"]
        all_cases = self.begin("--jobs", "2", *decks)
        for name in self.NAMES[:2]:
            self.holder_of(f"{name}.lock")
        all_cases.send_signal(signal.SIGTERM)
        out, err = all_cases.communicate(timeout=SECONDS)
        self.assertEqual((all_cases.returncode, err), (75, ""))
        self.assertEqual([r["message"] for r in lines_of(out)],
                         ["r00.nml: stopped by SIGTERM", "r01.nml: stopped by SIGTERM", "r02.nml: not begun",
                          "r03.nml: not begun"])

    def test_how_many(self):
        for number in ("0", "-1", "x", "10000"):
            with self.subTest(number):
                done = subprocess.run([DEM_BATCH, "--jobs", number, "a.nml"], cwd=self.folder, capture_output=True,
                                      text=True, timeout=SECONDS, check=False)
                self.assertEqual(done.returncode, 2)
                self.assertEqual(done.stderr.splitlines()[0],
                                 f"dem_batch: error: '--jobs' needs a number from 1 to 9999, got {number}")
        self.assertEqual([r["name"] for r in self.results(0, "--jobs", "9", "a.nml")], ["a"])

    def begin(self, *arguments):
        process = subprocess.Popen([DEM_BATCH, *arguments], cwd=self.folder, stdin=subprocess.DEVNULL,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.addCleanup(process.kill)
        return process

    def holder_of(self, lock):
        """The process that writes the output, once it does."""
        deadline = time.monotonic() + SECONDS
        while time.monotonic() < deadline:
            try:
                return int((self.folder / lock).read_text(encoding="utf-8").split()[1])
            except (OSError, IndexError):
                time.sleep(0.005)
        raise AssertionError(f"{lock} did not come")


class Settings(Case):
    def test_a_setting_is_as_if_the_deck_had_it(self):
        self.put("b.nml", DECK.replace("restitution = 0.25", "restitution = 0.75").replace("2e-4", "3e-4") +
                 "&solver rtol = 1e-7 /\n")
        settings = ["--set", "run.t_end=3e-4", "--set", "obstacle(2).restitution=0.1", "--set",
                    "SOLVER.Rtol=1e-7", "--set", "obstacle(2).restitution=0.75"]
        self.assertEqual(self.call(0, "--echo", *settings, "a.nml"), self.call(0, "--echo", "b.nml"))
        result, = self.results(0, *settings, "a.nml")
        self.assertEqual(result["set"], settings[1::2])
        self.assertEqual(result["t_end"], 3e-4)
        again, = self.results(0, "b.nml")
        self.assertEqual(again, result, "done already")

    def test_any_value_of_a_deck(self):
        echo = self.call(0, "--echo", "a.nml", "--set", "body.velocity=-1, 2*0", "--set", "body.velocity=1,-2",
                         "--set", 'run.title="it\'s ! & /"', "--set", "output.events=T",
                         "--set", "output.fields='velocity', 'strain'")
        for line in ("velocity = 1, -2\n", "title = 'it''s ! & /'\n", "events = .true.\n", "fields = 'velocity', 'strain'\n"):
            self.assertIn(line, echo)

    def test_strings_need_no_quotes(self):
        echo = self.call(0, "--echo", "a.nml", "--set", "output.name=slow", "--set", "output.fields=stress,strain",
                         "--set", "contact.method=exact", "--set", "run.title=1, it's a/b")
        for line in ("name = 'slow'\n", "fields = 'stress', 'strain'\n", "method = 'exact'\n", "title = '1, it''s a/b'\n"):
            self.assertIn(line, echo)

    def test_an_empty_value_takes_the_key_away(self):
        echo = self.call(0, "--echo", "a.nml", "--set", "run.title=", "--set", "obstacle(1).restitution=0")
        self.assertRegex(echo, r"title = '.*' ! default\n")
        self.call(3, "--echo", "a.nml", "--set", "run.t_end=", stderr="a.nml:2:1: error: 't_end' in &run must be given\n")

    def test_faults_name_the_setting(self):
        for setting, fault in (
                ("run.tend=1", "unknown key 'tend' in &run (did you mean 't_end'?)"),
                ("rnu.t_end=1", "unknown group &rnu (did you mean &run?)"),
                ("run.t_end=-1", "'t_end' in &run must be > 0, got -1"),
                ("run.t_end=abc", "'t_end' in &run expects a real, got 'abc'"),
                ("run.title='abc", "the string is not closed"),
                ("run.t_end=1, gravity=0,0", "one key and its value are expected"),
                ("run.t_end=1 / &body ", "one key and its value are expected"),
                ("body.velocity=1", "'velocity' in &body expects 2 values, got 1"),
                ("body(2).spacing=1", "there is only 1 &body"),
                ("obstacle(3).restitution=1", "there are only 2 &obstacle"),
                ("obstacle.restitution=1", "there are 2 groups &obstacle; write obstacle(1) to obstacle(2)"),
                ("void(2).radius=1", "there is no &void"),
                ("output.name='x/y'", "'name' in &output must have 1 to 100 characters, no '/', and not begin with '.' or '-'")):
            with self.subTest(setting):
                done = subprocess.run([DEM_BATCH, "a.nml", "--set", setting], cwd=self.folder, capture_output=True,
                                      text=True, timeout=SECONDS, check=False)
                self.assertEqual(done.returncode, 3, done.stderr)
                self.assertEqual(done.stderr.splitlines()[0], f"--set {setting}: error: {fault}")
                self.assertEqual(lines_of(done.stdout)[0]["message"], done.stderr.splitlines()[0])
        self.assertEqual(self.files(), set())


class Results(Case):
    def test_it_is_what_the_log_says(self):
        log = self.call(0, "--verbose", "a.nml", "--set", "run.t_end=5e-4")  # a contact lasts at 2e-4 s
        result = self.result()
        self.assertEqual(log.splitlines(True)[-1], (self.folder / "a.json").read_text(encoding="utf-8"))
        self.assertEqual((result["deck"], result["name"], result["output"]), ("a.nml", "a", "a.vtkhdf"))
        self.assertEqual((result["status"], result["exit_code"], result["message"]), ("done", 0, ""))
        self.assertIn(f"problem {result['problem']}\n", log)
        self.assertEqual((result["t_end"], result["t"]), (5e-4, 5e-4))
        for key, pattern in (("steps", r"\nrun        (\d+) steps"), ("evaluations", r"retried, (\d+) evaluations"),
                             ("events", r"\nevents     (\d+) times"), ("impacts", r" (\d+) impacts,"),
                             ("closings", r"\nlasting    (\d+) closings")):
            self.assertEqual(result[key], int(re.search(pattern, log)[1]), key)
        self.assertGreater(result["impacts"], 0)
        for value, form, pattern in ((result["first_contact"], "%.6e", r"\ncontact    first at (\S+) s"),
                                     (result["rebound_speed"], "%+.5g", r"centre of mass (\S+) m/s at the last"),
                                     (result["rising_speed"], "%+.5g", r"contact, (\S+) m/s at t_end"),
                                     (result["energy"]["kinetic"], "%.6g", r"\nenergy     kinetic (\S+),"),
                                     (result["closure"], "%+.2e", r"closure (\S+)"),
                                     (result["strain_min"]["strain"], "%+.4g", r"\nstrain     smallest (\S+) in"),
                                     (result["most_stressed"]["von_mises"], "%.4g", r": von Mises (\S+) Pa"),
                                     (result["obstacles"][1]["impulse"][0], "%.6g", r"\nobstacle   2: impulse \((\S+),")):
            self.assertEqual(form % value, re.search(pattern, log)[1])
        self.assertEqual(result["boundaries"], [])
        rebound, impacts = result["rebound"], result["impact_impulse"]
        self.assertEqual(rebound["velocity"][1], result["rebound_speed"], "gravity is along y")
        self.assertAlmostEqual(rebound["ratio"], -rebound["normal_after"] / rebound["normal_before"], delta=1e-12)
        self.assertEqual((rebound["bounces"], rebound["along_impulse"]), (1, True))
        self.assertIn("normal     of obstacle %d, (%.4g, %.4g) along the impulse of all obstacles: " %
                      (rebound["obstacle"] + 1, *rebound["normal"]), log)
        self.assertIn("force      largest at %.4e s, by lasting contacts; impacts gave (%.6g, %.6g) N s" %
                      (result["largest_reaction"]["t"], *impacts), log)
        self.assertIn("touching %.4e s; largest force (%.6g, %.6g) N" %
                      (result["touching_time"], *result["largest_reaction"]["force"]), log)

    def test_while_a_contact_lasts_there_is_no_rebound(self):
        log = self.call(0, "a.nml")
        result = self.result()
        self.assertEqual((result["contacts"], result["rebound"]), (1, None))
        self.assertEqual(result["warnings"][-1], "no rebound yet: 1 contact at t_end; give a later t_end")
        self.assertIn("\nrebound    not yet: 1 contact at t_end; give a later t_end\n", log)
        self.assertNotIn("no rebound yet", log[:log.index("{")])

    def test_but_for_the_time_it_is_the_same_each_time(self):
        first, = self.results(0, "a.nml")
        (self.folder / "a.json").unlink()
        second, = self.results(0, "a.nml")
        self.assertEqual(lasting(first), lasting(second))
        self.assertTrue(all(key in first for key in ("wall_start", "wall_seconds")))

    def test_a_run_without_its_result_is_not_done(self):
        """It was cut off behind its last frame."""
        self.call(0, "a.nml")
        result = lasting(self.result())
        for text in (None, "", "{}\n", '{"status":"failed"}\n'):
            (self.folder / "a.json").unlink()
            if text is not None:
                (self.folder / "a.json").write_text(text, encoding="utf-8")
            self.assertIn("\nresumed    ", self.call(0, "a.nml"))
            self.assertEqual(self.files(), FILES)
            self.assertEqual(lasting(self.result()), result)

    def test_one_that_has_failed(self):
        self.put("storm.nml", STORM)
        done = subprocess.run([DEM_BATCH, "storm.nml"], cwd=self.folder, capture_output=True, text=True,
                              timeout=SECONDS, check=False)
        result = self.result("storm")
        self.assertEqual((done.returncode, result["exit_code"], result["status"]), (4, 4, "failed"))
        self.assertEqual(result["message"] + "\n", done.stderr)
        self.assertTrue(0 < result["t"] < 2e-4 and result["impacts"] > 0)

    def test_what_has_not_happened_is_null(self):
        result, = self.results(0, "a.nml", "--set", "run.t_end=1e-6")
        never = ("first_contact", "last_contact", "touching_time", "rebound_speed", "rebound")
        self.assertEqual([result[key] for key in never], [None] * len(never))

    def test_any_text(self):
        name = "\N{GREEK SMALL LETTER ALPHA} \"\\\t.nml"
        self.put(name, DECK.replace("'bounce'", "'\"\\ \N{SNOWMAN}'"))
        result, = self.results(0, name)
        self.assertEqual((result["deck"], result["title"]), (name, '"\\ \N{SNOWMAN}'))
        (self.folder / "a.nml").rename(self.folder / os.fsdecode(b"\xff.nml"))
        result, = self.results(0, os.fsdecode(b"\xff.nml"))
        self.assertEqual(result["deck"], "\ufffd.nml")

    def test_one_that_cannot_be_written(self):
        (self.folder / "a.json.part").mkdir()
        fault = "a.json.part: error: cannot be written (Is a directory)"
        result, = self.results(5, "a.nml", stderr=fault + "\n")
        self.assertEqual((result["exit_code"], result["status"], result["message"]), (5, "failed", fault))
        self.assertNotIn("a.json", self.files())


class Locks(Case):
    def test_another_process_has_the_output(self):
        with open(self.folder / "a.lock", "w", encoding="utf-8") as file:
            fcntl.lockf(file, fcntl.LOCK_EX)
            print("process 17 on elsewhere", file=file, flush=True)
            fault = "a.lock: error: process 17 on elsewhere is writing this output"
            result, = self.results(7, "a.nml", stderr=fault + "\n")
            self.assertEqual(result["message"], fault)
            self.assertEqual(self.files(), {"a.lock"})
        self.call(0, "a.nml")
        self.assertEqual(self.files(), FILES)

    def test_two_runs_at_once(self):
        long = ["a.nml", "--set", "run.t_end=1", "--set", "output.frame_interval=1"]
        with subprocess.Popen([DEM_BATCH, *long], cwd=self.folder, stdout=subprocess.PIPE, text=True) as first:
            try:
                for line in first.stdout:
                    if line.startswith("output "):
                        break
                fault = f"a.lock: error: process {first.pid} on {os.uname().nodename} is writing this output\n"
                self.call(7, *long, stderr=fault)
            finally:
                first.kill()
        self.assertIn("a.lock", self.files(), "nobody could remove it")
        self.call(0, "a.nml", "--overwrite")
        self.assertNotIn("a.lock", self.files())

    def test_a_done_run_needs_no_lock(self):
        self.call(0, "a.nml")
        with open(self.folder / "a.lock", "w", encoding="utf-8") as file:
            fcntl.lockf(file, fcntl.LOCK_EX)
            self.assertIn("done already", self.call(0, "a.nml"))


class Overwrite(Case):
    def state(self):
        return {name: (self.folder / name).read_bytes() for name in self.files()}

    def test_what_is_in_the_way_is_renamed(self):
        self.call(0, "a.nml")
        self.put("a.checkpoint", "1")
        self.put("a.checkpoint.prev", "2")
        self.put("a.00001.vtkhdf", "3")
        self.put("a.part.vtkhdf", "4")
        self.put("a.b.vtkhdf", "another's")
        self.put("ab.vtkhdf", "another's")
        first = self.state()
        others = {name: first.pop(name) for name in ("a.b.vtkhdf", "ab.vtkhdf")}
        change = ["a.nml", "--set", "material.density=1060", "--overwrite"]
        self.assertTrue(self.call(0, *change).startswith("a.vtkhdf: set aside as a.old.vtkhdf\n"))
        old = {name.replace("a.", "a.old.", 1): text for name, text in first.items()}
        second = self.state()
        self.assertEqual(second.keys(), FILES | old.keys() | others.keys())
        self.assertEqual(second, second | old | others)
        self.assertIn("done already", self.call(0, *change))
        self.call(0, "a.nml", "--overwrite")
        older = {name.replace("a.", "a.old2.", 1): second[name] for name in FILES}
        self.assertEqual(self.state(), self.state() | old | older | others)

    def test_nothing_is_renamed_that_is_not_in_the_way(self):
        self.call(0, "a.nml", "--overwrite")
        before = self.state()
        self.assertIn("done already", self.call(0, "a.nml", "--overwrite"))
        self.assertEqual(self.state(), before)

    def test_in_another_folder(self):
        (self.folder / "out").mkdir()
        self.call(0, "a.nml", "--outdir", "out")
        self.call(0, "a.nml", "--outdir", "out", "--overwrite", "--set", "run.t_end=1e-4")
        self.assertEqual({path.name for path in (self.folder / "out").iterdir()},
                         FILES | {name.replace("a.", "a.old.", 1) for name in FILES})


if __name__ == "__main__":
    DEM_BATCH = os.path.abspath(sys.argv.pop(1))
    unittest.main()
