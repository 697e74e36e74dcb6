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
    "{S} is above the highest speed of the live tool, {limit:whole}: the control holds it there or stops, and each "
    "tooth takes a thicker chip than intended; write S{limit:whole}, and lower F with it",
    values=("speed", "limit"),
    worse=("speed",),
    at=("S",),
)
def live_tool_above_highest_speed(procedure: Procedure, machine: Machine) -> Hits:
    """
    S above the highest speed of the live tool.

    Live tools turn more slowly than the spindle of a mill, often at 4000 to 6000 in a minute. The control holds a
    higher S at the limit without a word, or stops with an alarm. F stays as it is: where the tool turns at half of S,
    each tooth takes twice the chip, and small cutters break. Write the highest S, and lower F in the same share.

    Source: limits.live_tool_speed of the machine profile; the builder's data of the live tool.

    Bad, set limits.live_tool_speed=6000, set m_codes.live_tool_on=["M33"], tool 8:radius=0:

        T0808
        G97 S1500 M3
        G99 G1 X50. F.2
        M5
        G97 S8000 M33     (expect: live-tool-above-highest-speed)
        G98 G0 X60. C0
        G12.1
        G1 X40. F200
        C10.
        X60.
        G13.1

    Good, set limits.live_tool_speed=6000, set m_codes.live_tool_on=["M33"], tool 8:radius=0:

        T0808
        G97 S8000 M3
        G99 G1 X50. F.2
        M5
        G97 S6000 M33
        G98 G0 X60. C0
        G12.1
        G1 X40. F200
        C10.
        X60.
        G13.1
    """
    # Compares nothing: for which of two spindles an S is hangs on codes before and behind it.
    return Hits(procedure.live_tool_above_highest_speed, values={"limit": machine.limits.live_tool_speed})


def details(hit: Hit, blocks: ExecutedBlocks) -> Details:
    return {"speed": blocks.word("S")[hit.row]}
