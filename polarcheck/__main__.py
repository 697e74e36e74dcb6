"""`python -m polarcheck` and the console script: handles signals and lack of memory before the large imports."""

from __future__ import annotations

import atexit
import os
import sys
from collections.abc import Iterable
from typing import Any, NoReturn

try:
    from polarcheck.foundation import ending
except KeyboardInterrupt:
    os.write(2, b"polarcheck: interrupted\n")
    os._exit(130)


def run() -> None:
    """Run the command line; never returns."""
    ending.end_on_signals()
    statuses: list[int] = []
    if not atexit._ncallbacks():  # what is registered first is called last
        atexit.register(ending.leave, statuses)
    try:
        from polarcheck.files.cache import repeats

        found = repeats.find(sys.argv[1:])
        if found is not None:
            _repeat(*found)
        from polarcheck import commands

        commands.run()
    except KeyboardInterrupt as stop:  # raised outside the code that handles it, or a second time
        ending.end_by(stop)
    except SystemExit as stop:
        if isinstance(stop.code, int):
            statuses.append(stop.code)
        raise
    except Exception as error:
        if not ending.is_of_memory(error):
            raise
        ending.end(2, "there is not enough memory")


def _repeat(status: int, pieces: Iterable[tuple[bool, str | bytes]]) -> NoReturn:
    """Print what an earlier run has printed, and end with its exit code. pieces: with True for standard error."""
    try:
        for to_error, text in pieces:
            stream: Any = sys.stderr if to_error else sys.stdout
            stream.reconfigure(errors="backslashreplace")
            (stream.buffer if isinstance(text, bytes) else stream).write(text)
            stream.flush()
    except OSError as error:
        from polarcheck.commands import exit_codes, output

        output.abandon_output()
        if not output.nobody_reads(error):
            output.say(f"standard output: {error.strerror or error}")
            status = exit_codes.COULD_NOT_RUN
    sys.exit(status)


if __name__ == "__main__":
    run()
