from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import ERROR, Hits, rule

if TYPE_CHECKING:
    from polarcheck.columns.modes.mode_words import ModeWords
    from polarcheck.columns.modes.switch_words import SwitchWords
    from polarcheck.rules.hit import Details, Hit


@rule(
    ERROR,
    "{code} shares its block with {word}; it must stand in a block of its own{taken_by}",
    values=("code", "word"),
    doubts=(("metal", "section"),),
)
def polar_switch_not_alone(mode_words: ModeWords, switch_words: SwitchWords) -> Hits:
    """
    G12.1 or G13.1 not in a block of its own.

    What the control does with other words beside them is not specified: they may be ignored, or be read on the polar
    plane, or outside of it. Only a sequence number, the block skip sign and comments may share the block, and beside
    G12.1 the words that this control takes there (polar.words_beside_switch). A G13.1 outside the mode, as at the head
    of a program for safety, is not meant.

    The message names the controls that take such words beside G12.1: P is the spindle or the axis there, and in
    LinuxCNC, whose G12.1 is no polar mode, the number of the kinematics.

    Source: FANUC B-62764EN/01, p. 50; GSK 988, description of G12.1 IP P Q E; LinuxCNC, pull requests 4414
    and 4534.

    Bad:

        G98 G0 X60. C0
        G12.1 M8          (expect: polar-switch-not-alone)
        G1 X40. F200
        C10.
        X60.
        G13.1 G0 Z50.     (expect: polar-switch-not-alone)

    Bad, machine gsk-988:

        G98 G0 X60. C0
        G12.1 P1 Q3
        G1 X40. F200
        C10.
        X60.
        G13.1 P1 Q3       (expect: polar-switch-not-alone)

    Good:

        G40 G80 G13.1
        G98 G0 X60. C0 M8
        N10 G12.1 (ON)
        G1 X40. F200
        C10.
        X60.
        /N20 G13.1
        G13.1
        G0 Z50.
    """
    beside = mode_words.in_rows(mode_words.switches) & ~mode_words.may_stand_beside_switch
    beside &= ~switch_words.shifts_incrementally
    return Hits(mode_words.rows(beside), at=beside)


def details(hit: Hit) -> Details:
    return {"code": hit.switch, "word": hit.word_list, "taken_by": _taken_by(hit)}


def _taken_by(hit: Hit) -> str:
    """Where these addresses stand beside the same code that begins the mode; empty for nowhere."""
    from polarcheck.foundation.errors import enumerated
    from polarcheck.program.machines import profiles

    code, letters = hit.switch, {chr(hit.trace.run.words.address[index]) for index in hit.words}
    names = [
        profile.name
        for profile in profiles.built_in()
        if code in profile.machine.polar.on and letters <= {*profile.machine.polar.words_beside_switch}
    ]
    if not names or code not in hit.trace.machine.polar.on:
        return ""
    words = " ".join(sorted(letters))
    kinematics = ", and LinuxCNC chooses the kinematics by it" if code == "G12.1" and words == "P" else ""
    return f"; {enumerated(names)} (--machine) {'take' if len(names) > 1 else 'takes'} {words} there{kinematics}"
