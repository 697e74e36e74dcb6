"""The F in force, as messages name it."""

from __future__ import annotations

from polarcheck.rules.hit import Hit
from polarcheck.rules.wording.written import executed_word


def feed_word(hit: Hit) -> str:
    """The F word in force in a row, its line where that is another, and at what it is clamped."""
    feedrate, written = hit.trace.feedrate, f_word(hit)
    if feedrate.feed[hit.row] < feedrate.programmed_feed[hit.row]:
        return f"{written} clamped at {hit.quantity(feedrate.feed[hit.row]):feed}"
    return written


def f_word(hit: Hit) -> str:
    """The F word in force in a row, and its line where that is another."""
    run, feedrate = hit.trace.run, hit.trace.feedrate
    words = hit.trace.blocks.word_indices("F")
    at = words[run.words.start[words] == feedrate.feed_word[hit.row]]
    if not len(at):
        return f"F {hit.quantity(feedrate.programmed_feed[hit.row]):feed}"
    line, written = hit.line(run.row[at[0]]), executed_word(run, int(at[0]))
    return written if line == hit.line(hit.row) else f"{written} of line {line}"
