"""What comes of converting a program, by the simulated lathe: equal, to decide, refused, or wrong."""

from __future__ import annotations

import re
from typing import NamedTuple

import msgspec
from post_styles import Drawn
from simulated_lathe import differences, steps

from polarcheck.checking.settings import Settings
from polarcheck.files.settings.of_programs import OfPrograms, Options, on_machine
from polarcheck.foundation.errors import RefusedError
from polarcheck.rewrite.convert.converting import converted
from polarcheck.rewrite.convert.doubtful_values import KEYS
from polarcheck.rewrite.writing.outcome import Outcome
from polarcheck.rewrite.writing.rewritten_program import rewritten

EQUAL, TO_DECIDE, REFUSED, NEEDLESS, WRONG = "equal", "to decide", "refused truly", "refused needlessly", "wrong"
#: The reasons that are true: what the target has no function for, a value that is not known, what a person must decide.
TRUE_REASONS = (
    ("goes round outer corners otherwise", "the other control goes round outer corners otherwise"),
    ("is a statement of a language", "a macro statement for a control with another language"),
    ("Z cannot move in an arc", "a helix for a control whose arcs have no Z"),
    ("how .* writes that is not known", "a subprogram for a control whose calls are not known"),
    ("Z cannot move beside the axes", "Z beside the axes of the plane for a control that forbids it"),
)


class Conversion(NamedTuple):
    """What has come of it, and why."""

    what: str
    why: tuple[str, ...] = ()


def settings_of(program: Drawn) -> Settings:
    """The lathe and the tools of a program."""
    settings = OfPrograms(Options(machine=program.machine, tools=program.tools, use_config=False))("")
    job = msgspec.structs.replace(settings.job, units="inch" if program.inch else "mm")
    return msgspec.structs.replace(settings, job=job)


def conversion(program: Drawn, target: str) -> Conversion:
    """Convert a program, run both on their lathes, and compare what they do; all values in doubt are accepted."""
    settings = settings_of(program)
    try:
        outcome = rewritten(
            program.name,
            program.text.encode(),
            settings,
            lambda original: converted(original, on_machine(settings, target), KEYS),
        )
    except RefusedError as error:
        texts = [refusal.text for refusal in error.refusals]
        if kind := next((kind for pattern, kind in TRUE_REASONS if re.search(pattern, "\n".join(texts))), ""):
            return Conversion(REFUSED, (kind,))
        return Conversion(NEEDLESS, tuple(texts))
    found = differences_of(program, target, outcome)
    if found:
        return Conversion(WRONG, tuple(found))
    return Conversion(TO_DECIDE if outcome.decisions else EQUAL)


def differences_of(program: Drawn, target: str, outcome: Outcome) -> list[str]:
    """What the new program does otherwise, but by words that a comment in it or a note names there."""
    left_out = (re.match(r"line (\d+): (.*) is left out", note) for note in outcome.notes)
    texts = [(decision.line, decision.text.partition(": ")[0]) for decision in outcome.decisions]
    told = dict[int, str]()
    for line, words in texts + [(int(match[1]), match[2]) for match in left_out if match]:
        told[line] = told.get(line, "") + "".join(re.findall(r"(?<![A-Z])([A-Z])B?\d?=?[-.\d\[#]", words))
    theirs = steps(outcome.data.decode("latin-1"), target, outcome.origin)
    return differences(steps(program.text, program.machine), theirs, told)[0]
