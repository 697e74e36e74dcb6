"""`polarcheck certify`: checks the programs that a post makes for each control against a manifest."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click
from click.core import ParameterSource

from polarcheck.commands import options
from polarcheck.commands.exit_codes import BUG, CLEAN, COULD_NOT_RUN, FINDINGS
from polarcheck.commands.options import narrower, option
from polarcheck.commands.output import COLUMNS
from polarcheck.foundation.errors import UsageError

if TYPE_CHECKING:
    from collections.abc import Mapping

    from polarcheck.checking.settings import Settings
    from polarcheck.rewrite.certify.certifying import Certified
    from polarcheck.rewrite.certify.loading import Loaded
    from polarcheck.rewrite.certify.results import Certificate

_INIT = "init"
_FORMATS = ("text", "json", "html")


@click.command(short_help="Check the programs of a post for each control against a manifest.")
@click.argument("manifest", metavar="FILE")
@click.argument("folder", required=False, metavar="[FOLDER]", type=click.Path(file_okay=False, path_type=Path))
@narrower("--format", "form", type=click.Choice(_FORMATS), default="text", show_default=True)
@options.outputs(_FORMATS)
@option("--strict/--no-strict", default=False, help="Fail where a feature has no case on a control, too.")
@click.option("--update", is_flag=True, help="Write the golden traces of cases that pass otherwise.")
@option("--case", "names", multiple=True, metavar="TEXT", help="Only this case; may be repeated.")
@option("--machine", "machines", multiple=True, metavar="NAME|FILE", help="With init: a control; may be repeated.")
@options.color
@options.max_size
@options.debug
@click.pass_context
def certify(
    ctx: click.Context,
    /,
    manifest: str,
    folder: Path | None,
    machines: tuple[str, ...],
    **arguments: Any,
) -> None:
    """
    Check the programs of a post against FILE, a manifest: it says what a program of each feature and control must do.

    \b
    polarcheck certify post.toml
    polarcheck certify post.toml -o html:certificate.html
    polarcheck certify post.toml --update
    polarcheck certify init suite --machine fanuc-30i --machine siemens-transmit

    Shown is a matrix, features down and controls across: pass, no golden trace (before the first --update), fail, not
    run, missing (no case), not offered. A case passes if its program has the expected verdict and findings, makes the
    expected part, and runs the path of its golden trace or of another case.

    --update writes the golden traces anew and says what changes; of a case that fails otherwise it keeps the old one.
    init writes a folder with small jobs to post, as drawings in words and DXF, and a manifest for them.

    Ends with 0 if all cases pass; 1 if one fails or has no golden trace, or with --strict a feature is missing; 2 if a
    program could not be read, or the manifest cannot be used; 3 for a bug.
    """
    if manifest == _INIT and folder is not None:
        ctx.exit(_init(folder, machines))
    if folder is not None:
        raise UsageError(f"{folder}: expected one manifest; `certify init DIR` writes a new folder")
    if ctx.get_parameter_source("machines") is ParameterSource.COMMANDLINE:
        raise UsageError("--machine: is for `certify init DIR`; the manifest names the machine of each control")
    if manifest == _INIT and not Path(manifest).exists():
        raise UsageError("init: give a folder: polarcheck certify init DIR")
    ctx.exit(_certify(Path(manifest), debug=options.DEBUG in ctx.meta, **arguments))


def _certify(
    path: Path,
    *,
    form: str,
    outputs: list[tuple[str, Path]],
    strict: bool,
    update: bool,
    names: tuple[str, ...],
    color: str,
    max_size: int,
    debug: bool,
) -> int:
    from polarcheck.commands.output import bug_lines, columns, in_color, say_lines, show, warn
    from polarcheck.commands.progress import Bar
    from polarcheck.foundation.memory import keep_within_memory
    from polarcheck.program.reading import files
    from polarcheck.rewrite.certify import certifying, loading
    from polarcheck.rewrite.certify.results import NOT_RUN

    keep_within_memory()
    loaded = loading.load(path)
    for line in loaded.without_programs():
        warn(line)
    chosen = certifying.chosen(loaded, names)
    settings = certifying.conditions(loaded, certifying.needed(loaded, chosen))
    _refuse(outputs, loaded, settings)
    bar = Bar(len(settings), True)
    case_runs = dict(bar.watched(certifying.runs(loaded, settings, max_size)))
    bugs = [run.bug for run in case_runs.values() if run.bug is not None]
    for bug in bugs:
        say_lines(bug_lines(bug, debug))
    certified = certifying.certified_cases(loaded, settings, case_runs)
    status = CLEAN
    if update:
        _update(loaded, certified, frozenset(chosen))
        certified = certifying.certified_cases(loaded, settings, case_runs)
    certificate = certifying.certificate(loaded, {name: certified[name] for name in certified if name in chosen})
    for extra_form, output in outputs:
        files.write(output, _report(certificate, extra_form))
    is_colored = in_color(color)
    report = _report(certificate, form, columns(), is_colored)
    show(report if form == "text" else report.encode(), is_colored or None)
    counts = certificate.summary
    if counts.fail or counts.no_golden or (strict and counts.missing):
        status = max(status, FINDINGS)
    if any(case.state == NOT_RUN for case in certificate.cases):
        status = max(status, COULD_NOT_RUN)
    return BUG if bugs else status


def _refuse(outputs: list[tuple[str, Path]], loaded: Loaded, settings: Mapping[str, Settings]) -> None:
    """
    Raise OutputError for a report that would overwrite a file of the certification, or another report.

    All files that the manifest names count, those of cases that are not run, too.
    """
    from polarcheck.commands import overwriting
    from polarcheck.files.batch.tasks import Task
    from polarcheck.foundation import record
    from polarcheck.foundation.errors import OutputError
    from polarcheck.program.reading.files import display_path

    named = [file for case in loaded.cases.values() for file in (case.program, case.golden) if file is not None]
    record.note(*map(loaded.beside, [*named, *loaded.named_files()]))
    tasks = [Task(str(loaded.beside(loaded.cases[name].program)), of_case) for name, of_case in settings.items()]
    overwriting.refuse([output for _, output in outputs], tasks)
    goldens = {os.path.realpath(loaded.beside(case.golden)) for case in loaded.cases.values() if case.golden}
    for _, output in outputs:
        if os.path.realpath(output) in goldens:
            raise OutputError(f"-o {display_path(output)}: is a golden trace of the manifest; name another file")


def _update(loaded: Loaded, certified: dict[str, Certified], chosen: frozenset[str]) -> None:
    """Write the golden traces; say what changes."""
    from polarcheck.commands.output import say_lines, warn
    from polarcheck.rewrite.certify.updating import updates

    any_golden = False
    for line, _ in updates(loaded, certified, chosen):
        any_golden = True
        say_lines([line])
    if not any_golden:
        warn("--update: no case has a golden trace; `golden = FILE` names one")


def _report(certificate: Certificate, form: str, columns: int = COLUMNS, is_colored: bool = False) -> str:
    """Return the report in a format."""
    if form == "html":
        from polarcheck.rewrite.certify.certificate_page import html

        return html(certificate)
    if form == "json":
        from polarcheck.reports.json import encoded

        return f"{encoded(certificate, indent=2)}\n"
    from polarcheck.reports import painted
    from polarcheck.reports.pages.painting import plain
    from polarcheck.rewrite.certify.certificate_text import text

    return text(certificate, columns, painted if is_colored else plain)


def _init(folder: Path, machines: tuple[str, ...]) -> int:
    from polarcheck.commands.output import show
    from polarcheck.program.reading.excerpt import head
    from polarcheck.rewrite.certify import suite

    written = suite.write(folder, machines)
    manifest, words, *drawings = map(head, written)
    show(
        f"{manifest}: the manifest; fill in the title, and the file names of the programs\n"
        f"{words}: the jobs in words, to be programmed once and posted for each control\n"
        f"{len(drawings)} drawings beside it\n"
        f"then: polarcheck certify {manifest}\n"
    )
    return CLEAN
