from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import WARNING, Hits, rule

if TYPE_CHECKING:
    from polarcheck.columns.words.written import Written
    from polarcheck.program.machines.machine import Machine
    from polarcheck.program.reading.words import Words


@rule(
    WARNING,
    "{count} words in a block; this control takes {limit}",
    values=("count", "limit"),
    worse=("count",),
    over="words",
)
def words_too_many(words: Words, written: Written, machine: Machine) -> Hits:
    """
    More words in a block than the control takes.

    The control stops at a block with more words than it can hold, 26 as a rule. Divide the block.

    Source: FANUC alarm 5006.

    Bad, set control.word_limit=4:

        G40 G80 G97 G98 M8   (expect: words-too-many)

    Good, set control.word_limit=4:

        /G40 G80 G97 G98
        M8
    """
    limit = machine.control.word_limit
    counted = words.address != ord("/")
    beyond = written.first_beyond(counted, limit)
    return Hits(beyond, values={"count": written.in_block(counted, beyond), "limit": limit})
