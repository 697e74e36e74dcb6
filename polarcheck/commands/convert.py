"""`polarcheck convert`: programs as another control reads them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from polarcheck.commands import options
from polarcheck.commands.options import many, option
from polarcheck.commands.rewriting import Command, rewriting
from polarcheck.foundation.errors import UsageError

if TYPE_CHECKING:
    from polarcheck.checking.settings import Settings
    from polarcheck.rewrite.writing.rewritten_program import Work


@click.command(short_help="Write programs for another control, or say why not.")
@rewriting(
    option(
        "--to", required=True, metavar="NAME|FILE",
        help="The lathe to write for: one of `polarcheck machines`, or a TOML file of your own.",
    ),
    many(
        "--accept", "accepted", metavar="KEY",
        help="A key of the profiles whose value in doubt is right: numbers may change with it. Repeatable.",
    ),
    machine=options.machine_from,
)  # fmt: skip
def convert(to: str, accepted: tuple[str, ...]) -> Command:
    """
    Write the programs at PATH as the lathe of --to reads them: its polar sections, and around them what both machine
    profiles know. --from names the lathe that they were written for; else it is that of the job file.

    A word that one of the profiles does not know is a comment in the new program that says what is to be decided; the
    exit code is then 1. The new program is read again as its control would: the path of the tool center, depth, F and
    the angles of C must be those of the original to the least increment. Otherwise nothing is written, the reasons are
    said with their lines, and the exit code is 2.

    Where a value that differs between the two profiles is in doubt, as whether X is a diameter, and a number would be
    another one because of it, nothing is written either until --accept names its key.
    """
    from polarcheck.files.settings.of_programs import default_machine
    from polarcheck.rewrite.convert.doubtful_values import KEYS

    for key in accepted:
        if key not in KEYS:
            raise UsageError(f"--accept {key}: expected one of {', '.join(KEYS)}")
    machine_id, machine = default_machine(to)

    def work(settings: Settings) -> Work:
        from polarcheck.files.settings.of_programs import on_machine
        from polarcheck.rewrite.convert.converting import converted

        target = on_machine(settings, to)
        return lambda original: converted(original, target, accepted)

    return Command("convert", f"converted for {machine.title}", work, machine_id)
