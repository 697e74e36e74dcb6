"""
Splits a file with the programs of several channels, as of a lathe with several turrets or slides.

Each channel is a view of the file in which the others are blank, so that positions and lines do not change.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from msgspec.structs import replace

from polarcheck.foundation.arrays import Mask
from polarcheck.program.reading.source import CR, CTRL_Z, LF, Bytes, Source
from polarcheck.program.reading.surroundings import find_channel_marks, without_comments

_SPACE = 32
#: Characters of other channels that are not blanked: the ends of lines and of the file.
_STAYS = (LF, CR, CTRL_Z)


def channels(source: Source, mark: str, line_comments: str = "") -> list[Source]:
    """
    The channels of a file in the order of their numbers; a file without marks of channels is one channel.

    mark: the character before the number of a channel; empty for none. Text before the first mark is part of all
    channels.
    """
    data = source.code.tobytes()
    if not mark or mark.encode("latin-1") not in data:
        return [source]
    stored = data[: data.find(CTRL_Z)] if CTRL_Z in data else data
    code = np.frombuffer(bytearray(stored if b"\n" in stored else stored.replace(b"\r", b"\n")), np.uint8)
    marks = find_channel_marks(without_comments(code, line_comments), mark)
    numbers = sorted({number for _, number in marks})
    if len(numbers) < 2:
        return [source]
    owner = _owners(marks, len(data))
    every = np.isin(source.code, _STAYS) | (owner == 0)
    return [replace(source, code=_only(source.code, every | (owner == n)), channel=f"{mark}{n}") for n in numbers]


def channel_like(source: Source, example: Source, mark: str, line_comments: str) -> Source:
    """The channel of a new reading of a file that corresponds to `example`; the file itself where there is none."""
    every = channels(source, mark, line_comments) if example.channel else []
    return next((channel for channel in every if channel.channel == example.channel), source)


def stands_in(channel: Source, line: int) -> bool:
    """True where a line, from 1, contains anything of a channel."""
    start, *end = channel.line_starts[line - 1 : line + 1].tolist()
    return bool(channel.code[start : end[0] if end else None].tobytes().strip())


def _owners(marks: Sequence[tuple[int, int]], size: int) -> Bytes:
    """The channel of each character; 0 before the first mark."""
    begins = [0, *(start for start, _ in marks), size]
    return np.repeat(np.array([0, *(number for _, number in marks)], np.uint8), np.diff(begins))


def _only(code: Bytes, mask: Mask) -> Bytes:
    return np.where(mask, code, np.uint8(_SPACE))
