"""Joins the texts of a file and of the programs that it calls; each file is read once."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np

from polarcheck.program.reading.source import LF, Part, Source
from polarcheck.program.reading.surroundings import narrow
from polarcheck.program.reading.words import Blocks, Spans, Text, Words


def joined(files: Sequence[Text]) -> Text:
    """
    Join texts: the tables of the first file, then those of each called file with their positions moved behind it.

    `source.parts` contains where each called file begins.
    """
    if len(files) == 1:
        return files[0]
    source, characters = _joined_sources([file.source for file in files])
    blocks = [0, *itertools.accumulate(len(file.blocks) for file in files)]
    lines = [0, *itertools.accumulate(len(file.source.line_starts) for file in files)]
    size = narrow(len(source.code))

    def moved(columns: Iterable[Any], offsets: Sequence[int]) -> Any:
        return np.concatenate(
            [column.astype(size) + size(offset) for column, offset in zip(columns, offsets, strict=False)]
        )

    def table(kind: type[Any], tables: Sequence[Any]) -> Any:
        offsets = {"start": characters, "end": characters, "block": blocks, "line": lines}
        names = kind.__struct_fields__
        columns = {name: [getattr(part, name) for part in tables] for name in names}
        return kind(
            *(
                moved(columns[name], offsets[name]) if name in offsets else np.concatenate(columns[name])
                for name in names
            )
        )

    return Text(
        source=source,
        words=table(Words, [file.words for file in files]),
        blocks=table(Blocks, [file.blocks for file in files]),
        comments=table(Spans, [file.comments for file in files]),
        unclosed=np.concatenate([file.unclosed for file in files]),
        nested=np.concatenate([file.nested for file in files]),
        names=table(Spans, [file.names for file in files]),
        strays=table(Spans, [file.strays for file in files]),
        foreign=table(Spans, [file.foreign for file in files]),
        prose=table(Spans, [file.prose for file in files]),
        dots=table(Spans, [file.dots for file in files]),
        outside=table(Spans, [file.outside for file in files]),
        tape_marks=moved([file.tape_marks for file in files], characters),
        letters=moved([file.letters for file in files], characters),
        labels=table(Spans, [file.labels for file in files]),
    )


def _joined_sources(sources: Sequence[Source]) -> tuple[Source, list[int]]:
    """The characters of all files, each with a line end behind it; and the positions at which they begin."""
    texts, codes, starts, parts = [], [], [], []
    offsets, lines = [0], 0
    for source in sources:
        ends = bool(len(source.code)) and source.code[-1] == LF
        texts.append(source.text + "\n" * (not ends))
        codes.append(source.code if ends else np.append(source.code, np.uint8(LF)))
        starts.append(source.line_starts + offsets[-1])
        parts.append(Part(lines + 1, source.path, source.added_lines))
        lines += len(source.line_starts)
        offsets.append(offsets[-1] + len(codes[-1]))
    data = "".join(texts).encode("utf-8", "surrogatepass")
    first = sources[0]
    code, line_starts = np.concatenate(codes), np.concatenate(starts)
    whole = Source(first.path, data, "utf-8", b"", code, line_starts, tuple(parts[1:]), channel=first.channel)
    return whole, offsets
