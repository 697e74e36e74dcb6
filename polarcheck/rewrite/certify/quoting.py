"""Files outside of the folder of the manifest and of the working folder: a certificate quotes no text of them."""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from pathlib import Path

import msgspec

from polarcheck.foundation.finding import FileReport, Finding, NotEvaluated
from polarcheck.program.reading import files
from polarcheck.rules.rule import load_all


def outside(folders: Iterable[Path], paths: Iterable[str | os.PathLike[str]]) -> list[str]:
    """Return the files and pipes among the paths that lie below none of the folders, through links, each once."""
    real = [os.path.realpath(folder) for folder in folders]
    elsewhere: dict[str, str] = {}
    for path in paths:
        target = os.path.realpath(path)
        if any(Path(target).is_relative_to(folder) for folder in real) or os.path.isdir(target):  # noqa: PTH112
            continue
        if os.path.exists(target):  # noqa: PTH110  Path.exists raises for some names
            elsewhere.setdefault(target, files.display_path(os.fspath(path)))
    return list(elsewhere.values())


def remark(names: Sequence[str]) -> str:
    """Return one line on files whose text is not quoted."""
    return (
        f"nothing is quoted of {', '.join(names)}, outside of the folder of the manifest and of the working folder; "
        "certify in a folder above it says more"
    )


def without_text(report: FileReport) -> FileReport:
    """Return a report with the titles of rules in place of their messages."""
    return msgspec.structs.replace(
        report,
        findings=[_finding(finding) for finding in report.findings],
        not_evaluated=[_gap(gap) for gap in report.not_evaluated],
    )


def _finding(finding: Finding) -> Finding:
    # The block is compared with expected ones, and is not shown.
    title = load_all()[finding.rule].title
    return msgspec.structs.replace(finding, message=title, channel=msgspec.UNSET)


def _gap(gap: NotEvaluated) -> NotEvaluated:
    return msgspec.structs.replace(gap, reason=f"{gap.rule} is not evaluated")
