from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import WARNING, rule

if TYPE_CHECKING:
    from polarcheck.columns.words.written import Written
    from polarcheck.foundation.arrays import Mask


@rule(WARNING, "there is no block in this file", over="files")
def empty_program(written: Written) -> Mask:
    """
    File without any block.

    Nothing was looked at: the file is empty, holds only comments, or all of it stands outside the program. A transfer
    that broke off or a post that failed leaves such a file behind.

    Source: FANUC B-63524EN/01, p. 649 (what a control stores of a file).

    Bad:

        %  (expect: empty-program)
        (TRANSFER BROKE OFF)
        %

    Good:

        %
        O0001
        M30
        %
    """
    return written.contents == 0
