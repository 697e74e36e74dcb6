"""Prepares the background of the reports of a run, and writes the reports that go to files."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

from polarcheck.commands.options import option
from polarcheck.foundation.errors import OutputError, UsageError, why

if TYPE_CHECKING:
    from polarcheck.checking.settings import Extra
    from polarcheck.files.batch.tasks import Task
    from polarcheck.foundation.finding import Report, Summary
    from polarcheck.reports import Background

#: The variable with the file of a step's summary in GitHub Actions, and the format for GitHub Actions.
STEP_SUMMARY, _OF_GITHUB = "GITHUB_STEP_SUMMARY", "github"
#: Formats that can hold counts in place of findings.
_WITH_COUNTS = ("text", "short", "concise", "json", "jsonl")

statistics = option("--statistics", is_flag=True, help="How often each rule speaks, in place of the findings.")


show_files = option(
    "--show-files",
    "lists_files",
    is_flag=True,
    help="Which files are read and which are not, with the reason; no check.",
)


def refuse(form: str | None, wants_statistics: bool) -> None:
    """Raise UsageError if counts are requested in a format that cannot hold them."""
    if wants_statistics and form not in (None, *_WITH_COUNTS):
        raise UsageError(f"--statistics: expected --format {', '.join(_WITH_COUNTS)}, found {form}")


#: The format for people in which there is room for paths and for what a section makes.
_TEXT = "text"
paths = option("--show", "shown_too", type=click.Choice(["path"]), help="In text, the paths of each section, too.")


def extras(shown_too: str | None, form: str | None, outputs: Iterable[tuple[str, Path]]) -> tuple[Extra, ...]:
    """Return the functions that add paths to reports. Raises UsageError for a format that cannot show paths."""
    if shown_too is None:
        return ()
    for extra in (form or _TEXT, *(form for form, _ in outputs)):
        if extra != _TEXT:
            raise UsageError(f"--show {shown_too}: expected --format {_TEXT}, found {extra}")
    from polarcheck.view.section_view import with_views

    return (with_views,)


def with_makes(tasks: Sequence[Task], forms: Iterable[str]) -> list[Task]:
    """Return the tasks; if any of these formats is text, their reports say in one line what a section makes."""
    if _TEXT not in forms:
        return list(tasks)
    import msgspec

    from polarcheck.files.batch.tasks import with_settings
    from polarcheck.reports.made_parts.makes import with_makes

    return with_settings(
        tasks, lambda settings: msgspec.structs.replace(settings, extras=(*settings.extras, with_makes))
    )


def unread(summary: Summary) -> list[str]:
    """Return what the walks through folders did not read, in words."""
    if not (summary.not_read or summary.excluded):
        return []
    from polarcheck.reports.pages import unread

    return unread.unread(summary)


def background(plain: Background, tasks: Iterable[Task]) -> Background:
    """Add the settings of each file, and the folders that paths are relative to, to a background."""
    from polarcheck.files.batch.batch_run import folders
    from polarcheck.files.batch.tasks import settings_of

    root, folder = folders()
    return plain._replace(settings=settings_of(tasks), root=root, folder=folder)


def written(outputs: Iterable[tuple[str, Path]], form: str, report: Report, plain: Background) -> Iterator[OutputError]:
    """Write the reports that go to files, and the summary of GitHub Actions; yield the errors."""
    from polarcheck import reports
    from polarcheck.program.reading import files

    forms = [form]
    for kind, path in outputs:
        forms.append(kind)
        try:
            files.write(path, reports.pieces(kind, report, plain))
        except OutputError as error:
            yield error
    summary = os.environ.get(STEP_SUMMARY)
    if summary and _OF_GITHUB in forms:
        try:
            if reason := files.read_by_this_run(Path(summary)):
                raise ValueError(reason)
            _append(summary, report, plain)
        except (OSError, ValueError) as error:
            yield OutputError(f"{STEP_SUMMARY}: {files.display_path(summary)}: {why(error)}")


def _append(path: str, report: Report, plain: Background) -> None:
    """Append the summary to the file of the step, which other commands may have written to."""
    from polarcheck.reports.ci.step_summary import LARGEST, step_summary

    with Path(path).open("ab") as file:
        file.write(step_summary(report, plain, LARGEST - file.tell()).encode())
