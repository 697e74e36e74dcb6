"""The executed program with Z turned over, so that it rises away from the part where it is written the other way."""

from __future__ import annotations

import msgspec
import numpy as np

from polarcheck.columns.path.path import ProgrammedPath
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Floats


class UprightPath(ProgrammedPath, frozen=True):
    """Z rises away from the part, and is written the other way."""

    @property
    def z_sense(self) -> float:
        """By which Z here is multiplied to become Z as it is written."""
        return -1.0

    @property
    def _z_words(self) -> tuple[Floats, Floats]:
        absolute, steps = super()._z_words
        return -absolute, -steps

    def _set_by(self, axis: str) -> Floats:
        coordinate = super()._set_by(axis)
        return -coordinate if axis == "Z" else coordinate


class DepthlessPath(ProgrammedPath, frozen=True):
    """Nobody knows which way along Z the part lies, so that Z says nothing of its depths."""

    @property
    def z(self) -> Floats:
        """NaN."""
        return np.full(len(self.run), np.nan)


def with_path(trace: Trace, kind: type[ProgrammedPath]) -> Trace:
    """The trace with its path as another kind of path."""
    return msgspec.structs.replace(
        trace, path=kind(*(getattr(trace.path, name) for name in trace.path.__struct_fields__))
    )
