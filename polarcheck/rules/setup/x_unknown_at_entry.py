from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import WARNING, rule

if TYPE_CHECKING:
    from polarcheck.columns.modes.entry import Entry
    from polarcheck.columns.modes.executed_blocks import ExecutedBlocks
    from polarcheck.columns.modes.modal import ModalStates
    from polarcheck.columns.modes.mode import PolarMode
    from polarcheck.columns.path.axes import PlaneAxes
    from polarcheck.columns.path.path import ProgrammedPath
    from polarcheck.foundation.arrays import Mask
    from polarcheck.rules.hit import Details, Hit


@rule(
    WARNING,
    "X {unknown_since}; position {axes} outside the part before {switch}",
    at=("on",),
    follows={"way": ("rapid-in-polar",)},
)
def x_unknown_at_entry(
    blocks: ExecutedBlocks, modal: ModalStates, axes: PlaneAxes, mode: PolarMode, entry: Entry
) -> Mask:
    """
    X not positioned before the polar mode.

    The plane begins at the present X. If X was not programmed since the head of the program, the last reference return
    or tool change, the first move starts from where the turret happens to be, and neither the ramp of the compensation
    nor the speed of C can be foreseen. Position X outside the part first, then write G12.1. Where C does not turn the
    plane (polar.zero_angle), a first G0 in the mode that writes both axes does as well.

    Source: builder's guide to G12.1, programming the tool approach point.

    Bad:

        O0001
        T0101
        G98 G0 Z2. C0
        G12.1             (expect: x-unknown-at-entry)
        G1 X40. F200
        C10.
        X60.
        G13.1
        M30

    Bad:

        O0001
        T0101
        G0 X60. Z2.
        G28 U0
        T0202
        G98 G0 C0
        G12.1             (expect: x-unknown-at-entry)
        G1 X40. F200
        C10.
        X60.
        G13.1
        M30

    Good:

        O0001
        T0101
        G98 G0 X60. Z2. C0
        G12.1
        G1 X40. F200
        C10.
        X60.
        G13.1
        M30

    Good, machine siemens-transmit:

        %
        N1 G94 DIAMOF
        N2 T1 D1
        N3 TRANSMIT
        N4 G0 X40 Y10
        N5 G1 X30 Y10 F200
        N6 Y0
        N7 TRAFOOF
        N8 M30

    Good:

        O0002
        G12.1
        G1 X40. F200
        C10.
        X60.
        G13.1
        M99
    """
    positioned = (blocks.has("X", "U") & (modal.uses_axes | modal.sets_coordinates)) | blocks.moves_unnamed
    by_x = mode.is_followed & (axes.linear_axis == ord("X"))
    unknown = blocks.whole_program & ~entry.happened(positioned, since=entry.loses_x)
    return mode.enters & by_x & unknown & ~entry.positions_in_mode


def details(hit: Hit, path: ProgrammedPath, entry: Entry) -> Details:
    import numpy as np

    axes = f"X and {hit.rotary}" if np.isnan(path.c_angle[hit.row]) else "it"
    return {"axes": axes, "unknown_since": _unknown_since(hit, entry)}


def _unknown_since(hit: Hit, entry: Entry) -> str:
    """`is not known since T0404 in line 7`, or that X was never positioned."""
    import numpy as np

    from polarcheck.rules.wording.written import executed_word

    blocks, run, row = hit.trace.blocks, hit.trace.run, hit.row
    starts = np.flatnonzero(blocks.starts[: row + 1])
    first = int(starts[-1]) if len(starts) else 0
    lost = first + np.flatnonzero(entry.loses_x[first : row + 1])
    if not len(lost):
        return "has not been positioned in this program"
    at = int(lost[-1])
    named = "T" if blocks.has("T")[at] else "GXU"
    low, high = np.searchsorted(run.row, (at, at + 1))
    words = [index for index in range(low, high) if chr(int(run.words.address[index])) in named]
    written = " ".join(executed_word(run, word) for word in words)
    return f"is not known since {written} in line {hit.line(at)}"
