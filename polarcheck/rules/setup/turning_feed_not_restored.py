from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import WARNING, rule

if TYPE_CHECKING:
    from polarcheck.columns.modes.modal import ModalStates
    from polarcheck.columns.modes.procedure import Procedure
    from polarcheck.foundation.arrays import Mask
    from polarcheck.program.machines.machine import Machine
    from polarcheck.rules.hit import Details, Hit


@rule(
    WARNING,
    "{feed_word} is {feed:length} a minute in this move: {carried_mode} is still in force from "
    "the polar mode; write {per_revolution} after it",
    values=("feed",),
    at=("F",),
    once="feed mode",
    is_advice=True,
)
def turning_feed_not_restored(procedure: Procedure) -> Mask:
    """
    Feed per minute of the polar mode carried into turning.

    Milling in the mode goes with feed per minute, turning with feed per revolution, and either is modal. Without G99
    (G95 in systems B and C) behind the section an F of .008 inch for each turn is .008 inch a minute, the tool rubs,
    and nobody sees why the lathe stands still; or the F of the mill turns on. Write it on the retract: `G99 G0 X2.5`.
    Nothing is said of an F that may be meant per minute, as in drilling with a live tool, nor of threads.

    Source: builder's guide to G12.1, sample program: switch back to IPR feed mode.

    Bad, machine turning-center, tool 8:radius=0:

        T0808
        M5
        M35
        G28 H0
        G97 S2000 M33
        G98 G0 X2.15 Z.1 C0
        G12.1
        G1 C.5339 F60.
        G41 X1.75 F7.
        C-.5339
        G40 X2.15 F60.
        G13.1
        G0 Z1. M35
        T0101
        M34
        G97 S800 M3
        G0 X1. Z.1
        G1 Z-.5 F.008     (expect: turning-feed-not-restored)
        X1.2
        G0 X5.

    Good, machine turning-center, tool 8:radius=0:

        T0808
        M5
        M35
        G28 H0
        G97 S2000 M33
        G98 G0 X2.15 Z.1 C0
        G12.1
        G1 C.5339 F60.
        G41 X1.75 F7.
        C-.5339
        G40 X2.15 F60.
        G13.1
        G0 X0 Z.1
        G1 Z-.5 F3.
        G99 G0 Z1. M35
        T0101
        M34
        G97 S800 M3
        G0 X1. Z.1
        G1 Z-.5 F.008
        X1.2
        G0 X5.
    """
    # Compares nothing: which moves turn, and whose F is in force, hangs on the rows above.
    return procedure.turns_at_feed_of_mill


def details(hit: Hit, modal: ModalStates, machine: Machine) -> Details:
    import numpy as np

    from polarcheck.rules.wording.feeds import feed_word
    from polarcheck.rules.wording.written import code_of

    since = int(np.flatnonzero(modal.sets("feed_mode")[: hit.row + 1])[-1])
    return {
        "feed": hit.trace.feedrate.feed_number[hit.row],
        "feed_word": feed_word(hit),
        "carried_mode": f"{code_of(machine, 'feed_per_minute')} of line {hit.line(since)}",
        "per_revolution": code_of(machine, "feed_per_revolution"),
    }
