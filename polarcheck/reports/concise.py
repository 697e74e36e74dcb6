"""One line for each finding, as compilers write them: editors and hooks know where to jump to."""

from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.reading.excerpt import visible

if TYPE_CHECKING:
    from polarcheck.checking.finding import Report
    from polarcheck.reports import Background


def concise(report: Report, background: Background | None = None) -> str:
    """`path:line:column: severity: message [rule]`, nothing else."""
    return "".join(
        visible(f"{file.path}:{found.line}:{found.column}: {found.severity}: {found.message} [{found.rule}]") + "\n"
        for file in report.files
        for found in file.findings
    )
