from __future__ import annotations

from polarcheck.checking.rule import ERROR, Mask, OtherMode, Words, rule


@rule(ERROR, "{text}: {number_fault}", over="words")
def bad_number(words: Words, other_mode: OtherMode) -> Mask:
    """
    A number that a control cannot read.

    An address without digits, a number with two points or two signs or a sign behind its digits, digits without an
    address: the control stops at this block. The rest of the block is read as if the word were not there.

    Source: FANUC alarms 004 to 007.

    Bad:

        G98 G0 X60. C0
        G12.1
        G1 X F100        (expect: bad-number)
        X40.5.           (expect: bad-number)
        C--5.            (expect: bad-number)
        G13.1

    Good:

        G98 G0 X+60. C0
        G12.1
        G1 X40. F100
        C-5.
        G13.1
    """
    return words.is_unreadable & ~other_mode.explained
