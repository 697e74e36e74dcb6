"""Rows with another R, or on the other side: what the control would object to there."""

from __future__ import annotations

import numpy as np
import pytest
from cases import looped
from programs import tables_of

from polarcheck.columns.path.tool_center import OtherRadius
from polarcheck.columns.path.trial import Trial
from polarcheck.foundation.arrays import Floats

pytestmark = pytest.mark.ci

HEAD, TAIL = "T0101\nG98 G0 X100. C0\nG12.1\nG1 C20. F500\n", "G40 X100.\nG13.1\n"


def trial_of(blocks: str, share: float, radius: float = 4.0) -> tuple[Trial, Floats]:
    """All rows with a share of R, below 0 on the other side; and the line of each row."""
    tables = tables_of(HEAD + blocks + TAIL, "fanuc", f"1:radius={radius}")
    trace = tables["trace"]
    rows = np.ones(len(trace), bool)
    other = OtherRadius(rows, tables["since"].compensation, share * trace.compensation.radius)
    return Trial(trace, other), trace.blocks.line


@looped(
    ("blocks", "share", "lines"),
    [
        # An arc of 3 mm on the inner side of R 4, and of R 2; on the other side it has room.
        ("G41 X60. F200\nC0\nG3 X66. C-3. R3.\nG1 X80.\n", 1, [7]),
        ("G41 X60. F200\nC0\nG3 X66. C-3. R3.\nG1 X80.\n", 0.5, []),
        ("G42 X60. F200\nC0\nG3 X66. C-3. R3.\nG1 X80.\n", 1, []),
        ("G42 X60. F200\nC0\nG3 X66. C-3. R3.\nG1 X80.\n", -1, [7]),
        # A slot of 6 mm with a bottom.
        ("G41 X60. F200\nC3.\nX40.\nC-3.\nX60.\nC-20.\n", 1, [8]),
        ("G41 X60. F200\nC3.\nX40.\nC-3.\nX60.\nC-20.\n", 0.5, []),
        # An arc of 5 mm round the end of a line.
        ("G41 X60. F200\nC0\nG3 X70. C0 R5.\nG1 C-20.\n", 1, [6]),
        # Two blocks without a way on the plane, of whatever R; an arc about its own start.
        ("G41 X60. F200\nM8\nM9\nC-20.\n", 1, [5]),
        ("G41 X60. F200\nM8\nM9\nC-20.\n", 0.01, [5]),
        ("G41 X60. F200\nM8\nC-20.\n", 1, []),
        ("G41 X60. F200\nC0\nG3 X66. C-3. I0 J0\nG1 X80.\n", 1, [7]),
    ],
    one_in=2,
)
def test_what_the_control_would_object_to(blocks: str, share: float, lines: list[int]) -> None:
    trial, line = trial_of(blocks, share)
    assert line[trial.objects].tolist() == lines
    for column in (trial.fails, trial.faulty):
        assert set(lines) <= set(line[column].tolist())
