from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import WARNING, Hits, graded, rule

if TYPE_CHECKING:
    from polarcheck.columns.modes.blocks import ExecutedBlocks
    from polarcheck.columns.modes.procedure import Procedure
    from polarcheck.program.machines.machine import Machine


@rule(
    WARNING,
    "the live tool still runs at {word}: {started} was not stopped after the polar mode; {to_stop}",
    values={"word": "word", "other_line": "line_of_start"},
)
def live_tool_never_stopped(blocks: ExecutedBlocks, procedure: Procedure, machine: Machine) -> Hits:
    """
    Live tool not stopped after the polar mode.

    A cutter that still turns when the turret indexes, or when the door is opened at the end, is a danger to the one who
    stands there and to what it swings past; lathes with an interlock wait for ever. Stop the live tool on the retract:
    `Z.1 M35`. It is a note at the end of the program, which on most lathes stops it, too.

    Source: builder's guide to G12.1, sample program: retract Z-axis and stop milling spindle.

    Bad, machine turning-center, tool 8:radius=0:

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
        G99 G0 Z1.
        T0101             (expect: live-tool-never-stopped)
        M35
        M30

    Bad, machine turning-center, tool 8:radius=0:

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
        G99 G0 Z1.
        M30               (expect: live-tool-never-stopped)

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
        T0101
        M30
    """
    still, ends = procedure.live_tool_runs_on >= 0, blocks.ends_program
    ending = blocks.words_at(blocks.code_indices(*machine.m_codes.program_end))
    at = ending | blocks.words_at(blocks.word_indices("T"))
    return graded(warning=still & ~ends, note=still & ends, at=at)
