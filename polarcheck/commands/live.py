"""Writes the report on standard output while files are still being checked."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from polarcheck import reports
from polarcheck.commands.output import show
from polarcheck.foundation.errors import OutputError
from polarcheck.foundation.finding import FileReport, Report
from polarcheck.reports import Background

#: With more files than this the report is written file by file; with fewer, text says more about each (reports.text).
_MANY = 10


class Live:
    """
    The report on standard output: file by file if the format allows it and there are many files, else at the end.

    form: the format.
    background: what the report shows besides findings.
    planned: the number of files.
    hide: called before anything is written.
    in_place_of_findings: write counts of findings per rule only.
    to_error: write to standard error, since standard output holds something else.
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
        self._is_open = True
        self._error: OutputError | None = None

    def file(self, report: FileReport, lines: Mapping[int, str]) -> None:
        """Write the part of a file, if the report is written file by file."""
        if self._parts is not None and (text := self._parts.of_file(report, lines)):
            self._hide()
            self._write(text)

    def end(self, report: Report, lines: Mapping[str, Mapping[int, str]]) -> None:
        """
        Write the end of the report, or all of it.

        Raises OutputError if anything could not be written; the check goes on before, for other reports and the exit
        code.
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
        if not self._is_open or self._error is not None:
            return
        try:
            data = text if self._form in reports.FOR_PEOPLE else text.encode()
            self._is_open = show(data, self._background.color or None, self._to_error)
        except OutputError as error:
            self._error = error
