"""
Slips that a setter makes in a sound program, one at a time, and whether each does something to the metal or the lathe.

    slip = drawn_slip(7)      # slip.sound, slip.program, slip.line, slip.witness

A slip is counted where metal or lathe are affected, and a check without a drawing could know it: by its witness.
"""

from __future__ import annotations

import random
import re
from typing import NamedTuple

from metal_simulation import RAPID, cuts_the_part, differs, simulate
from setter_dialects import DIALECTS
from setter_programs import BOSSES, FAMILIES, Program, drawn
from slip_blocks import (
    block_doubled,
    block_moved,
    block_written,
    cancelled_at_once,
    code_moved,
    contour_at_two_depths,
    deeper,
    degrees,
    ends_inside,
    index_word,
    position_angle_missing,
    retract_missing,
    side_swapped,
    x_too_small,
    z_at_depth_before,
)
from slip_settings import (
    bar_comment,
    code_missing,
    entered_again,
    other_offset,
    per_minute_missing,
    per_revolution,
    size_comment,
    text_missing,
    tool_comment,
    units_missing,
    unknown_offset,
)
from slip_witnesses import witness
from slip_words import (
    VALUES,
    Draw,
    Plant,
    all_arcs,
    all_words,
    arc_code,
    arc_word,
    axes_swapped,
    block_changed,
    block_missing,
    letter_for_other,
    neighbour,
    other_arc,
    word_changed,
    word_missing,
)

LEADS = ("", "", "corner", "extension", "overlap")


class Slip(NamedTuple):
    """
    A kind of slip: what goes wrong, and where.

    plant: makes it in a program, or gives None where it cannot be made. knows: what a check knows it by, in each
    program; "" where that is computed for each. is_real: it matters though the metal is the same, as a wrong comment
    does. families, machines: regular expressions of those where it is one.
    """

    name: str
    plant: Plant
    knows: str = ""
    is_real: bool = False
    families: str = ""
    machines: str = ""


_INCREMENTS = "fanuc|doosan|takisawa|colchester|quick|mazak-eia|mitsubishi"
_ENGAGED = "doosan|colchester|quick|haas|okuma|mazak-eia"
ARCS = ("sign wrong", "digits swapped", "digit lost", "another digit", "ten times or a tenth", "twice")
_LINE = r"(?:G10?1(?!\d)|G1(?!\d)) ?"


def _values(where: str, letters: str, roles: tuple[str, ...], names: tuple[str, ...] = (), **more: str) -> list[Slip]:
    return [Slip(f"{name} in {where}", word_changed(letters, VALUES[name], *roles), **more) for name in names or VALUES]


SLIPS = (
    *_values("the contour", "XC", ("contour",)),
    *_values("a subprogram", "XC", ("contour",), families="subprogram"),
    *_values("the ramp", "XC", ("ramp",)),
    *_values("the approach", "XC", ("approach", "position")),
    *_values("the cancel", "XC", ("cancel",), ("sign wrong", "another digit", "ten times or a tenth", "twice")),
    *(Slip(f"R: {name}", arc_word("R", VALUES[name])) for name in ARCS),
    *(Slip(f"I or J: {name}", arc_word("I", VALUES[name])) for name in ARCS),
    *_values("the depth", "Z", ("plunge", "plunge outside"), ("sign wrong",), knows="cuts only air"),
    *_values("the depth", "Z", ("plunge", "plunge outside"), ("digit doubled", "ten times or a tenth")),
    *_values("the retract", "Z", ("retract", "lift"), ("sign wrong",)),
    # ---- words of a contour ----
    Slip("neighbour's value in the contour", neighbour),
    Slip("neighbour's value in a subprogram", neighbour, families="subprogram"),
    Slip("word missing in the contour", word_missing),
    Slip("word missing in a subprogram", word_missing, families="subprogram"),
    Slip("X and C swapped in the contour", axes_swapped),
    Slip("X and C swapped in a subprogram", axes_swapped, families="subprogram"),
    Slip("X for C in the contour", letter_for_other),
    Slip("X for C in a subprogram", letter_for_other, families="subprogram"),
    Slip("all X as the other of diameter and radius", all_words("X")),
    Slip("all C doubled", all_words("C")),
    Slip("C as degrees", degrees, "rises to 360"),
    Slip("all R doubled", all_arcs),
    Slip("Y for C", block_changed(r"(?<![A-Z])C(?=-?[\d.])", "Y", "contour"), "Y is no axis here", True),
    # ---- blocks ----
    Slip("block missing in the contour", block_missing("contour")),
    Slip("block missing in a subprogram", block_missing("contour"), families="subprogram"),
    Slip("block doubled in the contour", block_doubled("contour")),
    Slip("blocks swapped in the contour", block_moved(1, "contour")),
    Slip("blocks swapped in a subprogram", block_moved(1, "contour"), families="subprogram"),
    Slip("block skipped in the contour", block_changed("^", "/", "contour")),
    Slip("ramp block missing", block_missing("ramp"), "G40 that cancels nothing"),
    Slip("ramp block behind the contour's first", block_moved(1, "ramp")),
    Slip("ramp block before the depth", block_moved(-1, "ramp")),
    Slip("ramp block skipped", block_changed("^", "/", "ramp")),
    Slip("approach block missing", block_missing("approach")),
    Slip("approach blocks swapped", block_moved(1, "approach")),
    Slip("cancel block missing", block_missing("cancel"), "G13.1 in offset mode"),
    Slip("cancel block before the contour's last", block_moved(-1, "cancel")),
    Slip("cancel block behind the retract", block_moved(1, "cancel")),
    Slip("position block missing", block_missing("position")),
    # ---- codes of a contour ----
    Slip("G2 and G3 swapped", arc_code(other_arc)),
    Slip("G2 and G3 swapped in a subprogram", arc_code(other_arc), families="subprogram"),
    Slip("G2 forgotten", arc_code(lambda code, program: ""), "R or I beside a line"),
    Slip("G1 for G2", arc_code(lambda code, program: program.dialect.line), "R or I beside a line"),
    Slip("G2 a block late", code_moved(r"G10?[23](?!\d) ?", 1, "contour")),
    Slip("G2 a block early", code_moved(r"G10?[23](?!\d) ?", -1, "contour")),
    Slip("G1 behind an arc forgotten", block_changed(_LINE, "", "contour")),
    Slip("G1 a block late", code_moved(_LINE, 1, "contour")),
    Slip("G0 in the contour", block_changed(r"^(N\d+ ?)?", r"\g<1>G0 ", "contour"), "G0 in the mode", True),
    Slip("G0 for G1 in the plunge", block_changed("G1(?!0|1)", "G0", "plunge")),
    Slip("G0 for G1 in the approach", block_changed("G1(?!0|1)", "G0", "ramp", "approach")),
    Slip("G91 forgotten", text_missing(r"G91 ?")),
    Slip("G90 forgotten", text_missing("G90 ?", "plunge", "cancel"), "G91 stays in force", True),
    Slip("G91 in the contour", block_changed(r"^(N\d+ ?)?", r"\g<1>G91 ", "contour")),
    # ---- compensation ----
    Slip("G41 for G42", side_swapped, "cuts into the part"),
    Slip("G41 for G42 in a subprogram", side_swapped, "cuts into the part", families="subprogram"),
    Slip("G41 forgotten", block_changed("G4[12] ?", "", "ramp"), "G40 that cancels nothing"),
    Slip("G41 a block late", code_moved("G4[12] ?", 1, "ramp"), "cuts before it"),
    Slip("G41 a block early", code_moved("G4[12] ?", -1, "ramp")),
    Slip("G41 again in the contour", block_written("G41", "contour")),
    Slip("G40 at once", cancelled_at_once, "nothing lies between"),
    Slip("G40 forgotten", block_changed("G40 ?", "", "cancel"), "G13.1 in offset mode"),
    Slip("G40 forgotten in a subprogram", block_changed("G40 ?", "", "cancel"), "G13.1 in it", families="subprogram"),
    Slip("G40 a block late", code_moved("G40 ?", 1, "cancel")),
    Slip("G40 a block early", code_moved("G40 ?", -1, "cancel")),
    Slip("offset without R", unknown_offset, "no radius is known"),
    Slip("offset of the other cutter", other_offset, "the comment"),
    Slip("T missing beside its comment", block_changed(r"T\d+(?: ?D\d)? (?=\(.*D)", "", "call"), "it", True),
    Slip("tool call in the contour", block_written("T1717", "contour"), "T in the mode", True, machines="^(?!siem)"),
    # ---- depth, index, ways ----
    Slip("depth missing", block_missing("plunge", "plunge outside"), "cuts only air, or twice the same"),
    Slip("depth far deeper than the other passes", word_changed("Z", deeper, "plunge"), families="depths|ramp"),
    Slip("retract missing", retract_missing),
    Slip("index missing", index_word("missing"), "cuts only air"),
    Slip("index at an angle of its own", index_word("another digit"), "the steps of the others"),
    Slip("index twice", index_word("twice"), "cuts only air"),
    Slip("contour at two depths", contour_at_two_depths, "Z in the middle of a contour"),
    Slip("approach inside the bar", x_too_small(0.6)),
    Slip("approach near the center", x_too_small(0.25)),
    Slip("down by rapid at the approach", z_at_depth_before),
    Slip("pass ends inside the bar", ends_inside),
    # ---- the mode ----
    Slip("G12.1 missing", block_missing("on"), "G13.1 without it"),
    Slip("G12.1 a block late", block_moved(1, "on")),
    Slip("G12.1 twice", block_doubled("on"), "the mode is on", True),
    Slip("G13.1 missing", block_missing("off"), "the mode is left open"),
    Slip("G13.1 a block early", block_moved(-1, "off")),
    Slip("left and entered again", entered_again, "C stands elsewhere"),
    Slip("C elsewhere at the second section", position_angle_missing, "nobody positioned it"),
    Slip("G54 in the contour", block_written("G54", "contour"), "the mode refuses it", True, machines="^(?!siem)"),
    Slip("G28 in the contour", block_written("G28 U0", "contour"), "a code that the mode refuses", True),
    # ---- feed, spindle, units, comments ----
    Slip("unit missing", units_missing, "never reaches its bar, or is all in it", True),
    Slip("G99 for G98", per_revolution, "F of a feed per minute"),
    Slip("G98 missing", per_minute_missing, "F of a feed per minute"),
    Slip("F of a feed per revolution", block_changed(r"F[\d.]+", "F0.1", "ramp", "plunge"), "takes hours"),
    Slip("F0", block_changed(r"F[\d.]+", "F0", "ramp", "plunge"), "no feed", True),
    Slip("F ten or a hundred times", block_changed(r"F(\d+)(\.?)", r"F\g<1>00\2", "ramp"), "above all others", True),
    Slip("all F missing", block_changed(r" ?F[\d.]+", "", "ramp", "plunge", "approach", every=True), "no feed", True),
    Slip("C axis not engaged", code_missing("engage"), "the manual", True, machines=_ENGAGED),
    Slip("live tool not started", code_missing("spindle"), "no spindle", True),
    Slip("wrong cutter in the comment", tool_comment, "the comment", True),
    Slip("wrong size in the comment", size_comment, "the comment", True),
    Slip("wrong bar in the comment", bar_comment, "the part is larger", True),
    Slip("constant surface speed", block_written("G96 S200", "on"), "it refuses it", True, machines="^(?!okuma)"),
    Slip("rotation in force", block_written("G68 R45.", "on"), "the mode refuses it", True),
    # ---- text ----
    Slip("point lost", block_changed(r"(?<=[1-9])\.", "", "contour"), "the others", True, machines=_INCREMENTS),
    Slip("comma for point", block_changed(r"(?<=\d)\.(?=\d)", ",", "contour"), "no number", True),
    Slip("letter O for 0", block_changed(r"(?<=[1-9])0(?=\.)", "O", "contour"), "no number", True),
    Slip("dash of print", block_changed(r"(?<=[A-Z])-", "–", "contour", "ramp"), "no number", True),
    Slip("word twice", block_changed(r"([XCY])(-?[\d.]+)$", r"\1\2 \g<1>7.", "contour"), "twice in a block", True),
    Slip("stray character", block_changed("$", " ?", "contour"), "no word", True),
)  # fmt: skip


class Planted(NamedTuple):
    """A program with a slip, and without; line: of the first block that differs, from 1."""

    slip: Slip
    sound: Program
    program: Program
    line: int
    witness: str


def planted(slip: Slip, program: Program, draw: Draw) -> Planted | None:
    """The program with the slip, where it can be made, does something, and a check could know it."""
    changed = slip.plant(program, draw)
    if changed is None or changed.text() == program.text():
        return None
    try:
        known = knows(slip, program, changed)
    except (ValueError, SyntaxError, ZeroDivisionError, OverflowError):
        return None
    return Planted(slip, program, changed, _first_change(program, changed) + 1, known) if known else None


def knows(slip: Slip, program: Program, changed: Program) -> str:
    """What a check could know a slip by, or ""."""
    if slip.is_real:
        return slip.knows
    sound, other = simulate(program), simulate(changed)
    events = other.events - sound.events
    if RAPID in events and "bar" not in program.evidence:
        events -= set() if cuts_the_part(program, sound, changed, other, rapids=True) else {RAPID}
    if events:
        return min(events)
    if not differs(sound, other):
        return ""
    told = slip.knows or witness(program, sound, other)
    if told or ("steps" in program.evidence and "depth" in slip.name):
        return told or "steps"
    is_drilled = program.family.endswith("center path") and not program.family.startswith(BOSSES)
    cuts = _is_beside(program, changed) and not is_drilled and cuts_the_part(program, sound, changed, other)
    return "a way through the part" if cuts else ""


def _is_beside(program: Program, changed: Program) -> bool:
    """Whether only ways to and from the contour are changed in the plane."""
    ways = ("ramp", "approach", "position", "position angle", "cancel", "lead")
    if len(program.lines) == len(changed.lines):
        pairs = zip(program.lines, changed.lines, strict=True)
        return all(one.role in ways for one, two in pairs if one.text != two.text)
    index = _first_change(program, changed)
    return index < len(program.lines) and program.lines[index].role in ways


def _first_change(program: Program, changed: Program) -> int:
    texts = zip(program.text().splitlines(), changed.text().splitlines(), strict=False)
    return next((index for index, (one, two) in enumerate(texts) if one != two), len(changed.lines))


def drawn_slip(seed: int, kinds: tuple[Slip, ...] = SLIPS, machine: str = "") -> Planted | None:
    """A slip of the kind that is in turn."""
    draw = random.Random(f"slip {seed}")  # noqa: S311 - programs that can be written again
    slip = kinds[seed % len(kinds)]
    families = [name for name in FAMILIES if re.search(slip.families, name)]
    machines = [name for name in DIALECTS if re.search(slip.machines, name)] if slip.machines else [""]
    for _ in range(60):
        program = drawn(
            draw.randrange(10**6), machine or draw.choice(machines), draw.choice(families), draw.choice(LEADS)
        )
        with_slip = planted(slip, program, draw)
        if with_slip:
            return with_slip
    return None
