"""Many cases in one test, and the name of a case. A test that pytest collects costs more than most cases take."""

from __future__ import annotations

import functools
import inspect
import math
from collections.abc import Callable, Iterable, Mapping, Sequence, Set
from enum import Enum
from typing import Any

import pytest

#: What pytest.param returns.
ParameterSet = type(pytest.param())

#: Characters of one value in the name of a case.
LONGEST = 50


class Run:
    """
    How tests run, as the command line says.

    is_nightly: all cases of all tests are tried. stops_at_failure: nothing runs after the first failure.
    """

    is_nightly = False
    stops_at_failure = False


run = Run()


def looped(
    names: str | Sequence[str],
    cases: Iterable[Any],
    *,
    ids: Callable[[Any], object] | Iterable[object] | None = None,
    one_in: int = 1,
) -> Callable[[Callable[..., None]], Callable[..., None]]:
    """
    A decorator like pytest.mark.parametrize for cases that need no fixture of their own: one test runs them all, and
    says of each that fails which one it is. Of two above each other, each case of one is tried with each of the other.

    one_in: before the nightly run, the first case and each one_in-th after it are tried; it stands in the topmost.
    """
    parameters = [name.strip() for name in names.split(",")] if isinstance(names, str) else list(names)
    rows = [dict(zip(parameters, values_of(case, len(parameters)), strict=True)) for case in cases]
    if ids is None or callable(ids):
        own = [(functools.partial(title_of, row, ids or name_of), row) for row in rows]
    else:
        own = [(functools.partial(str, title), row) for title, row in zip(ids, rows, strict=True)]

    def decorate(test: Callable[..., None]) -> Callable[..., None]:
        inner, inner_cases = vars(test).get("looped", (test, [((), {})]))
        all_cases = [((*parts, part), {**others, **row}) for parts, others in inner_cases for part, row in own]

        @functools.wraps(test)
        def loop(**fixtures: Any) -> None:
            chosen = all_cases[:: 1 if run.is_nightly else one_in]
            assert chosen, "there are no cases"
            failures: list[BaseException] = []
            for parts, row in chosen:
                try:
                    inner(**fixtures, **row)
                except (Exception, pytest.fail.Exception) as failure:
                    failure.add_note(f"case {'-'.join(part() for part in parts)}")
                    if run.stops_at_failure:
                        raise
                    failures.append(failure)
            if len(failures) > 1:
                raise BaseExceptionGroup(f"{len(failures)} of {len(chosen)} cases failed", failures)
            if failures:
                raise failures[0]

        signature = inspect.signature(test)
        remaining = [parameter for name, parameter in signature.parameters.items() if name not in parameters]
        vars(loop).update(looped=(inner, all_cases), __signature__=signature.replace(parameters=remaining))
        return loop

    return decorate


def title_of(row: Mapping[str, Any], spelled: Callable[[Any], object]) -> str:
    """The values of a case, spelled by this function."""
    return "-".join(str(spelled(value)) for value in row.values())


def values_of(case: Any, count: int) -> tuple[Any, ...]:
    """The values of a case of so many parameters."""
    if isinstance(case, ParameterSet):
        assert not case.marks, "pytest.mark.parametrize marks single cases"
        return tuple(case.values)
    return (case,) if count == 1 else tuple(case)


def name_of(value: Any) -> str:
    """Programs in one line, tables and numbers as their values: `X1. Z2. X3.-9`, not `X1. Z2. X3.-expected0`."""
    text = _spelled(value).replace("\n", " ").strip().encode("unicode_escape").decode("ascii") or "nothing"
    return text if len(text) <= LONGEST else f"{text[: LONGEST - 3]}..."


def _spelled(value: Any) -> str:
    if isinstance(value, Enum):
        return value.name
    if isinstance(value, Mapping):
        return " ".join(f"{_spelled(key)}={_spelled(item)}" for key, item in value.items())
    if isinstance(value, list | tuple | Set):
        parts = [_spelled(item) for item in value]
        return " ".join(sorted(parts) if isinstance(value, Set) else parts)
    if isinstance(value, bytes):
        return value.decode("latin-1")
    if isinstance(value, complex):
        return "unknown" if math.isnan(abs(value)) else f"{value:g}"
    return str(getattr(value, "__name__", value))
