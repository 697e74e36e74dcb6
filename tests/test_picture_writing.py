"""How a page writes points: in the words that the program writes, with its zero, its axes and their addresses."""

from __future__ import annotations

import cmath
import math

import pytest
from cases import looped
from test_pictures import ARCS, HEAD, HEXAGON, points, section_of

from polarcheck.view.picture_data import SectionPicture, Writing

FRAMES = """\
N10 G90 G94 G40 G97
N20 T="MILL_8" D2
N30 G0 X120 C0 Z5
N40 DIAMOF
N50 TRANSMIT
N60 G17
N70 TRANS X8 Y4
N80 AROT RPL=30
N90 G0 X60 Y-20
N100 G1 X12 Y-12 F200
N110 X-12
{}N230 X60
N240 TRAFOOF
N270 M30
"""


def plane_point(section: SectionPicture, x: float, c: float) -> complex:
    """The point of the plane [mm] that a program means by these words."""
    writing = section.writing
    assert writing.origin is not None
    written = complex(x / (2 if section.diameter else 1), c / (2 if writing.virtual_diameter else 1)) * section.scale
    return cmath.rect(1, math.radians(writing.turn)) * written + complex(*writing.origin)


@pytest.mark.ci
@looped(
    ("program", "machine", "words", "virtual"),
    [
        (HEXAGON, "fanuc", (0, 17.320508), "C"),
        (HEXAGON.replace("G21", "G20").replace("X0.0", "X0.5"), "fanuc", (0.5, 17.320508), "C"),
        (
            HEXAGON.replace("G12.1", "G112").replace("G13.1", "G113").replace(" C", " Y"),
            "haas-lathe",
            (0, 17.320508),
            "Y",
        ),
        (FRAMES.format(""), "siemens-transmit", (12, -12), "Y"),
        (HEXAGON.replace("G12.1", "G12.1 X6. C2."), "gsk-988", (0, 17.320508), "C"),
    ],
    ids=["mm", "inch", "Y", "frame", "center"],
    one_in=3,
)
def test_words_and_points_of_the_plane_agree(
    program: str, machine: str, words: tuple[float, float], virtual: str
) -> None:
    section = section_of(program, machine=machine)
    assert section.writing.virtual == virtual
    assert min(abs(points(section.programmed) - plane_point(section, *words))) < 1e-3


def test_a_zero_that_moves_within_the_section_is_not_known() -> None:
    section = section_of(FRAMES.format("N120 TRANS X9\n"), machine="siemens-transmit")
    assert section.writing == Writing(virtual="Y", origin=None)


@pytest.mark.ci
def test_each_arc_has_its_center() -> None:
    section = section_of(ARCS, "8:radius=4")
    assert [center for center in section.moves.center if center is not None] == [(0.0, 0.0)] * 2
    assert [block[:2] for block, center in zip(section.moves.block, section.moves.center, strict=True) if center] == [
        "G3",
        "G3",
    ]
    assert not any(section_of(HEAD + "G1 X10. F200\nG13.1\nM30\n").moves.center)
