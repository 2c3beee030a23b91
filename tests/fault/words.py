# SPDX-License-Identifier: BSD-3-Clause
"""Whether what a program prints is said in our words, and not in those of the libraries that it stands on."""
import re

RAW = re.compile(r"HDF5-DIAG|#0\d\d:|HDF5: infinite|\[ERROR\]|\[WARNING\]|SUNDIALS|ARKODE|ARKode|ARK_[A-Z]|ERKStep|ARKStep|H5[A-Z][a-z_]|"
                 r"Assertion|libgomp|\0")


def faults(stderr):
    """Of what a run of one deck has to say of its end."""
    return [f"not our words: {line}" for line in stderr.splitlines() if RAW.search(line) or ": error: " not in line]
