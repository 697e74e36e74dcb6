"""`polarcheck feeds`: the highest F of each block, what limits it, and the time that it costs."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

from polarcheck.commands import options
from polarcheck.commands.exit_codes import CLEAN, COULD_NOT_RUN
from polarcheck.commands.options import narrower, option
from polarcheck.commands.output import say, show, warn
from polarcheck.foundation.errors import UsageError

if TYPE_CHECKING:
    from polarcheck.rules.tables import Tables


@click.command(short_help="Show the highest F of each block that keeps C and X within their limits.")
@click.argument("path", metavar="FILE")
@options.executing("program", both=False)
@narrower(
    "--format", "form", type=click.Choice(["text", "json", "csv"]), default="text", show_default=True,
    help="csv is the curve of F and of the rate of C over time.",
)  # fmt: skip
@option("--diff", is_flag=True, help="Show the program with the F of the table, as a diff, and no table.")
@options.max_size
@options.debug
def feeds(path: str, form: str, diff: bool, no_config: bool, max_size: int, **arguments: Any) -> int:
    """
    Show for each cutting block of the polar sections of FILE the highest F, up to the programmed one, that keeps C and
    X within their limits; what limits it; what F the limits would allow; and the time that this costs.

    The limits are limits.c_feed, limits.c_acceleration, limits.x_feed, limits.x_acceleration and limits.polar_feed of
    the machine. With teeth of the tool, `--tool 8:radius=4,teeth=3`, and S in the program the chip load is told, too.
    --diff shows the program with these F; it writes nothing. Where the program is for another control, so that nothing
    of the table can be believed, standard error says so.
    """
    from polarcheck.api import feed_tables, loaded_program
    from polarcheck.files.settings.of_programs import Options
    from polarcheck.foundation.memory import keep_within_memory

    keep_within_memory()
    if diff and form != "text":
        raise UsageError(f"--diff shows a diff: leave out --format {form}")
    program = loaded_program.of_file(path, Options(use_config=not no_config, **arguments), max_size)
    with program.runs() as executed:
        doubts, missing = feed_tables.doubts(program, executed)
        for doubt in doubts:
            warn(f"{program.path}:{doubt.line}: {doubt.full_message} [{doubt.rule}]")
        for unknown in missing:
            warn(unknown)
        runs = [tables for _, tables in executed]
        if diff:
            return _show_diff(program.path, program.data, runs, program.settings.encoding)
        _show_table(program.path, program.settings.machine_id, runs, form)
    return CLEAN


def _show_table(title: str, machine: str, runs: list[Tables], form: str) -> None:
    import msgspec

    from polarcheck.rewrite.feeds import feed_page as pages
    from polarcheck.rewrite.feeds.table import FeedReport, feed_table

    if form == "csv":
        for line in pages.as_csv(runs):
            if not show(line.encode()):
                break
        return
    report = FeedReport(schema=1, path=title, machine=machine, tables=[feed_table(tables) for tables in runs])
    encoded = msgspec.json.format(msgspec.json.encode(report), indent=2) + b"\n"
    show(encoded if form == "json" else pages.text(report))


def _show_diff(title: str, data: bytes, runs: list[Tables], encoding: str | None) -> int:
    from polarcheck.rewrite.feeds.feed_edits import with_feeds

    edited = with_feeds(title, data, runs, encoding)
    if edited is None:
        say(f"{title}: its encoding does not give all characters back as they are")
        return COULD_NOT_RUN
    show("".join(f"{line}\n" for line in edited.difference))
    for line in edited.lowest:
        warn(f"{title}:{line}: its runs need different F, and it has the lowest of them")
    for line in edited.left:
        warn(f"{title}:{line}: F cannot be written there: an expression, or a block of another language or file")
    return CLEAN
