"""`python -m polarcheck` and the console script: handles signals and lack of memory before the large imports."""

from __future__ import annotations

import os

try:
    from polarcheck.foundation import ending
except KeyboardInterrupt:
    os.write(2, b"polarcheck: interrupted\n")
    os._exit(130)


def run() -> None:
    """Run the command line; never returns."""
    ending.end_on_signals()
    try:
        from polarcheck import commands

        commands.run()
    except KeyboardInterrupt as stop:  # raised outside the code that handles it, or a second time
        ending.end_by(stop)
    except Exception as error:
        if not ending.is_of_memory(error):
            raise
        ending.end(2, "there is not enough memory")


if __name__ == "__main__":
    run()
