"""A finish beside its roughing but for one point, and passes on the other side of one contour."""

from __future__ import annotations

import pytest
from cases import looped
from programs import report_of

from polarcheck.foundation.finding import each_finding

pytestmark = pytest.mark.ci

#: Corners of a rectangle, X as a diameter.
FINISH = [(36.0, 10.0), (36.0, -10.0), (-36.0, -10.0), (-36.0, 10.0)]


def section(tool: int, corners: list[tuple[float, float]]) -> str:
    """Round a rectangle clockwise from the middle of its first wall."""
    x = corners[0][0]
    walls = "".join(f"X{x:.3f} C{c:.3f}\n" for x, c in [*corners[1:], corners[0]])
    return (
        f"T0{tool}0{tool}\nG0 X80. Z2. C0\nG12.1\nG1 X80. C0. F1500\nZ-5. F300\nG41 X{x:.3f} C0. F250\n{walls}"
        f"X{x:.3f} C0.\nG40 X80. F1500\nZ2.\nG13.1\nG0 Z50.\n"
    )


def told(*sections: str) -> list[tuple[str, str]]:
    text = f"O1\nG21 G98\n{''.join(sections)}M30\n"
    report = report_of(text, "fanuc", "1:radius=4,nose=0", "2:radius=4,nose=0")
    return [(one.rule, one.message) for one in report.findings if one.severity != "note"]


def offset(x: float, c: float) -> list[tuple[float, float]]:
    return [(a + 2 * x * (1 if a > 0 else -1), b + c * (1 if b > 0 else -1)) for a, b in FINISH]


@pytest.mark.nightly
@looped("corner", [1, 2, 3])
@looped("allowance", [(0.3, 0.3), (0.25, 0.5)])
@looped("wrong", ["finish", "roughing"])
@looped("by", [(-4.0, 0.0), (0.0, 1.5), (-0.3, 0.0)])
def test_one_point_that_is_not_beside_the_other_contour(
    corner: int, allowance: tuple[float, float], wrong: str, by: tuple[float, float]
) -> None:
    contours = {"roughing": offset(*allowance), "finish": list(FINISH)}
    assert told(section(1, contours["roughing"]), section(2, contours["finish"])) == []
    x, c = contours[wrong][corner]
    contours[wrong][corner] = (x + by[0] * (1 if x > 0 else -1), c + by[1] * (1 if c > 0 else -1))
    ((rule, message),) = told(section(1, contours["roughing"]), section(2, contours["finish"]))
    assert rule == "passes-differ"
    assert f"at X{x:g} C{c:g}" in message
    assert f"{min(allowance):g} mm beside" in message


@looped(
    "corners",
    [[(40.0, 10.0), *FINISH[1:3], (-40.0, 10.0)], [(36.0, 12.0), (36.0, -10.0), (-36.0, -10.0), (-36.0, 12.0)]],
)
def test_two_points_elsewhere_are_another_shape(corners: list[tuple[float, float]]) -> None:
    larger = [(x + 0.6 * (1 if x > 0 else -1), c + 0.3 * (1 if c > 0 else -1)) for x, c in corners]
    assert told(section(1, larger), section(2, FINISH)) == []


FLAT = "G1 X60. C20. F1500\nZ{z} F300\n{side} X30. F250\nC-20.\nG40 X60. F1500\nZ2.\n"


@pytest.mark.nightly
@looped(
    ("passes", "lines"),
    [
        ((("-2.", "G41"), ("-4.", "G41")), []),
        ((("-2.", "G42"), ("-4.", "G41"), ("-6.", "G41")), [8]),
        ((("-2.", "G41"), ("-4.", "G42"), ("-6.", "G41")), [14]),
        ((("-2.", "G41"), ("-4.", "G42")), [14]),
        # Both walls of a slot.
        ((("-2.", "G41"), ("-2.", "G42")), []),
        ((("-2.", "G41"), ("-2.", "G42"), ("-4.", "G41"), ("-4.", "G42")), []),
    ],
)
def test_a_pass_on_the_other_side(passes: tuple[tuple[str, str], ...], lines: list[int]) -> None:
    blocks = "".join(FLAT.format(z=z, side=side) for z, side in passes)
    text = f"O1\nG21 G98\nT0101\nG0 X60. Z2. C0\nG12.1\n{blocks}G13.1\nG0 Z50.\nM30\n"
    report = report_of(text, "fanuc", "1:radius=4,nose=0")
    assert [one.line for one in each_finding(report.findings) if one.rule == "passes-differ"] == lines
