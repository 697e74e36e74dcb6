"""A hexagon of 36 mm across its flats, as known-good as a program can be, for tests that change a word of it."""

from __future__ import annotations

#: With R 4 of offset 1; a / stands for the end of a block.
HEX = (
    "O1000/G21 G98 G40 M200/T0101/G97 S3000 M13/G28 H0/G0 X60. Z2. C0/G12.1/G1 X56. F1000/Z-4. F200/G42 X36. C0 F150/"
    "C10.392/X0 C20.785/X-36. C10.392/C-10.392/X0 C-20.785/X36. C-10.392/C0/G40 X56./Z2. F1000/G13.1/G0 X100. Z50./"
    "M5/M30"
)
#: Controls that read it alike; the last one wants its C axis engaged, by M200.
CONTROLS = ("fanuc-30i", "gsk-988", "mazak-eia")
CUTTER = "1:radius=4"


def hexagon(*changes: tuple[str, str]) -> str:
    """The program with some of its text replaced, each text once."""
    text = HEX
    for old, new in changes:
        assert old in text, old
        text = text.replace(old, new, 1)
    return text.replace("/", "\n") + "\n"
