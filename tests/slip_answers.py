"""
What is said about a slip, and whether it leads back to the sound program.

    answer = answered(slip)         # a slip of single_slips
    answer.findings, answer.is_there, answer.names, answer.remedy, answer.fix

A remedy is right where the metal that it leaves is that of the sound program, by metal_simulation.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Sequence
from typing import NamedTuple

from metal_simulation import C_LIMIT, differs, simulate
from programs import job_of, machine_of, report_of
from setter_pen import Line
from setter_programs import Program
from single_slips import Planted

from polarcheck.checking.settings import Settings
from polarcheck.foundation.finding import FileReport, Finding
from polarcheck.rewrite.fixes.fix_rounds import with_fixes
from polarcheck.rules.rule import load_all

_WORD = r"[A-Z]+=?[-+]?(?:\d+\.?\d*|\.\d+)"
_VALUES = re.compile(
    rf"(?:(?<!min )(?<!stands here, )\b(?:with|write|or|and) (?P<words>{_WORD}(?: {_WORD})*)"
    rf"(?P<rest>(?: here| in line (?P<line>\d+)| not here but in line (?P<moved>\d+)"
    rf"| in a block of its own before this one)?)"
    rf"(?= (?:it|its|all|more|here|in line|and leave)\b|$|,| \()"
    rf"|[;:] (?P<others>{_WORD}(?: {_WORD})*)(?= would (?:fit|be tangent|lie)))"
)
_GROUPS = (
    {"G0", "G1", "G2", "G3", "G101", "G102", "G103"},
    {"G40", "G41", "G42"},
    {"G90", "G91"},
    {"G98", "G99", "G94", "G95"},
    {"G20", "G21"},
)


class Answer(NamedTuple):
    """
    What is said of a slip.

    findings: at or above warning, that the sound program has not. is_open: nothing is said, but the check names what
    it did not evaluate. is_there: one of them stands at a line of the slip or names it. names: "" where none names a
    value, "right" where it is that of the sound program, else "wrong". remedy: of the values as they are told, and fix:
    of --unsafe-fixes: "" where there is none, else "right" or "wrong".
    """

    findings: tuple[Finding, ...]
    is_open: bool
    is_there: bool
    names: str
    remedy: str
    fix: str


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


def said_of(report: FileReport) -> list[Finding]:
    return [finding for finding in report.findings if finding.severity != "note"]


def lines_named(finding: Finding) -> set[int]:
    """The line of a finding, and those that its message names."""
    named = re.findall(r"\blines? (\d+)((?:, \d+)*)(?: (?:and|to) (\d+))?", finding.message)
    return {finding.line} | {int(number) for groups in named for number in re.findall(r"\d+", " ".join(groups))}


def answered(slip: Planted, before: Sequence[Finding] | None = None) -> Answer:
    """Check a program with a slip; before: what is said of the sound one."""
    sound, program = slip.sound, slip.program
    before = said_of(report_on(sound)) if before is None else before
    report = report_on(program)
    old = Counter((finding.rule, finding.message) for finding in before)
    findings = [finding for finding in said_of(report) if not old[finding.rule, finding.message]]
    lines, needed = changed_lines(sound, program)
    named = [value for finding in findings for value in values_of(finding)]
    names = remedy = ""
    if named:
        remedy = "right" if any(is_sound(slip, written(program, value)) for value in named) else "wrong"
        # The sound program has no word for what is written once too often.
        is_named = any(needed <= _values(value.words) for value in named) if needed else remedy == "right"
        names = "right" if is_named else "wrong"
    fix = ""
    if any(finding.fix for finding in findings):
        lines_fixed = fixed(program)
        fix = "right" if lines_fixed is not None and is_sound(slip, lines_fixed) else "wrong"
    is_open = not findings and report.verdict == "unverified"
    is_there = any(lines_named(finding) & set(lines) for finding in findings)
    return Answer(tuple(findings), is_open, is_there, names, remedy, fix)


class Value(NamedTuple):
    """
    Words that a message says to write, in which lines (from 1), in a block of their own or not.

    word: the word in whose place they stand, "" where the message names none. out_of: the line that they leave, 0 for
    none. more: lines behind these that the message counts and does not name, where the word stands, too.
    """

    words: tuple[str, ...]
    lines: tuple[int, ...]
    is_block: bool
    word: str = ""
    out_of: int = 0
    more: int = 0


def values_of(finding: Finding) -> list[Value]:
    """What a message says to write."""
    found = []
    for match in _VALUES.finditer(finding.message):
        words = tuple((match["words"] or match["others"]).split())
        line = int(match["line"] or match["moved"] or finding.line)
        word = str(finding.values.get("word", "")) if line == finding.line else ""
        pattern = r"likewise in lines? (\d+(?:(?:, | and )\d+\b(?! more))*)(?: and (\d+) more)?"
        also = re.search(pattern, finding.message[match.end() :])
        lines = (line, *(map(int, re.findall(r"\d+", also[1])) if also else ()))
        out_of, more = finding.line if match["moved"] else 0, int(also[2] or 0) if also else 0
        found.append(Value(words, lines, "block" in (match["rest"] or ""), word, out_of, more))
    return found


def written(program: Program, value: Value) -> tuple[Line, ...]:
    """The program with the words as they are told."""
    lines = program.lines
    if value.out_of:
        left = value.out_of - 1
        text = re.sub(rf"(?<![A-Z]){value.words[0]}(?![\d.]) ?", "", lines[left].text, count=1)
        lines = (*lines[:left], lines[left]._replace(text=text), *lines[left + 1 :])
    behind = [number for number, line in enumerate(lines, 1) if value.word in line.text and number > max(value.lines)]
    for number in (*value.lines, *behind[: value.more]):
        index = min(number, len(lines)) - 1
        line = lines[index]
        if value.is_block:
            return (*lines[:index], line._replace(text=" ".join(value.words), role="contour"), *lines[index:])
        lines = (*lines[:index], line._replace(text=_with_words(line.text, value)), *lines[index + 1 :])
    return lines


def _with_words(text: str, value: Value) -> str:
    is_letter = len(value.words) == 1 and re.fullmatch(_WORD, value.word) and value.word[0] != "G"
    if is_letter and value.word[0] != value.words[0][0] and value.word in text:
        return text.replace(value.word, value.words[0], 1)
    for word in value.words:
        group = next((group for group in _GROUPS if word in group), {word})
        letter = re.match("[A-Z]+=?", word)
        assert letter
        old = "|".join(code + r"(?![\d.])" for code in group) if word[0] == "G" else rf"{letter[0]}[-+]?[\d.]+"
        number = re.match(r"(N\d+ ?)?", text)
        assert number
        if re.search(rf"(?<![A-Z])(?:{old})", text):
            text = re.sub(rf"(?<![A-Z])(?:{old})", word, text, count=1)
        elif word[0] == "G":
            text = f"{number[0]}{word} {text[number.end() :]}"
        else:
            text = f"{text} {word}"
    return text


def fixed(program: Program) -> tuple[Line, ...] | None:
    """The program after --unsafe-fixes; None where they are refused."""
    tools, job, limits = settings_of(program)
    work = job_of(*tools, job=job)
    machine = machine_of(program.machine, limits)
    settings = Settings(program.machine, machine, work, list(load_all().values()), work.severities)
    result = with_fixes(program.text().encode(), settings, "-", unsafe=True)
    if not result.fixed:
        return None
    rows = zip(result.data.decode().splitlines(), result.origin, strict=False)
    last = len(program.lines)
    return tuple(program.lines[min(source, last) - 1]._replace(text=text) for text, source in rows)


def is_sound(slip: Planted, lines: Iterable[Line]) -> bool:
    """Whether these lines are the sound program, or leave its metal."""
    program = slip.program._replace(lines=tuple(lines))
    if _bare(program) == _bare(slip.sound):
        return True
    try:
        one, two = simulate(slip.sound), simulate(program)
    except (ValueError, SyntaxError, ZeroDivisionError, OverflowError):
        return False
    return not (differs(one, two) or two.events - one.events)


def _bare(program: Program) -> str:
    text = re.sub(r"(?m)^N\d+| ", "", program.text())
    return re.sub(r"(?<=[\d.])(?<=\.)0+(?!\d)|(?<=\.\d)0+(?!\d)", "", text)


def changed_lines(sound: Program, changed: Program) -> tuple[list[int], set[tuple[str, float]]]:
    """The lines of the slip (from 1), and the words of the sound program that are wrong or missing there."""
    old, new = sound.text().splitlines(), changed.text().splitlines()
    if len(old) == len(new):
        places = [index for index, (one, two) in enumerate(zip(old, new, strict=True)) if one != two]
        needed = {word for index in places for word in _values(_words(old[index])) - _values(_words(new[index]))}
        return [index + 1 for index in places], needed
    first = next((i for i, (one, two) in enumerate(zip(old, new, strict=False)) if one != two), min(len(old), len(new)))
    tail = 0
    while tail < min(len(old), len(new)) - first and old[-1 - tail] == new[-1 - tail]:
        tail += 1
    around = range(first, max(len(new) - tail, first) + 2)
    return list(around), {word for line in old[first : len(old) - tail] for word in _values(_words(line))}


def _words(text: str) -> list[str]:
    return re.findall(rf"(?<![A-Za-z]){_WORD}", re.sub(r"\([^)]*\)", "", text))


def _values(words: Iterable[str]) -> set[tuple[str, float]]:
    """Words as letters and numbers, without block numbers and F."""
    found = set()
    for word in words:
        letter, number = re.match(r"([A-Z]+=?)(.*)", word).groups()  # type: ignore[union-attr]
        if letter not in "NF":
            found.add((letter, round(float(number), 3)))
    return found
