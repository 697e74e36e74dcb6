"""Reports of many files: the first ones in memory, the others in a temporary file without a name."""

from __future__ import annotations

import pickle
import weakref
from collections.abc import Iterator, Mapping, Sequence
from typing import IO, overload

from polarcheck.foundation.finding import FileReport

#: Reports that stay in memory: they take less than the libraries do.
_IN_MEMORY = 500
#: Size up to which the others stay in memory, too [bytes].
_SPOOLED = 8_000_000

Lines = Mapping[int, str]


class Spool:
    """
    Reports in the order in which they are added, with the source lines of their findings.

    They can be read any number of times. A reader that keeps none of them needs no more memory for 10,000 than for a
    few.
    """

    def __init__(self, in_memory: int = _IN_MEMORY) -> None:
        self._in_memory = in_memory
        self._reports: list[FileReport] = []
        self._lines: list[Lines] = []
        self._places: list[int] = []
        self._file: IO[bytes] | None = None
        self._with_lines: dict[str, int] = {}

    def add(self, report: FileReport, lines: Lines) -> None:
        """Append a report."""
        if lines:
            self._with_lines[report.path] = len(self)
        if len(self) < self._in_memory:
            self._reports.append(report)
            self._lines.append(lines)
            return
        if self._file is None:
            import tempfile

            self._file = tempfile.SpooledTemporaryFile(_SPOOLED)  # noqa: SIM115  open as long as the spool
            weakref.finalize(self, self._file.close)
        self._places.append(self._file.seek(0, 2))
        pickle.dump((report, lines), self._file, pickle.HIGHEST_PROTOCOL)

    def __len__(self) -> int:
        return len(self._reports) + len(self._places)

    def at(self, number: int) -> tuple[FileReport, Lines]:
        """The report of this number, from 0, and the source lines of its findings."""
        if number < len(self._reports):
            return self._reports[number], self._lines[number]
        assert self._file is not None
        self._file.seek(self._places[number - len(self._reports)])
        # The process itself has written it, where nobody else can.
        entry: tuple[FileReport, Lines] = pickle.load(self._file)  # noqa: S301
        return entry

    @property
    def files(self) -> Sequence[FileReport]:
        """The reports: a list where all of them are in memory."""
        return _Files(self) if self._places else self._reports

    @property
    def lines(self) -> Mapping[str, Lines]:
        """Source lines of the findings, by path and number."""
        if self._places:
            return _LinesByPath(self, self._with_lines)
        return {path: self._lines[number] for path, number in self._with_lines.items()}


class _Files(Sequence[FileReport]):
    def __init__(self, spool: Spool) -> None:
        self._spool = spool

    def __len__(self) -> int:
        return len(self._spool)

    @overload
    def __getitem__(self, number: int) -> FileReport: ...
    @overload
    def __getitem__(self, number: slice) -> list[FileReport]: ...
    def __getitem__(self, number: int | slice) -> FileReport | list[FileReport]:
        at = range(len(self))[number]
        return self._spool.at(at)[0] if isinstance(at, int) else [self._spool.at(one)[0] for one in at]


class _LinesByPath(Mapping[str, Lines]):
    def __init__(self, spool: Spool, numbers: Mapping[str, int]) -> None:
        self._spool, self._numbers = spool, numbers

    def __len__(self) -> int:
        return len(self._numbers)

    def __iter__(self) -> Iterator[str]:
        return iter(self._numbers)

    def __getitem__(self, path: str) -> Lines:
        return self._spool.at(self._numbers[path])[1]
