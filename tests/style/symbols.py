#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Does the library export what its headers declare, and has nothing come or gone unnoticed? `symbols.py LIBDEM HEADERS
LIST`; with --update behind them the list becomes what is exported."""
import pathlib
import re
import subprocess
import sys

library, headers, golden = (pathlib.Path(word) for word in sys.argv[1:4])
listed = subprocess.run(["nm", "-D", "--defined-only", library], capture_output=True, text=True, check=True).stdout
exported = {line.split()[-1] for line in listed.splitlines()}
declared = {name for header in headers.glob("*.h")
            for name in re.findall(r"(?m)^DEM_API\b[^;(]*?\b(\w+)\(", header.read_text(encoding="utf-8"))}
if sys.argv[4:] == ["--update"]:
    golden.write_text("".join(f"{name}\n" for name in sorted(exported)), encoding="utf-8")
known = set(golden.read_text(encoding="utf-8").split())

faults = [f"{name}: {what}" for names, what in (
    (exported - declared, "exported, but in no header"),
    (declared - exported, "declared, but not exported"),
    ({name for name in exported if not name.startswith("dem_")}, "exported, and does not begin with dem_"),
    (exported - known, "new: docs/contributing.md tells how it joins the list"),
    (known - exported, "gone: programs that use it no longer run")) for name in sorted(names)]
print("\n".join(faults) if faults else f"{len(exported)} symbols, all known")
sys.exit(1 if faults else 0)
