from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import WARNING, Hits, graded, rule

if TYPE_CHECKING:
    from polarcheck.columns.modes.executed_blocks import ExecutedBlocks
    from polarcheck.columns.modes.mode import PolarMode
    from polarcheck.columns.modes.spindles import Spindles
    from polarcheck.columns.path.axes import PlaneAxes
    from polarcheck.program.machines.machine import Machine


@rule(
    WARNING,
    "{code} in the polar mode; the spindle is the {rotary} axis here",
    values=("code",),
    follows={"section": ("polar-never-left",)},
)
def spindle_code_in_polar(
    blocks: ExecutedBlocks, axes: PlaneAxes, mode: PolarMode, spindles: Spindles, machine: Machine
) -> Hits:
    """
    Main spindle started or stopped, or the C axis released, in the polar mode.

    In the mode the spindle is the C axis and the part of every move. A code that starts it as a spindle, or releases
    the C axis, takes it out of the control's hands in the middle of the contour. Such codes belong before G12.1 or
    after G13.1, and so does M19, which turns the spindle to an angle. Many lathes use M3 and M5 for the live tool, too;
    where the machine profile does not name codes of its own for the live tool, these are a note.

    Source: builder's guide to G12.1, sample program; FANUC B-62764EN/01, p. 50.

    Bad, set m_codes.c_axis_on=["M35"], set m_codes.c_axis_off=["M34"]:

        M35
        G28 H0
        G98 G0 X60. C0
        M33
        G12.1
        G1 C10. F1500
        X40. F200
        M34               (expect: spindle-code-in-polar)
        C-10.
        X60. F1500
        G13.1

    Bad:

        G98 G0 X60. C0
        G12.1
        G1 X40. F200
        C10.
        X60.
        M5                (expect: spindle-code-in-polar)
        G13.1

    Bad:

        G98 G0 X60. C0
        G12.1
        G1 X40. F200
        C10.
        M19               (expect: spindle-code-in-polar)
        X60.
        G13.1

    Good:

        G98 G0 X60. C0
        G12.1
        G1 X40. F200
        C10.
        M8
        X60.
        G13.1
        M5
    """
    codes = machine.m_codes
    in_mode = mode.in_polar & spindles.has_code
    if machine.polar.engaged_behind:
        in_mode &= ~blocks.codes(*codes.c_axis_on) | mode.given_in_section(axes.moves_plane)
    of_axis = blocks.codes(*codes.c_axis_on, *codes.c_axis_off, *codes.spindle_orientation)
    is_known = spindles.are_no_live_tool | of_axis
    return graded(warning=in_mode & is_known, note=in_mode & ~is_known, at=spindles.words)
