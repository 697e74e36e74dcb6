"""Programs written anew: for another control, with the polar mode or without it, with compensation or without it."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Literal, TypeAlias, Unpack

import msgspec

from polarcheck.api.keywords import ExecutionKeywords, PathName, path_of, takes
from polarcheck.api.loaded_program import NAMELESS, Call, Program
from polarcheck.api.values import choice, flag, length, names
from polarcheck.files.settings.of_programs import on_machine
from polarcheck.foundation.errors import UsageError
from polarcheck.program.machines.feed_keys import WITH_ROTARY
from polarcheck.program.machines.profiles import machine_id
from polarcheck.program.reading.files import LARGEST
from polarcheck.rewrite.writing.outcome import Decision, Doubt, Figure
from polarcheck.rewrite.writing.rewritten_program import Work, rewritten

Side: TypeAlias = Literal["left", "right", "part-inside", "part-outside"]
RotaryFeed: TypeAlias = Literal["inverse-time", "per-minute", "per-minute-c", "per-minute-diameter"]
UnrolledFeed: TypeAlias = RotaryFeed | Literal["stepwise"]

#: The largest lengths that the commands take [mm].
_LARGEST_LENGTH = 25.4
#: What stands where no length is given [mm].
_CHORD_ERROR, _TOLERANCE = 0.005, 0.01
_A_LENGTH = "a length above 0 and up to 25.4 [mm]"


class Rewritten(msgspec.Struct, frozen=True, kw_only=True):
    """
    A program written anew, read back and compared with the original.

    path: of the original, as it is reported.
    machine, new_machine: the ids of the lathes of the original and of the new program.
    data: the new program, in the encoding and with the line ends of the original.
    decisions: what somebody has to decide before it runs: `line` of the original, 0 for the whole program, and `text`.
    figures: what was measured: `name`, `value`, and `unit`.
    notes: what was done where.
    doubts: of `convert`, values of the profiles in doubt on which changed numbers rest: `line`, `key`, `value`,
        `new_value`, and the `machines` for which it is in doubt.
    """

    path: str
    machine: str
    new_machine: str
    data: bytes
    decisions: list[Decision]
    figures: list[Figure]
    notes: list[str]
    doubts: list[Doubt]


@takes(ExecutionKeywords)
def convert(
    path: PathName,
    *,
    to: PathName,
    accept: str | Iterable[str] = (),
    max_size: int = LARGEST,
    **keywords: Unpack[ExecutionKeywords],
) -> Rewritten:
    """
    Write a program as another lathe reads it.

    to: the lathe to write for, the name of a built-in one or the path of a TOML file; `machine` is that of the
        original.
    accept: keys of the profiles whose values in doubt numbers may rest on, "control.x".
    max_size: a larger file is not read [bytes].

    Raises RefusedError, with its refusals, where the new program would not do the same; SourceError if the file cannot
    be read, UsageError, JobError or MachineError for a wrong setting, TooHardError if the program takes too long.
    """
    call = Call("polarcheck.convert()", ExecutionKeywords, keywords)
    return _converted(call, call.of_path(path, max_size), to, accept)


@takes(ExecutionKeywords)
def convert_text(
    text: str | bytes,
    *,
    to: PathName,
    accept: str | Iterable[str] = (),
    name: str = NAMELESS,
    **keywords: Unpack[ExecutionKeywords],
) -> Rewritten:
    """
    Write a text as another lathe reads it, as `convert` does a file.

    to, accept: as for `convert`.
    name: the path that it is reported as, and by which entries of a job file apply to it. No job file is read unless
        `config` names one, or use_config=True asks for the one nearest to this path.

    Raises as `convert` does.
    """
    call = Call("polarcheck.convert_text()", ExecutionKeywords, keywords)
    return _converted(call, call.of_text(text, name), to, accept)


def _converted(call: Call, program: Program, to: PathName, accept: str | Iterable[str]) -> Rewritten:
    from polarcheck.rewrite.convert.converting import converted
    from polarcheck.rewrite.convert.doubtful_values import KEYS

    accepted = names(f"{call.function}: accept", accept)
    if unknown := next((key for key in accepted if key not in KEYS), None):
        raise UsageError(f"{call.function}: accept: expected one of {', '.join(KEYS)}, found {unknown}")
    name = path_of(f"{call.function}: to", to, "the name of a lathe, or the path of a TOML file")
    target = on_machine(program.settings, name)
    return _rewritten(program, lambda original: converted(original, target, accepted), machine_id(name))


@takes(ExecutionKeywords)
def unroll(
    path: PathName,
    *,
    chord_error: float = _CHORD_ERROR,
    feed: UnrolledFeed | None = None,
    max_size: int = LARGEST,
    **keywords: Unpack[ExecutionKeywords],
) -> Rewritten:
    """
    Write the polar sections of a program as plain moves of X and C.

    chord_error: how far the tool center may leave its path between two points [mm].
    feed: what F is where X and C move together; None for what the machine has.
    max_size: a larger file is not read [bytes].

    Raises as `convert` does.
    """
    call = Call("polarcheck.unroll()", ExecutionKeywords, keywords)
    return _unrolled(call, call.of_path(path, max_size), chord_error, feed)


@takes(ExecutionKeywords)
def unroll_text(
    text: str | bytes,
    *,
    chord_error: float = _CHORD_ERROR,
    feed: UnrolledFeed | None = None,
    name: str = NAMELESS,
    **keywords: Unpack[ExecutionKeywords],
) -> Rewritten:
    """
    Write the polar sections of a text as plain moves of X and C, as `unroll` does those of a file.

    chord_error, feed: as for `unroll`. name: as for `convert_text`.

    Raises as `convert` does.
    """
    call = Call("polarcheck.unroll_text()", ExecutionKeywords, keywords)
    return _unrolled(call, call.of_text(text, name), chord_error, feed)


def _unrolled(call: Call, program: Program, chord_error: float, feed: str | None) -> Rewritten:
    from polarcheck.rewrite.unroll.unrolling import FEEDS, Unrolling, unrolled

    within = length(
        f"{call.function}: chord_error",
        _CHORD_ERROR if chord_error is None else chord_error,
        _LARGEST_LENGTH,
        _A_LENGTH,
    )
    options = Unrolling(within, choice(f"{call.function}: feed", feed, FEEDS, ""))
    return _rewritten(program, lambda original: unrolled(original, options))


@takes(ExecutionKeywords)
def roll(
    path: PathName,
    *,
    tolerance: float = _TOLERANCE,
    feed: RotaryFeed | None = None,
    keep_c: bool = False,
    max_size: int = LARGEST,
    **keywords: Unpack[ExecutionKeywords],
) -> Rewritten:
    """
    Write plain moves of X and C of a program as polar sections of lines and arcs.

    tolerance: how far the path may be from the ends of the blocks [mm].
    feed: what F per minute is where X and C move together; None for what the machine has.
    keep_c: leave C where it stands when the mode is switched on.
    max_size: a larger file is not read [bytes].

    Raises as `convert` does.
    """
    call = Call("polarcheck.roll()", ExecutionKeywords, keywords)
    return _rolled(call, call.of_path(path, max_size), tolerance, feed, keep_c)


@takes(ExecutionKeywords)
def roll_text(
    text: str | bytes,
    *,
    tolerance: float = _TOLERANCE,
    feed: RotaryFeed | None = None,
    keep_c: bool = False,
    name: str = NAMELESS,
    **keywords: Unpack[ExecutionKeywords],
) -> Rewritten:
    """
    Write plain moves of X and C of a text as polar sections, as `roll` does those of a file.

    tolerance, feed, keep_c: as for `roll`. name: as for `convert_text`.

    Raises as `convert` does.
    """
    call = Call("polarcheck.roll_text()", ExecutionKeywords, keywords)
    return _rolled(call, call.of_text(text, name), tolerance, feed, keep_c)


def _rolled(call: Call, program: Program, tolerance: float, feed: str | None, keep_c: bool) -> Rewritten:
    from polarcheck.rewrite.roll.rolling import Rolling, rolled

    within = length(
        f"{call.function}: tolerance", _TOLERANCE if tolerance is None else tolerance, _LARGEST_LENGTH, _A_LENGTH
    )
    meaning = choice(f"{call.function}: feed", feed, WITH_ROTARY, "")
    options = Rolling(within, meaning, flag(f"{call.function}: keep_c", False if keep_c is None else keep_c))
    return _rewritten(program, lambda original: rolled(original, options))


@takes(ExecutionKeywords)
def compensate(
    path: PathName,
    *,
    center: bool = False,
    side: Side | None = None,
    max_size: int = LARGEST,
    **keywords: Unpack[ExecutionKeywords],
) -> Rewritten:
    """
    Write a program, whose polar sections program the path of the tool center, with G41 or G42, or the reverse.

    center: write contours with G41 or G42 as paths of the tool center.
    side: of the path on which the cutter is, or where the part is, if the program does not say so.
    max_size: a larger file is not read [bytes].

    Raises as `convert` does.
    """
    call = Call("polarcheck.compensate()", ExecutionKeywords, keywords)
    return _compensated(call, call.of_path(path, max_size), center, side)


@takes(ExecutionKeywords)
def compensate_text(
    text: str | bytes,
    *,
    center: bool = False,
    side: Side | None = None,
    name: str = NAMELESS,
    **keywords: Unpack[ExecutionKeywords],
) -> Rewritten:
    """
    Write a text with G41 or G42, or as paths of the tool center, as `compensate` does a file.

    center, side: as for `compensate`. name: as for `convert_text`.

    Raises as `convert` does.
    """
    call = Call("polarcheck.compensate_text()", ExecutionKeywords, keywords)
    return _compensated(call, call.of_text(text, name), center, side)


def _compensated(call: Call, program: Program, center: bool, side: str | None) -> Rewritten:
    from polarcheck.rewrite.compensate.centering import centered
    from polarcheck.rewrite.compensate.compensating import Compensating, compensated
    from polarcheck.rewrite.compensate.contours import SIDES

    options = Compensating(choice(f"{call.function}: side", side, SIDES, ""))
    if not flag(f"{call.function}: center", False if center is None else center):
        return _rewritten(program, lambda original: compensated(original, options))
    if options.side:
        raise UsageError(f"{call.function}: side is for contours beside a path: with center the program says its sides")
    return _rewritten(program, centered)


def _rewritten(program: Program, work: Work, new_machine: str = "") -> Rewritten:
    outcome = rewritten(program.path, program.data, program.settings, work)
    machine = program.settings.machine_id
    return Rewritten(
        path=program.path,
        machine=machine,
        new_machine=new_machine or machine,
        data=outcome.data,
        decisions=outcome.decisions,
        figures=outcome.figures,
        notes=outcome.notes,
        doubts=outcome.doubts,
    )
