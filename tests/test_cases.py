"""A test that loops over its cases names those that fail, and tries what the run asks for."""

from __future__ import annotations

import inspect
from collections.abc import Callable

import cases
import pytest
from cases import looped


@pytest.fixture
def by_day(monkeypatch: pytest.MonkeyPatch) -> None:
    """A run of the lower tiers that goes on after a failure, whatever the present one is."""
    monkeypatch.setattr(cases, "run", cases.Run())


def sum_of(count: int, **options: int) -> tuple[Callable[..., None], list[tuple[int, int]]]:
    """A test of so many times two cases, of which those with a sum of 3 fail; and the cases that it has tried."""
    tried = []

    @looped("first", range(count), **options)
    @looped(("second",), [pytest.param(1), pytest.param(2)])
    def test(first: int, second: int, fixture: str) -> None:
        assert fixture == "fixture"
        tried.append((first, second))
        assert first + second != 3

    return test, tried


def test_one_case_that_fails_is_named(by_day: None) -> None:
    test, tried = sum_of(2)
    with pytest.raises(AssertionError) as caught:
        test(fixture="fixture")
    assert caught.value.__notes__ == ["case 2-1"]
    assert tried == [(0, 1), (1, 1), (0, 2), (1, 2)]


def test_each_case_that_fails_is_named(by_day: None) -> None:
    with pytest.raises(ExceptionGroup, match="2 of 6 cases failed") as caught:
        sum_of(3)[0](fixture="fixture")
    assert [error.__notes__ for error in caught.value.exceptions] == [["case 1-2"], ["case 2-1"]]


def test_only_the_nightly_run_tries_each_case(by_day: None, monkeypatch: pytest.MonkeyPatch) -> None:
    test, tried = sum_of(2, one_in=3)
    monkeypatch.setattr(cases.run, "is_nightly", False)
    with pytest.raises(AssertionError):
        test(fixture="fixture")
    assert tried == [(0, 1), (1, 2)]
    monkeypatch.setattr(cases.run, "is_nightly", True)
    with pytest.raises(AssertionError):
        test(fixture="fixture")
    assert len(tried) == 2 + 4


def test_a_test_without_cases_fails(by_day: None) -> None:
    with pytest.raises(AssertionError, match="no cases"):
        sum_of(0)[0](fixture="fixture")


def test_pytest_gives_the_remaining_fixtures() -> None:
    @looped("number", [1])
    def test(number: int, pytestconfig: pytest.Config) -> None: ...

    assert list(inspect.signature(test).parameters) == ["pytestconfig"]
