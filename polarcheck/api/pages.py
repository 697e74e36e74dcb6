"""The page with pictures of a program."""

from __future__ import annotations

from typing import Unpack

from polarcheck import reports
from polarcheck.api.keywords import PartKeywords, PathName, takes
from polarcheck.api.loaded_program import NAMELESS, Call, Program
from polarcheck.checking import check
from polarcheck.files.batch import tasks as batch
from polarcheck.program.reading.files import LARGEST
from polarcheck.reports import Background
from polarcheck.rules import rule


@takes(PartKeywords)
def plot(path: PathName, *, max_size: int = LARGEST, **keywords: Unpack[PartKeywords]) -> str:
    """
    Return a page that shows what a program makes and how the tool runs, as HTML that needs no network.

    max_size: a larger file is not read [bytes].

    Raises SourceError if the file cannot be read, UsageError for a wrong keyword or if plotly is not installed,
    JobError or MachineError for a wrong setting, TooHardError if the program takes too long.
    """
    return _page(Call("polarcheck.plot()", PartKeywords, keywords).of_path(path, max_size))


@takes(PartKeywords)
def plot_text(text: str | bytes, *, name: str = NAMELESS, **keywords: Unpack[PartKeywords]) -> str:
    """
    Return such a page of a text, as `plot` does of a file.

    name: the path that it is reported as, and by which entries of a job file apply to it. No job file is read unless
        `config` names one, or use_config=True asks for the one nearest to this path.

    Raises as `plot` does.
    """
    return _page(Call("polarcheck.plot_text()", PartKeywords, keywords).of_text(text, name))


def _page(program: Program) -> str:
    from polarcheck.view.plotly_script import require
    from polarcheck.view.run_drawing import drawn, split

    require()
    settings = program.settings
    with program.runs() as runs:
        report = check.check_runs(runs, settings.rules, settings.severities, settings.inline, settings.deselected)
        report, drawing = split(drawn(report, runs))
    background = Background(
        rules=rule.load_all(),
        settings={report.path: settings},
        drawn={} if drawing is None else {report.path: drawing},
    )
    return reports.render("html", batch.report([report], settings.machine_id), background)
