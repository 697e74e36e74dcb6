"""The ways in which a file runs: as it stands or executed, with block skip off and on, with the programs it calls."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path

import msgspec
import numpy as np

from polarcheck.execution.programs import find_programs, needs_flow
from polarcheck.execution.run import Run, straight
from polarcheck.machines.job import Running
from polarcheck.machines.machine import Machine
from polarcheck.reading.source import Source, joined, read
from polarcheck.reading.translation import translated
from polarcheck.reading.words import Text, read_words

#: A called program is a program, not an archive.
_LARGEST_SUBPROGRAM = 50_000_000
_MOST_SUBPROGRAMS = 100
_NAME = re.compile(r"[A-Za-z0-9+_.-]{1,64}")


def runs(source: Source, machine: Machine, asked: Running) -> list[tuple[str, Run]]:
    """The runs of a file, each with the state of block skip ("" where it makes no difference)."""
    text = _text(source, machine)
    if not needs_flow(text):
        return [("", straight(text))]
    has_skip = bool(np.any(text.words.address == ord("/"))) or _skips_macro(text)
    states = ["off", "on"] if asked.block_skip == "both" else [asked.block_skip]
    if not has_skip:
        return [("", _executed(source, text, machine, asked, False))]
    found = [(state, _executed(source, text, machine, asked, state == "on")) for state in states]
    return found if len(found) > 1 else [("", found[0][1])]


def _text(source: Source, machine: Machine) -> Text:
    return read_words(translated(source, machine.control.native_words), machine.control.line_comments)


def _skips_macro(text: Text) -> bool:
    """Whether a block with macro begins with / or has one that is no division."""
    from polarcheck.execution.programs import block_text

    blocks = np.flatnonzero(text.blocks.is_macro).tolist()
    return any(re.match(r"\s*(?:N\s*\d+\s*)?/", block_text(text, block), re.IGNORECASE) for block in blocks)


def _executed(source: Source, text: Text, machine: Machine, asked: Running, skip: bool) -> Run:
    from polarcheck.execution.calls import Bounds
    from polarcheck.execution.execute import execute

    ends = tuple(machine.m_codes.program_end)
    macro = msgspec.structs.replace(machine.macro, given={**machine.macro.given, **asked.variables})
    bounds = Bounds(asked.max_blocks, asked.max_statements, asked.max_seconds)
    tried: set[tuple[int | None, str | None]] = set()
    found: list[Source] = []

    def resolve(number: int | None, name: str | None) -> bool:
        if (number, name) in tried or len(tried) > _MOST_SUBPROGRAMS:
            return False
        tried.add((number, name))
        called = find_program(number, name, [Path(folder) for folder in asked.subprograms])
        if called is not None:
            found.append(called)
        return called is not None

    while True:
        run = execute(text, find_programs(text), macro, ends, skip=skip, bounds=bounds, resolve=resolve)
        if run is not None:
            return run
        source = joined(source, found[-1])
        text = _text(source, machine)


def find_program(number: int | None, name: str | None, folders: Sequence[Path]) -> Source | None:
    """
    A program in the folders of the job, never outside them: O1234, 1234.nc, O1234.NC, or its <name>.

    A file without an O number of its own is given that of the call.
    """
    if number is not None:
        wanted = re.compile(rf"O?0*{number}(?:\.[A-Za-z]{{1,4}})?", re.IGNORECASE)
    elif name is not None and _NAME.fullmatch(name):
        wanted = re.compile(rf"{re.escape(name)}(?:\.[A-Za-z]{{1,4}})?", re.IGNORECASE)
    else:
        return None
    for folder in folders:
        root = folder.resolve()
        for path in sorted(root.iterdir()) if root.is_dir() else ():
            inside = path.resolve().is_relative_to(root)
            if wanted.fullmatch(path.name) and inside and path.is_file() and path.stat().st_size < _LARGEST_SUBPROGRAM:
                return _with_head(path, number, name)
    return None


def _with_head(path: Path, number: int | None, name: str | None) -> Source | None:
    try:
        data = path.read_bytes()
    except OSError:
        return None
    head = f"O{number:04d}" if number is not None else f"O<{name}>"
    own = re.search(rb"^\s*%?\s*[O:]\s*(\d+|<[^>\n]*>)", data, re.MULTILINE | re.IGNORECASE)
    right = own is not None and (own[1].isdigit() and number is not None and int(own[1]) == number)
    if not right and not (own and name is not None and own[1].strip(b"<>").decode("latin-1").upper() == name.upper()):
        data = head.encode() + b"\n" + data
    return read(data, path.name)
