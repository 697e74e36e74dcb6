"""`check --diff` and `check --fix`: the fixes of the programs, shown or written, before they are checked."""

from __future__ import annotations

import contextlib
import functools
import gc
import io
import sys
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import click

from polarcheck.commands.exit_codes import BUG, CLEAN, COULD_NOT_RUN, FINDINGS
from polarcheck.commands.options import all_of, option
from polarcheck.commands.output import bug_lines, say, say_lines, show, show_diff, warn
from polarcheck.foundation.errors import OutputError, PolarcheckError, SourceError, TooHardError, UsageError

if TYPE_CHECKING:
    from polarcheck.files.batch.tasks import Task
    from polarcheck.foundation.finding import Assumed, FileReport
    from polarcheck.rewrite.fixes.fix_rounds import Outcome

#: The most fixes of a file that are listed.
_LISTED = 20
#: The options of fixes, which are left out of a command that repeats a report.
NAMES = ("fix", "unsafe_fixes", "diff", "backup")


class Wanted(NamedTuple):
    """
    The options of fixes.

    fix: write the fixes.
    unsafe_fixes: apply unsafe fixes, too.
    diff: show the fixes, and write nothing.
    backup: keep the original file.
    """

    fix: bool
    unsafe_fixes: bool
    diff: bool
    backup: bool


class Shown(NamedTuple):
    """
    The options of the output.

    quiet: show findings only.
    color: write in color.
    debug: show tracebacks.
    outputs: reports are written to files.
    """

    quiet: bool
    color: bool
    debug: bool
    outputs: bool


class Result(NamedTuple):
    """
    The result of the fixes.

    status: the exit code so far.
    fixed: the number of fixes that were written.
    assumed: the unsafe ones.
    ends: the command ends without a report.
    has_output: standard output holds a program, so that the report goes to standard error.
    """

    status: int = CLEAN
    fixed: int = 0
    ends: bool = False
    has_output: bool = False
    assumed: Sequence[Assumed] = ()


def wanted(function: Any) -> Any:
    """
    Add the options of fixes to a command, which takes them as one argument, `fixes`.

    The environment cannot set --fix or --unsafe-fixes: they change what the lathe cuts.
    """

    def collected(*arguments: Any, **options: Any) -> Any:
        return function(*arguments, fixes=Wanted(*(options.pop(name) for name in NAMES)), **options)

    functools.update_wrapper(collected, function)
    return all_of(
        click.option("--fix", is_flag=True, help="Write the safe fixes into the programs, then check them."),
        click.option("--unsafe-fixes", is_flag=True, help="With --fix or --diff: those that move otherwise, too."),
        option("--diff", is_flag=True, help="Show what --fix would change, and no report."),
        option("--backup", is_flag=True, help="With --fix, keep the old program as FILE.orig."),
    )(collected)


def run(
    wanted: Wanted,
    tasks: Sequence[Task],
    max_size: int,
    shown: Shown,
    suppress: Callable[[FileReport], FileReport] | None = None,
) -> Result:
    """
    Show or write the fixes of the programs, if requested.

    max_size: the largest size of a program [bytes].
    suppress: removes findings that must not be fixed from a report.

    Raises UsageError for options that exclude each other, SourceError if standard input cannot be read.
    """
    if wanted.diff and (wanted.fix or shown.outputs):
        raise UsageError(f"--diff shows what --fix would change, and writes nothing: leave out {_other(wanted)}")
    for name in ("unsafe_fixes", "backup"):
        if getattr(wanted, name) and not (wanted.fix or (wanted.diff and name == "unsafe_fixes")):
            warn(f"--{name.replace('_', '-')} does nothing without --fix")
    if not (wanted.fix or wanted.diff):
        return Result()
    from polarcheck.commands.progress import Bar

    work = _Work(wanted, max_size, shown, suppress)
    with contextlib.closing(Bar(len(tasks), not shown.quiet).watched(tasks)) as awaited:
        for task in awaited:
            work.do(task)
            gc.collect(0)
    if not shown.quiet:
        work.summarize()
    findings = FINDINGS if wanted.diff and work.count else CLEAN
    return Result(max(work.status, findings), work.count, wanted.diff, work.has_output, work.assumed)


def _other(wanted: Wanted) -> str:
    return "one of the two" if wanted.fix else "-o"


class _Work:
    """
    The pass over the programs.

    status: the exit code so far.
    count: the number of fixes.
    files: the number of files with fixes.
    left: the number of fixes that only --unsafe-fixes would apply.
    has_output: standard output holds a program.
    assumed: the unsafe fixes that were written.
    """

    def __init__(
        self,
        wanted: Wanted,
        most: int,
        shown: Shown,
        suppress: Callable[[FileReport], FileReport] | None,
    ) -> None:
        self.wanted, self.most = wanted, most
        self.shown, self.suppress = shown, suppress
        self.status = CLEAN
        self.count = self.files = self.left = 0
        self.has_output = False
        self.assumed: list[Assumed] = []

    def do(self, task: Task) -> None:
        """Fix one program; an error concerns this program only, and the report that follows says more."""
        from polarcheck.program.reading import files

        is_input = files.is_standard_input(task.path)
        try:
            data = files.read_program(task.path, self.most)
        except SourceError as error:
            if is_input:
                raise
            self._fail(error)
            return
        outcome = self._outcome(task, data, task.title)
        new = data if outcome is None else outcome.data
        if self.wanted.diff:
            self._show(task, data, outcome)
        elif is_input:
            show(new)
            self.has_output = True
            # Standard input can be read only once; the check that follows reads the fixed program.
            sys.stdin = io.TextIOWrapper(io.BytesIO(new))
        elif new != data and not self._written(task.path, data, new):
            return
        if outcome is not None:
            self._count(outcome, task.title)

    def _outcome(self, task: Task, data: bytes, path: str) -> Outcome | None:
        from polarcheck.rewrite.fixes.fix_rounds import with_fixes

        try:
            return with_fixes(
                data,
                task.settings,
                path,
                self.wanted.unsafe_fixes,
                self.suppress or (lambda report: report),
            )
        except (SourceError, TooHardError) as error:
            self._fail(error)
        except MemoryError:
            self._fail(SourceError(f"{path}: there is not enough memory to fix it"))
        except Exception as error:
            error.add_note(f"while fixing {path}")
            say_lines(bug_lines(error, self.shown.debug))
            self.status = BUG
        return None

    def _fail(self, error: PolarcheckError) -> None:
        """Report an error of a diff; otherwise the check that follows reports it."""
        if self.wanted.diff:
            say(str(error))
            self.status = max(self.status, COULD_NOT_RUN)

    def _written(self, path: str, old: bytes, new: bytes) -> bool:
        from polarcheck.program.reading.replacing import rewrite

        try:
            rewrite(path, old, new, keep=self.wanted.backup)
        except OutputError as error:
            say(str(error))
            self.status = max(self.status, COULD_NOT_RUN)
            return False
        return True

    def _show(self, task: Task, old: bytes, outcome: Outcome | None) -> None:
        from polarcheck.rewrite.fixes.difference import difference

        if outcome is None:
            return
        show_diff(difference(task.title, old, outcome.data, outcome.origin, task.settings.encoding), self.shown.color)

    def _count(self, outcome: Outcome, path: str) -> None:
        """List the applied and the refused fixes, with lines of the original file."""
        from polarcheck.foundation.finding import Assumed

        self.count += len(outcome.fixed)
        self.assumed += [
            Assumed(path=path, line=written.new_line, block=written.block, rule=written.rule, title=written.title)
            for written in outcome.assumed
        ]
        self.files += bool(outcome.fixed)
        self.left += outcome.left
        if not outcome.is_whole:
            warn(f"{path}: it takes too long to try all of its fixes; run it once more for those that are left")
        if self.shown.quiet:
            return
        for fixed in outcome.fixed[:_LISTED] if not self.wanted.diff else ():
            say(f"{path}:{fixed.line}: fixed: {fixed.title} [{fixed.rule}]")
        if len(outcome.fixed) > _LISTED and not self.wanted.diff:
            say(f"{path}: {len(outcome.fixed) - _LISTED} more fixed")
        for refused in outcome.refused[:_LISTED]:
            say(f"{path}:{refused.line}: not fixed: {refused.title} [{refused.rule}]: {refused.reason}")
        if len(outcome.refused) > _LISTED:
            say(f"{path}: {len(outcome.refused) - _LISTED} more not fixed")

    def summarize(self) -> None:
        """Write one line on all fixes, if no report says it."""
        from polarcheck.foundation.errors import counted

        more = f"{self.left} more with --unsafe-fixes" if self.left else ""
        if self.wanted.diff:
            fixes, into = counted(self.count, "fix"), counted(self.files, "file")
            would = f"--fix would write {fixes} into {into}" if self.count else "nothing to fix"
            say(f"{would}{'; ' * bool(more)}{more}")
        elif more:
            say(more)
