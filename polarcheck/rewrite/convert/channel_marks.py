"""Marks of channels and waits for another one, which a control without them cannot read."""

from __future__ import annotations

from polarcheck.checking.settings import Settings
from polarcheck.rewrite.convert.block_texts import BlockTexts
from polarcheck.rewrite.convert.new_program import NewProgram
from polarcheck.rewrite.writing.new_blocks import NewBlock, decision_comment
from polarcheck.rewrite.writing.original import Original
from polarcheck.rewrite.writing.outcome import Decision


def write_channel_marks(original: Original, target: Settings, new: NewProgram) -> list[str]:
    """
    Write marks of channels ($1) and waits (!2L1) that the other control does not read as comments; a person decides on
    waits. Return notes.

    new: has the other blocks, behind which such marks stand.
    """
    trace, notes = original.trace, list[str]()
    if trace.machine == target.machine:
        return notes
    ours, theirs = trace.machine.control, target.machine.control
    texts, comments, rewritten = BlockTexts(trace), trace.text.comments, set(new.blocks)
    for block, start, end in zip(comments.block.tolist(), comments.start.tolist(), comments.end.tolist(), strict=True):
        mark = trace.text.source.excerpt(start, end)
        key = {ours.wait_mark: "wait_mark", ours.channel_mark: "channel_mark"}.get(mark[:1], "")
        is_read = key and mark[:1] == getattr(theirs, key) and f"control.{key}" not in target.doubtful
        if not key or (is_read and block not in rewritten):
            continue
        line, title = texts.line(block), target.machine.title
        first, *others = new.blocks.get(block) or [NewBlock(tuple(texts.content(block).split()))]
        if key == "channel_mark":
            notes.append(f"line {line}: {mark} is a comment: nothing says that {title} reads marks of channels")
        else:
            text = f"{mark}: a wait for another channel, and nothing says that {title} reads it"
            new.decisions.append(Decision(line, text))
            first = NewBlock(first.words, ". ".join(part for part in (first.comment, decision_comment(text)) if part))
        new.blocks[block] = [first, *others]
    return notes
