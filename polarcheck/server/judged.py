"""What is known of one state of a buffer: its settings, its tables, and what a check reports of it."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from polarcheck import bounded
from polarcheck.checking import check
from polarcheck.checking.settings import Settings
from polarcheck.checking.tables import Tables
from polarcheck.errors import PolarcheckError, StoppedError
from polarcheck.finding import FileReport
from polarcheck.reading import files
from polarcheck.reading.words import Text
from polarcheck.server.open_text import OpenText
from polarcheck.table.trace import Trace
from polarcheck.time_limit import seconds_for, time_limit

#: What applies to a program. Raises a PolarcheckError for settings that cannot be used.
SettingsOf = Callable[[Path], Settings]


class Judged(NamedTuple):
    """
    text: the state of the buffer. path: of its file. told: why it could not be judged, in one line; else empty, and
    settings, runs (as check.read gives them) and report are there.
    """

    text: OpenText
    path: Path
    told: str = ""
    settings: Settings | None = None
    runs: Sequence[tuple[str, Tables]] = ()
    report: FileReport | None = None

    @property
    def traces(self) -> Iterator[Trace]:
        """The executed programs: of each channel and state of block skip."""
        for _, tables in self.runs:
            yield tables["trace"]

    @property
    def texts(self) -> list[Text]:
        """What was read: of each channel once, the called files behind it."""
        found = [trace.text for trace in self.traces]
        return [text for index, text in enumerate(found) if all(text is not one for one in found[:index])]

    def row_of(self, line: int) -> tuple[Tables, int, int] | None:
        """The run in which a line is executed, the first of its rows, and how many there are; None where none is."""
        for _, tables in self.runs:
            trace: Trace = tables["trace"]
            rows = np.flatnonzero(trace.line_in_file == line)
            if len(rows):
                # Rows of a program that is called there stand behind that of the call.
                own = rows[trace.run.depth[rows] == trace.run.depth[rows[0]]]
                return tables, int(rows[0]), len(own)
        return None

    @property
    def read(self) -> list[Path]:
        """The files besides its own that it was judged by; in folders of called programs the folder, too."""
        if self.settings is None:
            return []
        folders = [Path(folder) for folder in self.settings.job.run.subprograms]
        called = [folder / part.name for folder in folders for text in self.texts for part in text.source.parts]
        return [*self.settings.read, *folders, *called]


def judge(
    text: OpenText,
    path: Path,
    settings_of: SettingsOf,
    folders: Sequence[Path],
    is_stopped: Callable[[], bool] = lambda: False,
) -> Judged:
    """
    Check a buffer as the file that it will be. Nothing but files in the folders, and those of subprograms, is opened.

    is_stopped: whether nobody waits for it any more. Raises StoppedError then; and what a bug raises.
    """
    try:
        with bounded.only_below(folders):
            settings = settings_of(path)
            job = settings.job
            with time_limit(seconds_for(len(text.data), job.run.max_seconds), is_stopped):
                runs = check.read(text.data, settings.machine, job, files.shown(str(path)))
                report = check.check_runs(runs, settings.rules, settings.severities, settings.inline)
    except StoppedError:
        raise
    except PolarcheckError as error:
        return Judged(text, path, str(error))
    except MemoryError:
        return Judged(text, path, "there is not enough memory to check this program")
    return Judged(text, path, "", settings, runs, report)
