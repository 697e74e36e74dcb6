"""`plot --png` and `--svg`: pictures for documents."""

from __future__ import annotations

import importlib.util
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

from polarcheck.commands import picturing
from polarcheck.commands.options import all_of, option
from polarcheck.commands.output import warn
from polarcheck.foundation.errors import UsageError
from polarcheck.program.reading.files import display_path, write

if TYPE_CHECKING:
    from polarcheck.files.batch.tasks import Task
    from polarcheck.foundation.finding import FileReport
    from polarcheck.reports import Background
    from polarcheck.view.picture_data import Drawn

_FORMATS = ("png", "svg")


_HELP = "The face of each section as {}, for a document; or a folder, for a file of each program."
#: The options of pictures for documents.
options = all_of(
    option("--png", metavar="FILE", help=_HELP.format("PNG")),
    option("--svg", metavar="FILE", help=_HELP.format("SVG")),
    option(
        "--section", "chosen", multiple=True, type=click.IntRange(1), metavar="N",
        help="With --png or --svg, only this section; the first is 1.",
    ),
)  # fmt: skip


class Stills:
    """
    Writes the pictures of each program as soon as it is checked.

    files: the files that are written.
    options: the option that names each.
    """

    def __init__(self, targets: Sequence[tuple[str, Path]], tasks: Sequence[Task], chosen: Sequence[int]) -> None:
        """
        targets: format and file, or folder, of each picture.
        chosen: the numbers of the sections, from 1; empty for all.

        Raises UsageError if pictures cannot be written like that.
        """
        if targets and importlib.util.find_spec("matplotlib") is None:
            raise UsageError("--png and --svg need matplotlib, of the extra [plot]: pip install matplotlib")
        if chosen and not targets:
            raise UsageError("--section: it chooses what --png and --svg draw; give one of them")
        if chosen and len(tasks) > 1:
            raise UsageError(f"--section: it is of one program, and these are {len(tasks)}")
        self._chosen = chosen
        self._names = dict(_names(targets, tasks))
        self._folders = [path for _, path in targets if picturing.is_folder(path)]
        self.files = [path for files in self._names.values() for _, path in files]
        self.options = {path: f"--{form}" for files in self._names.values() for form, path in files}

    def begin(self) -> None:
        """Create the folders."""
        for folder in self._folders:
            picturing.create_folder(folder)

    def write(self, report: FileReport, drawn: Drawn, background: Background) -> None:
        """Write the pictures of a program. Raises OutputError if one cannot be written."""
        if not self._names:
            return
        from polarcheck.view.page_data import picture
        from polarcheck.view.stills.still import MOST, still

        pictured = picture(report, background._replace(drawn={report.path: drawn}))
        count = len(drawn.sections)
        if self._chosen and max(self._chosen) > count:
            sections = "1 polar section" if count == 1 else f"{count} polar sections"
            raise UsageError(f"--section {max(self._chosen)}: {report.path} has {sections}")
        if len(self._chosen or range(count)) > MOST:
            warn(f"{report.path}: the picture has {MOST} of {count} sections; --section N chooses others")
        for form, path in self._names[report.path]:
            write(path, still(pictured, form, sorted(set(self._chosen))[:MOST]))


def targets(png: str | None, svg: str | None, output: str | None) -> tuple[list[tuple[str, Path]], str | None]:
    """
    Return format and path of each picture for a document, and the page that remains of --output.

    The ending of --output decides what it is. Raises UsageError if an ending is that of the other format.
    """
    named = [(form, value) for form, value in zip(_FORMATS, (png, svg), strict=True) if value is not None]
    if output is not None and (ending := Path(output).suffix.lower()[1:]) in _FORMATS and not Path(output).is_dir():
        named.append((ending, output))
        output = None
    for form, value in named:
        ending = Path(value).suffix.lower()[1:]
        if value == "-" or (ending in (*_FORMATS, "html") and ending != form):
            raise UsageError(f"--{form} {display_path(value)}: expected a name that ends in .{form}, or a folder")
    return [(form, Path(value)) for form, value in named], output


def _names(stills: Sequence[tuple[str, Path]], tasks: Sequence[Task]) -> Iterator[tuple[str, list[tuple[str, Path]]]]:
    """Yield each program and the format and file of its pictures."""
    if not stills:
        return
    from polarcheck.view.picture_index import page_names

    pages = page_names(task.title for task in tasks)
    for task, page in zip(tasks, pages, strict=True):
        files = []
        for form, path in stills:
            if picturing.is_folder(path):
                files.append((form, path / f"{page.removesuffix('.html')}.{form}"))
            elif len(tasks) > 1:
                raise UsageError(
                    f"--{form}: a picture is of one program, and these are {len(tasks)}: a folder takes one for each"
                )
            else:
                files.append((form, path))
        yield task.title, files
