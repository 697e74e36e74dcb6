"""Where the time of a check goes, on standard error: what `--timings` asks for."""

from __future__ import annotations

from collections.abc import Callable

from polarcheck.commands.output import say_lines
from polarcheck.errors import UsageError


def refuse(workers: int, cluster: str | None, watch: bool) -> None:
    """Raises UsageError for what would let others check, who are not measured, or would never end."""
    for name, is_asked in (("--jobs", workers > 1), ("--cluster", cluster), ("--watch", watch)):
        if is_asked:
            raise UsageError(f"--timings: not with {name}; one process is measured, once")


def told(run: Callable[[], int]) -> int:
    """The exit code of a check that is run here, when it has been told where its time went."""
    from polarcheck.checking.timing import timed
    from polarcheck.reports.pages.timings import timings_table

    with timed() as clock:
        status = run()
    clock.go_on("report")
    say_lines(timings_table(clock.spent, clock.files, clock.blocks).splitlines())
    return status
