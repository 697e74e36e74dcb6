from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import WARNING, Hits, graded, rule

if TYPE_CHECKING:
    from polarcheck.columns.modes.executed_blocks import ExecutedBlocks
    from polarcheck.columns.modes.procedure import Procedure
    from polarcheck.columns.modes.spindles import Spindles
    from polarcheck.program.machines.machine import Machine
    from polarcheck.rules.hit import Details, Hit


@rule(
    WARNING,
    "the live tool still runs at {word}: {started} was not stopped after the polar mode; {to_stop}",
    values=("word", "other_line"),
    follows={"block": ("offset-changed-in-polar",)},
)
def live_tool_never_stopped(blocks: ExecutedBlocks, procedure: Procedure, machine: Machine) -> Hits:
    """
    Live tool not stopped after the polar mode.

    A cutter that still turns when the turret indexes, or when the door is opened at the end, endangers the operator and
    all that it passes; a lathe with an interlock waits for ever. Stop the live tool on the retract: `Z.1 M35`. It is a
    note at the end of the program, which on most lathes stops it, too.

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


def details(hit: Hit, procedure: Procedure, spindles: Spindles) -> Details:
    from polarcheck.rules.wording.written import executed_word

    start = int(procedure.live_tool_runs_on[hit.row])
    run, codes = hit.trace.run, hit.trace.machine.m_codes
    words = hit.trace.blocks.code_indices(*codes.live_tool_on)
    code = executed_word(run, int(words[run.row[words] == start][0]))
    return {
        "other_line": hit.line(start),
        "started": f"{code} of line {hit.line(start)}",
        "to_stop": _to_stop(hit, procedure, spindles),
    }


def _to_stop(hit: Hit, procedure: Procedure, spindles: Spindles) -> str:
    """
    Where to write the code that stops the live tool.

    It may stand there already, but behind the tool change; or an M code that is in no list stands in its place.
    """
    import numpy as np

    from polarcheck.rules.wording.written import executed_word

    blocks, run, codes, row = hit.trace.blocks, hit.trace.run, hit.trace.machine.m_codes, hit.row
    stop = " or ".join(codes.live_tool_off) or "the code that stops it"
    stops = np.flatnonzero(blocks.codes(*codes.live_tool_off))
    late = stops[stops >= row]
    starts = np.flatnonzero(blocks.codes(*codes.live_tool_on) & (np.arange(len(blocks)) > row))
    if len(late) and blocks.program[late[0]] == blocks.program[row] and not np.any(starts < late[0]):
        words = blocks.code_indices(*codes.live_tool_off)
        written = executed_word(run, int(words[run.row[words] == late[0]][0]))
        where = "stands beside it" if late[0] == row else f"of line {hit.line(late[0])} comes behind it"
        return f"{written} {where}: write it before the tool change"
    since = max(int(procedure.section_before[row]), int(procedure.live_tool_runs_on[row]))
    others = spindles.unlisted[(run.row[spindles.unlisted] > since) & (run.row[spindles.unlisted] <= row)]
    if not len(others):
        return f"write {stop} on the retract"
    code = f"{executed_word(run, int(others[0]))} of line {hit.line(run.row[others[0]])}"
    return f"write {stop} on the retract, in place of {code} if that is meant for it"
