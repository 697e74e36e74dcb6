"""A progress bar on a terminal."""

from __future__ import annotations

import contextlib
import sys
import time
from collections.abc import Generator, Iterable
from typing import TypeVar

from polarcheck.commands.output import is_terminal

#: The bar appears after this time [s].
_PATIENCE = 1.0
#: The least time between two updates [s].
_STEP = 0.1
#: The length of the bar [characters].
_LENGTH = 24

Element = TypeVar("Element")


class Bar:
    """One line on stderr with the number of finished files, their rate, and the time left."""

    def __init__(self, total: int, is_shown: bool) -> None:
        self._total = total
        self._is_shown = is_shown and is_terminal(sys.stderr)
        self._length = 0

    def watched(self, elements: Iterable[Element]) -> Generator[Element, None, None]:
        """Yield the elements; if stderr is a terminal, the bar appears after the first second."""
        if not self._is_shown:
            yield from elements
            return
        begun = time.monotonic()
        drawn = begun + _PATIENCE - _STEP
        try:
            for done, element in enumerate(elements, 1):
                yield element
                now = time.monotonic()
                if now - drawn >= _STEP:
                    drawn = now
                    self._draw(line(done, self._total, now - begun))
        finally:
            self.hide()

    def hide(self) -> None:
        """Remove the bar before something else is written; the next update shows it again."""
        if self._length:
            self._write(f"\r{' ' * self._length}\r")
            self._length = 0

    def _draw(self, text: str) -> None:
        import shutil

        # A line that reaches the edge of the terminal would wrap.
        text = text[: shutil.get_terminal_size().columns - 1]
        self._write(f"\r{text}{' ' * (self._length - len(text))}")
        self._length = len(text)

    @staticmethod
    def _write(text: str) -> None:
        with contextlib.suppress(OSError, ValueError):
            sys.stderr.write(text)
            sys.stderr.flush()


def line(done: int, total: int, seconds: float) -> str:
    """Return a line such as `[####----] 120 of 400 files, 85 files/s, 0:03 left`."""
    rate = done / max(seconds, 1e-3)
    filled = _LENGTH * done // total
    fast = f"{rate:.0f}" if rate >= 10 else f"{rate:.1f}"
    return (
        f"[{'#' * filled}{'-' * (_LENGTH - filled)}] {done} of {total} files, {fast} files/s, "
        f"{_clock((total - done) / rate)} left"
    )


def _clock(seconds: float) -> str:
    minutes, rest = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours}:{minutes:02}:{rest:02}" if hours else f"{minutes}:{rest:02}"
