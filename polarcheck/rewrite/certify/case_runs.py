"""What a program of a case says and does: its report, and the moves of its tool center."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence

import msgspec

from polarcheck.checking import check
from polarcheck.checking.settings import Settings
from polarcheck.files.batch.tasks import Task, outcome
from polarcheck.foundation import record
from polarcheck.foundation.errors import PolarcheckError, SourceError
from polarcheck.foundation.finding import UNREADABLE, FileReport
from polarcheck.foundation.time_limit import seconds_for, time_limit
from polarcheck.program.reading import files
from polarcheck.reports.pages import executed
from polarcheck.reports.pages.executed import Move
from polarcheck.rewrite.certify import quoting
from polarcheck.rewrite.certify.golden import GoldenOrder, GoldenTrace, orders_of
from polarcheck.rewrite.certify.loading import Loaded


class CaseRun(msgspec.Struct, frozen=True):
    """
    A program that was checked and executed.

    report: None where it could not be checked; failure then says why.
    moves: of the paths that were asked for, by name (tool, programmed), channel by channel.
    orders: beside the moves, where any were asked for.
    sense: 1 where C of the machine grows with the angle on the plane, -1 where it falls.
    unknown: the radii that are not known, in one line; empty if none is.
    bug: an internal error.
    outside: the files it rests on whose text is not quoted, since they lie outside of the folders of a certification.
    size: of the program [bytes].
    """

    report: FileReport | None = None
    failure: str = ""
    moves: Mapping[str, Sequence[Move]] = {}
    orders: Sequence[GoldenOrder] = ()
    sense: int = 1
    unknown: str = ""
    bug: Exception | None = None
    outside: Sequence[str] = ()
    size: int = 0

    def golden_trace(self, path: str) -> GoldenTrace:
        """The moves of a path, and the orders, as a golden trace holds them. path: its name, tool or programmed."""
        return GoldenTrace(self.moves[path], self.orders)


def run(path: str, settings: Settings, most: int, paths: Collection[str], loaded: Loaded) -> CaseRun:
    """
    Check the program at a path, and execute it if its moves are asked for.

    most: its largest size [bytes]. paths: names of the paths whose moves are asked for. loaded: the manifest.
    """
    try:
        data = files.read_program(path, most)
    except SourceError as error:
        return CaseRun(failure=str(error))
    with record.recorded() as read:
        of_case = _checked(path, data, settings, most, paths)
    outside = loaded.outside([path, *settings.read, *read.paths])
    return _without_text(of_case, files.display_path(path), outside) if outside else of_case


def _without_text(of_case: CaseRun, title: str, outside: Sequence[str]) -> CaseRun:
    """Return the same run without any text of its files."""
    return msgspec.structs.replace(
        of_case,
        report=None if of_case.report is None else quoting.without_text(of_case.report),
        failure=f"{title}: it cannot be checked; {quoting.remark(outside)}" if of_case.failure else "",
        unknown="",
        bug=None if of_case.bug is None else RuntimeError(f"{type(of_case.bug).__name__} in {title}"),
        outside=outside,
    )


def _checked(path: str, data: bytes, settings: Settings, most: int, paths: Collection[str]) -> CaseRun:
    checked = outcome(Task(path, settings), most, data)
    if checked.report is None or checked.report.verdict == UNREADABLE:
        return CaseRun(failure=checked.failure or f"{files.display_path(path)}: an internal error", bug=checked.bug)
    if not paths:
        return CaseRun(checked.report)
    try:
        return _executed(checked.report, path, settings, data, paths)
    except PolarcheckError as error:
        return CaseRun(failure=f"{files.display_path(path)}: {error}")


def _executed(report: FileReport, path: str, settings: Settings, data: bytes, paths: Collection[str]) -> CaseRun:
    job = settings.job
    if job.run.block_skip == "both":  # a path has a single state, as that of `trace`
        job = msgspec.structs.replace(job, run=msgspec.structs.replace(job.run, block_skip="off"))
    moves: dict[str, list[Move]] = {name: [] for name in paths}
    orders: list[GoldenOrder] = []
    unknown: list[str] = []
    sense = 1
    with time_limit(seconds_for(len(data), job.run.max_seconds)):
        for _, tables in check.read(data, settings.machine, job, files.display_path(path), settings.encoding):
            trace, tool_center = tables["trace"], tables["tool_center"]
            for name in paths:
                moves[name] += executed.moves(trace, tool_center, name, has_z_alone=True)
            orders += orders_of(trace)
            unknown.append(executed.without_radius(trace, tool_center))
            sense = tool_center.moves.c_axis.sense
    return CaseRun(report, "", moves, orders, sense, "; ".join(filter(None, unknown)), size=len(data))
