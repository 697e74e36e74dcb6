"""`polarcheck roll`: plain moves of X and C become polar sections of lines and arcs."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from polarcheck.commands.options import option
from polarcheck.commands.rewriting import Command, length, rewriting
from polarcheck.program.machines.feed_keys import WITH_ROTARY

if TYPE_CHECKING:
    from polarcheck.checking.settings import Settings
    from polarcheck.rewrite.writing.original import Original
    from polarcheck.rewrite.writing.outcome import Outcome
    from polarcheck.rewrite.writing.rewritten_program import Work


@click.command(short_help="Write plain moves of X and C as polar sections of lines and arcs.")
@rewriting(
    length("--tolerance", 0.01, "How far the path may be from the ends of the blocks, in the units of the program."),
    option(
        "--feed", type=click.Choice(WITH_ROTARY), help="What F per minute is where X and C move together, if the "
        "machine does not say it.",
    ),
    option(
        "--keep-c", is_flag=True, help="Leave C where it stands when the mode is switched on; else it goes to 0 above "
        "the part, where it can.",
    ),
)  # fmt: skip
def roll(tolerance: float | None, feed: str | None, keep_c: bool) -> Command:
    """
    Write the plain moves of X and C of PATH, thousands of short blocks of a CAM without the polar mode, as polar
    sections of lines and arcs that pass the ends of the blocks within a tolerance.

    \b
    polarcheck roll O1234.NC -o O1234_POLAR.NC
    polarcheck roll --diff O1234.NC
    polarcheck roll --machine haas-lathe --feed per-minute O1234.NC

    F becomes that of the tool along its way, lower near the center where C would be above its limit. The result is read
    back before it is written. Stretches that cannot become a section stay as they are; the notes say why.
    """

    def work(settings: Settings) -> Work:
        from polarcheck.rewrite.roll.rolling import Rolling, rolled
        from polarcheck.rewrite.writing.rewritten_program import in_mm

        def rolls(original: Original) -> Outcome:
            allowed = 0.01 if tolerance is None else in_mm(original, tolerance)
            return rolled(original, Rolling(allowed, feed or "", keep_c))

        return rolls

    return Command("roll", "rolled", work)
