# SPDX-License-Identifier: BSD-3-Clause
"""How far an advance has come."""
from __future__ import annotations

from typing import Any


class Progress:
    """A bar of tqdm, in a terminal or a notebook, if it is wanted."""
    OF_TIME = "{percentage:5.1f} % |{bar}| {n:.4g} of {total:.4g} s, {remaining} left"

    def __init__(self, wanted: bool, t: float, t_end: float, bar_format: str = OF_TIME) -> None:
        self._bar: Any = None
        if wanted:
            from tqdm.auto import tqdm  # only who wants a bar needs it
            self._bar = tqdm(total=t_end, initial=t, unit="s", bar_format=bar_format)

    def show(self, t: float) -> None:
        if self._bar is not None:
            self._bar.update(t - self._bar.n)

    def __enter__(self) -> Progress:
        return self

    def __exit__(self, *_: object) -> None:
        if self._bar is not None:
            self._bar.close()
