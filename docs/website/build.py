#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Builds the website of docs/ by MkDocs Material: `build.py SOURCE_ROOT OUT`. Warnings are errors, such as links to what
is not there. README.md is its first page, the headers are pages under api/, notebooks are read as text and code."""
import importlib.util
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

for needed in ("material", "mkdocs", "latex2mathml"):
    if importlib.util.find_spec(needed) is None:
        print(f"skipped: the Python package {needed} is needed")
        sys.exit(77)

from api import Pages  # noqa: E402
from latex2mathml.converter import convert  # noqa: E402

ROOT, OUT = (pathlib.Path(word).resolve() for word in sys.argv[1:])
FENCE = r"(?ms)^```.*?^```$|`[^`\n]+`"


def outside_code(change, text):
    """Changes what is not code."""
    ends = [0, *(place for found in re.finditer(FENCE, text) for place in found.span()), len(text)]
    return "".join(change(text[a:b]) if k % 2 == 0 else text[a:b] for k, (a, b) in enumerate(zip(ends, ends[1:])))


def equation(found):
    """MathML, which browsers show without a script. In a span, or Markdown would take it for a block."""
    return f"<span>{convert(found[2], display='block' if found[1] == '$$' else 'inline')}</span>"


def with_equations(text):
    """$...$, and $$...$$ in a line of its own."""
    return outside_code(lambda part: re.sub(r"(\$\$?)([^$\n]+)\1", equation, part), text)


def with_links(text, prefix):
    """Links that leave docs/: decks are in the website, headers have pages. `prefix` leads to its top."""
    text = re.sub(r"\]\((?:\.\./)+inputs/", f"]({prefix}inputs/", text)
    text = re.sub(r"\]\((?:\.\./)+include/dem/(\w+)\.h\)", rf"]({prefix}api/\1.md)", text)
    return re.sub(r"\.ipynb\)", ".md)", text)


def of_notebook(path):
    cells = json.loads(path.read_text(encoding="utf-8"))["cells"]
    sources = [(cell["cell_type"], "".join(cell["source"])) for cell in cells]
    return "\n\n".join(text if kind == "markdown" else f"```python\n{text}\n```" for kind, text in sources)


def gather(pages):
    shutil.copytree(ROOT / "docs", pages, ignore=shutil.ignore_patterns("website", "man", "meson.build", "__pycache__"))
    shutil.copytree(ROOT / "inputs", pages / "inputs")
    Pages(ROOT).write(pages / "api")
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    (pages / "index.md").write_text(re.sub(r"\]\(docs/", "](", readme), encoding="utf-8")
    for notebook in pages.rglob("*.ipynb"):
        notebook.with_suffix(".md").write_text(of_notebook(notebook), encoding="utf-8")
    for page in pages.rglob("*.md"):
        text = page.read_text(encoding="utf-8")
        prefix = "../" * (len(page.relative_to(pages).parts) - 1)
        page.write_text(with_equations(with_links(text, prefix)), encoding="utf-8")


with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    gather(folder / "pages")
    shutil.copy(ROOT / "docs/website/mkdocs.yml", folder)
    # With --quiet it would not count warnings either.
    done = subprocess.run([sys.executable, "-m", "mkdocs", "build", "--strict", "--site-dir", OUT], cwd=folder,
                          env={**os.environ, "NO_MKDOCS_2_WARNING": "1"}, check=False)
    sys.exit(done.returncode)
