"""Pictures on their way from those who check to a page, or to a folder with a page for each program."""

from __future__ import annotations

import sys
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from polarcheck.commands.output import is_terminal
from polarcheck.errors import OutputError, UsageError
from polarcheck.reading.files import shown, write

if TYPE_CHECKING:
    from polarcheck.batch.tasks import Outcome, Task
    from polarcheck.checking.settings import Extra
    from polarcheck.pictures.picture import Drawn
    from polarcheck.reports import Background

#: The format that holds pictures.
FORMAT = "html"


def extras() -> tuple[Extra, ...]:
    """Return the functions that add pictures to reports. Raises UsageError if plotly is missing, before any check."""
    from polarcheck.pictures.drawing import drawn
    from polarcheck.pictures.library import require

    require()
    return (drawn,)


def refuse(tasks: Sequence[Task], to_terminal: bool, example: str) -> None:
    """Raises UsageError for several programs in one page, and for a page on a terminal."""
    if len(tasks) > 1:
        raise UsageError(f"a page is of one program, and these are {len(tasks)}: {example}FOLDER takes a page for each")
    if to_terminal:
        raise UsageError(f"a page is nothing for a terminal: {example}FILE.html writes it to a file")


def is_folder(path: Path) -> bool:
    """Return True if an output is a folder: an existing one, or a new name without an extension."""
    return path.is_dir() or not (path.suffix or path.exists())


class Apart:
    """Takes pictures off reports, and keeps them by the path of the program."""

    def __init__(self) -> None:
        self.drawn: dict[str, Drawn] = {}

    def taken(self, outcomes: Iterable[Outcome]) -> Iterator[Outcome]:
        """The outcomes as they are told."""
        from polarcheck.finding import FileReport

        for outcome in outcomes:
            if outcome.report is None or type(outcome.report) is FileReport:
                yield outcome
                continue
            import msgspec

            from polarcheck.pictures.drawing import split  # a check without pictures does without

            report, drawn = split(outcome.report)
            told = msgspec.structs.replace(outcome, report=report)
            if drawn is not None:
                self.keep(told, drawn)
            yield told

    def keep(self, outcome: Outcome, drawn: Drawn) -> None:
        """Write the pictures of a program."""
        assert outcome.report is not None
        self.drawn[outcome.report.path] = drawn

    def begin(self, background: Background) -> None:
        """Prepare the output before the first program."""

    def end(self) -> None:
        """Finish the output after the last program."""


class Folder(Apart):
    """
    Writes a page for each program as soon as it is checked, so that many take no more memory than one; behind them the
    page that leads to them, and plotly once. Raises OutputError where one cannot be written.
    """

    def __init__(self, folder: Path, tasks: Sequence[Task]) -> None:
        from polarcheck.reports import Background
        from polarcheck.reports.pages.picture_index import Entry, page_names

        super().__init__()
        self._folder, self._background = folder, Background()
        self._names = dict(zip((task.title for task in tasks), page_names(task.title for task in tasks), strict=True))
        self._entries: list[Entry] = []

    @property
    def outputs(self) -> list[Path]:
        """All that will be written."""
        from polarcheck.pictures.library import FILE_NAME
        from polarcheck.reports.pages.picture_index import INDEX

        return [self._folder / name for name in (INDEX, FILE_NAME, *self._names.values())]

    def begin(self, background: Background) -> None:
        """Make the folder, and write into it what all pages share."""
        from polarcheck.pictures.library import FILE_NAME, library

        self._background = background
        try:
            self._folder.mkdir(exist_ok=True)
        except (OSError, ValueError) as error:
            said = getattr(error, "strerror", None) or error
            raise OutputError(f"{shown(str(self._folder))}: {said}") from None
        write(self._folder / FILE_NAME, library())

    def keep(self, outcome: Outcome, drawn: Drawn) -> None:
        """Write the page of a program."""
        from polarcheck.pictures.library import FILE_NAME
        from polarcheck.pictures.page import page
        from polarcheck.reports.pages.picture_index import entry
        from polarcheck.reports.pages.pictured import picture

        report = outcome.report
        assert report is not None
        if len(self._names) == 1:  # for a page beside the folder
            super().keep(outcome, drawn)
        name = self._names[report.path]
        pictured = picture(report, self._background._replace(drawn={report.path: drawn}))
        write(self._folder / name, page([pictured], beside=FILE_NAME))
        self._entries.append(entry(report, name))

    def end(self) -> None:
        """Write the page that leads to all others."""
        from polarcheck.reports.pages.picture_index import INDEX, index

        write(self._folder / INDEX, index(self._entries))


def of_outputs(
    outputs: Sequence[tuple[str, Path]], to_output: bool, tasks: Sequence[Task], example: str
) -> tuple[Apart, list[tuple[str, Path]], list[Path]]:
    """
    Where the pictures of a run go, the outputs that are files, and all files that are written.

    to_output: whether a page goes to standard output, too. example: how a file or folder is named. Raises UsageError
    where there is no way to write one.
    """
    files = [(form, path) for form, path in outputs if form != FORMAT or not is_folder(path)]
    folders = [path for form, path in outputs if form == FORMAT and is_folder(path)]
    if to_output or any(form == FORMAT for form, _ in files):
        refuse(tasks, to_output and is_terminal(sys.stdout), example)
    if len(folders) > 1:
        raise UsageError(f"{example}{shown(str(folders[1]))}: pages are written to one folder only")
    if not folders:
        return Apart(), files, [path for _, path in files]
    folder = Folder(folders[0], tasks)
    return folder, files, [*(path for _, path in files), *folder.outputs]
