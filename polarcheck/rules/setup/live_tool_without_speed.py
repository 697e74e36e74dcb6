from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import WARNING, Hits, rule

if TYPE_CHECKING:
    from polarcheck.columns.modes.executed_blocks import ExecutedBlocks
    from polarcheck.columns.modes.procedure import Procedure
    from polarcheck.program.machines.machine import Machine
    from polarcheck.rules.hit import Details, Hit


@rule(
    WARNING,
    "{code} starts the live tool, and no S above 0 is in force for it: it turns at another speed, or "
    "not at all; write S before it",
    values=("code",),
    once="program",
    subject="word",
)
def live_tool_without_speed(blocks: ExecutedBlocks, procedure: Procedure, machine: Machine) -> Hits:
    """
    Live tool started without a speed.

    The code that starts the live tool takes the S in force. Where the program gives none for it, that is the speed of
    the job before, or 0, and the cutter is pressed into the part without turning. An S with which the main spindle was
    started is not meant for it, and takes the place of what was; nor is the limit of G50. Write S beside the code:
    `G97 S2000 M33`. Where the builder does not ask for that, only a whole program without any S is meant, on machines
    of which it is known how the live tool gets its speed.

    Source: builder's guide to G12.1, sample program: live tool spindle ON.

    Bad, machine turning-center, tool 8:radius=0:

        O1
        T0808
        M5
        M35
        G28 H0
        G97 M33           (expect: live-tool-without-speed)
        G98 G0 X2.15 Z.1 C0
        G12.1
        G1 C.5339 F60.
        G41 X1.75 F7.
        C-.5339
        G40 X2.15 F60.
        G13.1
        G99 G0 Z1. M35
        M30

    Bad, set m_codes.live_tool_on=["M33"], set m_codes.live_tool_off=["M35"], tool 8:radius=0:

        O1
        T0808
        G97 M33           (expect: live-tool-without-speed)
        G98 G0 X60. Z2. C0
        G12.1
        G1 C10. F600
        G41 X40. F70
        C-10.
        G40 X60. F600
        G13.1
        M35
        M30

    Good, machine turning-center, tool 8:radius=0:

        O1
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
        G99 G0 Z1. M35
        M30
    """
    # Compares nothing: for which of two spindles an S is hangs on what starts after it.
    started = blocks.words_at(blocks.code_indices(*machine.m_codes.live_tool_on))
    return Hits(procedure.live_tool_without_speed, at=started)


def details(hit: Hit) -> Details:
    return {"code": hit.word}
