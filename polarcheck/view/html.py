"""The report as a page that needs no network: findings as a table, and pictures of the polar sections."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from polarcheck.foundation.finding import Report
    from polarcheck.reports import Background


def html(report: Report, background: Background) -> str:
    """Return one page for all files; it contains plotly if anything is drawn."""
    from polarcheck.reports.pages.unread import unread
    from polarcheck.view.page import page
    from polarcheck.view.page_data import picture
    from polarcheck.view.plotly_script import library

    pictures = [picture(file, background) for file in report.files]
    drawn = library() if any(picture.sections for picture in pictures) else ""
    return page(pictures, drawn, notes=unread(report.summary))
