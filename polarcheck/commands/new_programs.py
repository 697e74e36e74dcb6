"""Where new programs go: a file, a folder, over the original, or standard output; nothing is overwritten by mistake."""

from __future__ import annotations

import os
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import click

from polarcheck.commands.options import Decorator, color, narrower, option
from polarcheck.commands.output import is_terminal, show, warn
from polarcheck.foundation.errors import OutputError, UsageError, why

if TYPE_CHECKING:
    from polarcheck.files.batch.tasks import Task

_FOLDER_ENDS = ("/", os.sep)


class Wanted(NamedTuple):
    """
    The options that say where new programs go.

    out: their file, or a folder; None for standard output.
    force: replace existing files.
    in_place: replace the originals.
    backup: keep the originals as FILE.orig.
    diff: show what would change, and write nothing.
    form: text or json.
    color: auto, always or never.
    quiet: say only what somebody has to do.
    """

    out: str | None
    force: bool
    in_place: bool
    backup: bool
    diff: bool
    form: str
    color: str
    quiet: bool


#: The options of Wanted. The environment sets nothing that decides what is overwritten.
OPTIONS: Sequence[Decorator] = (
    click.option("-o", "--output", "out", metavar="FILE", help="The new program, or its folder; else standard output."),
    click.option("--force", is_flag=True, help="With -o, replace files that are there already."),
    click.option("--in-place", is_flag=True, help="Write the new program over the original; needs --backup."),
    option("--backup", is_flag=True, help="With --in-place, keep the original as FILE.orig."),
    option("--diff", is_flag=True, help="Show what would change, and write nothing."),
    narrower(
        "--format", "form", type=click.Choice(["text", "json"]), default="text", show_default=True,
        help="json: on standard output what comes of it, in place of the program, which -o writes.",
    ),
    color,
    option("-q", "--quiet", is_flag=True, help="Say only what is to be decided, or why it is refused."),
)  # fmt: skip


def refuse(request: Wanted, paths: Sequence[str]) -> None:
    """Raise UsageError for options that exclude each other; warn of those without effect."""
    from polarcheck.program.reading import files

    if request.diff:
        options = {"-o": request.out, "--in-place": request.in_place, "--format json": request.form == "json"}
        for name, is_set in options.items():
            if is_set:
                raise UsageError(f"--diff shows what would change, and writes nothing: leave out {name}")
    if request.in_place and request.out is not None:
        raise UsageError("--in-place writes over the program: leave out -o")
    if request.in_place and any(map(files.is_standard_input, paths)):
        raise UsageError("--in-place: expected a file, found standard input")
    if request.in_place and not request.backup:
        raise UsageError("--in-place writes over the program: give --backup, too, which keeps it as FILE.orig")
    if request.out == "":
        raise UsageError("-o: expected the name of a file or folder")
    if request.force and request.out is None:
        warn("--force does nothing without -o")


def outputs(request: Wanted, tasks: Sequence[Task], paths: Sequence[str]) -> Mapping[str, Path]:
    """
    Return the file of each new program, by `task.place`; empty without -o.

    A program keeps its path below its folder, in the folder that -o names.

    paths: the arguments that the tasks come from.

    Raises OutputError or UsageError, before anything is computed, if a file exists or is read by the run, or if two
    programs would go to one file.
    """
    from polarcheck.commands.overwriting import folders_of, refuse_input
    from polarcheck.program.reading import files

    several = len(tasks) > 1 or len(paths) > 1 or any(map(os.path.isdir, paths))
    if request.out is None:
        if several and not (request.in_place or request.diff or request.form == "json"):
            raise UsageError("several programs: expected -o FOLDER, --in-place or --diff")
        return {}
    out = files.display_path(request.out)
    is_folder = request.out.endswith(_FOLDER_ENDS) or os.path.isdir(request.out)  # noqa: PTH112  Path.is_dir raises for some names
    if several and not is_folder and os.path.exists(request.out):  # noqa: PTH110
        raise UsageError(f"-o {out}: expected a folder for several programs, found a file")
    folders = folders_of(tasks)
    by_task: dict[str, Path] = {}
    for task in tasks:
        output = Path(request.out)
        if is_folder or several:
            if files.is_standard_input(task.place):
                raise UsageError(f"-o {out}: a folder; name the file, or give --stdin-filename")
            output /= _name_in_folder(task.place, paths)
        title = f"-o {files.display_path(output)}"
        if output in by_task.values():
            raise UsageError(f"{title}: two programs would be written to this file")
        refuse_input(output, title, folders)
        if not request.force:
            _refuse_existing(output)
        by_task[task.place] = output
    return by_task


def _name_in_folder(path: str, paths: Sequence[str]) -> str:
    """Return the path of a program in the folder that was walked, or its name if it was named itself."""
    folders = [folder for folder in paths if os.path.isdir(folder) and Path(path).is_relative_to(folder)]  # noqa: PTH112
    return os.path.relpath(path, max(folders, key=len)) if folders else Path(path).name


def _refuse_existing(output: Path) -> None:
    from polarcheck.program.reading import files

    if output.is_file():
        raise OutputError(f"-o {files.display_path(output)}: it is there already; --force replaces it")


def write(request: Wanted, task: Task, old: bytes, new: bytes, output: Path | None) -> str | None:
    """
    Write a new program into its file; return the file. None if it goes to standard output, or nothing is written.

    Raises OutputError if it cannot be written; then the file is as it was.
    """
    from polarcheck.program.reading import files, replacing

    if request.in_place:
        if new == old:
            return None
        replacing.rewrite(task.path, old, new, keep=True)
        return task.title
    if output is None or request.diff:
        return None

    def refuse_new(written: Path) -> None:
        """Raise OutputError if the file has appeared meanwhile."""
        if not request.force:
            _refuse_existing(output)

    try:
        output.parent.mkdir(parents=True, exist_ok=True)
    except (OSError, ValueError) as error:
        raise OutputError(f"{files.display_path(output.parent)}: {why(error)}") from None
    files.write(output, new, refuse_new)
    return files.display_path(output)


def print_program(data: bytes, path: str, encoding: str | None) -> None:
    """Write a program to standard output: its bytes; on a terminal its text without control characters."""
    from polarcheck.program.reading.excerpt import visible
    from polarcheck.program.reading.source import read_source

    if not is_terminal(sys.stdout):
        show(data)
        return
    source = read_source(data, path, encoding)
    lines = (source.line_text(line).strip("\r") for line in range(1, len(source.line_starts) + 1))
    show("".join(f"{visible(line)}\n" for line in lines))
