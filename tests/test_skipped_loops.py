"""Loops that are skipped, by reason and by row."""

from __future__ import annotations

import numpy as np

from polarcheck.columns.contour.skipped_loops import SkippedLoops, SkipReason

FAR, CHORDS, CROSSES = SkipReason.TOO_FAR, SkipReason.TOO_MANY_CHORDS, SkipReason.CROSSES


def test_rows_are_chosen_by_the_reason_of_their_loop() -> None:
    skipped = SkippedLoops.of({FAR: np.array([4]), CHORDS: np.array([2, 7]), CROSSES: np.zeros(0, np.int64)})
    loop = np.array([-1, 2, 2, 3, 4, 7])
    assert skipped.rows(loop, FAR).tolist() == [False, False, False, False, True, False]
    assert skipped.rows(loop, CHORDS).tolist() == [False, True, True, False, False, True]
    assert skipped.rows(loop, FAR, CHORDS).tolist() == [False, True, True, False, True, True]
    assert not skipped.rows(loop, CROSSES).any()


def test_a_loop_may_be_skipped_for_two_reasons() -> None:
    skipped = SkippedLoops.concatenated(
        [SkippedLoops.of({CROSSES: np.array([1])}), SkippedLoops.of({FAR: np.array([1])})]
    )
    assert [skipped.rows(np.array([1]), reason).tolist() for reason in (CROSSES, FAR, CHORDS)] == [
        [True],
        [True],
        [False],
    ]


def test_nothing_is_skipped_of_no_loops() -> None:
    assert not SkippedLoops.of({}).rows(np.array([0, -1]), *SkipReason).any()
