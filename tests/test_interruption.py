"""Steps of GEOS end when the time is over, nobody waits any more, or a signal comes; the others are left alone."""

from __future__ import annotations

import contextlib
import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import shapely  # type: ignore[import-untyped]
from cases import looped
from clocks import Clock
from polarcheck.errors import NoAnswerError, StoppedError, TooHardError
from test_cli import IMPORTED_FROM

from polarcheck.foundation.time_limit import time_limit
from polarcheck.geometry.polygons import areas
from polarcheck.geometry.polygons.interruption import _Watch, interruptible

pytestmark = pytest.mark.ci

not_on_windows = pytest.mark.skipif(sys.platform == "win32", reason="signals of POSIX")

#: One step of GEOS that would take many minutes.
TANGLE = """
import numpy as np, shapely
from polarcheck.geometry.polygons import areas
from polarcheck.foundation.time_limit import time_limit
ends = np.random.default_rng(1).uniform(-50, 50, (40000, 2, 2))
tangle = shapely.multilinestrings(shapely.linestrings(ends))
"""


def tangle() -> Any:
    values: dict[str, Any] = {}
    exec(TANGLE, values)  # noqa: S102  the text above, which a process runs, too
    return values["tangle"]


def wait_for(holds: Callable[[], bool]) -> None:
    """Wait until it holds; only what will never hold takes so long that this fails."""
    end = time.monotonic() + 600
    while not holds():
        assert time.monotonic() < end
        time.sleep(0.01)


def test_a_step_ends_when_the_time_is_over() -> None:
    with (
        pytest.raises(TooHardError, match=r"takes longer than 0\.2 s of processor time, or 2 s in all"),
        time_limit(0.2),
    ):
        areas.with_itself(tangle())


def test_a_step_ends_when_nobody_waits_any_more() -> None:
    asked_beside: list[bool] = []

    def is_stopped() -> bool:
        asked_beside.extend([True] * (threading.current_thread() is not threading.main_thread()))
        return bool(asked_beside)

    with pytest.raises(StoppedError), time_limit(1000, is_stopped):
        areas.with_itself(tangle())


def test_it_ends_in_another_thread_too() -> None:
    """The language server checks in one."""
    raised: list[Exception] = []

    def work() -> None:
        try:
            with time_limit(0.2):
                areas.with_itself(tangle())
        except TooHardError as error:
            raised.append(error)

    thread = threading.Thread(target=work)
    thread.start()
    thread.join(120)
    assert [str(error)[:30] for error in raised] == ["the check of this file takes l"]


@pytest.mark.nightly
def test_the_steps_after_it_are_left_alone() -> None:
    squares = shapely.box(np.arange(50), 0, np.arange(50) + 2, 2)
    for _ in range(3):
        with pytest.raises(TooHardError), time_limit(0.1):
            areas.with_itself(tangle())
        with time_limit(100):
            for _ in range(50):
                assert areas.union_all(squares).area == 102


def test_a_request_that_comes_too_late_is_taken_back() -> None:
    with time_limit(0.01) as limit:
        with interruptible():
            wait_for(lambda: limit.helper(_Watch)._was_requested)  # the time is over, and GEOS is asked to stop
        assert shapely.union_all(shapely.box(np.arange(50), 0, np.arange(50) + 2, 2)).area == 102


def test_a_step_that_waits_for_the_processor_goes_on(monkeypatch: pytest.MonkeyPatch) -> None:
    """Until the thread itself has worked for so long, however much passes on the wall; the watch is in another one."""
    work = wall = 0.0
    clock = Clock(lambda looks: work, lambda looks: wall)
    clock.use(monkeypatch)
    with time_limit(1) as limit, interruptible():
        watch = limit.helper(_Watch)
        for passed in (2.0, 4.0, 6.0):
            wall, clock.looks_at_thread = passed, 0
            wait_for(lambda: clock.looks_at_thread > 0)
            assert not watch._was_requested
        work, wall = 1.1, 8.0
        wait_for(lambda: watch._was_requested)


@pytest.mark.nightly
def test_a_step_that_is_late_ends_no_step_of_another_thread() -> None:
    """GEOS has one flag for all threads, and the first step that looks at it ends."""
    angles = np.arange(300) * 2.4
    star = shapely.LineString(np.column_stack((np.cos(angles), np.sin(angles))))
    alone = shapely.unary_union([star])
    has_ended = threading.Event()
    late: list[bool] = []

    def be_late() -> None:
        while not has_ended.is_set():
            with contextlib.suppress(TooHardError), time_limit(0.05):
                areas.with_itself(tangle())
            late.append(True)

    thread = threading.Thread(target=be_late)
    thread.start()
    try:
        with time_limit(1000):
            while len(late) < 3:
                assert areas.with_itself(star).equals_exact(alone, 1e-9)
    finally:
        has_ended.set()
        thread.join()


def test_what_has_no_answer_is_not_called_late() -> None:
    """A polygon that crosses itself has no union with others."""
    broken = shapely.Polygon([(0, 0), (2, 2), (2, 0), (0, 2)])
    with time_limit(100), pytest.raises(NoAnswerError, match="cannot be computed"):
        areas.difference(broken, shapely.box(0.5, 0.2, 1.5, 1.7))


def test_nothing_is_left_behind() -> None:
    before, wakeup = threading.active_count(), signal.set_wakeup_fd(-1)
    for _ in range(3):
        with time_limit(100), interruptible():
            assert threading.active_count() == before + 1
    assert threading.active_count() == before
    assert signal.set_wakeup_fd(wakeup) == -1


def test_without_a_step_no_thread_is_started() -> None:
    before = threading.active_count()
    with time_limit(100):
        assert threading.active_count() == before
    with interruptible():
        assert threading.active_count() == before


@not_on_windows
@looped(("number", "word"), [(signal.SIGINT, "interrupt"), (signal.SIGTERM, "terminated")])
def test_a_signal_ends_a_step(number: signal.Signals, word: str) -> None:
    """The process would go on for many minutes; the limit here only tells an end from a hang."""
    script = (
        "import signal\nfrom polarcheck.commands import signals\nsignals.listen()\n"
        f"signal.signal(signal.SIGINT, signal.default_int_handler)\n{TANGLE}"
        "print('begins', flush=True)\ntry:\n    with time_limit(10000):\n        areas.with_itself(tangle)\n"
        "except signals.Terminated:\n    print('terminated')\nexcept KeyboardInterrupt:\n    print('interrupt')\n"
    )
    environment = {**os.environ, "PYTHONPATH": IMPORTED_FROM}
    with subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, text=True, env=environment) as run:
        assert run.stdout is not None
        assert run.stdout.readline() == "begins\n"
        time.sleep(0.5)
        run.send_signal(number)
        said, _ = run.communicate(timeout=60)
    assert said == f"{word}\n"
