"""Handles Ctrl-C and SIGTERM: both raise an exception, so that finished files are still reported."""

from __future__ import annotations

import signal
import sys
import threading
from typing import Any

from polarcheck.foundation.ending import INTERRUPTED, TERMINATED, Terminated, handle

#: After this time the destructor or callback has returned [s].
_UNTIL_AGAIN = 0.01


def listen() -> None:
    """Turn Ctrl-C, SIGTERM and Ctrl-Break of Windows into exceptions, unless the parent process ignores them."""
    handle({"SIGINT": signal.default_int_handler, "SIGTERM": _terminated, "SIGBREAK": _terminated})
    sys.unraisablehook = _deliver_again


def _terminated(number: int, frame: Any) -> None:
    raise Terminated


def _deliver_again(unraisable: Any) -> None:
    """
    Send the signal once more where Python has dropped its exception.

    It does so where the exception was raised in a destructor or in a callback, such as those of the import system.
    """
    if not isinstance(unraisable.exc_value, KeyboardInterrupt):
        sys.__unraisablehook__(unraisable)
        return
    number = signal.SIGTERM if isinstance(unraisable.exc_value, Terminated) else signal.SIGINT
    again = threading.Timer(_UNTIL_AGAIN, _send, (number,))
    again.daemon = True
    again.start()


def _send(number: int) -> None:
    """Send a signal to the main thread: one sent to another thread would not end a sleep or a wait of the main one."""
    main = threading.main_thread().ident
    if main is not None and hasattr(signal, "pthread_kill"):
        signal.pthread_kill(main, number)
    else:
        signal.raise_signal(number)


def interrupt_behind(error: BaseException) -> KeyboardInterrupt | None:
    """Return the interrupt that caused an exception: Python 3.11 raises RuntimeError for one in `__set_name__`."""
    cause = error.__cause__
    while cause is not None and not isinstance(cause, KeyboardInterrupt):
        cause = cause.__cause__
    return cause


def exit_status(stop: BaseException) -> tuple[int, str]:
    """Return the exit code of an interrupt, and the word for it."""
    # During a command, click replaces the exception, which becomes the cause.
    is_terminated = isinstance(stop, Terminated) or isinstance(stop.__cause__, Terminated)
    return (TERMINATED, "terminated") if is_terminated else (INTERRUPTED, "interrupted")
