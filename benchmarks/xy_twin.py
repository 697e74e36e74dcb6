"""
The same path on a mill: a lathe program of benchmarks/generate.py in words that readers of mill programs know.

    python benchmarks/xy_twin.py polar.nc --radius 2 -o xy.ngc

A polar section becomes G17 with X as a radius and Y in the place of C, so that its moves are those of the plane of
G12.1 one for one; turning stays in G18, X as a radius, too. What a mill does not know is left out: reference returns,
constant surface speed, the clutches of the C axis and the live tool. Each block stays a block.
"""

from __future__ import annotations

import argparse
import re
from collections.abc import Iterator
from pathlib import Path

WORD = re.compile(r"([A-Z])([-+]?[0-9.]+)")
COMMENT = re.compile(r"\([^)]*\)")
#: Codes of a lathe and of its builder, and what stands for each; nothing where that is left out.
CODES = {
    **dict.fromkeys(("G50", "G96", "G97", "M13", "M33", "M34", "M35"), ""),
    "G12.1": "G17",
    "G13.1": "G18",
    "G98": "G94",
    "G99": "G95",
}
REFERENCE_RETURN = "G28"
SIDES = {"G41", "G42"}
OFF = "G40"
TOOLS = range(1, 13)
#: A table of tools is in the units of the machine, and these are inches where no configuration says otherwise.
MM_PER_INCH = 25.4


def twin(program: str, *, compensated: bool = False, sinumerik: bool = False) -> str:
    """
    The mill program, a line for each line.

    compensated: with G41, G42 and G40, and the D of the tool in the spindle; without, the path is that of the contour.
    sinumerik: without % and comments, and the radius of arcs as CR=, as Sinumerik writes it.
    """
    return "\n".join(_lines(program, compensated, sinumerik)) + "\n"


def _lines(program: str, compensated: bool, sinumerik: bool) -> Iterator[str]:
    tool = "0"
    for line in program.splitlines():
        if line == "%":
            yield "" if sinumerik else line
            continue
        words = WORD.findall(COMMENT.sub("", line))
        called = [value for address, value in words if address == "T"]
        # T0404 is tool 4 with offset 4.
        tool = str(int(called[0][:2])) if called else tool
        yield " ".join(_words(words, tool, compensated, sinumerik))


def _words(words: list[tuple[str, str]], tool: str, compensated: bool, sinumerik: bool) -> Iterator[str]:
    codes = {address + value for address, value in words}
    is_return = REFERENCE_RETURN in codes
    for address, value in words:
        code = address + value
        if address == "O" or (is_return and address != "N"):
            continue
        if code in SIDES | {OFF}:
            if compensated:
                yield f"{code} D{tool}" if code in SIDES else code
        elif address in "GM":
            if found := CODES.get(code, code):
                yield found
        elif address == "T":
            yield f"T{tool} M6"
        elif address == "X":
            # Three decimals of a diameter are four of a radius.
            yield "X" + f"{float(value) / 2:.4f}".rstrip("0")
        elif address == "C":
            yield f"Y{value}"
        elif address == "K":  # the center of arcs in the mode; those of turning have R
            yield f"J{value}"
        elif address == "R" and sinumerik:
            yield f"CR={value}"
        else:
            yield code


def tool_table(radius: float) -> str:
    """The tools of the program in a table as LinuxCNC reads it, all of one radius [mm]."""
    return "".join(f"T{tool} P{tool} D{2 * radius / MM_PER_INCH:.6f}\n" for tool in TOOLS)


def main() -> None:
    """Write the twin of a program, and with a radius its tool table beside it."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("path", type=Path, help="the program, as benchmarks/generate.py writes it")
    parser.add_argument("--radius", type=float, help="of the cutter [mm]: with compensation, and a table of tools")
    parser.add_argument("--sinumerik", action="store_true")
    parser.add_argument("-o", "--output", type=Path, required=True)
    asked = parser.parse_args()
    compensated = asked.radius is not None
    text = twin(asked.path.read_text("ascii"), compensated=compensated, sinumerik=asked.sinumerik)
    asked.output.write_text(text, "ascii")
    if compensated:
        asked.output.with_suffix(".tbl").write_text(tool_table(asked.radius), "ascii")


if __name__ == "__main__":
    main()
