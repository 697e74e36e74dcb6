"""
Edits of the text of a program: words taken out, blocks put in, with the line ends and blanks of what stands around.

A Replace is (start, end, text): the characters from start to end (exclusive) become the text.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import pairwise

from polarcheck.foundation.arrays import stretch
from polarcheck.program.execution.run import Run
from polarcheck.program.reading.source import CR, LF, Source
from polarcheck.program.reading.words import Text
from polarcheck.rules.places import squeezed

Replace = tuple[int, int, str]

_SEMICOLON = ord(";")
_BLANKS = " \t"
_BLANK_OR_END = " \t\r\n\0\x7f"


def is_plain(run: Run, row: int) -> bool:
    """Whether the words of a row stand in the file as they are executed: no macro, no words of another language."""
    block = int(run.block[row])
    if run.text.blocks.is_macro[block]:
        return False
    words, source = run.words, run.text.source
    for index in words_of(run, row):
        written = source.excerpt(int(words.start[index]), int(words.end[index])).lstrip(",").strip()
        address = chr(int(words.address[index])).upper()
        if written[:1].upper().replace(":", "O") != address:
            return False
    return True


def words_of(run: Run, row: int) -> list[int]:
    """The executed words of a row, in the order in which they are written."""
    low, high = stretch(run.row, row, row + 1)
    return sorted(range(low, high), key=lambda index: int(run.words.start[index]))


def is_head(run: Run, index: int) -> bool:
    """An N word, an O word or block skip, which stay at the head of a block."""
    return chr(int(run.words.address[index])) in "NO/"


def words_behind_head(run: Run, row: int) -> list[int]:
    """The executed words of a row without those at its head, in the order in which they are written."""
    return [index for index in words_of(run, row) if not is_head(run, index)]


def begins_program(run: Run, row: int) -> bool:
    """A row with an O word: nothing can be put before its block."""
    return any(chr(int(run.words.address[index])) == "O" for index in words_of(run, row))


def written_word(run: Run, index: int) -> str:
    """An executed word as it is written, without blanks."""
    words = run.words
    text = squeezed(run.text.written(words, index))
    return "".join(filter(str.isprintable, text))


def skip_sign(run: Run, row: int) -> str:
    """The block skip of a row as it is written, `/` or `/2`; empty without."""
    signs = [index for index in words_of(run, row) if chr(int(run.words.address[index])) == "/"]
    return written_word(run, signs[0]) if signs else ""


def separator(run: Run, row: int) -> str:
    """What stands between the words of a row: a blank, or nothing in a program without blanks."""
    words, own = run.words, words_of(run, row)
    if len(own) < 2:
        return " "
    apart = [int(words.start[after]) - int(words.end[before]) for before, after in pairwise(own)]
    return " " if any(apart) else ""


def line_end(source: Source, line: int) -> str:
    """The line end behind a line (from 1), else that before it: LF, CR LF, LF CR CR, CR CR LF or CR; LF without any."""
    code, starts = source.code, source.line_starts
    for number in (line, line - 1):
        if not 0 < number < len(starts) + (len(code) > 0 and code[-1] in (LF, CR)):
            continue
        end = int(starts[number]) if number < len(starts) else len(code)
        first = end - 1
        if code[first] == CR:
            return "\r"
        while first and code[first - 1] == CR:
            first -= 1
        last = end
        while last < len(code) and code[last] == CR:
            last += 1
        if last < len(code) and code[last] == LF:  # they belong to the end of the next line, which is empty
            last = end
        return "\r" * (end - 1 - first) + "\n" + "\r" * (last - end)
    return "\n"


def content_of(text: Text, block: int) -> tuple[int, int]:
    """The characters of a block without the blanks and line ends around it."""
    return without_blanks(text.written(text.blocks, block), int(text.blocks.start[block]))


def without_blanks(content: str, start: int) -> tuple[int, int]:
    """The characters of a content that begins with `start`, without the blanks and line ends around it."""
    stripped = content.rstrip(_BLANK_OR_END)
    end = start + len(stripped)
    return end - len(stripped.lstrip(_BLANK_OR_END)) if stripped else start, end


def _ends_with_sign(text: Text, block: int) -> bool:
    """A semicolon ends the block."""
    code, end = text.source.code, int(text.blocks.end[block])
    return end < len(code) and int(code[end]) == _SEMICOLON


def _line_of(text: Text, block: int) -> int:
    return text.source.line_of(content_of(text, block)[0])


def blocks_before(text: Text, block: int, texts: Sequence[str]) -> Replace:
    """New blocks before one, each on a line of its own; before a block in the middle of a line beside it."""
    source, (start, _) = text.source, content_of(text, block)
    line = source.line_of(start)
    first = int(source.line_starts[line - 1])
    while first < start and source.code[first] == CR:
        first += 1
    if source.excerpt(first, start).strip(_BLANK_OR_END):
        return start, start, "".join(f"{content}; " for content in texts)
    sign = ";" * _ends_with_sign(text, block)
    return first, first, "".join(f"{content}{sign}{line_end(source, line)}" for content in texts)


def blocks_behind(text: Text, block: int, texts: Sequence[str]) -> Replace:
    """New blocks behind one, each on a line of its own."""
    end = content_of(text, block)[1]
    sign = parting(text, block)
    return end, end, "".join(f"{sign}{content}" for content in texts)


def parting(text: Text, block: int) -> str:
    """What parts a block into two."""
    return ";" * _ends_with_sign(text, block) + line_end(text.source, _line_of(text, block))


def parted(run: Run, row: int, index: int) -> Replace:
    """The block of a row parted in two before one of its words; block skip stands at the head of both."""
    words, source = run.words, run.text.source
    block = int(run.block[row])
    start, begin = int(words.start[index]), int(run.text.blocks.start[block])
    before = source.excerpt(begin, start)
    blanks = len(before) - len(before.rstrip(_BLANKS))
    return start - blanks, start, parting(run.text, block) + skip_sign(run, row)


def with_word(run: Run, row: int, text: str) -> Replace:
    """A word put behind the last one of a row."""
    index = words_of(run, row)[-1]
    end = int(run.words.end[index])
    return end, end, separator(run, row) + text


def in_place_of(run: Run, index: int, text: str) -> Replace:
    """Another word in the place of one; a name before = that is read as its letter, as CR, stays."""
    start, end = int(run.words.start[index]), int(run.words.end[index])
    return start, end, text[text.find("=") :] if run.text.source.excerpt(start, start + 1) == "=" else text


def without(run: Run, row: int, removed: Iterable[int]) -> list[Replace]:
    """The block of a row without some of its words; where nothing is left of it, without its line."""
    words, source = run.words, run.text.source
    block = int(run.block[row])
    begin, end = content_of(run.text, block)
    text = source.excerpt(begin, end)
    gone: list[tuple[int, int]] = []
    for index in sorted(removed, key=lambda index: int(words.start[index])):
        first, last = int(words.start[index]) - begin, int(words.end[index]) - begin
        if gone and not text[gone[-1][1] : first].strip(_BLANKS):
            gone[-1] = gone[-1][0], last
        else:
            gone.append((first, last))
    kept = [0, *(place for span in gone for place in span), len(text)]
    if not "".join(text[first:last] for first, last in zip(kept[::2], kept[1::2], strict=True)).strip(_BLANKS + "/"):
        return [line_without(run.text.source, begin, end)]
    return [(begin + first, begin + last, "") for first, last in (_with_blanks(text, *span) for span in gone)]


def _with_blanks(text: str, first: int, last: int) -> tuple[int, int]:
    """What goes with the blanks behind it; at the end of a block with those before it."""
    behind = text[last:]
    last += len(behind) - len(behind.lstrip(_BLANKS))
    return (len(text[:first].rstrip(_BLANKS)), last) if last == len(text) else (first, last)


def line_without(source: Source, begin: int, end: int) -> Replace:
    """A block that goes as a whole: with its line, where nothing else stands on that."""
    line = source.line_of(begin)
    first = int(source.line_starts[line - 1])
    while first < begin and source.code[first] == CR:
        first += 1
    last = int(source.line_starts[line]) if line < len(source.line_starts) else len(source.code)
    behind = source.excerpt(end, last)
    if source.excerpt(first, begin).strip(_BLANKS) or behind.strip(_BLANK_OR_END + ";") or behind.count(";") > 1:
        return begin, end + len(behind) - len(behind.lstrip(_BLANKS + ";")) if ";" in behind else end, ""
    if line < len(source.line_starts):
        while last < len(source.code) and source.code[last] == CR:
            last += 1
        if last < len(source.code) and source.code[last] == LF:
            last = int(source.line_starts[line])
    return first, last, ""
