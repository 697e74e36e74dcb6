"""Reports as text in the formats of the command line."""

from __future__ import annotations

from polarcheck import reports
from polarcheck.api.values import choice
from polarcheck.files.batch import tasks as batch
from polarcheck.files.batch.batch_run import folders
from polarcheck.foundation.errors import UsageError
from polarcheck.foundation.finding import FileReport, Report
from polarcheck.reports import Background
from polarcheck.rules import rule


def render(report: Report | FileReport, form: str = "text") -> str:
    """
    Return a report as text, as the command line writes it with --format.

    report: of `check` or `check_text`.
    form: text, short, concise, json, jsonl, sarif, junit, gitlab, github or checkstyle. Text for people is not in
        color, and shows no lines of the programs, which a report does not hold. Formats of CI name files from the root
        of the repository around the working folder.

    Raises UsageError for another format.
    """
    forms = [name for name in reports.formats() if name not in reports.PER_FILE]
    form = choice("polarcheck.render(): form", form, forms, "text")
    if isinstance(report, FileReport):
        report = batch.report([report], report.machine)
    if not isinstance(report, Report):
        raise UsageError(f"polarcheck.render(): expected a report of check, found {type(report).__name__}")
    root, folder = folders()
    return reports.render(form, report, Background(rules=rule.load_all(), root=root, folder=folder))
