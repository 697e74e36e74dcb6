"""`polarcheck unroll`: polar sections as plain moves of X and C, for a lathe without the mode."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from polarcheck.commands.options import option
from polarcheck.commands.rewriting import Command, length, rewriting

if TYPE_CHECKING:
    from polarcheck.checking.settings import Settings
    from polarcheck.rewrite.writing.rewritten_program import Work

#: The choices that polarcheck.rewrite.unroll.unrolled_feeds knows; it is imported late.
_FEEDS = ("inverse-time", "per-minute", "per-minute-c", "per-minute-diameter", "stepwise")


@click.command(short_help="Write polar sections as plain moves of X and C, without the mode.")
@rewriting(
    length(
        "--chord-error", 0.005,
        "How far the tool center may leave its path between two points, in the units of the program.",
    ),
    option(
        "--feed", type=click.Choice(_FEEDS),
        help="What F is where X and C move together; what the machine has if it is left out.",
    ),
)  # fmt: skip
def unroll(chord_error: float | None, feed: str | None) -> Command:
    """
    Write the polar sections of the programs of PATH as plain moves of X and C along the path of the tool center, for a
    lathe without the mode. G41 and G42 are gone: R of the cutter is that of the job, `--tool 8:radius=4`.

    F keeps the speed of the tool, or less where C or X would pass its limit. It is what `feed.with_rotary` of the
    machine says: inverse time, per minute along X and C, or per minute of C alone; stepwise gives several blocks the
    same F. The new program is read back: standard error says how far its true path leaves that of the original, how
    fast C and X move, and how many blocks the control has to run in a second. Where a section cannot be written,
    nothing is, and standard error names the lines and the reasons.
    """

    def work(settings: Settings) -> Work:
        from polarcheck.rewrite.unroll.unrolling import DEFAULT_CHORD_ERROR, Unrolling, unrolled
        from polarcheck.rewrite.writing.rewritten_program import in_mm

        return lambda original: unrolled(
            original,
            Unrolling(DEFAULT_CHORD_ERROR if chord_error is None else in_mm(original, chord_error), feed or ""),
        )

    return Command("unroll", "unrolled", work)
