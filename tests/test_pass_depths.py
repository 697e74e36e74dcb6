"""Depths of passes round one contour: those in step, and one that is not, with the Z that it would have."""

from __future__ import annotations

import numpy as np
import pytest
from cases import looped
from programs import tables_of

pytestmark = pytest.mark.ci

BLOCKS = "Z{}\nG42 X{} C0 F{}\nG3 I-{}\nG1 G40 X{}\n"
#: Size of X, F, radius and X of the approach: of mm and of inch.
UNITS = {"G21": (1.0, "20.", "200", "10.", "60."), "G20": (25.4, "1.", "8.", ".5", "3.")}


def off(levels: list[float], code: str) -> dict[int, float]:
    """The passes that are off by the number of their Z, and the Z that each would have."""
    scale, across, feed, radius, away = UNITS[code]
    passes = "".join(BLOCKS.format(f"{z / scale:.5f}", across, feed, radius, away) for z in levels)
    text = f"O1\n{code} G98 T0101\nG0 X{away} Z.2 C0\nG12.1\nG1 X{away} F{feed}\n{passes}Z.2\nG13.1\n"
    tables = tables_of(text, "fanuc", f"1:radius={4 / scale:.5f}")
    depths = tables["pass_depths"]
    lines = tables["trace"].blocks.line
    return {(int(lines[row]) - 2) // 4: float(depths.expected[row]) for row in np.flatnonzero(depths.is_off).tolist()}


@looped("code", UNITS)
@looped(
    ("levels", "expected"),
    [
        ([-2, -4, -6, -8], {}),
        ([-2, -40, -6, -8], {2: -4}),
        ([-20, -4, -6, -8], {1: -2}),
        ([-2, -4, -60, -8], {3: -6}),
        # The last one: none says that it should be higher, but the steps before it.
        ([-2, -4, -6, -80], {4: -8}),
        ([-2, -4, -6, -9], {}),
        ([-2, -4, -40], {3: -6}),
        ([-2, -20, -6], {2: -4}),
        # A spring pass; a last step that is smaller; the first one on its way through air.
        ([-2, -4, -6, -6], {}),
        ([-2, -4, -6, -6.5], {}),
        ([-2, -4, -5, -8], {}),
        # Twice at one depth is one pass.
        ([-2, -4, -4, -8], {}),
        ([-2, -4, -4, -6, -80], {5: -8}),
        # Up again.
        ([-2, -4, -3, -8], {3: -6}),
    ],
)
def test_a_pass_that_is_out_of_step(levels: list[float], expected: dict[int, float], code: str) -> None:
    assert off(levels, code) == pytest.approx(expected, abs=0.001)
