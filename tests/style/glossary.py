#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Do the words that docs/glossary.md replaces stay away, and is the glossary in order? `glossary.py SOURCE_ROOT`.
A word counts wherever it stands: in comments, in strings, in names between underscores."""
import pathlib
import re
import sys

ROOT = pathlib.Path(sys.argv[1])

# Word, and what to say instead.
INSTEAD = {
    "asleep": "inactive", "audience": "observers", "awake": "active", "ball": "neighbourhood", "balls": "neighbourhoods",
    "books": "ledger or quadratures", "foreign": "untrusted", "heed": "check_callback", "patch": "local correction",
    "patches": "local corrections", "poke": "vertex gap", "reel": "trajectory rows", "refuge": "rollback", "sheaf": "shape batch", "skin": "penetration tolerance", "skins": "penetration tolerances",
    "site": "candidate", "sites": "candidates", "strike": "impact", "strikes": "hits", "struck": "hit", "told": "reported", "trail": "changed motion"}
# File, word: where it may stand, and why.
ALLOWED = {
    ("drivers/namelist/schema.c", "skin"),  # the key that decks had before
    ("tests/deck/test_refused.py", "skin"), ("tests/unit/drivers/namelist/test_schema.c", "skin"),  # and its message
    ("tests/bench/lammps.py", "skin"),  # LAMMPS's word for how far its lists of neighbours reach
    ("include/dem/status.h", "patch"), ("include/dem/trajectory.h", "patch"),  # of a version
    ("tests/verification/test_patch.c", "patch"), ("tests/verification/meson.build", "patch"),  # the patch test of the
    ("tests/unit/drivers/batch/test_report.c", "patch"),  # finite element method
    ("tests/deck/test_f90nml.py", "patch"),  # a function of f90nml
    ("tests/verification/test_bounce.c", "ball"), ("tests/unit/time/test_integrator.c", "ball"),  # that bounces
    ("tests/unit/drivers/plot/test_ticks.c", "books"),  # that are printed
    ("docs/changelog.md", "skin"), ("docs/migration.md", "skin"), ("docs/algorithms.md", "patch"), ("docs/verification.md", "patch"),  # the same
    ("docs/verification.md", "ball"),
}
faults = []


def words_of(line):
    """Parts of names between underscores and capitals count for themselves."""
    return re.findall(r"[a-z]+", re.sub(r"([a-z])([A-Z])", r"\1 \2", line).lower())


def check_file(path):
    name = str(path.relative_to(ROOT))
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        for word in set(words_of(line)) & INSTEAD.keys():
            if (name, word) not in ALLOWED:
                faults.append(f"{name}:{number}: '{word}': say {INSTEAD[word]}")


def check_glossary():
    """An entry for each term, `- **term**: meaning; where`, in alphabetical order within each list."""
    last = ""
    text = (ROOT / "docs/glossary.md").read_text(encoding="utf-8")
    joined = re.sub(r"\n  (?=\S)", "\0", text)  # an entry goes on in indented lines
    following = 1
    for line in joined.split("\n"):
        number, following = following, following + 1 + line.count("\0")
        if line.startswith("#"):
            last = ""
        if not line.startswith("- "):
            continue
        found = re.match(r"- \*\*([^*]+)\*\*: \S", line)
        if found is None:
            faults.append(f"docs/glossary.md:{number}: is no term with its meaning")
            continue
        term = found.group(1).lower()
        if term <= last:
            faults.append(f"docs/glossary.md:{number}: '{term}' does not follow '{last}'")
        last = term
        for place in re.findall(r"`((?:src|drivers|include|docs)/[\w/.]+)`", line):
            if not (ROOT / place).exists():
                faults.append(f"docs/glossary.md:{number}: {place} is not there")


sources = sorted(p for d in ("src", "drivers", "include", "tests") for p in (ROOT / d).rglob("*")
                 if p.suffix in (".c", ".h", ".py", ".f90", ".sh") or p.name == "meson.build")
sources.remove(ROOT / "tests/style/glossary.py")
sources += [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]
for source in sources:
    check_file(source)
check_glossary()
print("\n".join(faults) if faults else f"{len(sources)} files speak the glossary's language")
sys.exit(1 if faults else 0)
