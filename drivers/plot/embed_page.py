#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Makes C of page.html, in two halves about the mark where the data of a run go: `embed_page.py PAGE.html OUT.c`."""
import pathlib
import sys

MARK = "<!-- data -->\n"


def array_of(name, text):
    numbers = ", ".join(str(byte) for byte in text.encode("utf-8"))
    return f"const char {name}[] = {{{numbers}, 0}};\n"


before, behind = pathlib.Path(sys.argv[1]).read_text(encoding="utf-8").split(MARK)
pathlib.Path(sys.argv[2]).write_text(
    '#include "page_template.h"\n\n' + array_of("page_template_before", before) + array_of("page_template_behind", behind),
    encoding="utf-8")
