"""
Slips in sound programs, and whether what is found leads back to the sound program.

    judged = judged_slip(7)
    judged.advice      # each finding with its grade, one of GRADES
"""

from __future__ import annotations

import random
import re
from typing import NamedTuple

from metal_simulation import C_LIMIT, differs, simulate
from programs import job_of, machine_of, report_of
from setter_programs import Program, drawn
from single_slips import SLIPS, planted
from slip_words import Draw, Plant, block_changed, block_missing, digit_wrong, point_moved, word_changed

from polarcheck.checking.settings import Settings
from polarcheck.foundation.finding import FileReport, Finding
from polarcheck.rewrite.fixes.fix_rounds import with_fixes
from polarcheck.rules.rule import load_all

GRADES = ("right", "place", "else there", "no advice", "elsewhere")
#: What begins an advice in a message.
_ADVICE = re.compile(
    r"\b(write|delete|take|retract|change|measure|make|put|begin|cancel|enter|position|keep|lower|highest F|would"
    r" (?:be|fit|close)|needs? |is missing|add|set|check it|go round|convert)\b"
)


class Advice(NamedTuple):
    """A finding, its grade, and what its fix makes: "" for none, "sound", "other path" or "refused"."""

    line: int
    rule: str
    severity: str
    message: str
    grade: str
    fix: str


class Judged(NamedTuple):
    """A slip: its line (from 1), the block as written and the sound one, and what is found."""

    kind: str
    seed: int
    machine: str
    family: str
    line: int
    written: str
    sound: str
    advice: tuple[Advice, ...]
    safe_fix_is_wrong: bool


def _missing(pattern: str) -> Plant:
    """A code of the head or end of a program is missing, as a word or with its block."""

    def plant(program: Program, draw: Draw) -> Program | None:
        places = [index for index, line in enumerate(program.lines) if re.search(pattern, line.text)]
        if not places:
            return None
        index = draw.choice(places)
        text = re.sub(pattern, "", program.lines[index].text, count=1).strip()
        return program.changed(index, *([text] if text and not re.fullmatch(r"N\d+", text) else []))

    return plant


def _code(name: str) -> Plant:
    """The code that the dialect writes for something is missing."""

    def plant(program: Program, draw: Draw) -> Program | None:
        code = getattr(program.dialect, name)
        return _missing(rf"{re.escape(code)}(?![\d.])")(program, draw) if code else None

    return plant


#: Kinds beside those of single_slips; metal need not differ, since the lathe stops or may.
MORE: dict[str, Plant] = {
    "F with a point moved": word_changed("F", point_moved, "ramp", "plunge", "contour"),
    "F with a digit wrong": word_changed("F", digit_wrong, "ramp", "plunge", "contour"),
    "ramp: X ten times or a tenth": word_changed("X", point_moved, "ramp"),
    "ramp: virtual axis wrong": word_changed("C", digit_wrong, "ramp"),
    "ramp: virtual axis ten times": word_changed("C", point_moved, "ramp"),
    "cancel: word wrong": word_changed("XC", digit_wrong, "cancel"),
    "cancel: point moved": word_changed("XC", point_moved, "cancel"),
    "Z with a point moved": word_changed("Z", point_moved, "plunge", "retract", "lift", "plunge outside"),
    "C axis not engaged": _code("engage"),
    "C axis not released": _code("release"),
    "live tool not started": _code("spindle"),
    "live tool not stopped": _code("spindle_off"),
    "feed mode not restored": _code("per_revolution"),
    "retract block missing": block_missing("retract", "lift"),
    "T missing": _missing(r"T\d{2,4}(?: ?D\d)?"),
    "point lost in a contour": block_changed(r"(?<=\d)\.(?=\d|\b|[A-Z ]|$)", "", "contour"),
    "letter O for 0": block_changed(r"(?<=[1-9])0(?=\.)", "O", "contour"),
    "dash of print": block_changed(r"(?<=[A-Z])-", "–", "contour", "ramp"),
    "G0 in the contour": block_changed(r"^(N\d+ ?)?", r"\g<1>G0 ", "contour"),
}
KINDS: dict[str, Plant | None] = {**{slip.name: None for slip in SLIPS}, **MORE}
_BY_NAME = {slip.name: slip for slip in SLIPS}


def judged_slip(seed: int, kinds: tuple[str, ...] = tuple(KINDS), machine: str = "") -> Judged | None:
    """A slip of the kind that is in turn, in a program of which nothing is said without it; None where none is made."""
    draw = random.Random(f"remedy {seed}")  # noqa: S311 - programs that can be written again
    kind = kinds[seed % len(kinds)]
    for _ in range(40):
        sound = drawn(draw.randrange(10**6), machine)
        plant = KINDS[kind]
        if plant is None:
            slipped = planted(_BY_NAME[kind], sound, draw)
            changed = slipped and slipped.program
        else:
            changed = plant(sound, draw)
        if changed is None or changed.text() == sound.text():
            continue
        if report_on(sound).verdict == "pass":
            return judged(kind, seed, sound, changed)
    return None


def judged(kind: str, seed: int, sound: Program, changed: Program) -> Judged:
    report = report_on(changed)
    lines, written, meant = changed_lines(sound, changed)
    findings = [finding for finding in report.findings if finding.severity != "note"]
    outcomes = [outcome_of_fix(finding, sound, changed) for finding in findings]
    advice = tuple(
        Advice(
            finding.line,
            finding.rule,
            finding.severity,
            finding.message,
            grade(finding, lines, written, meant, outcome),
            outcome,
        )
        for finding, outcome in zip(findings, outcomes, strict=True)
    )
    is_wrong = any(
        finding.fix is not None and finding.fix.safe and outcome == "other path"
        for finding, outcome in zip(findings, outcomes, strict=True)
    )
    return Judged(
        kind, seed, sound.machine, sound.family, lines[0], " / ".join(written), " / ".join(meant), advice, is_wrong
    )


def settings_of(program: Program) -> tuple[list[str], dict[str, object], dict[str, dict[str, float]]]:
    """Tools, job and changes of the machine with which a program is checked."""
    code = program.dialect.inch if program.inch else program.dialect.metric
    limits = {"limits": {"c_feed": C_LIMIT}}
    if not code or any(code in line.text for line in program.lines):
        job = {"stock": {"diameter": round(program.stock / program.scale, 5)}} if program.stock else {}
        return program.tools(), job, limits
    tools = {str(offset): {"radius": radius, "nose": 0} for offset, radius in program.radii.items()}
    in_mm: dict[str, object] = {"units": "mm", "tools": tools}
    if program.stock:
        in_mm["stock"] = {"diameter": program.stock}
    return [], in_mm, limits


def report_on(program: Program) -> FileReport:
    tools, job, limits = settings_of(program)
    return report_of(program.text(), program.machine, *tools, changes=limits, job=job)


def changed_lines(sound: Program, changed: Program) -> tuple[list[int], list[str], list[str]]:
    """The lines of the slip (from 1) in the changed program, its blocks there, and those of the sound one."""
    old, new = sound.text().splitlines(), changed.text().splitlines()
    if len(old) == len(new):
        places = [index for index, (one, two) in enumerate(zip(old, new, strict=True)) if one != two]
        return [index + 1 for index in places], [new[index] for index in places], [old[index] for index in places]
    first = next((i for i, (one, two) in enumerate(zip(old, new, strict=False)) if one != two), min(len(old), len(new)))
    tail = 0
    while tail < min(len(old), len(new)) - first and old[-1 - tail] == new[-1 - tail]:
        tail += 1
    written, meant = new[first : len(new) - tail], old[first : len(old) - tail]
    around = range(first, max(len(new) - tail, first) + 2) if not written else range(first + 1, len(new) - tail + 1)
    return list(around), written, meant


def grade(finding: Finding, lines: list[int], written: list[str], meant: list[str], fix: str) -> str:
    """How good the advice of a finding is; see benchmarks/remedies.py."""
    if fix == "sound":
        return "right"
    pairs = zip(written, meant, strict=True) if len(written) == len(meant) else [(" ".join(written), " ".join(meant))]
    changed = [(_words(one), _words(two)) for one, two in pairs]
    wanted = {word for one, two in changed for word in two - one}
    surplus = {word for one, two in changed for word in one - two} if not wanted else set()
    has_advice = bool(_ADVICE.search(finding.message) or finding.fix)
    letters = {word[0] for one, two in changed for word in one ^ two}
    bare = set(re.findall(r"\b(?:write|retract|delete|or|a|sign of) ([A-Z])\b", finding.message))
    names_word = bool(wanted & _words(finding.message)) or bool(letters & bare)
    deletes = "delete" in finding.message and bool(
        surplus & _words(finding.message) or "stands twice" in finding.message
    )
    if has_advice and (names_word or deletes):
        return "right"
    numbers = {
        int(number)
        for match in re.findall(r"lines? (\d+)(?: (?:and|to) (\d+))?", finding.message)
        for number in match
        if number
    }
    is_there = (
        finding.line in lines
        or bool(numbers & set(lines))
        or any(len(text) > 4 and text in finding.message for text in written)
    )
    if is_there:
        return "else there" if has_advice else "place"
    return "elsewhere" if has_advice else "no advice"


def _words(text: str) -> set[str]:
    """The words of a block or message, numbers without needless digits."""
    text = re.sub(r"\([^)]*\)", "", text) if text.startswith("(") else text
    return {
        f"{letter}{float(number):g}"
        for letter, number in re.findall(r"(?<![A-Za-z])([A-Z]+=?)([-+]?(?:\d+\.?\d*|\.\d+))", text)
    }


def outcome_of_fix(finding: Finding, sound: Program, changed: Program) -> str:
    """What the fix of one finding makes: "sound" metal, "other path", or nothing, "refused"; "" where it has none."""
    if finding.fix is None:
        return ""
    tools, job, limits = settings_of(changed)
    work = job_of(*tools, job=job)
    machine = machine_of(changed.machine, limits)
    rules = [load_all()[finding.rule]]
    settings = Settings(changed.machine, machine, work, rules, work.severities)
    result = with_fixes(changed.text().encode(), settings, "-", unsafe=True)
    if not result.fixed:
        return "refused"
    text = result.data.decode()
    if text == sound.text():
        return "sound"
    origin = {number: changed.lines[number - 1] for number in range(1, len(changed.lines) + 1)}
    lines = tuple(
        origin[min(source, len(origin))]._replace(text=line)
        for line, source in zip(text.splitlines(), result.origin, strict=False)
    )
    fixed = changed._replace(lines=lines)
    try:
        one, two = simulate(sound), simulate(fixed)
    except (ValueError, SyntaxError, ZeroDivisionError, OverflowError):
        return "other path"
    return "other path" if differs(one, two) or two.events - one.events else "sound"
