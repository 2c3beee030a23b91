#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Do help, man page, completion and program know the same options? `test_manual.py COMPLETION PAGE... PROGRAM...`."""
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

COMPLETION, PAGES, PROGRAMS = None, [], []

OPTION = re.compile(r"(?<![\w-])--?[a-z][a-z-]*")
SECONDS = 60


def run(*command, **more):
    return subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=SECONDS, check=False,
                          **more)


def help_of(program):
    return run(program, "--help").stdout


def shown(page):
    """The page as a reader sees it, but for lines that are long enough for any paragraph."""
    return run("groff", "-man", "-Tascii", "-P-cbou", "-rLL=2000n", page).stdout


def complete(program, *words):
    """What bash offers for the last word."""
    before = words[-2] if len(words) > 1 else program
    script = 'source "$1"; shift; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _dem "$1" "${@: -1}" "${@: -2:1}"; ' \
             'printf "%s\\n" "${COMPREPLY[@]}"'
    done = run("bash", "-c", script, "bash", COMPLETION, program, *words)
    return done.stdout.split(), done.stderr


class Options(unittest.TestCase):
    def of_each(self):
        for program in PROGRAMS:
            page = next(page for page in PAGES if page.name == f"{program.name}.1")
            listed = re.findall(r"(?ms)^(?:usage|options):.*?(?=^[a-z]|\Z)", help_of(program))
            yield program, page, set(OPTION.findall("".join(listed)))

    def test_pages_have_the_options_of_the_help_and_no_others(self):
        for program, page, options in self.of_each():
            found = set(OPTION.findall(shown(page)))
            self.assertIn("--help", options)
            self.assertLessEqual(options, found)
            self.assertLessEqual(found, set(OPTION.findall(help_of(program))))

    def test_pages_say_what_follows_an_option(self):
        for program, page, _ in self.of_each():
            text = shown(page)
            for form in re.findall(r"(?m)^ +(-\S*(?: \S+)?)(?:  .*)?$", help_of(program)):
                self.assertIn(form, text)

    def test_completion_offers_the_options_of_the_help_and_no_others(self):
        for program, _, options in self.of_each():
            offered, faults = complete(program, "-")
            self.assertEqual((set(offered), faults), (options, ""))

    def test_programs_take_the_options_of_the_help_and_no_others(self):
        """Every option is taken for one, and every word in the program that looks like one is in the help. A compiler may
        keep a word as numbers to compare with; another will not."""
        for program, _, options in self.of_each():
            words = re.findall(rb"\0(--[a-z][a-z-]+)\0", program.read_bytes().replace(b"\0", b"\0\0"))
            self.assertLessEqual({word.decode() for word in words}, options)
            done = run(program, "--no-such-option")
            self.assertEqual((done.returncode, "'--no-such-option' is no option" in done.stderr), (2, True))
            with tempfile.TemporaryDirectory() as folder:
                for option in options:
                    self.assertNotIn("is no option", run(program, option, cwd=folder).stderr)

    def test_completion_offers_the_words_that_may_follow_an_option(self):
        for program, _, _ in self.of_each():
            listed = re.findall(r"(?m)^ +(--[a-z-]+) ([a-z]\w*(?:\|\w+)+)", help_of(program))
            listed += re.findall(r"(?m)^(color)s: (.*)$", help_of(program))
            for option, words in listed:
                offered = complete(program, f"--{option.strip('-')}", "")[0]
                self.assertEqual(offered, re.split(r"\||, ", words))


class Pages(unittest.TestCase):
    def test_groff_has_nothing_to_say(self):
        for page in PAGES:
            self.assertEqual(run("groff", "-ww", "-man", "-Tascii", "-z", page).stderr, "", page.name)

    def test_every_key_of_a_deck_is_in_its_page_and_completed(self):
        batch = next(program for program in PROGRAMS if program.name == "dem_batch")
        page = shown(next(page for page in PAGES if page.name == "dem_deck.5"))
        keys, group = {}, None
        for line in run(batch, "--keys").stdout.splitlines():
            cells = re.split(r" (?<!\\)\| ", line.strip("| "))
            if line.startswith("## &"):
                group = line[4:]
            elif line.startswith("| `"):
                keys[f"{group}.{cells[0].strip('`')}"] = (cells[-1], cells[4] if r"\|" in cells[4] else "")
        self.assertGreater(len(keys), 100)
        sentences = page.splitlines()
        for key, (meaning, choices) in keys.items():
            self.assertTrue(any(line.strip() == meaning.replace("`", "") for line in sentences), key)
            self.assertIn(f"{key.split('.')[1]} (", page)
        self.assertEqual(complete(batch, "--set", "")[0], [f"{key}=" for key in keys])
        for key in ("body.shape", "material.plane"):
            self.assertEqual(complete(batch, "--set", key, "=", "")[0], keys[key][1].split(r"\|"))
        self.assertEqual(complete(batch, "--set", "run.t_end", "=", "")[0], [])


class Files(unittest.TestCase):
    def test_completion_offers_decks_lists_and_folders(self):
        batch = next(program for program in PROGRAMS if program.name == "dem_batch")
        decks = pathlib.Path(__file__).resolve().parents[2] / "inputs"
        self.assertIn(str(decks / "disc.nml"), complete(batch, str(decks / "di"))[0])
        self.assertEqual(complete(batch, "--outdir", str(decks)[:-2])[0], [str(decks)])
        self.assertEqual(complete(batch, f"@{decks}/rect")[0], [f"@{decks}/rectangle.nml"])
        self.assertEqual(complete(batch, "--max-wall", "1")[0], [])


if __name__ == "__main__":
    COMPLETION, *others = (pathlib.Path(word).resolve() for word in sys.argv[1:])
    PAGES = [path for path in others if re.fullmatch(r"\.\d", path.suffix)]
    PROGRAMS = [path for path in others if path not in PAGES]
    sys.argv[1:] = []
    unittest.main()
