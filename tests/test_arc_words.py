"""R, I and J in straight moves: words of a forgotten arc, or of the corner at their end."""

from __future__ import annotations

from cases import looped
from programs import report_of


@looped(
    ("moves", "is_forgotten"),
    [
        ("Y20. R4.\nX-20.", False),  # a corner that is rounded with R4
        ("Y16.\nX16. Y20. R4.\nX-16.", True),  # an arc of R4 would be tangent on both sides
        ("Y16.\nX16. Y20. R3.\nX-16.", False),
        ("Y17.\nY20. R4.\nX-20.", True),  # R4 leaves nothing of a move of 3
    ],
)
def test_on_a_lathe_that_rounds_corners_r_is_forgotten_g3_only_where_it_makes_no_corner(
    moves: str, is_forgotten: bool
) -> None:
    program = f"G98 G17\nG0 X60. Y0\nG112\nG1 X20. F200\n{moves}\nX60.\nG113\n"
    report = report_of(program, "haas-lathe", "1:radius=3", only=["arc-word-without-arc"])
    assert [finding.rule for finding in report.findings] == ["arc-word-without-arc"] * is_forgotten
