"""Many files to one report."""

from __future__ import annotations

import functools
import gc
import os
from collections import Counter
from collections.abc import Callable, Collection, Generator, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import msgspec

from polarcheck.checking import check
from polarcheck.checking.polar_sections import with_doubts
from polarcheck.checking.settings import Settings
from polarcheck.files.batch.spool import Spool
from polarcheck.foundation.digest import sha256_of
from polarcheck.foundation.errors import ClusterError, SourceError, TooHardError, one_line
from polarcheck.foundation.finding import (
    ERROR,
    SCHEMA,
    SEVERITIES,
    UNREADABLE,
    Assumed,
    FileReport,
    Interrupted,
    Producer,
    Report,
    RunSettings,
    Summary,
)
from polarcheck.foundation.record import LookUp, digest, note, recorded
from polarcheck.foundation.time_limit import seconds_for, time_limit
from polarcheck.foundation.version import __version__
from polarcheck.program.reading import files
from polarcheck.program.reading.source import Source
from polarcheck.program.reading.words import Text
from polarcheck.rules.tables import Tables

if TYPE_CHECKING:
    from polarcheck.program.reading.walking import ExcludedIn, Skipped

Tell = Callable[[str], None]


class Task(msgspec.Struct, frozen=True):
    """
    A file to check and what applies to it.

    path: what is read. named: the file that standard input is judged and reported as; empty for what is its own file.
    """

    path: str
    settings: Settings
    named: str = ""

    @property
    def place(self) -> str:
        """The path of the file that it is checked as, which need not be there."""
        return self.named or self.path

    @property
    def title(self) -> str:
        """The path under which it is reported."""
        return files.display_path(self.place)


def with_settings(tasks: Sequence[Task], changed: Callable[[Settings], Settings]) -> list[Task]:
    """The tasks with changed settings; those with the same ones share them still: other processes get them once."""
    new: dict[int, Settings] = {}
    for task in tasks:
        if id(task.settings) not in new:
            new[id(task.settings)] = changed(task.settings)
    return [msgspec.structs.replace(task, settings=new[id(task.settings)]) for task in tasks]


class Basis(msgspec.Struct, frozen=True):
    """
    What an outcome rests on beside the settings, so that it can be used again while that is the same.

    content: digest of the file (record.digest); None if another run may find otherwise, as of what has ended by its
    time. look_ups: the called programs that were looked for in the folders of the job.
    """

    content: bytes | None
    look_ups: tuple[LookUp, ...] = ()


class Outcome(msgspec.Struct, frozen=True):
    """
    What came of one file: its report with the lines that findings stand in.

    called: keys of the offsets that it calls, where it has a job with tools. failed: whether it fails, by its own
    settings. failure: in one line, why it could not be checked; its report says so, too. bug: what polarcheck itself
    did wrong. short_of_memory: where that is why; with more it may be checked. basis: what it rests on; None for what
    could not be checked.
    """

    report: FileReport | None = None
    lines: dict[int, str] = {}
    called: frozenset[str] = frozenset()
    failed: bool = False
    failure: str = ""
    bug: Exception | None = None
    short_of_memory: bool = False
    basis: Basis | None = None


class Checked(msgspec.Struct, frozen=True):
    """
    The reports of the files that could be read, and by path and number the lines that their findings stand in.

    Many reports are no list in memory, but can be gone through as often as one likes. called: keys of the offsets that
    any of the programs calls, where it has a job with tools. stopped: by what the check was interrupted; the files that
    were finished before that are here. failed: whether any of them fails, by the severity that its own settings name
    and, where these are strict, by being unverified. broken_off: in one line, why the workers could not go on.
    called_files: those in folders of subprograms that calls have led to.
    """

    files: Sequence[FileReport]
    lines: Mapping[str, Mapping[int, str]]
    called: set[str]
    stopped: KeyboardInterrupt | None = None
    failed: bool = False
    broken_off: str = ""
    called_files: set[str] = set()

    @property
    def readable(self) -> list[FileReport]:
        """The reports of the files that could be read and checked."""
        return [file for file in self.files if file.verdict != UNREADABLE]


def plan(
    paths: Iterable[str],
    settings_of: Callable[[str], Settings],
    extensions: Sequence[str],
    tell: Tell,
    warn: Tell,
    standard_input: str = files.STANDARD_INPUT,
    excluded_in: ExcludedIn | None = None,
    extensions_in: Callable[[str], Sequence[str]] | None = None,
    skipped: list[Skipped] | None = None,
) -> list[Task]:
    """
    The programs of files, folders and standard input (`-`), each once, in the order asked for.

    Paths that mean the same file are one program, under the first of them; where links lead to it from folders with
    settings of their own, one for each of these. An offset table that a job names is no program of a folder, though it
    looks like one, unless its name is that of a program.

    settings_of: what applies to a program. extensions: of the command line; where it has none, extensions_in returns
    those that the job file of a folder names. standard_input: the file, which need not be there, that standard input is
    judged as. excluded_in: which files and folders a walk passes over (walking.walk). skipped: takes what the walks did
    not read. tell is told of folders that cannot be read, warn of those without programs. Raises a PolarcheckError for
    settings that cannot be used, before any file is checked.
    """
    tasks: dict[tuple[str, int], Task] = {}
    by_look: set[tuple[str, int]] = set()
    real = files.RealPaths()
    unread_files: list[Skipped] = []
    wanted_in: Callable[[str], Collection[str]] | None = None
    for path in paths:
        programs, is_folder = [path], path != files.STANDARD_INPUT and os.path.isdir(path)  # noqa: PTH112
        if is_folder:
            wanted_in = wanted_in or _wanted_in(extensions, extensions_in)
            programs = _walked(path, wanted_in, excluded_in, tell, warn, unread_files)
        for program in programs:
            title = standard_input if program == files.STANDARD_INPUT else program
            settings = settings_of(title)
            named = title if title != program else ""
            key = real.of(title), id(settings)
            if not is_folder:
                by_look.discard(key)
            elif wanted_in and key not in tasks and _is_by_look(program, wanted_in):
                by_look.add(key)
            tasks.setdefault(key, Task(program, settings, named))
    if by_look:
        of_jobs = {id(task.settings): task.settings for task in tasks.values()}
        read = {real.of(path) for settings in of_jobs.values() for path in settings.read}
        for key in by_look:
            if key[0] in read:
                unread_files.append(_offset_table(tasks.pop(key).path))
    if skipped is not None and unread_files:
        from polarcheck.files.batch import unread_programs

        skipped += unread_programs.once(unread_files, {path for path, _ in tasks}, real)
    return list(tasks.values())


def _wanted_in(
    extensions: Sequence[str], extensions_in: Callable[[str], Sequence[str]] | None
) -> Callable[[str], Collection[str]]:
    """Return a function for the extensions of the programs in a folder."""
    from polarcheck.program.reading import walking

    def wanted_in(folder: str) -> Collection[str]:
        names = extensions or (extensions_in(folder) if extensions_in is not None else ())
        return frozenset(walking.extensions(names) or walking.EXTENSIONS)

    return functools.cache(wanted_in)


def _is_by_look(program: str, wanted_in: Callable[[str], Collection[str]]) -> bool:
    from polarcheck.program.reading import walking

    return not walking.has_name_of_program(program, wanted_in(os.path.dirname(program)))  # noqa: PTH120


def _offset_table(path: str) -> Skipped:
    from polarcheck.program.reading.walking import Skipped

    return Skipped(path, "offset table")


def _walked(
    folder: str,
    wanted_in: Callable[[str], Collection[str]],
    excluded_in: ExcludedIn | None,
    tell: Tell,
    warn: Tell,
    skipped: list[Skipped],
) -> list[str]:
    """Return the programs of a folder; take what is not read, and tell of what cannot be."""
    from polarcheck.files.batch import unread_programs
    from polarcheck.program.reading import walking

    failures: list[str] = []
    passed: list[Skipped] = []
    programs = list(walking.walk(folder, wanted_in, failures.append, excluded_in, passed.append))
    for failure in failures:
        tell(failure)
    if not programs and not failures:
        warn(f"{files.display_path(folder)}: {unread_programs.none_in_folder(passed)}")
    skipped += passed
    return programs


def settings_of(tasks: Iterable[Task]) -> dict[str, Settings]:
    """Return the settings of each file, by its path in reports."""
    return {task.title: task.settings for task in tasks}


def one_by_one(tasks: Iterable[Task], most: int = files.LARGEST) -> Generator[Outcome, None, None]:
    """Yield the outcome of each file, checked in this process."""
    for number, task in enumerate(tasks):
        if number:
            forget()
        yield outcome(task, most)


def forget() -> None:
    """
    Free what the last file has left behind: the command line keeps the collector off.

    It is young, so that to find it costs nothing of what is older. Without it no table of any file would ever be freed.
    """
    gc.collect(0)


def gather(
    outcomes: Iterable[Outcome],
    tell: Tell,
    bug: Callable[[Exception], None],
    show: Callable[[FileReport, Mapping[int, str]], None] | None = None,
) -> Checked:
    """
    All that came of the files, in their order, up to an interrupt.

    tell is told of failures in one line, bug of what polarcheck itself did wrong. show gets each report, with the lines
    of its findings, as soon as it is its turn.
    """
    spool, called, failed, stopped, broken_off = Spool(), set[str](), False, None, ""
    called_files: set[str] = set()
    try:
        for result in outcomes:
            if result.failure:
                tell(result.failure)
            if result.bug is not None:
                bug(result.bug)
            if result.report is not None:
                spool.add(result.report, result.lines)
                called |= result.called
                if result.basis is not None:
                    its_files = [path for look_up in result.basis.look_ups for path, _ in look_up.files]
                    note(*its_files)  # a worker may have read them
                    called_files.update(its_files)
                failed = failed or result.failed
                if show is not None:
                    show(result.report, result.lines)
    except KeyboardInterrupt as stop:
        stopped = stop
    except ClusterError as error:
        broken_off = str(error)
        tell(broken_off)
    return Checked(spool.files, spool.lines, called, stopped, failed, broken_off, called_files)


def outcome(task: Task, most: int = files.LARGEST, data: bytes | None = None) -> Outcome:
    """Return the outcome of the check of a file, or of its bytes if they were read before; raises nothing."""
    try:
        data = files.read_program(task.path, most) if data is None else data
        checked, source, called, basis = _check(task, data)
    except (SourceError, TooHardError) as error:
        return unreadable(task, str(error), data)
    except MemoryError:
        failed = unreadable(task, f"{task.title}: there is not enough memory to check it", data)
        return msgspec.structs.replace(failed, short_of_memory=True)
    except Exception as error:
        error.add_note(f"while checking {task.title}")
        failed = unreadable(task, f"a fault of polarcheck: {type(error).__name__}: {error}", data)
        return msgspec.structs.replace(failed, failure="", bug=error)
    report = msgspec.structs.replace(checked, **_of_task(task, data))
    lines = _lines(source, checked) if checked.findings else {}
    return Outcome(report, lines, frozenset(called), fails(report, task.settings), basis=basis)


def unreadable(task: Task, failure: str, data: bytes | None = None) -> Outcome:
    """
    Return the outcome of a file that could not be read or checked.

    failure: in one line, why; data: its bytes, where they could be read.
    """
    report = FileReport(
        path=task.title,
        programs=[],
        blocks=0,
        sections=0,
        verdict=UNREADABLE,
        reason=failure.removeprefix(f"{one_line(task.title)}: "),
        findings=[],
        not_evaluated=[],
        **_of_task(task, data),
    )
    return Outcome(report, failure=failure)


def unreadable_folder(failure: str) -> Outcome:
    """Return the outcome of a folder that a walk could not read. failure: its path and why, as `plan` tells them."""
    path, _, reason = failure.rpartition(": ")
    report = FileReport(
        path=path, programs=[], blocks=0, sections=0, verdict=UNREADABLE, reason=reason, findings=[], not_evaluated=[]
    )
    return Outcome(report)


def _of_task(task: Task, data: bytes | None) -> dict[str, Any]:
    """Return the values of a report that hang on the bytes of a file and its settings, by their names."""
    return {
        "machine": task.settings.machine_id,
        "machine_file": task.settings.machine_file or msgspec.UNSET,
        "profile_sha256": task.settings.profile_sha256,
        "settings": task.settings.decided if task.settings.differs else msgspec.UNSET,
        "sha256": None if data is None else sha256_of(data),
    }


def fails(report: FileReport, settings: Settings) -> bool:
    """
    Return True if a file has a finding at or above fail_on, or is unverified and the settings are strict.

    With max_warnings, warnings are counted over the run instead (decisions.too_many_warnings).
    """
    severities = {finding.severity for finding in report.findings}
    if settings.decided.max_warnings is not None:
        severities.discard("warning")
    is_severe = any(SEVERITIES[severity] >= SEVERITIES.get(settings.fail_on, ERROR + 1) for severity in severities)
    return is_severe or (settings.strict and report.verdict == "unverified")


def _check(task: Task, data: bytes) -> tuple[FileReport, Source, set[str], Basis]:
    """The report, the text, the keys of the offsets that are called, where the job has any, and what this rests on."""
    settings = task.settings
    with time_limit(seconds_for(len(data), settings.job.run.max_seconds)) as limit, recorded() as read:
        runs = check.read(data, settings.machine, settings.job, task.title, settings.encoding)
        text: Text = runs[0][1]["text"]
        report = check.check_runs(runs, settings.rules, settings.severities, settings.inline, settings.deselected)
        if settings.doubtful:
            report = with_doubts(report, runs, settings.doubtful)
        for extra in settings.extras:
            report = extra(report, runs)
        if settings.baseline is not None:
            from polarcheck.checking.block_outline import with_outline

            report = with_outline(report, runs)
        offsets = _offsets(runs) if settings.job.tools else set()
        # Whoever has left something out because the time was over has done so before this moment.
        basis = Basis(None if limit.is_over() else digest(data), tuple(read.look_ups))
        return report, text.source, offsets, basis


def _offsets(runs: Sequence[tuple[str, Tables]]) -> set[str]:
    return {
        trace.tools.offset_key(number)
        for trace in (tables["trace"] for _, tables in runs)
        for number in trace.tools.called_offsets
    }


def _lines(text: Source, report: FileReport) -> dict[int, str]:
    numbers = {line for finding in report.findings for line in (finding.line, finding.section_line) if line is not None}
    return {line: text.line_text(line) for line in sorted(numbers) if line <= len(text.line_starts)}


def interrupted(reason: str, reports: Sequence[FileReport], tasks: Sequence[Task]) -> Interrupted:
    """Return what a report says of a run that ended before its last file."""
    reported = {file.path for file in reports}
    next_path = next((task.title for task in tasks if task.title not in reported), None)
    return Interrupted(reason=reason, checked=len(reports), planned=len(tasks), next_path=next_path)


def report(
    reports: Sequence[FileReport],
    machine: str,
    settings: RunSettings | None = None,
    interrupted: Interrupted | None = None,
    skipped: Sequence[Skipped] = (),
    called_files: Collection[str] = (),
    assumed: Sequence[Assumed] = (),
) -> Report:
    """
    Return the report over all files.

    machine: what a report without files is for. settings: what decided. interrupted: why files are missing.
    skipped: what the walks did not read. called_files: subprograms that were executed where programs call them.
    assumed: what unsafe fixes have written before.
    """
    severities, verdicts, machines, silenced = Counter[str](), Counter[str](), set[tuple[str, str]](), 0
    for file in reports:  # once: it may not lie in memory
        severities.update(finding.severity for finding in file.findings)
        verdicts[file.verdict] += 1
        if file.verdict != UNREADABLE:
            machines.add((file.machine, file.machine_file or ""))
        silenced += len(file.silenced)
    machines = machines or {(machine, "")}
    summary = Summary(
        files=len(reports),
        errors=severities["error"],
        warnings=severities["warning"],
        notes=severities["note"],
        silenced=silenced,
        passed=verdicts["pass"],
        unverified=verdicts["unverified"],
        fail=verdicts["fail"],
        unreadable=verdicts[UNREADABLE],
    )
    if skipped:
        from polarcheck.files.batch import unread_programs

        skipped = unread_programs.never_called(skipped, called_files, files.RealPaths())
        not_read, excluded = unread_programs.by_ending(skipped), unread_programs.excluded(skipped)
        summary = msgspec.structs.replace(summary, not_read=not_read, excluded=excluded)
    return Report(
        schema=SCHEMA,
        tool=Producer("polarcheck", __version__),
        machine=machines.pop()[0] if len(machines) == 1 else None,
        settings=settings or RunSettings(version=__version__),
        interrupted=interrupted or msgspec.UNSET,
        assumed=[*assumed] or msgspec.UNSET,
        files=reports,
        summary=summary,
    )
