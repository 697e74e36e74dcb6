from __future__ import annotations

from polarcheck.checking.rule import WARNING, Faults, Mask, rule


@rule(WARNING, "{what}", over="faults")
def subprogram_missing(faults: Faults) -> Mask:
    """
    Called program that is not found.

    M98, G65 or G66 names a program that is neither in this file nor in a folder of the job. On the control it may be
    there; here its moves are not known, nor any position after it until it is programmed again. Name the folder in
    polarcheck.toml, `subprograms = ["folder"]`, or on the command line.

    Source: FANUC alarms 076 and 078.

    Bad:

        O0001
        #0=1             (expect: read-only-variable)
        G0 X50.
        M98 P1234        (expect: subprogram-missing)
        M30

    Bad:

        O0001
        M98              (expect: subprogram-missing)
        M30

    Good:

        O0001
        M98 P1234
        M30
        O1234
        G0 X50.
        M99
    """
    return faults.rule == "subprogram-missing"
