"""Many files to one report."""

from __future__ import annotations

import gc
import os
from collections.abc import Callable, Iterable, Sequence

import msgspec

from polarcheck import __version__
from polarcheck.checking import check
from polarcheck.checking.finding import FileReport, Producer, Report, Summary
from polarcheck.checking.settings import Settings
from polarcheck.checking.tables import Tables
from polarcheck.errors import SourceError, TooHardError
from polarcheck.reading import files
from polarcheck.reading.source import Source
from polarcheck.reading.words import Text
from polarcheck.time_limit import seconds_for, time_limit

SCHEMA = 1

Tell = Callable[[str], None]


class Task(msgspec.Struct, frozen=True):
    """A file to check and what applies to it."""

    path: str
    settings: Settings


class Checked(msgspec.Struct, frozen=True):
    """
    The reports of the files that could be read, and by path and number the lines that their findings stand in.

    called: keys of the offsets that any of the programs calls, where it has a job with tools. stopped: by what the
    check was interrupted; the files that were finished before that are here. failed: whether any of them fails, by the
    severity that its own settings name and, where these are strict, by being unverified.
    """

    files: list[FileReport]
    lines: dict[str, dict[int, str]]
    called: set[str]
    stopped: KeyboardInterrupt | None = None
    failed: bool = False


def plan(
    paths: Iterable[str], settings_of: Callable[[str], Settings], extensions: Sequence[str], tell: Tell, warn: Tell
) -> list[Task]:
    """
    The programs of files, folders and standard input (`-`), each once, in the order asked for.

    Paths that mean the same file are one program, under the first of them; where links lead to it from folders with
    settings of their own, one for each of these.

    settings_of: what applies to a program; a path that ends in a separator is a folder, of which the extensions are
    asked. tell is told of folders that cannot be read, warn of those without programs. Raises a PolarcheckError for
    settings that cannot be used, before any file is checked.
    """
    tasks: dict[tuple[str, int], Task] = {}
    real = files.RealPaths()
    for path in paths:
        found, failures = [path], list[str]()
        if path != files.STANDARD_INPUT and os.path.isdir(path):  # noqa: PTH112  Path.is_dir raises for some names
            own = settings_of(os.path.join(path, "")).job.extensions  # noqa: PTH118
            wanted = files.extensions(extensions or own) or files.EXTENSIONS
            found = list(files.walk(path, wanted, failures.append))
            for failure in failures:
                tell(failure)
            if not found and not failures:
                warn(f"{files.shown(path)}: no NC programs in this folder; --extensions names other endings")
        for program in found:
            settings = settings_of(program)
            tasks.setdefault((real.of(program), id(settings)), Task(program, settings))
    return list(tasks.values())


def check_files(
    tasks: Iterable[Task],
    tell: Tell,
    bug: Callable[[Exception], None],
    most: int = files.LARGEST,
) -> Checked:
    """
    Check one file after the other; what is wrong with one costs that file only.

    tell is told, in one line, of those that cannot be read or are too hard, bug of what polarcheck itself does wrong.
    most: bytes of a file; a larger one is not read.
    """
    reports: list[FileReport] = []
    lines: dict[str, dict[int, str]] = {}
    called: set[str] = set()
    stopped = None
    failed = False
    try:
        for number, task in enumerate(tasks):
            if number:
                # The command line keeps the collector off. What the last file has left behind is young, then: to
                # find it costs nothing of what is older, and without it no table of any file would ever be freed.
                gc.collect(0)
            try:
                found, source, offsets = _check(task, files.read(task.path, most))
            except (SourceError, TooHardError) as error:
                tell(str(error))
            except MemoryError:
                tell(f"{files.shown(task.path)}: there is not enough memory to check it")
            except Exception as error:
                error.add_note(f"while checking {files.shown(task.path)}")
                bug(error)
            else:
                verdict = check.verdict(found.findings, found.not_evaluated, task.settings.fail_on)
                reports.append(msgspec.structs.replace(found, machine=task.settings.name, verdict=verdict))
                failed = failed or fails(reports[-1], task.settings)
                if found.findings:
                    lines[found.path] = _lines(source, found)
                called |= offsets
    except KeyboardInterrupt as stop:
        stopped = stop
    return Checked(reports, lines, called, stopped, failed)


def fails(report: FileReport, settings: Settings) -> bool:
    """Whether a file has a finding at or above the severity that fails, or is unverified where that fails, too."""
    told = any(check.is_told(found, settings.fail_on) for found in report.findings)
    return told or (settings.strict and report.verdict == "unverified")


def _check(task: Task, data: bytes) -> tuple[FileReport, Source, set[str]]:
    """The report, the text, and the keys of the offsets that are called, where the job has any."""
    path, settings = files.shown(task.path), task.settings
    with time_limit(seconds_for(len(data), settings.job.run.max_seconds)):
        found = check.read(data, settings.machine, settings.job, path, settings.encoding)
        text: Text = found[0][1]["text"]
        report = check.check_runs(found, settings.rules, settings.severities)
        return report, text.source, _offsets(found) if settings.job.tools else set()


def _offsets(found: Sequence[tuple[str, Tables]]) -> set[str]:
    return {
        trace.offset_key(number)
        for trace in (tables["trace"] for _, tables in found)
        for number in trace.called_offsets
    }


def _lines(text: Source, found: FileReport) -> dict[int, str]:
    numbers = {line for finding in found.findings for line in (finding.line, finding.section_line) if line is not None}
    return {line: text.line_text(line) for line in sorted(numbers) if line <= len(text.line_starts)}


def report(reports: list[FileReport], machine: str) -> Report:
    """The report over all files; machine: what a report without files is for."""
    severities = [finding.severity for file in reports for finding in file.findings]
    verdicts = [file.verdict for file in reports]
    machines = {file.machine for file in reports} or {machine}
    summary = Summary(
        files=len(reports),
        errors=severities.count("error"),
        warnings=severities.count("warning"),
        notes=severities.count("note"),
        silenced=sum(len(file.silenced) for file in reports),
        passed=verdicts.count("pass"),
        unverified=verdicts.count("unverified"),
        fail=verdicts.count("fail"),
    )
    return Report(
        schema=SCHEMA,
        tool=Producer("polarcheck", __version__),
        machine=machines.pop() if len(machines) == 1 else None,
        files=reports,
        summary=summary,
    )
