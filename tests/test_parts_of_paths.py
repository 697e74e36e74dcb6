"""Long paths are compensated some sections at a time: the moves are those of all sections at once."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from polarcheck.checking.check import read
from polarcheck.columns.path.moves import compensation_path, tool_center_path
from polarcheck.columns.trace import Trace
from polarcheck.geometry.cutter_compensation import offset_path
from polarcheck.program.machines import profiles
from polarcheck.program.machines.job import Job, Tool

SAMPLES = Path(__file__).parents[1] / "sample_programs"
TOOLS = Job(tools={str(number): Tool(radius=3) for number in range(1, 20)})


def all_samples() -> bytes:
    """The programs of all samples in one file."""
    texts = (path.read_bytes() for path in sorted(SAMPLES.glob("*.nc")))
    return b"\n".join(text.replace(b"%", b"") for text in texts if b"G41" in text and b"#" not in text)


@pytest.mark.parametrize("name", ["fanuc", "mitsubishi-m700"])
def test_a_path_in_parts_is_that_of_all_sections(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    ((_, tables), *_) = read(all_samples(), profiles.load(name).machine, TOOLS)
    trace: Trace = tables["trace"]
    path = compensation_path(trace, np.flatnonzero(trace.mode.in_polar))
    whole = tool_center_path(trace, path)
    monkeypatch.setattr(offset_path, "_PART", 1)
    assert len(offset_path._parts(path.section)) == len(np.unique(path.section)) + 1 > 5
    parts = tool_center_path(trace, path)
    for column in whole.__struct_fields__:
        one, other = getattr(whole, column), getattr(parts, column)
        assert one.dtype == other.dtype
        assert np.array_equal(one, other, equal_nan=True), column
    assert np.count_nonzero(whole.phase == offset_path.Phase.OFFSET) > 10
