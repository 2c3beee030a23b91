# SPDX-License-Identifier: BSD-3-Clause
"""How far an advance has come."""


class Progress:
    """A bar of tqdm, in a terminal or a notebook, if it is wanted."""
    OF_TIME = "{percentage:5.1f} % |{bar}| {n:.4g} of {total:.4g} s, {remaining} left"

    def __init__(self, wanted, t, t_end, bar_format=OF_TIME):
        self._bar = None
        if wanted:
            from tqdm.auto import tqdm  # only who wants a bar needs it
            self._bar = tqdm(total=t_end, initial=t, unit="s", bar_format=bar_format)

    def show(self, t):
        if self._bar is not None:
            self._bar.update(t - self._bar.n)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self._bar is not None:
            self._bar.close()
