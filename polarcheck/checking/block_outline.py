"""The outline of a file: a hash per block, by which a baseline finds the places of known findings again."""

from __future__ import annotations

import re
import zlib
from bisect import bisect_right
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from itertools import chain
from typing import TYPE_CHECKING

import msgspec
import numpy as np

from polarcheck.checking.called_files import in_the_file
from polarcheck.checking.channel_reports import first_runs
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Floats, side_by_side
from polarcheck.foundation.finding import FASTEST, FASTEST_PER_REVOLUTION, LOWEST_Z, FileReport, Finding, Outline
from polarcheck.foundation.states import Motion
from polarcheck.program.reading.source import Source
from polarcheck.program.reading.words import Text
from polarcheck.rules import places
from polarcheck.rules.rule import load_all
from polarcheck.rules.tables import Tables

if TYPE_CHECKING:
    from polarcheck.checking.engine import Listed


#: The span of rules with one finding for a program.
_PROGRAM = "program"
#: The most hashes of an outline: of a longer file a part of the blocks is listed.
MOST = 2000
#: Larger files have no outline [bytes].
_LARGEST = 64_000_000
#: A hash has so many bits, four characters of base 64.
BITS = 24
_BLANKS = dict.fromkeys((*range(10), *range(11, 33), 127, 160, ord(";"))) | {ord(":"): "O"}
#: At the begin of a line, and behind the slash of block skip; both patterns begin with a letter, which is found fast.
_SEQUENCE_NUMBERS = re.compile(r"N(?<=\nN)\d+"), re.compile(r"N(?<=\n/N)\d+")
_PLUS = re.compile(r"(?<=[A-Z=])\+(?=[\d.])")
_LEADING_ZEROS = re.compile(r"(?<![\d.])0+(?=[\d.])")
_TRAILING_ZEROS = re.compile(r"\.\d*0(?!\d)")
#: A line that says nothing about what is cut: a tape mark, or the number of the program, which a copy changes.
_HEAD = re.compile(r"%.*|O\d+")


def with_outline(report: FileReport, runs: Sequence[tuple[str, Tables]]) -> FileReport:
    """Return the report with the outline of its file, if it has a finding and is not too large."""
    texts: list[Text] = [tables["text"] for _, tables in first_runs(runs)]
    if not report.findings or len(texts[0].source.data) > _LARGEST:
        return report
    lines = _lines_of_programs(runs)
    of_file = outline(_without_comments(texts), chain(_lines(report.findings), *lines.values()))
    return msgspec.structs.replace(report, outline=msgspec.structs.replace(of_file, cuts=cuts(runs), lines=lines))


def outline(text: str, lines: Iterable[int], most: int = MOST) -> Outline:
    """
    Return the outline of a text without comments.

    lines: those whose places are wanted, from 1.
    most: hashes that are listed.
    """
    requested = {*lines}
    with_block: list[int] = []
    of_lines: list[int] = []
    hashes: list[int] = []
    for number, block in enumerate(_in_one_spelling(text).split("\n"), 1):
        if block and not _HEAD.fullmatch(block):
            of_lines.append(number)
            if number in requested:
                with_block.append(number)
            hashes.append(zlib.crc32(block.encode("utf-8", "replace")) & ((1 << BITS) - 1))
    of = 1
    while len(hashes) > most:
        of *= 2
        listed = [index for index, value in enumerate(hashes) if value % of == 0]
        of_lines, hashes = [of_lines[index] for index in listed], [hashes[index] for index in listed]
    return Outline(hashes, of, {line: bisect_right(of_lines, line) - 1 for line in with_block})


def _in_one_spelling(text: str) -> str:
    """Return the blocks in one spelling: N G01 X+05.0 is G1X5. in any case, with or without blanks."""
    text = text if "\n" in text else text.replace("\r", "\n")
    text = "\n" + text.upper().translate(_BLANKS)
    for pattern in _SEQUENCE_NUMBERS:
        text = pattern.sub("", text)
    text = _LEADING_ZEROS.sub("", _PLUS.sub("", text))
    return _TRAILING_ZEROS.sub(lambda number: number[0].rstrip("0"), text)[1:]


def _without_comments(texts: Sequence[Text]) -> str:
    """Return the text of the file itself, without its comments and without the programs that it calls."""
    source = texts[0].source
    text = source.text[: _end(source)]
    pieces, copied = [], 0
    for start, end in sorted(
        span
        for text_with_comments in texts
        for span in side_by_side(text_with_comments.comments.start, text_with_comments.comments.end)
    ):
        if start >= copied:
            pieces += [text[copied:start], "\n" * text.count("\n", start, end)]
            copied = end
    return "".join([*pieces, text[copied:]])


def _end(source: Source) -> int | None:
    """Return the position behind the file itself."""
    return int(source.line_starts[source.parts[0].first_line - 1]) if source.parts else None


def _lines(findings: Iterable[Finding]) -> Iterator[int]:
    for finding in findings:
        yield finding.line
        if finding.section_line is not None:
            yield finding.section_line


def _lines_of_programs(runs: Iterable[tuple[str, Tables]]) -> dict[str, list[int]]:
    """Return all lines of the findings that a program has once, by Outline.key."""
    rules = load_all()
    lines: dict[str, set[int]] = {}
    for _, tables in runs:
        listed: dict[str, Listed] = tables.get("listed", {})
        for name in [name for name in listed if rules[name].once == _PROGRAM]:
            of_hits = tables["trace"].blocks.line[places.rows(rules[name].over, tables)[listed[name].index]]
            for number, finding in enumerate(listed[name].findings):
                for key in _keys(finding, tables):
                    lines.setdefault(key, set()).update(of_hits[listed[name].finding == number].tolist())
    return {key: sorted(of_finding) for key, of_finding in lines.items()}


def _keys(finding: Finding, tables: Tables) -> Iterator[str]:
    """Yield the keys of a finding as it is reported in the file."""
    for reported in in_the_file([finding], tables["trace"], lambda answered, _: answered, tables.get("rows_in_calls")):
        yield Outline.key(reported)


def _depth(trace: Trace) -> Floats:
    """Z behind each row, with its sign turned [mm]; NaN on the sub spindle, whose part may lie on either side."""
    return np.where(trace.modal.on_sub_spindle, np.nan, -trace.path.z)


def _feed(trace: Trace) -> Floats:
    """F in force in each row [mm/min]; NaN in rapid traverse."""
    return np.where(trace.axes.motion == Motion.RAPID, np.nan, trace.feedrate.feed)


def _feed_per_revolution(trace: Trace) -> Floats:
    """F in force in each row [mm/rev]; NaN in rapid traverse."""
    is_other = trace.feedrate.per_minute | (trace.axes.motion == Motion.RAPID)
    return np.where(is_other, np.nan, trace.feedrate.feed_number)


#: The column of each number, which is the worse the higher it is, and the sign that the number has.
_NUMBERS: Mapping[str, tuple[Callable[[Trace], Floats], int]] = {
    LOWEST_Z: (_depth, -1),
    FASTEST: (_feed, 1),
    FASTEST_PER_REVOLUTION: (_feed_per_revolution, 1),
}


def cuts(runs: Iterable[tuple[str, Tables]]) -> dict[str, dict[str, float]]:
    """
    Return the numbers of all findings of rules that are `gouges`, those that follow from others too, by Outline.key.

    A finding stands for several blocks, and a block runs several times: the worst of them counts.
    """
    rules = load_all()
    worst: dict[str, dict[str, float]] = {}
    for _, tables in runs:
        listed: dict[str, Listed] = tables.get("listed", {})
        for name in [name for name in listed if rules[name].gouges]:
            for key, numbers in _of_rule(listed[name], rules[name].over, tables):
                largest = worst.setdefault(key, {})
                largest.update({number: max(value, largest.get(number, value)) for number, value in numbers.items()})
    return {key: {name: _NUMBERS[name][1] * value for name, value in numbers.items()} for key, numbers in worst.items()}


def _of_rule(listed: Listed, over: str, tables: Tables) -> Iterable[tuple[str, dict[str, float]]]:
    """Yield the keys of the findings of a rule in one run, and their highest numbers."""
    trace: Trace = tables["trace"]
    rows = places.rows(over, tables)[listed.index]
    numbers = {}
    for name, (column, _) in _NUMBERS.items():
        numbers[name] = np.full(len(listed.findings), np.nan)
        np.fmax.at(numbers[name], listed.finding, column(trace)[rows])
    for number, finding in enumerate(listed.findings):
        values = {name: float(column[number]) for name, column in numbers.items() if not np.isnan(column[number])}
        yield from ((key, values) for key in _keys(finding, tables))
