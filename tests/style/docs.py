#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Can README.md and docs/*.md be read in any editor, and do they name what is there? `docs.py SOURCE_ROOT`.
Lines are short, but for rows of tables, which Markdown cannot break, and URLs; links lead to files that are there;
where a page says `name`, src/room/file.c, that file has the name; and where a comment says docs/page.md, Section, that
page has a heading or a bold title that begins so."""
import pathlib
import re
import sys

ROOT = pathlib.Path(sys.argv[1])
MAX_LINE = 120
SECTIONED = ("method", "algorithms", "limits", "architecture")
faults = []


def check_lines(name, text):
    for number, line in enumerate(text.splitlines(), 1):
        length = len(re.sub(r"https?://\S+", "", line))
        if length > MAX_LINE and not line.startswith("|"):
            faults.append(f"{name}:{number}: line of {length} characters")


def check_links(path, name, text):
    for target in re.findall(r"\]\(([^)#]+)[^)]*\)", text) + re.findall(r"(?m)^\[[^\]]+\]: (\S+)", text):
        if "://" not in target and not (path.parent / target).exists():
            faults.append(f"{name}: links to {target}, which is not there")


def check_names(name, text):
    """One name, or several joined by commas and 'and', before the path of their file."""
    names = r"`\w+`(?:(?:,|\s+and)\s+`\w+`)*"
    for some, source in re.findall(rf"({names}),\s+((?:src|drivers|include)/[\w/]+\.[ch])\b", text):
        if not (ROOT / source).is_file():
            faults.append(f"{name}: {source} is not there")
            continue
        code = (ROOT / source).read_text(encoding="utf-8")
        for word in re.findall(r"\w+", some.replace(" and ", " ")):
            if word != "and" and not re.search(rf"\b{word}\b", code):
                faults.append(f"{name}: {source} has no {word}")


def titles_of(page):
    text = (ROOT / f"docs/{page}.md").read_text(encoding="utf-8")
    return re.findall(r"(?m)^#+ (.+)$", text) + re.findall(r"\*\*(.+?)\*\*", text)


def check_sections(path, titles):
    text = re.sub(r"\s*\n[\s*]*", " ", path.read_text(encoding="utf-8"))  # comments without their line ends
    for page, listed in re.findall(rf"docs/({'|'.join(SECTIONED)})\.md, ([^().:]+)", text):
        for section in listed.split("; "):
            known = any(title.startswith(section) for title in titles[page])
            parts = [section] if known else re.split(r", | and ", section)
            for part in parts:
                if "docs/" not in part and not any(title.startswith(part) for title in titles[page]):
                    faults.append(f"{path.relative_to(ROOT)}: docs/{page}.md has no section {part}")


pages = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]
for page in pages:
    content = page.read_text(encoding="utf-8")
    where = str(page.relative_to(ROOT))
    check_lines(where, content)
    check_links(page, where, content)
    check_names(where, content)

titled = {page: titles_of(page) for page in SECTIONED}
for top in ("src", "include", "drivers"):
    for source in sorted((ROOT / top).rglob("*.[ch]")):
        check_sections(source, titled)

print("\n".join(faults) if faults else f"{len(pages)} pages in order")
sys.exit(1 if faults else 0)
