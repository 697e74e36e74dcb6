"""`polarcheck trace`: shows the executed table, or the moves of a path, as a table, CSV, JSON lines or JSON."""

from __future__ import annotations

import shutil
import sys
from collections.abc import Iterable, Iterator, Sequence
from itertools import chain
from typing import TYPE_CHECKING, Any

import click

from polarcheck.commands import options
from polarcheck.commands.exit_codes import CLEAN, FINDINGS
from polarcheck.commands.options import narrower, option
from polarcheck.commands.output import COLUMNS, draws_dots, in_color, is_terminal, show, warn
from polarcheck.foundation.errors import UsageError

if TYPE_CHECKING:
    from polarcheck.columns.path.tool_center import ToolCenter
    from polarcheck.columns.trace import Trace
    from polarcheck.rules.tables import Tables


@click.command(short_help="Show what a program does, block by block or move by move.")
@click.argument("path", metavar="FILE")
@options.executing("program", both=False)
@option("--path", "which", type=click.Choice(["tool", "programmed"]), help="The moves of a path, not the blocks.")
@narrower(
    "--format",
    "form",
    type=click.Choice(["table", "csv", "jsonl", "json"]),
    show_default="table on a terminal, else csv",
    help="A table for people, or one for programs; json is one document of moves.",
)
@option("--golden", is_flag=True, help="Leave out lines, as a file to compare with wants it: it survives renumbering.")
@option("--show", "shown_too", type=click.Choice(["path"]), help="A picture of each section in place of the table.")
@options.color
@options.max_size
@options.debug
def trace(
    path: str,
    which: str | None,
    form: str | None,
    golden: bool,
    shown_too: str | None,
    color: str,
    no_config: bool,
    max_size: int,
    **arguments: Any,
) -> int:
    """
    Show what FILE does, block by block or, with --path, move by move inside polar sections.

    Lengths are mm, X as a radius, angles deg, feeds mm/min. Of a file with several channels one follows the other, and
    each line names its own. A table leaves out what says nothing and, on a terminal, what there is no room for.

    --path tool is the path of the tool center. What is run with G41 or G42 while the radius is not known is shown as
    programmed: those moves have "programmed" under path, a line on standard error says what to give, and the exit code
    is 1. --format json always shows moves, without --path those of the tool center.
    """
    from polarcheck.api import loaded_program
    from polarcheck.files.settings.of_programs import Options
    from polarcheck.foundation.memory import keep_within_memory
    from polarcheck.reports.pages import executed, trace_report

    keep_within_memory()
    if shown_too and (golden or form not in (None, "table")):
        raise UsageError(f"--show {shown_too}: expected --format table, found {'--golden' if golden else form}")
    if golden and form == "table":
        raise UsageError("--golden: expected --format csv, jsonl or json, found table")
    on_terminal = is_terminal(sys.stdout)
    form = form or ("table" if on_terminal and not golden else "csv")
    which = which or ("tool" if form == "json" or shown_too else None)
    program = loaded_program.of_file(path, Options(use_config=not no_config, **arguments), max_size)
    # One run for each channel, since --block-skip has a single state in this command.
    with program.runs() as runs:
        paths = [(tables["trace"], tables["tool_center"]) for _, tables in runs]
        unknown = [executed.without_radius(*of_run) for of_run in paths if which == "tool" or shown_too]
        for line in filter(None, unknown):
            warn(line)
        status = FINDINGS if any(unknown) else CLEAN
        if shown_too:
            _show_paths([tables for _, tables in runs], in_color(color))
            return status
        if form == "table":
            _show_all(_table(paths, which, on_terminal))
            return status
        items: Iterator[Any] = chain.from_iterable(
            executed.moves(*of_run, which, has_z_alone=golden) if which else executed.rows(*of_run) for of_run in paths
        )
        if golden and which and form == "jsonl":
            from polarcheck.rewrite.certify.golden import lines, orders_of

            orders = chain.from_iterable(orders_of(trace_of_run) for trace_of_run, _ in paths)
            _show_all(line.encode() for line in lines(items, orders))
            return status
        items = trace_report.without_lines(items) if golden else items
        if form == "json":
            machine = program.settings.machine_id
            pieces = trace_report.as_json(items, program.path, machine, which or "tool", golden)
        else:
            pieces = (executed.as_jsonl if form == "jsonl" else executed.as_csv)(items)
        _show_all(piece.encode() for piece in pieces)
        return status


def _show_all(pieces: Iterable[str | bytes]) -> None:
    """Show text piece by piece, until nobody reads it any more."""
    for piece in pieces:
        if not show(piece):
            return


def _show_paths(channels: Sequence[Tables], is_colored: bool) -> None:
    """Show each section, as wide as the terminal."""
    from polarcheck.reports import painted
    from polarcheck.reports.pages.painting import plain
    from polarcheck.view.section_view import views_of

    columns = shutil.get_terminal_size().columns if is_terminal(sys.stdout) else COLUMNS
    dots, paint = draws_dots(), painted if is_colored else plain
    for view in (view for tables in channels for view in views_of(tables)):
        if not show("".join(f"{line}\n" for line in view.lines(columns, dots=dots, paint=paint)), is_colored or None):
            return


def _table(paths: Sequence[tuple[Trace, ToolCenter]], which: str | None, on_terminal: bool) -> Iterator[str]:
    """Yield a table for each channel: on a terminal as wide as it is, with a head on every page; else all columns."""
    from polarcheck.reports.pages.trace_columns import moves_table, rows_table

    size = shutil.get_terminal_size()
    room, height = (size.columns, size.lines) if on_terminal else (None, None)
    for trace, tool_center in paths:
        if which:
            yield from moves_table(trace, tool_center, which, room, height)
        else:
            yield from rows_table(trace, tool_center, room, height)
