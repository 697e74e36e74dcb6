"""The check of programs."""

from __future__ import annotations

import warnings
from collections.abc import Iterable
from typing import Unpack

from polarcheck.api.keywords import CheckKeywords, PathName, options, paths_of, takes
from polarcheck.api.loaded_program import NAMELESS, Call
from polarcheck.api.values import flag, names, whole
from polarcheck.files.baselines.baselines import Baselines
from polarcheck.files.batch import batch_run
from polarcheck.files.batch import tasks as batch
from polarcheck.files.batch.differing_settings import with_own_settings
from polarcheck.files.batch.tasks import Outcome, Task
from polarcheck.files.settings.decisions import shared
from polarcheck.files.settings.of_programs import OfPrograms
from polarcheck.foundation.errors import PolarcheckWarning, SourceError
from polarcheck.foundation.finding import FileReport, Report
from polarcheck.program.machines import profiles
from polarcheck.program.reading import files
from polarcheck.program.reading.walking import Skipped

_FUNCTION = "polarcheck.check()"


@takes(CheckKeywords)
def check(
    paths: PathName | Iterable[PathName],
    *,
    extensions: str | Iterable[str] = (),
    exclude: str | Iterable[str] = (),
    force_exclude: bool = False,
    processes: int = 1,
    max_size: int = files.LARGEST,
    **keywords: Unpack[CheckKeywords],
) -> Report:
    """
    Check programs: files, and folders with all programs in them. The report holds one entry for each program.

    Neither a finding nor a file that cannot be read is an exception: such a file has the verdict unreadable. A folder
    without programs, a pattern that matches none and a job file that leaves another behind are told by a
    PolarcheckWarning.

    paths: one path or several; a program that several of them lead to is checked once.
    extensions: endings of the programs in folders, in place of .nc, .tap and others.
    exclude: patterns of programs that no walk through a folder finds, beside those of job files.
    force_exclude: what is excluded is left out even where it is named.
    processes: how many check; 1 for this one alone. More need a main module that can be imported (multiprocessing).
    max_size: a larger file is not read [bytes].

    Raises UsageError, JobError or MachineError for a wrong setting, BaselineError for a wrong baseline and SourceError
    for a folder that cannot be read, or that all programs of are excluded, before any file is checked.
    """
    count = whole(f"{_FUNCTION}: processes", processes, 1, 1)
    most = whole(f"{_FUNCTION}: max_size", max_size, 0, files.LARGEST)
    is_forced = flag(f"{_FUNCTION}: force_exclude", False if force_exclude is None else force_exclude)
    endings = names(f"{_FUNCTION}: extensions", extensions)
    patterns = names(f"{_FUNCTION}: exclude", exclude)
    named = paths_of(_FUNCTION, paths)
    settings_of = OfPrograms(options(_FUNCTION, CheckKeywords, keywords, exclude=patterns))
    skipped: list[Skipped] = []
    planned = batch_run.planned(named, settings_of, endings, force_exclude=is_forced, skipped=skipped)
    tasks, failures = planned.tasks, [*planned.failures, *planned.nothing]
    for doubt in planned.doubts:
        warnings.warn(doubt, PolarcheckWarning, stacklevel=2)
    if failures:
        raise SourceError(failures[0])
    settings = shared(task.settings for task in tasks)
    if settings.differing:
        tasks = with_own_settings(tasks)
    baselines = Baselines(tasks, named) if any(task.settings.baseline for task in tasks) else None
    with batch_run.outcomes(tasks, most, count) as outcomes:
        reports = [_report(outcome) for outcome in (baselines.outcomes(outcomes) if baselines else outcomes)]
    for doubt in (*baselines.faults, *baselines.leftovers) if baselines else ():
        warnings.warn(doubt, PolarcheckWarning, stacklevel=2)
    machine = tasks[0].settings.machine_id if tasks else profiles.DEFAULT
    return batch.report(reports, machine, settings, skipped=skipped)


def _report(outcome: Outcome) -> FileReport:
    if outcome.bug is not None:
        raise outcome.bug
    assert outcome.report is not None  # a file that cannot be read has one, too
    return outcome.report


@takes(CheckKeywords)
def check_text(text: str | bytes, *, name: str = NAMELESS, **keywords: Unpack[CheckKeywords]) -> FileReport:
    """
    Check a text, as `check` does a file.

    name: the path that it is reported as, and by which entries of a job file apply to it. No job file is read unless
        `config` names one, or use_config=True asks for the one nearest to this path.

    A text whose check takes too long has the verdict unreadable.

    Raises UsageError, JobError or MachineError for a wrong setting, BaselineError for a wrong baseline.
    """
    call = Call("polarcheck.check_text()", CheckKeywords, keywords)
    _, data, settings = call.of_text(text, name)
    task = Task(call.name_of(name), settings)
    report = _report(batch.outcome(task, data=data))
    return report if settings.baseline is None else Baselines([task], []).without_known(report)
