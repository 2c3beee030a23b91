#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Does a library export what its headers declare, and has nothing come or gone unnoticed? `symbols.py LIBRARY LIST
HEADER...`; with --update behind them the list becomes what is exported. Names that begin with dem_private_ are for
libdem_mpi of the same version alone, and not listed."""
import pathlib
import re
import subprocess
import sys

update = "--update" in sys.argv
library, golden, *headers = (pathlib.Path(word) for word in sys.argv[1:] if word != "--update")
table = subprocess.run(["nm", "-D", "--defined-only", library], capture_output=True, text=True, check=True).stdout
exported = {line.split()[-1] for line in table.splitlines()}
declared = {name for header in headers for name in re.findall(r"(?m)^DEM_API\b[^;(]*?\b(\w+)\(", header.read_text(encoding="utf-8"))}
listed = {name for name in exported if not name.startswith("dem_private_")}
if update:
    golden.write_text("".join(f"{name}\n" for name in sorted(listed)), encoding="utf-8")
known = set(golden.read_text(encoding="utf-8").split())

faults = [f"{name}: {what}" for names, what in (
    (exported - declared, "exported, but in no header"),
    (declared - exported, "declared, but not exported"),
    ({name for name in exported if not name.startswith("dem_")}, "exported, and does not begin with dem_"),
    (listed - known, "new: docs/contributing.md tells how it joins the list"),
    (known - listed, "gone: programs that use it no longer run")) for name in sorted(names)]
print("\n".join(faults) if faults else f"{len(exported)} symbols, all known")
sys.exit(1 if faults else 0)
