"""`polarcheck compare`: whether two revisions of a program make the same metal, and where they differ."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import click

from polarcheck.commands import options
from polarcheck.commands.options import option
from polarcheck.foundation.errors import PolarcheckError, TooHardError, UsageError, counted

if TYPE_CHECKING:
    from polarcheck.commands.running import Faults
    from polarcheck.files.batch.tasks import Task
    from polarcheck.files.settings.of_programs import OfPrograms
    from polarcheck.rewrite.compare.comparison_report import Comparison
    from polarcheck.rewrite.compare.revision_comparison import Revision

#: What git gives a diff driver: path, then file, hash and mode of both sides.
_GIT_ARGUMENTS = 7


class _Pair(NamedTuple):
    """Two files; named: the file whose settings apply to both, empty for those of each."""

    old: str
    new: str
    named: str = ""


@click.command(short_help="Compare two revisions of a program: metal, not text.")
@click.argument("paths", nargs=-1, required=True, metavar="OLD NEW")
@options.executing("programs")
@option("--old-machine", metavar="NAME|FILE", help="The lathe of OLD, in place of --machine.")
@option("--new-machine", metavar="NAME|FILE", help="The lathe of NEW, in place of --machine.")
@click.option(
    "--tolerance", "same_up_to", type=float, callback=options.length_up_to(10.0, 0.002), metavar="LENGTH",
    show_default="the least increment of the control",
    help="Up to this, lengths are the same, in the units of OLD.",
)  # fmt: skip
@options.text_or_json
@options.color
@option("--settings-of", "named", metavar="FILE", help="Use the settings of this program for both, as a difftool does.")
@option("--git", "is_git", is_flag=True, help="Take the seven arguments that git gives a diff driver; end with 0.")
@options.extensions
@options.max_size
@options.debug
@click.pass_context
def compare(ctx: click.Context, /, paths: tuple[str, ...], **arguments: Any) -> None:
    """
    Compare two revisions of a program, or the programs of two folders, by what they do at the lathe.

    \b
    polarcheck compare O1234.NC.orig O1234.NC
    polarcheck compare archive/ posted/ --tolerance 0.002
    polarcheck compare haas.nc okuma.nc --old-machine haas-lathe --new-machine okuma-osp

    It says that they are the same but for block numbers, the same metal, or where they differ: the largest deviation of
    the path of the tool center, by which blocks, depth, F, the state at the beginning of sections, time and rate of C,
    sections that are added, missing or moved, and orders such as M8. What could not be compared is named with its
    reason. Numbers of old stand before those of new.

    Ends with 0 for the same metal; 1 where it differs; 2 where something could not be compared or read; 3 for a bug.
    """
    ctx.exit(_compare(paths, **arguments))


def _compare(
    paths: tuple[str, ...],
    *,
    old_machine: str | None,
    new_machine: str | None,
    same_up_to: float | None,
    form: str,
    color: str,
    named: str | None,
    is_git: bool,
    extensions: tuple[str, ...],
    max_size: int,
    no_config: bool,
    machine: str | None,
    **arguments: Any,
) -> int:
    from polarcheck.commands.exit_codes import CLEAN, COULD_NOT_RUN, FINDINGS
    from polarcheck.commands.output import in_color, show
    from polarcheck.commands.running import Faults
    from polarcheck.files.settings.of_programs import OfPrograms, Options
    from polarcheck.foundation.memory import keep_within_memory
    from polarcheck.program.reading.excerpt import head
    from polarcheck.reports import painted
    from polarcheck.reports.pages.painting import plain
    from polarcheck.rewrite.compare import comparison_page as page
    from polarcheck.rewrite.compare.comparison_report import DIFFERS, NOT_COMPARED

    keep_within_memory()
    pair = _arguments(paths, named or "", is_git)
    if os.devnull in (pair.old, pair.new):
        # git has a new or a deleted file.
        side = "new" if pair.old == os.devnull else "old"
        show(f"{head(pair.named or getattr(pair, side))}: only in the {side} revision\n")
        return CLEAN if is_git else FINDINGS
    faults = Faults(bool(arguments.pop("debug", False)))
    settings = [
        OfPrograms(Options(machine=machine_of_side or machine, use_config=not no_config, **arguments))
        for machine_of_side in (old_machine, new_machine)
    ]
    pairs, only_old, only_new = _files(pair, settings, extensions, faults)
    comparisons = []
    for old, new in pairs:
        try:
            comparisons.append(_compared(old, new, same_up_to, max_size))
        except TooHardError as error:
            faults.failures.append(f"{old.title} | {new.title}: {error}")
        except PolarcheckError as error:
            faults.failures.append(str(error))
    if form == "json":
        show(page.json([comparison for comparison, _ in comparisons], only_old, only_new))
    else:
        has_color = in_color(color)
        for comparison, inch in comparisons:
            show(page.text(comparison, inch=inch, paint=painted if has_color else plain), has_color or None)
        show(page.single_files(only_old, only_new))
    verdicts = {comparison.verdict for comparison, _ in comparisons}
    status = FINDINGS if DIFFERS in verdicts or only_old or only_new else CLEAN
    status = max(status, COULD_NOT_RUN if NOT_COMPARED in verdicts else CLEAN, faults.report())
    # git takes any other code for a driver that has died.
    return CLEAN if is_git and status <= COULD_NOT_RUN else status


def _arguments(paths: Sequence[str], named: str, is_git: bool) -> _Pair:
    if is_git:
        if len(paths) < _GIT_ARGUMENTS:
            raise UsageError(f"--git: expected the {_GIT_ARGUMENTS} arguments that git gives, found {len(paths)}")
        return _Pair(paths[1], paths[4], named or paths[0])
    if len(paths) != 2:
        raise UsageError(f"compare: expected OLD and NEW, found {counted(len(paths), 'path')}")
    return _Pair(paths[0], paths[1], named)


def _files(
    pair: _Pair, settings: Sequence[OfPrograms], extensions: Sequence[str], faults: Faults
) -> tuple[list[tuple[Task, Task]], list[str], list[str]]:
    """The pairs of programs, and those of a folder that the other one does not have."""
    from polarcheck.commands.running import planned
    from polarcheck.program.reading.files import STANDARD_INPUT

    are_folders = [os.path.isdir(path) for path in pair[:2]]  # noqa: PTH112  Path.is_dir raises for some names
    if are_folders[0] != are_folders[1]:
        raise UsageError("compare: expected two programs or two folders")
    if pair.old == pair.new == STANDARD_INPUT:
        raise UsageError("compare: - can stand for one of the two programs only")
    if not are_folders[0]:
        return _of_files(pair, settings), [], []
    programs = [
        {os.path.relpath(task.path, folder): task for task in planned((folder,), of, extensions, faults)}
        for folder, of in zip(pair[:2], settings, strict=True)
    ]
    both = [(task, programs[1][name]) for name, task in programs[0].items() if name in programs[1]]
    only = [sorted(set(programs[side]) - set(programs[1 - side])) for side in (0, 1)]
    return both, only[0], only[1]


def _of_files(pair: _Pair, settings: Sequence[OfPrograms]) -> list[tuple[Task, Task]]:
    from polarcheck.files.batch.tasks import Task

    places = [pair.named or path for path in pair[:2]]
    if not pair.named:
        # A revision from elsewhere, as one that git has put in a folder of its own, has the settings of the other one.
        has_file = [of.applied(path).file.path is not None for of, path in zip(settings, places, strict=True)]
        if has_file[0] != has_file[1]:
            places = [places[has_file.index(True)]] * 2
    tasks = [Task(path, of(title)) for path, of, title in zip(pair[:2], settings, places, strict=True)]
    return [(tasks[0], tasks[1])]


def _compared(old: Task, new: Task, tolerance: float | None, max_size: int) -> tuple[Comparison, bool]:
    """The comparison of two programs, and whether its lengths are shown in inch."""
    from polarcheck.foundation.states import MM_PER_INCH, Units
    from polarcheck.foundation.time_limit import seconds_for, time_limit
    from polarcheck.program.reading import files
    from polarcheck.rewrite.compare.revision_comparison import compared, default_tolerance
    from polarcheck.rewrite.compare.terms import Terms

    data = [files.read_program(task.path, max_size) for task in (old, new)]
    seconds = max(task.settings.job.run.max_seconds for task in (old, new))
    with time_limit(seconds_for(sum(map(len, data)), 2 * seconds)):
        revisions = [_revision(task, text) for task, text in zip((old, new), data, strict=True)]
        units = revisions[0].trace.lengths.units
        inch = bool(len(units) and (units == Units.INCH).all())
        given = None if tolerance is None else tolerance * (MM_PER_INCH if inch else 1.0)
        length = given or default_tolerance(*revisions)
        return compared(revisions[0], revisions[1], Terms(length)), inch


def _revision(task: Task, data: bytes) -> Revision:
    from polarcheck.checking import check
    from polarcheck.rewrite.compare.revision_comparison import Revision

    settings = task.settings
    runs = check.read(data, settings.machine, settings.job, task.title, settings.encoding)
    return Revision(task.title, settings.machine_id, runs)
