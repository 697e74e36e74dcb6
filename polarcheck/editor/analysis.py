"""The result of a check of one state of a buffer: its settings, tables and report."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from types import MappingProxyType
from typing import NamedTuple, Protocol

import numpy as np
from lsprotocol import types

from polarcheck.checking import check
from polarcheck.checking.settings import Settings
from polarcheck.columns.trace import Trace
from polarcheck.editor.open_text import OpenText
from polarcheck.foundation import bounded, record
from polarcheck.foundation.errors import PolarcheckError, StoppedError
from polarcheck.foundation.finding import FileReport, Finding
from polarcheck.foundation.time_limit import seconds_for, time_limit
from polarcheck.program.execution.runs import texts_of
from polarcheck.program.reading import files, source
from polarcheck.program.reading.words import Text
from polarcheck.rules.tables import Tables


class SettingsOf(Protocol):
    """Returns the settings of a program."""

    def __call__(self, path: Path) -> Settings:
        """Return the settings. Raises a PolarcheckError for settings that cannot be used."""

    def fallback(self, path: Path) -> Settings:
        """Return what is left of the settings while they cannot be used."""


class Analysis(NamedTuple):
    """
    The result of a check of one state of a buffer.

    text: the text.
    path: the path of its file.
    error: why it could not be checked, in one line; then there are no runs and no report.
    settings: the settings of the program; after an error, the last ones that could be used, or the default ones.
    runs: each run by its name, with its tables, from check.read.
    report: the report.
    read: what the result depends on, by absolute path: the files that were read or looked for, and folders.
    plain: the texts of the channels after an error, for what needs no execution.
    """

    text: OpenText
    path: Path
    error: str = ""
    settings: Settings | None = None
    runs: Sequence[tuple[str, Tables]] = ()
    report: FileReport | None = None
    read: Mapping[str, record.Seen] = MappingProxyType({})
    plain: Sequence[Text] = ()

    @property
    def traces(self) -> Iterator[Trace]:
        """Yield the trace of each run: one per channel and state of block skip."""
        for _, tables in self.runs:
            yield tables["trace"]

    @property
    def texts(self) -> list[Text]:
        """Return the text of each channel once, with the called files after it."""
        texts = [trace.text for trace in self.traces] or list(self.plain)
        return [text for index, text in enumerate(texts) if all(text is not earlier for earlier in texts[:index])]

    def findings_in(self, first: types.Position, last: types.Position) -> list[Finding]:
        """Return the findings whose words are, in part at least, between two positions."""
        text, start, end = self.text, self.text.offset(first), self.text.offset(last)
        return [
            finding
            for finding in (self.report.findings if self.report is not None else ())
            if text.offset_of(finding.line, finding.column) <= end
            and text.offset_of(finding.end_line, finding.end_column) >= start
        ]

    def row_of(self, line: int) -> tuple[Tables, int, int] | None:
        """Return the first run that executes a line, the first of its rows and their number; None if no run does."""
        for _, tables in self.runs:
            trace: Trace = tables["trace"]
            rows = np.flatnonzero(trace.blocks.line_in_file == line)
            if len(rows):
                # Rows of a called program have the line of the call, and are deeper.
                of_line = rows[trace.run.depth[rows] == trace.run.depth[rows[0]]]
                return tables, int(rows[0]), len(of_line)
        return None


def _without_known(
    report: FileReport, runs: Sequence[tuple[str, Tables]], path: Path, settings: Settings
) -> FileReport:
    """Return the report without the findings that the baseline of the program knows."""
    from polarcheck.checking.block_outline import with_outline
    from polarcheck.files.baselines.baselines import Baselines
    from polarcheck.files.batch.tasks import Task

    baselines = Baselines([Task(str(path), settings)], [])
    return baselines.without_known(with_outline(report, runs))


def judge(
    text: OpenText,
    path: Path,
    settings_of: SettingsOf,
    folders: Sequence[Path],
    is_stopped: Callable[[], bool] = lambda: False,
    last: Settings | None = None,
) -> Analysis:
    """
    Check a buffer as if it were saved. Only files in the folders and in those of subprograms are opened.

    is_stopped: returns True once the check is cancelled; then StoppedError is raised. A bug raises its own exception.
    last: the last settings of the program that could be used.
    """
    settings = None
    with bounded.only_below(folders), record.recorded(has_states=True) as recorded:
        read = recorded.seen if recorded.seen is not None else {}
        try:
            settings = settings_of(path)
            job = settings.job
            with time_limit(seconds_for(len(text.data), job.run.max_seconds), is_stopped):
                runs = check.read(text.data, settings.machine, job, files.display_path(path))
                report = check.check_runs(runs, settings.rules, settings.severities, settings.inline)
                if settings.baseline is not None:
                    report = _without_known(report, runs, path, settings)
            return Analysis(text, path, "", settings, runs, report, read)
        except StoppedError:
            raise
        except PolarcheckError as caught:
            error = str(caught)
        except MemoryError:
            error = "there is not enough memory to check this program"
        settings = settings or last or settings_of.fallback(path)
        return Analysis(text, path, error, settings, read=read, plain=_plain(text, path, settings, is_stopped))


def _plain(text: OpenText, path: Path, settings: Settings, is_stopped: Callable[[], bool]) -> list[Text]:
    """Return the text of each channel of a program that could not be checked."""
    try:
        with time_limit(seconds_for(len(text.data), settings.job.run.max_seconds), is_stopped):
            return texts_of(source.read_source(text.data, files.display_path(path)), settings.machine)
    except StoppedError:
        raise
    except (PolarcheckError, MemoryError):
        return []
