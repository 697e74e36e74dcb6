"""How programs for a control are written, where what it reads leaves a choice: the keys of [writing]."""

from typing import Annotated, Literal

import msgspec

from polarcheck.program.machines.values import NotNegative, Plain


class Writing(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """
    How a program for the control is written; it reads more than that. Blanks stand between the words of a block.

    before: blocks in front of the block that switches the polar mode on
    switch: block that switches it on, with C0 where a direction stands in it
    behind: blocks right behind it
    end: block that switches the polar mode off
    behind_end: blocks right behind that
    rapid_in_mode: G0 is written in the mode; where not, a line by rapid_feed stands in its place
    rapid_feed: F of that line [mm/min]
    arcs_by: center, radius: what may be written beside the end of an arc; the first where the program does not decide
    arc_radius: word of the radius of an arc, as R or CR=
    arc_split: largest angle of an arc that is written, within arcs.sweep_limit [deg]
    helices: arcs with Z beside X and the virtual axis are written
    live_tool_speed: word of the speed of the live tool, as S or SB=; empty where it is not known
    subprogram_call: block that calls a subprogram, with its number in the place of #; empty where it is not known
    subprogram_repeats: word beside it of how often the subprogram runs; empty where it is not known
    subprogram_return: block that ends a subprogram; empty where it is not known
    program_head: blocks at the head of a program, with its number in the place of #
    program_end: blocks at its end
    archive_heads: of the first and of a further program where a file has several without O; none where it cannot
    """

    before: list[Plain] = []
    switch: Annotated[Plain, msgspec.Meta(min_length=1)]
    behind: list[Plain] = []
    end: Annotated[Plain, msgspec.Meta(min_length=1)]
    behind_end: list[Plain] = []
    rapid_in_mode: bool = False
    rapid_feed: NotNegative
    arcs_by: Annotated[list[Literal["center", "radius"]], msgspec.Meta(min_length=1)]
    arc_radius: Plain
    arc_split: Annotated[float, msgspec.Meta(gt=0, le=360)]
    helices: bool = False
    live_tool_speed: Plain = ""
    subprogram_call: Plain = ""
    subprogram_repeats: Plain = ""
    subprogram_return: Plain = ""
    program_head: list[Plain] = []
    program_end: list[Plain] = []
    archive_heads: list[Plain] = []
