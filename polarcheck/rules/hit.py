"""One hit of a rule, and the words and numbers that messages of several rules have for it."""

from __future__ import annotations

from typing import Any, TypeAlias

from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Mask
from polarcheck.foundation.errors import enumerated
from polarcheck.program.machines.code_tables import code_numbers, spelled
from polarcheck.rules.places import Place
from polarcheck.rules.quantity import Quantity, in_row
from polarcheck.rules.wording import offsets, written
from polarcheck.rules.wording.written import code_of, executed_word, short

#: Names of a message, and what stands for them at one hit.
Details: TypeAlias = dict[str, Any]
#: More words of a block are counted, not listed; and more lines that are like another one.
_LISTED, _LINES = 6, 4


class Hit:
    """
    One hit of a rule: what its details are taken from. Templates name its properties, and the details.

    place: the element in the file. row: of the trace, that of the G12.1 for a section; -1 where no row runs it.
    index: the element in the mask of the rule. words: the executed words at fault. count: how many elements the finding
    stands for.
    """

    def __init__(self, trace: Trace, place: Place, words: list[int], count: int = 1) -> None:
        self.trace = trace
        self.place, self.row, self.index = place, place.row, place.index
        self.words = words
        self.count = count

    # ---- numbers and places in the units of the program ----

    def quantity(self, value: Any) -> Quantity:
        """A value [mm, mm/min, radius] as the program writes it in this row."""
        return in_row(value, self.trace.lengths, self.row)

    def length(self, value: Any) -> str:
        """A length with its unit: `12.5 mm`."""
        return f"{self.quantity(value):length}"

    def number(self, value: Any) -> str:
        """A length as it stands behind an address: `12.5`."""
        return self.length(value).partition(" ")[0]

    def point(self, place: complex) -> str:
        """A plane point as words: X30 C15, or X30 Y15."""
        return written.point(self.trace, place, self.row)

    def point_off_center(self, place: complex) -> str:
        """A point that is counted from the center of C, as words."""
        return self.point(place + complex(self.trace.path.center_shift[self.row]))

    def line(self, row: int) -> int:
        """The line of a row."""
        return int(self.trace.blocks.line[row])

    def likewise(self, rows: Mask) -> str:
        """`; likewise in lines 26 and 41`: where else in the program these rows are, in other lines than this one."""
        blocks = self.trace.blocks
        same_program = blocks.program == blocks.program[self.row]
        own = self.line(self.row)
        lines = [line for line in dict.fromkeys(blocks.line[rows & same_program].tolist()) if line != own]
        if not lines:
            return ""
        names = [*map(str, lines[:_LINES]), *([f"{len(lines) - _LINES} more"] if len(lines) > _LINES else [])]
        return f"; likewise in line{'s' if len(lines) > 1 else ''} {enumerated(names)}"

    @property
    def radius(self) -> float:
        """R that the row is compensated with, without its sign."""
        return abs(self.signed_radius)

    @property
    def signed_radius(self) -> float:
        """R that the row is compensated with."""
        return float(self.trace.compensation.radius[self.row])

    # ---- what is written ----

    @property
    def text(self) -> str:
        """What stands at the element."""
        return short(self.trace.text.source.excerpt(self.place.start, self.place.end))

    @property
    def word(self) -> str:
        """The first executed word at fault as it is written, without blanks; of other elements what stands there."""
        return executed_word(self.trace.run, self.words[0]) if self.words else self.text

    @property
    def word_list(self) -> str:
        """The words at fault as they are written."""
        more = f" and {len(self.words) - _LISTED} more" if len(self.words) > _LISTED else ""
        return " ".join(executed_word(self.trace.run, index) for index in self.words[:_LISTED]) + more

    def written(self, address: str) -> str:
        """The last word of an address in the row as it is written; the address where there is none."""
        return written.written(self.trace.blocks, self.trace.run, self.row, address)

    @property
    def code(self) -> str:
        """The codes at fault, each once, as in `G17, M5`."""
        table = self.trace.run.words
        numbers = code_numbers(table.value[self.words])
        codes = [spelled(chr(int(table.address[at])), int(code)) for at, code in zip(self.words, numbers, strict=True)]
        return ", ".join(dict.fromkeys(codes))

    @property
    def block(self) -> str:
        """The block as it is written: `G0 C120.`"""
        return written.block_in_short(self.trace.run, self.row)

    @property
    def offset(self) -> int | str:
        """The tool offset in force, for `of offset 8`, `of offset MILL_8/1`."""
        return offsets.offset(self.trace.tools, self.row)

    # ---- addresses and codes of the machine ----

    @property
    def title(self) -> str:
        """The title of the machine."""
        return self.trace.machine.title

    @property
    def linear(self) -> str:
        """The address of the linear axis: X."""
        return chr(self.trace.axes.linear_axis[self.row])

    @property
    def virtual(self) -> str:
        """The address of the virtual axis: C."""
        return self.trace.axes.virtual_axis_of(self.row)

    @property
    def rotary(self) -> str:
        """The address of the rotary axis: C."""
        return self.trace.machine.polar.rotary_address

    @property
    def centers(self) -> str:
        """The addresses of arc centers: I or J."""
        return " or ".join(self.trace.axes.center_words(self.row))

    @property
    def side(self) -> str:
        """G41 or G42, whichever is in force."""
        return f"G{self.trace.compensation.side[self.row]}"

    @property
    def cancel(self) -> str:
        """G40."""
        return code_of(self.trace.machine, "compensation_off")

    @property
    def switch(self) -> str:
        """The code in this row that switches the polar mode on or off, as in G12.1 or G113."""
        return written.switch(self.trace.blocks, self.trace.machine, self.row)

    @property
    def switch_on(self) -> str:
        """The code that begins the mode which the code in this row ends: G112 for G113."""
        return written.switch_on(self.trace.blocks, self.trace.machine, self.row)

    @property
    def outside(self) -> str:
        """Where it belongs, with the codes of this section: before G112 or after G113."""
        trace = self.trace
        enter = int(trace.mode.sections.enter[trace.mode.section[self.row]])
        begin, end = (code(trace.blocks, trace.machine, enter) for code in (written.switch, written.switch_off))
        return f"before {begin} or after {end}"
