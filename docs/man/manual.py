#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Man pages that say what the programs say: `manual.py VERSION PAGE.in PROGRAM`, `manual.py VERSION PAGE.in DECK.md`.

PAGE.in is the page in man(7), less its title. Its line @help@ is replaced by what `PROGRAM --help` prints, its line
@keys@ by the groups and keys of docs/deck.md."""
import pathlib
import re
import subprocess
import sys

# In escaped text: options, and what stands in `backticks`.
BOLD = re.compile(r"`([^`]*)`|(?<![\w\\-])((?:\\-){1,2}[a-z](?:\w|\\-)*)")


def plain(text):
    """Text that man(7) prints as it stands."""
    text = text.replace("\\", r"\e").replace("-", r"\-")
    return r"\&" + text if text.startswith((".", "'")) else text


def marked(text):
    return BOLD.sub(lambda m: rf"\fB{m[1] or m[2]}\fP", plain(text))


def item(term, text):
    """A term and what it means: its words are bold, those in capitals, which stand for others, slanted."""
    term = re.sub(r"[^\s\[\]|=.(),]+", lambda m: rf"\f{'I' if m[0].isupper() else 'B'}{plain(m[0])}\fP", term)
    return [".TP", term, marked(text)] if text else [".PP", term]


def sections(text):
    """Headings, which begin a line and end with ':', what stands behind them, and their lines, which are indented."""
    found = []
    for line in text.splitlines():
        heading = re.match(r"([a-z][a-z ]*):\s*(.*)", line)
        if heading:
            found.append((heading[1], heading[2], []))
        elif line.startswith(" ") and found:
            found[-1][2].append(line)
        elif line:
            sys.exit(f"error: a line of the help is of no section: {line}")
    return found


def pairs(lines):
    """Terms and texts: a term ends at two spaces; what is indented deeper than the last term goes on with its text."""
    found, indent = [], None
    for line in lines:
        depth = len(line) - len(line.lstrip())
        if found and depth > indent:
            found[-1][1] += " " + line.strip()
        else:
            indent = depth
            term, _, text = line.strip().partition("  ")
            found.append([term, text.strip()])
    return found


def help_of(program):
    text = subprocess.run([program, "--help"], capture_output=True, text=True, check=True).stdout
    page = []
    for heading, first, rows in sections(text):
        page.append(f".SH {'SYNOPSIS' if heading == 'usage' else heading.upper()}")
        if heading == "usage":
            listed = pairs([first] + [row.strip() for row in rows])
        else:
            listed = [] if first else pairs(rows)
        page += [row for term, meaning in listed for row in item(term, meaning)]
        if not listed:
            page.append(marked(" ".join([first] + [row.strip() for row in rows])))
    return page


def keys_of(deck):
    page = []
    for line in pathlib.Path(deck).read_text(encoding="utf-8").splitlines():
        cells = [cell.strip().replace(r"\|", "|") for cell in re.split(r"(?<!\\)\|", line)[1:-1]]
        if line.startswith("## "):
            page += [f'.SH "{plain(line[3:])}"']
        elif cells and cells[0].startswith("`"):
            key, kind, unit, default, values, meaning = cells
            facts = [kind if unit == "-" else f"{kind}, {unit}",
                     "one of " + values.replace("|", ", ") if "|" in values else values,
                     f"default {default}" if default.startswith("`") else default]
            page += [".TP", rf"{marked(key)} ({marked('; '.join(fact for fact in facts if fact))})", marked(meaning)]
        elif line and page and not cells:
            page += [marked(line)]
    return page


version, source, of = sys.argv[1:4]
page = pathlib.Path(source)
title, section = page.name.split(".")[:2]
print(r'.\" SPDX-License-Identifier: BSD-3-Clause')
print(f'.TH {title.upper()} {section} "" "dem {version}" "dem"')
for row in page.read_text(encoding="utf-8").splitlines():
    print("\n".join(help_of(of) if row == "@help@" else keys_of(of) if row == "@keys@" else [row]))
