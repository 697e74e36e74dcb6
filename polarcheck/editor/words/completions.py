"""Completion of codes, tools, jump targets, programs and variables: what this control and this program know."""

from __future__ import annotations

import itertools
import os
import re
from collections.abc import Callable, Iterable, Iterator
from typing import NamedTuple

import numpy as np
from lsprotocol import types

from polarcheck.checking.settings import Settings
from polarcheck.editor.open_text import OpenText
from polarcheck.editor.structure.document import Document, block_at
from polarcheck.editor.words import code_meanings, variables
from polarcheck.editor.words.at_cursor import is_in
from polarcheck.program.execution.listing import Listing
from polarcheck.program.execution.programs import Program, block_text
from polarcheck.program.machines.machine import Machine
from polarcheck.program.reading.excerpt import shortened, visible

_NAME = re.compile(r"O?0*+(\d{1,8})(?:\.[A-Za-z]{1,4})?", re.IGNORECASE | re.ASCII)
#: Files of a folder that are looked at.
_MOST_ENTRIES = 2_000


def numbered_files(folders: Iterable[str]) -> list[tuple[int, str]]:
    """Return number and file name of the programs in some folders; folders that cannot be listed hold none."""
    found = []
    for folder in folders:
        try:
            with os.scandir(folder) as entries:
                names = sorted(entry.name for entry, _ in zip(entries, range(_MOST_ENTRIES), strict=False))
        except OSError:
            continue
        found += [(int(match[1]), name) for name in names if (match := _NAME.fullmatch(name))]
    return found


#: The most items of a list; beyond them the editor asks again.
_MOST = 500
#: What stands beside an item [characters].
_LONGEST = 60
_VARIABLES = re.compile(r"#\d{1,8}(?!\d)|\b(?:R|VC)\d{1,5}(?!\d)", re.ASCII | re.IGNORECASE)
#: A block with an N number, up to a comment.
_NUMBERED = re.compile(
    r"(?:^|(?<=[\n\r;]))[ \t]{0,9}(?:/\d?[ \t]{0,9})?N[ \t]{0,9}0{0,9}(\d{1,9})(?!\d)[^\n\r;(]{0,80}",
    re.ASCII | re.IGNORECASE,
)


class Item(NamedTuple):
    """
    What can be written.

    label: as it is written.
    detail: what it is.
    kind: for the editor's sign.
    """

    label: str
    detail: str
    kind: types.CompletionItemKind


class CursorContext(NamedTuple):
    """
    Where somebody writes.

    document: as its control reads it.
    listing: the channel.
    block: of the listing.
    program: the program around it.
    settings: of the last check; None before the first.
    """

    document: Document
    listing: Listing
    block: int
    program: Program
    settings: Settings | None


def completions(document: Document, settings: Settings | None, position: types.Position) -> types.CompletionList:
    """Return what can be written at a position; nothing in comments, and nothing where no list of it would help."""
    before = _before(document, position)
    items: list[Item] = []
    typed = ""
    if before is not None:
        for pattern, find in _FINDERS:
            match = pattern.search(before)
            if match is None:
                continue
            listing, block = next(iter(document.at(position)))
            if listing.programs.programs:
                program = listing.programs.around(block_at(listing, document.text.character_of(position)))
                place_of_cursor = CursorContext(document, listing, block, program, settings)
                items = list(itertools.islice(find(place_of_cursor, match[1]), _MOST + 1))
            typed = match[1]
            break
    offset = document.text.offset(position)
    range_typed = document.text.range(offset - len(typed), offset)
    fitting = [item for item in items if item.label.upper().startswith(typed.upper()[:1])]
    return types.CompletionList(
        is_incomplete=len(fitting) > _MOST,
        items=[_item(item, number, range_typed) for number, item in enumerate(_nearest(fitting, typed)[:_MOST])],
    )


def _nearest(items: list[Item], typed: str) -> list[Item]:
    """Return the items, those that begin as it is typed first; of a long list they alone can be shown."""
    return sorted(items, key=lambda item: not item.label.upper().startswith(typed.upper()))


def _item(item: Item, number: int, range_typed: types.Range) -> types.CompletionItem:
    return types.CompletionItem(
        label=visible(item.label),
        kind=item.kind,
        detail=visible(shortened(item.detail, _LONGEST)) or None,
        sort_text=f"{number:05d}",
        filter_text=item.label,
        text_edit=types.TextEdit(range_typed, item.label),
    )


def _before(document: Document, position: types.Position) -> str | None:
    """Return what stands in the line before a position; None in a comment."""
    text: OpenText = document.text
    offset = text.offset(position)
    written = text.text[text.offset_of(text.line_of(position)) : offset]
    for mark in document.machine.control.line_comments:
        if mark in written:
            return None
    if document.machine.control.parentheses_are_comments:
        return None if written.rfind("(") > written.rfind(")") else written[written.rfind(")") + 1 :]
    return written


# ---- what can be written ----


def _codes(context: CursorContext, typed: str) -> Iterator[Item]:
    """Yield the codes of the control; those that switch the polar mode, and those of the program, come first."""
    machine, letter = context.document.machine, typed[0].upper()
    texts = {code: text for code, text in code_meanings.known_codes(machine).items() if code[0] == letter}
    switches = [code for code in (*machine.polar.on, *machine.polar.off) if code in texts]
    used = [code for code in _used(context.listing, letter) if code in texts]
    explained = [code for code, text in texts.items() if text]
    for code in dict.fromkeys([*switches, *sorted(used, key=_number), *sorted(explained, key=_number)]):
        yield Item(code, texts[code], types.CompletionItemKind.Function)
    # The others mean nothing to polarcheck; they follow once a digit is typed.
    for code in sorted(set(texts) - set(explained), key=_number) if len(typed) > 1 else ():
        if code not in used:
            yield Item(code, "", types.CompletionItemKind.Function)


def _number(code: str) -> float:
    return float(code[1:])


def _used(listing: Listing, letter: str) -> list[str]:
    words = listing.text.words
    values = np.unique(np.round(words.value[words.address == ord(letter)], 1))
    return [f"{letter}{value:g}" for value in values[np.isfinite(values)].tolist() if 0 <= value < 10_000]


def _tools(context: CursorContext, typed: str) -> Iterator[Item]:
    """Yield the tools of the job and of the program, as T calls them."""
    machine = context.document.machine
    by_edge = machine.offsets.called_by == "edge"
    labels: dict[str, str] = {}
    words = context.listing.text.words
    is_tool = np.flatnonzero((words.address == ord("T")) & np.isfinite(words.value))
    for index in is_tool[:_MOST].tolist():
        written = context.listing.text.written(words, index).upper()
        label = "".join(written.split())
        labels.setdefault(label, _comment(context.listing, int(words.block[index])))
    digits = machine.control.offset_digits
    units = f" {context.settings.job.units or context.settings.machine.control.units}" if context.settings else ""
    for key, tool in context.settings.job.tools.items() if context.settings is not None else ():
        name = str(key)
        if by_edge:
            label = (
                f"T{name.partition('/')[0]}" if name.partition("/")[0].isdecimal() else f'T="{name.partition("/")[0]}"'
            )
        elif name.isdecimal():
            label = _label(int(name), digits, labels)
        else:
            continue
        radius = f"R {tool.radius:g}{units} ({tool.source})" if tool.radius == tool.radius else ""
        labels[label] = ", ".join(filter(None, (radius, labels.get(label, ""))))
    for label, detail in labels.items():
        yield Item(label, detail, types.CompletionItemKind.EnumMember)


def _label(number: int, digits: int, labels: Iterable[str]) -> str:
    """Return how the program calls an offset, or how it would by the number of the tool."""
    digits_needed = f"{number:0{digits}d}"[-digits:]
    return next(
        (label for label in labels if len(label) > digits and label.endswith(digits_needed)),
        f"T{number:02d}{digits_needed}",
    )


def _comment(listing: Listing, block: int) -> str:
    """Return the comment beside a block."""
    comments = listing.text.comments
    low, high = np.searchsorted(comments.block, (block, block + 1)).tolist()
    if low == high:
        return ""
    return listing.text.written(comments, low).strip("();")


def _sequence_numbers(context: CursorContext, typed: str) -> Iterator[Item]:
    """Yield the N numbers of the program, with what stands behind them."""
    text, program = context.listing.text, context.program
    begin, end = int(text.blocks.start[program.first]), int(text.blocks.end[program.end - 1])
    numbers: dict[int, str] = {}
    # By the characters: no answer at a key waits for the statements of a long program.
    for match in _NUMBERED.finditer(text.source.text, begin, end):
        if match[1].startswith(typed):
            numbers.setdefault(int(match[1]), match[0])
    for number in sorted(numbers):
        yield Item(str(number), " ".join(numbers[number].split()), types.CompletionItemKind.Reference)


def _labels(context: CursorContext, typed: str) -> Iterator[Item]:
    """Yield the labels of the program, then its N numbers."""
    has_labels = context.document.machine.macro.language != "custom-macro"
    labels = context.listing.programs.labels(context.program) if has_labels else {}
    for name, blocks in sorted(labels.items()):
        yield Item(name, _one_line(context.listing, blocks[0]), types.CompletionItemKind.Reference)
    prefix = "N" if has_labels else ""
    for item in _sequence_numbers(context, typed.upper().removeprefix("N")):
        yield item._replace(label=f"{prefix}{item.label}")


def _returns(context: CursorContext, typed: str) -> Iterator[Item]:
    """Yield the N numbers to which M99 P returns: those of the other programs of the file, or of its own."""
    callers = [program for program in context.listing.programs.programs if program.first != context.program.first]
    for program in callers[:_MOST] or [context.program]:
        yield from _sequence_numbers(context._replace(program=program), typed)


def _programs(context: CursorContext, typed: str) -> Iterator[Item]:
    """Yield the programs of the file and of the folders of called programs, by their numbers."""
    programs = context.listing.programs.programs
    names = {
        program.number: _comment(context.listing, program.first)
        for program in programs
        if program.number is not None and program.first != context.program.first
    }
    for number, name in numbered_files(context.document.folders):
        names.setdefault(number, name)
    for number, detail in sorted(names.items()):
        yield Item(str(number), detail, types.CompletionItemKind.Module)


def _variables(context: CursorContext, typed: str) -> Iterator[Item]:
    """Yield the variables of the program, those with a value from the settings, and those that act by themselves."""
    machine, first = context.document.machine, typed[0].upper()
    used = _used_variables(context, first, typed.upper())
    for name, block in sorted(used.items(), key=lambda entry: (len(entry[0]), entry[0])):
        yield Item(name, _of_variable(name, machine, _one_line(context.listing, block)), _VARIABLE)
    if first == "#":
        macro = machine.macro
        given = {**macro.given, **(context.settings.job.run.variables if context.settings is not None else {})}
        for number in [*given, *macro.alarm_variables, *macro.stop_variables]:
            if f"#{number}" not in used:
                value = f"= {given[number]:g}" if number in given else ""
                yield Item(f"#{number}", _of_variable(f"#{number}", machine, value), _VARIABLE)


def _used_variables(context: CursorContext, first: str, current: str) -> dict[str, int]:
    """Return the first block of each variable that the program uses, but for the one that is being typed."""
    text = context.listing.text
    used: dict[str, int] = {}
    for match in _VARIABLES.finditer(text.source.text):
        name = match[0].upper()
        if name in used or name[0] != first:
            continue
        block = block_at(context.listing, match.start())
        is_new = name == current and block == context.block
        if text.blocks.is_macro[block] and not is_new and not is_in(match.start(), text.comments, block):
            used[name] = block
    return used


_VARIABLE = types.CompletionItemKind.Variable


def _of_variable(name: str, machine: Machine, more: str) -> str:
    number = variables.number_of(name)
    kind = variables.kind_of(number, machine) if number is not None and name[0] == "#" else ""
    return ": ".join(filter(None, (more, kind)))


def _words(context: CursorContext, typed: str) -> Iterator[Item]:
    """Yield the words of the control's own language that stand for codes."""
    for word, equivalent in context.document.machine.control.native_words.items():
        if word.upper().startswith(typed.upper()):
            detail = code_meanings.known_codes(context.document.machine).get(equivalent, "") or f"read as {equivalent}"
            yield Item(word, detail, types.CompletionItemKind.Keyword)


def _one_line(listing: Listing, block: int) -> str:
    """Return the text of a block in one line."""
    return " ".join(block_text(listing.text, block).split())


#: What stands before the cursor, with what is replaced, and what can stand there; the first that fits counts.
_FINDERS: tuple[tuple[re.Pattern[str], Callable[[CursorContext, str], Iterator[Item]]], ...] = tuple(
    (re.compile(pattern, re.IGNORECASE | re.ASCII), find)
    for pattern, find in (
        (r"GOTO[FBC]?[ ]{0,9}(\w{0,40})$", _labels),
        (r"(?<![A-Z])M0?99[^A-Z]{0,9}P[ ]?(\d{0,9})$", _returns),
        (r"(?<![A-Z])(?:M0?98|M198|G65|G66(?:\.1)?)(?![\d.])[^\n]{0,60}?(?<![A-Z])P[ ]?(\d{0,9})$", _programs),
        (r"(?<![A-Z])(?:G7[0-3])(?![\d.])[^\n]{0,60}?(?<![A-Z])[PQ][ ]?(\d{0,9})$", _sequence_numbers),
        (r"(?<![A-Z])M0?97[^A-Z]{0,9}P[ ]?(\d{0,9})$", _sequence_numbers),
        (r"(#\d{0,8})$", _variables),
        (r"(?<![A-Z0-9_])((?:R|VC)\d{1,5})$", _variables),
        (r"(?<![A-Z_])([GM]\d{0,3}\.?\d?)$", _codes),
        (r"(?<![A-Z_])(T\d{0,8})$", _tools),
        (r"(?<![A-Z0-9_])([A-Z][A-Z_]{1,30})$", _words),
    )
)
