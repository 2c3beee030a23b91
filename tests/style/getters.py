#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Does the test that no getter calls a function of the program know all of them? `getters.py SOURCE_ROOT`. A getter takes a
`const dem_simulation *` first; the test calls it by its name, or through drivers/common/ask.h."""
import pathlib
import re
import sys

ROOT = pathlib.Path(sys.argv[1])
sys.path.insert(0, str(ROOT / "src" / "fortran"))
from headers import read_headers  # noqa: E402

getters = {name for header in read_headers(ROOT / "include" / "dem") for name, function in header.functions.items()
           if function.arguments and function.arguments[0].type == "dem_simulation" and function.arguments[0].const}
test = (ROOT / "tests/unit/simulation/test_query.c").read_text(encoding="utf-8")
looks = re.search(r"(?ms)^static void look_at_all\(.*?^\}", test)[0]
ask = (ROOT / "drivers/common/ask.h").read_text(encoding="utf-8")
through = dict(re.findall(r"(?s)\b(ask_\w+)\([^)]*\)\n\{\n    ASK\(\w+, (\w+)\(", ask))
called = set(re.findall(r"\bdem_simulation_\w+", looks)) | {through[name] for name in re.findall(r"\bask_\w+", looks)}
missing = sorted(getters - called)
print("\n".join(f"tests/unit/simulation/test_query.c: look_at_all() does not call {name}" for name in missing)
      or f"{len(getters)} getters, all called")
sys.exit(1 if missing or len(getters) < 15 else 0)
