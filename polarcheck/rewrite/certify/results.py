"""The certificate: what came of each case, and the matrix of features and controls. This is a JSON contract."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence

import msgspec

from polarcheck.foundation.finding import Producer

#: Number of the JSON contract.
SCHEMA = 1
#: States of a cell; of several cases in a cell the worst one counts.
PASS, NO_GOLDEN, MISSING, NOT_OFFERED, NOT_RUN, FAIL = STATES = (
    *("pass", "no golden trace", "missing", "not offered", "not run", "fail"),
)


class PathComparison(msgspec.Struct, frozen=True, kw_only=True):
    """
    A tool center path beside another one.

    reference: file of the golden trace, or name of the other case.
    agrees: the deviation is within the tolerance, and nothing else differs.
    deviation: the largest [mm]; null where the paths cannot be laid beside each other.
    tolerance: the largest that is accepted [mm].
    """

    reference: str
    agrees: bool
    deviation: float | None
    tolerance: float


class CaseResult(msgspec.Struct, frozen=True, kw_only=True):
    """
    What came of a case.

    name, feature, control: the case, its row and its column.
    program: path of the program. machine: name or file of its machine.
    state: pass, fail, not run, or no golden trace: nothing else is wrong, and --update writes the first one.
    expected, verdict: of the program; verdict is null where it was not run.
    reasons: why it does not pass, each in one line.
    remarks: what else its reader must know.
    golden, same_path: comparisons of its path; null where there is none.
    """

    name: str
    feature: str
    control: str
    program: str
    machine: str
    state: str
    expected: str
    verdict: str | None
    reasons: list[str]
    remarks: list[str] = []
    golden: PathComparison | None = None
    same_path: PathComparison | None = None


class Cell(msgspec.Struct, frozen=True, kw_only=True):
    """
    A feature on a control.

    state: pass, no golden trace, fail, not run, missing (no case) or not offered.
    cases: names of its cases. reason: why the feature is not offered.
    """

    feature: str
    control: str
    state: str
    cases: list[str] = []
    reason: str = ""


class Summary(msgspec.Struct, frozen=True, kw_only=True):
    """Counts: of cases, and of cells without any case."""

    cases: int
    passed: int = msgspec.field(name="pass")
    no_golden: int
    fail: int
    not_run: int
    missing: int
    not_offered: int


class Certificate(msgspec.Struct, frozen=True, kw_only=True):
    """
    A certificate of a post.

    schema: number of this contract. tool: what wrote it.
    title: name and version of the post. manifest: path of the manifest.
    features, controls: rows and columns of the matrix. cells: by row, then by column.
    cases: in the order of the manifest.
    """

    schema: int
    tool: Producer
    title: str
    manifest: str
    features: list[str]
    controls: list[str]
    cells: list[Cell]
    cases: list[CaseResult]
    summary: Summary


def worst(states: Iterable[str]) -> str:
    """Return the worst of some states of cases; missing without any."""
    return max(states, key=STATES.index, default=MISSING)


def summary(cases: Sequence[CaseResult], cells: Sequence[Cell]) -> Summary:
    """Count the states of cases, and the cells without any."""
    of_cases, of_cells = Counter(case.state for case in cases), Counter(cell.state for cell in cells)
    return Summary(
        cases=len(cases),
        passed=of_cases[PASS],
        no_golden=of_cases[NO_GOLDEN],
        fail=of_cases[FAIL],
        not_run=of_cases[NOT_RUN],
        missing=of_cells[MISSING],
        not_offered=of_cells[NOT_OFFERED],
    )
