"""Marks of channels and waits for another one, which a control without them cannot read."""

from __future__ import annotations

from collections.abc import Sequence

import msgspec

from polarcheck.checking.settings import Settings
from polarcheck.rewrite.convert.block_texts import BlockTexts
from polarcheck.rewrite.writing.new_blocks import NewBlock, decision_comment
from polarcheck.rewrite.writing.original import Original
from polarcheck.rewrite.writing.outcome import Decision


class ChannelMarks(msgspec.Struct):
    """Blocks with marks that the other control does not read: the marks are comments, a person decides on waits."""

    blocks: dict[int, list[NewBlock]] = {}
    decisions: list[Decision] = []
    notes: list[str] = []


def channel_marks(original: Original, target: Settings, written: dict[int, Sequence[NewBlock]]) -> ChannelMarks:
    """
    Return what becomes of blocks with marks of channels ($1) and with waits (!2L1).

    written: index in text.blocks -> the new blocks, behind which such marks stand as comments.
    """
    trace, result = original.trace, ChannelMarks()
    if trace.machine == target.machine:
        return result
    ours, theirs = trace.machine.control, target.machine.control
    texts, comments = BlockTexts(trace), trace.text.comments
    for block, start, end in zip(comments.block.tolist(), comments.start.tolist(), comments.end.tolist(), strict=True):
        mark = trace.text.source.excerpt(start, end)
        key = {ours.wait_mark: "wait_mark", ours.channel_mark: "channel_mark"}.get(mark[:1], "")
        is_read = key and mark[:1] == getattr(theirs, key) and f"control.{key}" not in target.doubtful
        if not key or (is_read and block not in written):
            continue
        line, title = texts.line(block), target.machine.title
        new = result.blocks.get(block) or written.get(block) or [NewBlock(tuple(texts.content(block).split()))]
        if key == "channel_mark":
            result.notes.append(f"line {line}: {mark} is a comment: nothing says that {title} reads marks of channels")
        else:
            text = f"{mark}: a wait for another channel, and nothing says that {title} reads it"
            result.decisions.append(Decision(line, text))
            comment = ". ".join(part for part in (new[0].comment, decision_comment(text)) if part)
            new = [NewBlock(new[0].words, comment), *new[1:]]
        result.blocks[block] = list(new)
    return result
