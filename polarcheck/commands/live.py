"""A report on standard output that is written while files are still being checked."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from polarcheck import reports
from polarcheck.commands.output import show
from polarcheck.errors import OutputError
from polarcheck.finding import FileReport, Report
from polarcheck.reports import Background

#: Of more files than this it is written file by file; of fewer, text tells more of each (reports.text).
_MANY = 10


class Live:
    """
    Where the format can be written file by file, and there are many files. hide: called before anything is written.

    in_place_of_findings: whether it is counted how often each rule speaks, and no more said. to_error: whether it goes
    to standard error, where standard output holds something else.
    """

    def __init__(
        self,
        form: str,
        background: Background,
        planned: int,
        hide: Callable[[], None],
        *,
        in_place_of_findings: bool = False,
        to_error: bool = False,
    ) -> None:
        self._form, self._background, self._hide, self._to_error = form, background, hide, to_error
        self._counts = in_place_of_findings
        self._parts = reports.parts(form, background) if planned > _MANY and not self._counts else None
        self._is_read = True
        self._error: OutputError | None = None

    def file(self, report: FileReport, lines: Mapping[int, str]) -> None:
        """Write what is said of a file, if that can be said before the others are finished."""
        if self._parts is not None and (text := self._parts.of_file(report, lines)):
            self._hide()
            self._write(text)

    def end(self, report: Report, lines: Mapping[str, Mapping[int, str]]) -> None:
        """
        Write what is left to be said, or all of it. Raises OutputError where anything could not be written: the check
        went on, for the other reports and the exit code.
        """
        if self._parts is not None:
            self._write(self._parts.end(report))
        elif self._counts:
            from polarcheck.reports.pages.statistics import statistics

            self._write(statistics(report, self._background, self._form))
        else:
            for piece in reports.pieces(self._form, report, self._background._replace(lines=lines)):
                self._write(piece)
        if self._error is not None:
            raise self._error

    def _write(self, text: str) -> None:
        if not self._is_read or self._error is not None:
            return
        try:
            data = text if self._form in reports.FOR_PEOPLE else text.encode()
            self._is_read = show(data, self._background.color or None, self._to_error)
        except OutputError as error:
            self._error = error
