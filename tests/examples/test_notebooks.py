#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""A notebook of docs/examples runs from its first cell to its last, what it asserts holds, and it draws:
`test_notebooks.py NOTEBOOK INPUTS`. As it is kept it has no output."""
import importlib.util
import os
import pathlib
import sys
import tempfile
import time

NOTEBOOK, INPUTS = (pathlib.Path(word).resolve() for word in sys.argv[1:])
SECONDS = 120  # of a cell, on a machine with much else to do

for needed in ("nbclient", "ipykernel", "matplotlib"):
    if importlib.util.find_spec(needed) is None:
        print(f"skipped: the Python package {needed} is needed")
        sys.exit(77)

import nbformat  # noqa: E402
from nbclient import NotebookClient  # noqa: E402

book = nbformat.read(NOTEBOOK, as_version=4)
nbformat.validate(book)
for cell in book.cells:
    if cell.cell_type == "code" and (cell.outputs or cell.execution_count is not None):
        sys.exit("it is kept with output: clear it")

with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    (folder / "inputs").symlink_to(INPUTS)
    (folder / "examples").mkdir()
    for variable in ("HOME", "IPYTHONDIR", "JUPYTER_RUNTIME_DIR", "MPLCONFIGDIR", "TMPDIR"):
        os.environ[variable] = str(folder)
    start = time.monotonic()
    where = {"metadata": {"path": folder / "examples"}}
    NotebookClient(book, timeout=SECONDS, kernel_name="python3", resources=where).execute()
    print(f"{time.monotonic() - start:.1f} s")
outputs = [output for cell in book.cells if cell.cell_type == "code" for output in cell.outputs]
for output in outputs:
    print(output.get("text", ""), end="")
pictures = [output.data["image/png"] for output in outputs if "image/png" in output.get("data", {})]
if not pictures or min(map(len, pictures)) < 8000:
    sys.exit(f"{len(pictures)} pictures, of {[len(picture) for picture in pictures]} bytes")
