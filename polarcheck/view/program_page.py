"""The page with the picture of one program, for whoever shows a page and nothing else, as an editor does."""

from __future__ import annotations

from collections.abc import Sequence

from polarcheck.foundation.finding import FileReport
from polarcheck.reports import Background
from polarcheck.rules.tables import Tables
from polarcheck.view import page_data
from polarcheck.view.page import page
from polarcheck.view.plotly_script import library
from polarcheck.view.run_drawing import drawn, split


def program_page(
    report: FileReport, runs: Sequence[tuple[str, Tables]], background: Background, script: str = "", sources: str = ""
) -> str:
    """
    Return the page of a program: HTML that needs no network, or with an address that loads plotly from there.

    runs: as the check has run the program.
    script, sources: the address of plotly, and the sources of scripts that the policy of the page allows.

    Raises TooHardError where the drawing takes too long.
    """
    report, drawing = split(drawn(report, runs))
    if drawing is not None:
        background = background._replace(drawn={report.path: drawing})
    plot = page_data.picture(report, background)
    return page([plot], script_path=script, sources=sources) if script else page([plot], library())
