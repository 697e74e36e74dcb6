"""What the commands that rewrite programs share: their options, what they say, the exit code."""

from __future__ import annotations

import contextlib
import functools
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import click

from polarcheck.commands import new_programs, options, standard_input
from polarcheck.commands.exit_codes import CLEAN, COULD_NOT_RUN, FINDINGS
from polarcheck.commands.new_programs import Wanted
from polarcheck.commands.options import Decorator, option
from polarcheck.commands.output import in_color, say, show, show_diff
from polarcheck.foundation.errors import OutputError, RefusedError, SourceError, TooHardError

if TYPE_CHECKING:
    from polarcheck.checking.settings import Settings
    from polarcheck.commands.running import Faults
    from polarcheck.files.batch.tasks import Task
    from polarcheck.rewrite.writing.outcome import Figure, Outcome
    from polarcheck.rewrite.writing.rewriting_report import Rewriting
    from polarcheck.rewrite.writing.rewritten_program import Work

#: The most lines about one program of each kind.
_LISTED = 20


class Command(NamedTuple):
    """
    A command that rewrites programs.

    name: convert, unroll, ...
    done: `converted for okuma-osp`, for the line that says so.
    work: returns the function that rewrites, from the settings of the original.
    machine: the id of the lathe of the new program; empty for that of the original.
    """

    name: str
    done: str
    work: Callable[[Settings], Work]
    machine: str = ""


def rewriting(*of_command: Decorator, machine: Decorator = options.machine) -> Decorator:
    """
    Return a decorator that adds the argument PATH and the options of all commands that rewrite programs.

    The function takes the options of its own command, and returns the Command, which is run.

    of_command: the options of the command. machine: its option --machine.
    """

    def decorated(function: Any) -> Any:
        def called(ctx: click.Context, /, **arguments: Any) -> None:
            request = Wanted(*(arguments.pop(name) for name in Wanted._fields))
            shared = {name: arguments.pop(name) for name in list(arguments) if name not in own}
            ctx.exit(_run(function(**arguments), request, is_debug=options.DEBUG in ctx.meta, **shared))

        functools.update_wrapper(called, function)
        shared_options = options.all_of(
            options.executing("programs", machine=machine),
            *new_programs.OPTIONS, standard_input.filename, *_OF_FILES,
        )  # fmt: skip
        command: Any = shared_options(click.pass_context(called))
        own: set[str] = set()
        for decorate in reversed(of_command):
            command = decorate(command)
            own.add(command.__click_params__[-1].name)
        return click.argument("paths", nargs=-1, required=True, metavar="PATH...")(command)

    return decorated


_OF_FILES = (options.extensions, options.exclude, options.max_size, options.debug)


def length(name: str, default: float, text: str) -> Decorator:
    """Return an option for a length up to 1 in the units of the program. default: [mm]. text: of the help."""
    checked = options.length_up_to(1.0, default)
    return option(name, type=float, callback=checked, metavar="LENGTH", show_default=f"{default:g} mm", help=text)


def _run(
    command: Command,
    request: Wanted,
    *,
    is_debug: bool,
    paths: tuple[str, ...],
    stdin_filename: str | None,
    extensions: tuple[str, ...],
    max_size: int,
    no_config: bool,
    **arguments: Any,
) -> int:
    from polarcheck.commands.progress import Bar
    from polarcheck.commands.running import Faults, planned
    from polarcheck.files.settings.of_programs import OfPrograms, Options
    from polarcheck.foundation.memory import keep_within_memory

    keep_within_memory()
    new_programs.refuse(request, paths)
    named = standard_input.judged_as(paths, stdin_filename)
    faults = Faults(is_debug)
    settings_of = OfPrograms(Options(use_config=not no_config, **arguments))
    tasks = planned(paths, settings_of, extensions, faults, named=named)
    programs = _Programs(command, request, max_size, new_programs.outputs(request, tasks, paths), faults)
    with contextlib.closing(Bar(len(tasks), not request.quiet).watched(tasks)) as awaited:
        for task in awaited:
            programs.rewrite(task)
    if request.form == "json":
        programs.show_json()
    return max(programs.status, faults.report())


class _Original(NamedTuple):
    """A program and its bytes."""

    task: Task
    data: bytes

    @property
    def title(self) -> str:
        return self.task.title

    def line_count(self, data: bytes) -> int:
        """Return the lines of a program; 0 where it cannot be read in its encoding."""
        from polarcheck.program.reading.source import read_source

        try:
            return len(read_source(data, self.title, self.task.settings.encoding).line_starts)
        except SourceError:
            return 0


class _Programs:
    """
    The pass over the programs; an error in one of them does not stop the others.

    status: the exit code so far.
    """

    def __init__(
        self, command: Command, request: Wanted, most: int, outputs: Mapping[str, Path], faults: Faults
    ) -> None:
        self._command, self._wanted, self._most = command, request, most
        self._outputs, self._faults = outputs, faults
        self._of_json: list[Rewriting] = []
        self.status = CLEAN

    def rewrite(self, task: Task) -> None:
        """Rewrite a program, write the new one, and say what was done."""
        from polarcheck.program.reading import files
        from polarcheck.rewrite.writing.rewritten_program import rewritten

        work = self._command.work(task.settings)
        original = _Original(task, b"")
        try:
            original = _Original(task, files.read_program(task.path, self._most))
            outcome = rewritten(task.title, original.data, task.settings, work)
            written = new_programs.write(self._wanted, task, original.data, outcome.data, self._outputs.get(task.place))
        except RefusedError as error:
            self._refused(original, error)
        except TooHardError as error:
            self._failed(original, f"{task.title}: {error}")
        except (SourceError, OutputError) as error:
            self._failed(original, str(error))
        except MemoryError:
            self._failed(original, f"{task.title}: there is not enough memory")
        except Exception as error:
            error.add_note(f"in {task.title}")
            self._faults.bug(error)
        else:
            self._done(original, outcome, written)

    def show_json(self) -> None:
        """Write what has come of the programs to standard output."""
        import msgspec

        from polarcheck.rewrite.writing.rewriting_report import RewritingReport

        report = RewritingReport(schema=1, command=self._command.name, files=self._of_json)
        show(msgspec.json.format(msgspec.json.encode(report), indent=2) + b"\n")

    def _done(self, original: _Original, outcome: Outcome, written: str | None) -> None:
        request, settings = self._wanted, original.task.settings
        changes = outcome.data != original.data
        if outcome.decisions or (request.diff and changes):
            self.status = max(self.status, FINDINGS)
        if request.form == "json":
            self._of_json.append(self._entry(original, [], outcome, written))
            return
        if request.diff:
            from polarcheck.rewrite.fixes.difference import difference

            lines = difference(original.title, original.data, outcome.data, outcome.origin, settings.encoding)
            show_diff(lines, in_color(request.color))
        elif written is None and not request.in_place:
            new_programs.print_program(outcome.data, original.title, settings.encoding)
        if not request.quiet:
            self._say(original, outcome, written)
        _say_decisions(original.title, outcome)

    def _say(self, original: _Original, outcome: Outcome, written: str | None) -> None:
        title = original.title
        if outcome.data == original.data:
            say(f"{title}: nothing to change")
        else:
            old, new = (original.line_count(data) for data in (original.data, outcome.data))
            to = f": {written}" if written else ""
            say(f"{title}: {self._command.done}, from {old} lines to {new}{to}")
        for figure in outcome.figures:
            say(f"{title}: {_figure(figure)}")
        _list(outcome.notes, lambda note: f"{title}: {note}", f"{title}: {{}} more notes")

    def _refused(self, original: _Original, error: RefusedError) -> None:
        from polarcheck.rewrite.writing.rewriting_report import Reason

        title = original.title
        self.status = max(self.status, COULD_NOT_RUN)
        self._of_json.append(
            self._entry(original, [Reason(reason.line or None, reason.text) for reason in error.refusals])
        )
        if self._wanted.form != "json":
            _list(
                error.refusals,
                lambda refusal: f"{_location(title, refusal.line)}: {refusal.text}",
                f"{title}: {{}} more reasons",
            )
            say(f"{title}: not {self._command.done}: nothing is written")

    def _failed(self, original: _Original, line: str) -> None:
        from polarcheck.rewrite.writing.rewriting_report import Reason

        self.status = max(self.status, COULD_NOT_RUN)
        self._of_json.append(self._entry(original, [Reason(None, line)]))
        say(line)

    def _entry(
        self, original: _Original, refusals: Sequence[Any], outcome: Outcome | None = None, written: str | None = None
    ) -> Rewriting:
        from polarcheck.rewrite.writing.rewriting_report import Rewriting

        machine = original.task.settings.machine_id
        return Rewriting(
            path=original.title,
            machine=machine,
            new_machine=self._command.machine or machine,
            refusals=list(refusals),
            written=written,
            lines=original.line_count(original.data),
            new_lines=None if outcome is None else original.line_count(outcome.data),
            decisions=outcome.decisions if outcome else [],
            figures=outcome.figures if outcome else [],
            notes=outcome.notes if outcome else [],
            doubts=outcome.doubts if outcome else [],
        )


def _say_decisions(title: str, outcome: Outcome) -> None:
    _list(
        outcome.decisions,
        lambda decision: f"{_location(title, decision.line)}: to decide: {decision.text}",
        f"{title}: {{}} more to decide",
    )
    if outcome.decisions:
        say(f"{title}: {len(outcome.decisions)} to decide before it runs; a comment in the new program marks each")


def _list(elements: Sequence[Any], line: Callable[[Any], str], rest: str) -> None:
    for element in elements[:_LISTED]:
        say(line(element))
    if len(elements) > _LISTED:
        say(rest.format(len(elements) - _LISTED))


def _location(title: str, line: int) -> str:
    return f"{title}:{line}" if line else title


def _figure(figure: Figure) -> str:
    value = figure.value
    if value != value:
        return f"{figure.name}: not known"
    whole = f"{value:.0f}" if value == round(value) or abs(value) >= 1000 else f"{value:.4g}"
    number = f"{value:.4f}" if figure.unit == "mm" else whole
    return f"{figure.name}: {number} {figure.unit}".rstrip()
