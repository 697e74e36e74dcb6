"""Ctrl-C, and the signal with which a system ends a process: both let what is finished be reported."""

from __future__ import annotations

import signal
from typing import Any

from polarcheck.commands.exit_codes import INTERRUPTED, TERMINATED


class Terminated(KeyboardInterrupt):
    """SIGTERM, as an exception that goes the way of Ctrl-C."""


def listen() -> None:
    """Make SIGTERM an exception, unless whoever started the process has it ignored; on Windows Ctrl-Break, too."""
    for name in ("SIGTERM", "SIGBREAK"):
        number = getattr(signal, name, None)
        if number is not None and signal.getsignal(number) is signal.SIG_DFL:
            signal.signal(number, _terminated)


def _terminated(number: int, frame: Any) -> None:
    raise Terminated


def told(stop: BaseException) -> tuple[int, str]:
    """The exit code of an interrupt, and the word for it."""
    # click has made another exception of it, where it came while a command ran.
    is_terminated = isinstance(stop, Terminated) or isinstance(stop.__cause__, Terminated)
    return (TERMINATED, "terminated") if is_terminated else (INTERRUPTED, "interrupted")
