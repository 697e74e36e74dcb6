"""`polarcheck compensate`: paths of the tool center as contours with G41 or G42, and the other way round."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import click

from polarcheck.commands.options import option
from polarcheck.commands.rewriting import Command, rewriting
from polarcheck.foundation.errors import UsageError

if TYPE_CHECKING:
    from polarcheck.checking.settings import Settings
    from polarcheck.rewrite.writing.rewritten_program import Work

#: Those of polarcheck.rewrite.compensate.contours, which is imported late.
_SIDES = ("left", "right", "part-inside", "part-outside")


@click.command(short_help="Write contours with G41 or G42 for paths of the tool center, or the reverse.")
@rewriting(
    option("--center", is_flag=True, help="Write contours with G41 or G42 as paths of the tool center."),
    option(
        "--side", type=click.Choice(_SIDES),
        help="Side of the path on which the cutter is, or where the part is, if the program does not say so.",
    ),
)  # fmt: skip
def compensate(center: bool, side: str | None) -> Command:
    """
    Write the programs of PATH, whose polar sections program the path of the tool center, with G41 or G42 and the
    contour of the part. R of the cutter is that of the job: `--tool 8:radius=4`.

    With --center sections with G41 or G42 become paths of the tool center, for a control without compensation in the
    mode. The new program is read back: the part is the same. Where it would not be, or the program does not say on
    which side of a path the part is, nothing is written, and standard error names the lines and the reasons.
    """
    if center and side:
        raise UsageError("--side is for contours beside a path: with --center the program says its sides")
    return Command(
        "compensate", "written as paths of the tool center" if center else "compensated", _work(center, side or "")
    )


def _work(center: bool, side: str) -> Callable[[Settings], Work]:
    def work(settings: Settings) -> Work:
        from polarcheck.rewrite.compensate.centering import centered
        from polarcheck.rewrite.compensate.compensating import Compensating, compensated

        return centered if center else lambda original: compensated(original, Compensating(side))

    return work
