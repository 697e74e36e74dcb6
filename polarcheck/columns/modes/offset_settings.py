"""Settings of offsets by the program itself, and the values of an offset that result down the rows."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from polarcheck.columns.filling import fill_down, positions
from polarcheck.foundation.arrays import Floats, Mask, Rows, mask_at
from polarcheck.geometry.tolerances import ADJUSTMENT, ROUNDING

#: Kinds of settings.
RADIUS, RADIUS_WEAR, NOSE, X, X_WEAR = range(5)


class Settings(NamedTuple):
    """
    Settings of offsets by the program outside the mode, one element each.

    number: of the offset. kind: RADIUS and the like. value: [mm], or the nose type; NaN where it is not known.
    is_step: it is added.
    """

    row: Rows
    number: Rows
    kind: Rows
    value: Floats
    is_step: Mask

    def of(self, chosen: Mask | Rows) -> Settings:
        """The settings at some indices, or of a mask."""
        row, number, kind, value, is_step = self
        return Settings(row[chosen], number[chosen], kind[chosen], value[chosen], is_step[chosen])


def of_list(settings: Sequence[tuple[int, int, int, float, bool]]) -> Settings:
    """Columns of a list of settings: row, number, kind, value, is_step."""
    table = np.array(settings, np.float64).reshape(-1, 5)
    row, number, kind = (table[:, column].astype(np.int64) for column in range(3))
    return Settings(row, number, kind, table[:, 3], table[:, 4].astype(bool))


def in_order(parts: Sequence[Settings]) -> Settings:
    """Settings that were found in several ways, in order of the rows."""
    row, number, kind, value, is_step = (
        np.concatenate([part[column] for part in parts]) for column in range(len(Settings._fields))
    )
    return Settings(row, number, kind, value, is_step).of(np.argsort(row, kind="stable"))


class Steps:
    """
    The values of one offset after its settings, down the rows in which it is in force.

    Computed in the rows of the settings and of program heads alone: there may be many offsets, and many rows.
    """

    def __init__(self, starts: Mask, settings: Settings, rows: Rows) -> None:
        heads = np.flatnonzero(starts)
        self.settings = settings
        self.row = np.union1d(heads, settings.row)
        self.starts = np.isin(self.row, heads)
        self.at = np.searchsorted(self.row, settings.row)
        self.asked = np.searchsorted(self.row, rows, side="right") - 1

    @property
    def last(self) -> tuple[Rows, Floats]:
        """The row of the last setting in each of the rows, -1 where there is none in its program; and its value."""
        setting_row, value = np.full(len(self.row), -1), np.full(len(self.row), np.nan)
        setting_row[self.at], value[self.at] = self.settings.row, self.settings.value
        written = setting_row >= 0
        last = fill_down(setting_row, written | self.starts, -1)[self.asked]
        return last, fill_down(value, written | self.starts, np.nan)[self.asked]

    def radius(self, is_whole: Mask, program: Rows) -> tuple[Floats, Floats, Mask]:
        """
        R of the geometry and of the wear in each of the rows, and whether the geometry is no step from what is given.

        is_whole: settings of a wear that are R itself, if the program sets no geometry; program: of each setting.
        """
        _, _, kind, value, is_step = self.settings
        is_geometry = (kind == RADIUS) & ~is_step
        is_whole = is_whole | (np.abs(value) > ADJUSTMENT + ROUNDING)
        of_both = (kind == RADIUS_WEAR) & ~is_step & is_whole & ~np.isin(program, program[is_geometry])
        absolute = is_geometry | of_both
        geometry = self._summed(value, absolute, (kind == RADIUS) & is_step)
        of_wear = np.where(of_both, 0.0, value)
        wear = self._summed(of_wear, (kind == RADIUS_WEAR) & ~is_step, (kind == RADIUS_WEAR) & is_step)
        written = mask_at(len(self.row), self.at[absolute])
        return geometry, wear, fill_down(written, written | self.starts, False)[self.asked].astype(bool)

    def _summed(self, value: Floats, absolute: Mask, added: Mask) -> Floats:
        """The sum of some settings, from 0 on; NaN from an unknown one to the next absolute one."""
        absolute_value, step = np.full(len(self.row), np.nan), np.zeros(len(self.row))
        absolute_value[self.at[absolute]] = value[absolute]
        step[self.at[absolute & np.isnan(value)]] = np.nan
        np.add.at(step, self.at[added], value[added])
        return positions(absolute_value, step, self.starts, np.zeros(len(self.row)))[self.asked]
