"""The outline of a file: a hash per block, by which a baseline finds the places of known findings again."""

from __future__ import annotations

import re
import zlib
from bisect import bisect_right
from collections.abc import Iterable, Iterator, Sequence

import msgspec

from polarcheck.checking.channels import first_runs
from polarcheck.checking.cuts import cuts
from polarcheck.foundation.finding import FileReport, Finding, Outline
from polarcheck.program.reading.source import Source
from polarcheck.program.reading.words import Text
from polarcheck.rules.tables import Tables

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
    of_file = outline(_without_comments(texts), _lines(report.findings))
    return msgspec.structs.replace(report, outline=msgspec.structs.replace(of_file, cuts=cuts(runs)))


def outline(text: str, lines: Iterable[int], most: int = MOST) -> Outline:
    """
    Return the outline of a text without comments.

    lines: those whose places are wanted, from 1.
    most: hashes that are listed.
    """
    wanted = {*lines}
    with_block: list[int] = []
    of_lines: list[int] = []
    hashes: list[int] = []
    for number, block in enumerate(_in_one_spelling(text).split("\n"), 1):
        if block and not _HEAD.fullmatch(block):
            of_lines.append(number)
            if number in wanted:
                with_block.append(number)
            hashes.append(zlib.crc32(block.encode("utf-8", "replace")) & ((1 << BITS) - 1))
    of = 1
    while len(hashes) > most:
        of *= 2
        listed = [at for at, value in enumerate(hashes) if value % of == 0]
        of_lines, hashes = [of_lines[at] for at in listed], [hashes[at] for at in listed]
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
    pieces, at = [], 0
    for start, end in sorted(
        span for one in texts for span in zip(one.comments.start.tolist(), one.comments.end.tolist(), strict=True)
    ):
        if start >= at:
            pieces += [text[at:start], "\n" * text.count("\n", start, end)]
            at = end
    return "".join([*pieces, text[at:]])


def _end(source: Source) -> int | None:
    """Return the position behind the file itself."""
    return int(source.line_starts[source.parts[0].first_line - 1]) if source.parts else None


def _lines(findings: Iterable[Finding]) -> Iterator[int]:
    for finding in findings:
        yield finding.line
        if finding.section_line is not None:
            yield finding.section_line
