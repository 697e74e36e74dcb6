"""The result of a check of one state of a buffer: its settings, tables and report."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from polarcheck import bounded
from polarcheck.checking import check
from polarcheck.checking.settings import Settings
from polarcheck.checking.tables import Tables
from polarcheck.columns.trace import Trace
from polarcheck.errors import PolarcheckError, StoppedError
from polarcheck.finding import FileReport
from polarcheck.reading import files
from polarcheck.reading.words import Text
from polarcheck.server.open_text import OpenText
from polarcheck.time_limit import seconds_for, time_limit

#: Returns the settings of a program. Raises a PolarcheckError for settings that cannot be used.
SettingsOf = Callable[[Path], Settings]


class Judged(NamedTuple):
    """
    The result of a check of one state of a buffer.

    text: the text.
    path: the path of its file.
    error: why it could not be checked, in one line; if empty, the other fields are set.
    settings: the settings of the program.
    runs: each run by its name, with its tables, from check.read.
    report: the report.
    """

    text: OpenText
    path: Path
    error: str = ""
    settings: Settings | None = None
    runs: Sequence[tuple[str, Tables]] = ()
    report: FileReport | None = None

    @property
    def traces(self) -> Iterator[Trace]:
        """Yield the trace of each run: one per channel and state of block skip."""
        for _, tables in self.runs:
            yield tables["trace"]

    @property
    def texts(self) -> list[Text]:
        """Return the text of each channel once, with the called files after it."""
        texts = [trace.text for trace in self.traces]
        return [text for index, text in enumerate(texts) if all(text is not earlier for earlier in texts[:index])]

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

    @property
    def files_read(self) -> list[Path]:
        """Return the other files that the result depends on, and the folders of called programs."""
        if self.settings is None:
            return []
        folders = [Path(folder) for folder in self.settings.job.run.subprograms]
        called = [folder / part.name for folder in folders for text in self.texts for part in text.source.parts]
        return [*self.settings.read, *folders, *called]


def _without_known(
    report: FileReport, runs: Sequence[tuple[str, Tables]], path: Path, settings: Settings
) -> FileReport:
    """Return the report without the findings that the baseline of the program knows."""
    from polarcheck.batch.baselines import Baselines
    from polarcheck.batch.tasks import Task
    from polarcheck.checking.outline import with_outline

    known = Baselines([Task(str(path), settings)], [])
    return known.without_known(with_outline(report, runs))


def judge(
    text: OpenText,
    path: Path,
    settings_of: SettingsOf,
    folders: Sequence[Path],
    is_stopped: Callable[[], bool] = lambda: False,
) -> Judged:
    """
    Check a buffer as if it were saved. Only files in the folders and in those of subprograms are opened.

    is_stopped: returns True once the check is cancelled; then StoppedError is raised. A bug raises its own exception.
    """
    try:
        with bounded.only_below(folders):
            settings = settings_of(path)
            job = settings.job
            with time_limit(seconds_for(len(text.data), job.run.max_seconds), is_stopped):
                runs = check.read(text.data, settings.machine, job, files.shown(str(path)))
                report = check.check_runs(runs, settings.rules, settings.severities, settings.inline)
                if settings.baseline is not None:
                    report = _without_known(report, runs, path, settings)
    except StoppedError:
        raise
    except PolarcheckError as error:
        return Judged(text, path, str(error))
    except MemoryError:
        return Judged(text, path, "there is not enough memory to check this program")
    return Judged(text, path, "", settings, runs, report)
