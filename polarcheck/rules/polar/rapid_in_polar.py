from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.foundation.states import Motion
from polarcheck.rules.rule import ERROR, Hits, rule

if TYPE_CHECKING:
    from polarcheck.columns.modes.executed_blocks import ExecutedBlocks
    from polarcheck.columns.modes.modal import ModalStates
    from polarcheck.columns.modes.mode import PolarMode
    from polarcheck.columns.modes.mode_words import ModeWords
    from polarcheck.columns.path.axes import PlaneAxes
    from polarcheck.columns.path.compensation import CutterCompensation
    from polarcheck.columns.words.angles import Angles
    from polarcheck.rules.hit import Details, Hit


@rule(
    ERROR,
    "G0 cannot be used in the polar mode; {instead_of_rapid}",
    at=("rapid",),
    follows={"section": ("degrees-in-polar",)},
    doubts=(("rapid", "motion"),),
)
def rapid_in_polar(
    blocks: ExecutedBlocks, modal: ModalStates, axes: PlaneAxes, mode: PolarMode, angles: Angles, mode_words: ModeWords
) -> Hits:
    """
    Rapid traverse in the polar mode.

    The control stops with an alarm at a block with G0, and at a move without a code of its own while G0 is still in
    force, as after the approach. Positioning in the mode is done in G1 with a high feed, around 30 to 60 inch per
    minute.

    Source: builder's guide to G12.1; FANUC B-62764EN/01, p. 51; 30i alarm list, PS0146.

    Bad:

        G98 G0 X60. C0
        G12.1
        G1 X40. F200
        G0 C5.            (expect: rapid-in-polar)
        G1 C-5.
        G13.1

    Bad:

        G98 G0 X60. C0
        G12.1
        X40. F200         (expect: rapid-in-polar)
        G1 C5.
        G13.1

    Good:

        G98 G0 X60. C0
        G12.1
        G1 X40. F1500
        C5. F200
        G13.1
        G0 X60.
    """
    # What G0 means beside a code that can only stand outside is no question of its own.
    outside = blocks.listed("reference_check", "reference_return", "machine_coordinates")
    outside = outside | mode_words.rows(mode_words.only_outside & ~mode_words.sets_coordinates)
    in_rapid = mode.in_polar & (modal.state("motion") == Motion.RAPID) & ~outside
    written = blocks.listed("rapid")
    moves = in_rapid & (axes.motion == Motion.RAPID) & ~mode.enters_again
    first_move = mode.first_in_section(moves) & ~mode.given_in_section(written)
    # G0 with an angle of C is the positioning of an approach that stands behind G12.1 in place of before it.
    return Hits(in_rapid & (written | first_move), follows={"section": angles.is_positioning})


def details(hit: Hit, compensation: CutterCompensation) -> Details:
    from polarcheck.rules.wording.arcs import arc_in_force_before
    from polarcheck.rules.wording.written import move_code

    line = move_code(hit.trace.machine, "line")
    if not compensation.compensates[hit.row] or compensation.starts_up[hit.row]:
        return {"instead_of_rapid": f"write {line} with a high F"}
    word, arc = arc_in_force_before(hit.trace, hit.row)
    has_arc = f", and {word} belongs to an arc" if word else ""
    code = arc or (_either_arc(hit) if word else line)
    return {
        "instead_of_rapid": f"this block lies in a contour with {hit.side}{has_arc}: write {code} and leave F as it is"
    }


def _either_arc(hit: Hit) -> str:
    from polarcheck.rules.wording.written import move_code

    return " or ".join(move_code(hit.trace.machine, name) for name in ("arc_clockwise", "arc_counterclockwise"))
