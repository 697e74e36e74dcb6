"""Takes pictures from the checked reports, and writes them to a page or a folder with a page for each program."""

from __future__ import annotations

import sys
from collections.abc import Callable, Generator, Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from polarcheck.commands.output import is_terminal
from polarcheck.foundation.errors import OutputError, UsageError, why
from polarcheck.program.reading.files import display_path, write

if TYPE_CHECKING:
    from polarcheck.checking.settings import Extra
    from polarcheck.files.batch.tasks import Outcome, Task
    from polarcheck.foundation.finding import FileReport
    from polarcheck.reports import Background
    from polarcheck.view.picture_data import Drawn

#: The format that holds pictures.
FORMAT = "html"


def extras(*, for_page: bool = True) -> tuple[Extra, ...]:
    """
    Return the function that adds pictures to reports.

    for_page: they are drawn on a page. Raises UsageError if plotly is missing, which pages need.
    """
    from polarcheck.view.plotly_script import require
    from polarcheck.view.run_drawing import drawn

    if for_page:
        require()
    return (drawn,)


def refuse(tasks: Sequence[Task], to_terminal: bool, example: str) -> None:
    """Raise UsageError for several programs in one page, and for a page on a terminal."""
    if len(tasks) > 1:
        raise UsageError(f"a page is of one program, and these are {len(tasks)}: {example}FOLDER takes a page for each")
    if to_terminal:
        raise UsageError(f"a page is nothing for a terminal: {example}FILE.html writes it to a file")


def is_folder(path: Path) -> bool:
    """Return True if an output is a folder: an existing one, or a new one, whose name has no extension."""
    return path.is_dir() or not (path.suffix or path.exists())


def create_folder(folder: Path) -> None:
    """Create a folder unless it exists. Raises OutputError if that fails."""
    try:
        folder.mkdir(exist_ok=True)
    except (OSError, ValueError) as error:
        raise OutputError(f"{display_path(folder)}: {why(error)}") from None


class Pictures:
    """
    Separates pictures from reports.

    drawn: the drawings, by the path of the program.
    also: takes each report and its drawing, too.
    """

    def __init__(self) -> None:
        self.drawn: dict[str, Drawn] = {}
        self.also: Callable[[FileReport, Drawn], None] = lambda report, drawn: None

    def split(self, outcomes: Iterable[Outcome]) -> Generator[Outcome, None, None]:
        """Yield the outcomes without their pictures, which are stored."""
        from polarcheck.foundation.finding import UNREADABLE, FileReport

        for outcome in outcomes:
            if outcome.report is None or type(outcome.report) is FileReport:
                if outcome.report is not None and outcome.report.verdict == UNREADABLE:
                    self.miss(outcome.report)
                yield outcome
                continue
            import msgspec

            from polarcheck.view.run_drawing import split  # not needed without pictures

            report, drawn = split(outcome.report)
            plain = msgspec.structs.replace(outcome, report=report)
            if drawn is not None:
                self.store(plain, drawn)
                self.also(report, drawn)
            yield plain

    def store(self, outcome: Outcome, drawn: Drawn) -> None:
        """Store the drawing of a program."""
        assert outcome.report is not None
        self.drawn[outcome.report.path] = drawn

    def miss(self, report: FileReport) -> None:
        """Note a program without a drawing, since it could not be read or checked."""

    def begin(self, background: Background) -> None:
        """Prepare for the first program."""

    def end(self, notes: Sequence[str] = ()) -> None:
        """Finish after the last program. notes: what the walks did not read, in words."""


class Discarded(Pictures):
    """Stores no drawing."""

    def store(self, outcome: Outcome, drawn: Drawn) -> None:
        """Store nothing."""


class Folder(Pictures):
    """
    Writes a page for each program as soon as it is checked, so that memory does not grow; at last the index page.

    plotly is written once. Raises OutputError if a file cannot be written.
    """

    def __init__(self, folder: Path, tasks: Sequence[Task]) -> None:
        from polarcheck.reports import Background
        from polarcheck.view.picture_index import Entry, page_names

        super().__init__()
        self._folder, self._background = folder, Background()
        self._names = dict(zip((task.title for task in tasks), page_names(task.title for task in tasks), strict=True))
        self._entries: list[Entry] = []

    @property
    def outputs(self) -> list[Path]:
        """Return all files that will be written."""
        from polarcheck.view.picture_index import INDEX
        from polarcheck.view.plotly_script import FILE_NAME

        return [self._folder / name for name in (INDEX, FILE_NAME, *self._names.values())]

    def begin(self, background: Background) -> None:
        """Create the folder, and write the library that all pages share."""
        from polarcheck.view.plotly_script import FILE_NAME, library

        self._background = background
        create_folder(self._folder)
        write(self._folder / FILE_NAME, library())

    def store(self, outcome: Outcome, drawn: Drawn) -> None:
        """Write the page of a program."""
        from polarcheck.view.page import page
        from polarcheck.view.page_data import picture
        from polarcheck.view.picture_index import entry
        from polarcheck.view.plotly_script import FILE_NAME

        report = outcome.report
        assert report is not None
        if len(self._names) == 1:  # for a single page beside the folder
            super().store(outcome, drawn)
        name = self._names[report.path]
        pictured = picture(report, self._background._replace(drawn={report.path: drawn}))
        write(self._folder / name, page([pictured], script_path=FILE_NAME))
        self._entries.append(entry(report, name))

    def miss(self, report: FileReport) -> None:
        """List a program that has no page."""
        from polarcheck.view.picture_index import entry

        self._entries.append(entry(report, ""))

    def end(self, notes: Sequence[str] = ()) -> None:
        """Write the index page."""
        from polarcheck.view.picture_index import INDEX, index

        write(self._folder / INDEX, index(self._entries, notes))


def of_outputs(
    outputs: Sequence[tuple[str, Path]], to_output: bool, tasks: Sequence[Task], example: str
) -> tuple[Pictures, list[tuple[str, Path]], list[Path]]:
    """
    Return the object that takes the pictures of a run, the outputs that are files, and all files that are written.

    to_output: a page goes to standard output, too.
    example: the option before the name of a file or folder, for messages.

    Raises UsageError if a page cannot be written like that.
    """
    files = [(form, path) for form, path in outputs if form != FORMAT or not is_folder(path)]
    folders = [path for form, path in outputs if form == FORMAT and is_folder(path)]
    if to_output or any(form == FORMAT for form, _ in files):
        refuse(tasks, to_output and is_terminal(sys.stdout), example)
    if len(folders) > 1:
        raise UsageError(f"{example}{display_path(folders[1])}: pages are written to one folder only")
    if not folders:
        return Pictures(), files, [path for _, path in files]
    folder = Folder(folders[0], tasks)
    return folder, files, [*(path for _, path in files), *folder.outputs]
