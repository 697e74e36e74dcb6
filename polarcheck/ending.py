"""How the process ends while no command runs: while modules are imported, and after the report is printed."""

from __future__ import annotations

import contextlib
import errno
import os
import signal
from typing import Any, NoReturn

#: As shells count: 128 and the number of the signal.
INTERRUPTED, TERMINATED = 130, 143
#: What dynamic linkers say where an extension module finds no memory.
_OF_LINKER = ("failed to map segment", "annot allocate memory", "cannot map")


def end_on_signals() -> None:
    """
    Have the process end at once, in one line, on Ctrl-C and on the signals with which a system ends it.

    A signal that whoever started the process has it ignore stays ignored.
    """
    for name in ("SIGINT", "SIGTERM", "SIGBREAK"):
        number = getattr(signal, name, None)
        if number is not None and signal.getsignal(number) not in (signal.SIG_IGN, None):
            signal.signal(number, _end_on)


def _end_on(number: int, frame: Any) -> NoReturn:
    if number == signal.SIGINT:
        end(INTERRUPTED, "interrupted")
    end(TERMINATED, "terminated")


class Terminated(KeyboardInterrupt):
    """SIGTERM, as an exception that goes the way of Ctrl-C."""


def end_by(stop: KeyboardInterrupt) -> NoReturn:
    """End with the exit code of an interrupt that nothing has handled."""
    _end_on(signal.SIGTERM if isinstance(stop, Terminated) else signal.SIGINT, None)


def end(status: int, message: str) -> NoReturn:
    """End without another import or allocation that could fail. Nothing may be left to write: no buffer is flushed."""
    with contextlib.suppress(OSError):
        os.write(2, f"polarcheck: {message}\n".encode())
    os._exit(status)


def is_of_memory(error: BaseException) -> bool:
    """Tells whether an exception says that there is not enough memory: extension modules have ways of their own."""
    if isinstance(error, ImportError):
        return any(words in str(error) for words in _OF_LINKER)
    return isinstance(error, MemoryError) or (isinstance(error, OSError) and error.errno == errno.ENOMEM)
