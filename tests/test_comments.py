"""Radii as posts write them."""

from __future__ import annotations

import pytest

from polarcheck.table.radius_comments import radius_in


@pytest.mark.parametrize(
    ("comment", "inch", "radius"),
    [
        ('3/4" DIA. CUTTER', False, 0.375 * 25.4),
        ("3/4 DIA. CUTTER", True, 0.375 * 25.4),
        ("T8 D=12. CR=0. - ZMIN=-5. - FLAT END MILL", False, 6.0),
        ("D=.5 CR=.03", True, 0.25 * 25.4),
        ("R0.25", True, 0.25 * 25.4),
        ("Freza=12", False, 6.0),
        ("10MM END MILL", False, 5.0),
        ("1/2 INCH ENDMILL", False, 6.35),
        ("DIA 16", False, 8.0),
        ("ROUGH OD", False, None),
        ("CR=0.4", False, None),
        ("DRILL 3", False, None),
        ("OP10 REV 3", False, None),
        ("1/0 DIA", False, None),
        ("D9999.", False, None),
    ],
)
def test_radius_of_a_comment(comment: str, inch: bool, radius: float | None) -> None:
    found = radius_in(comment, inch)
    assert found == (None if radius is None else pytest.approx(radius))
