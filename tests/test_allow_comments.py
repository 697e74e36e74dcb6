"""Allow comments: what they silence and where, and what is said of those that silence nothing."""

from __future__ import annotations

import pytest
from programs import report_of, said

HEAD = "G98 G0 X60. C0\nG12.1\nG1 X40. F200\n"
REASON = "PROVEN ON L7"
ONLY = ("rapid-in-polar", "silence")


def silent(program: str, *only: str) -> list[tuple[int, str, str]]:
    """Line, rule and reason of what is silenced."""
    report = report_of(program, only=only or ONLY)
    assert {found.by for found in report.silenced} <= {"allow"}
    return [(found.line, found.rule, found.reason) for found in report.silenced]


@pytest.mark.parametrize(
    "block",
    [
        f"G0 C5. (POLARCHECK ALLOW RAPID-IN-POLAR {REASON})\n",
        f"(POLARCHECK ALLOW RAPID-IN-POLAR {REASON}) G0 C5.\n",
        f"G0 C5. (polarcheck allow: rapid_in_polar {REASON})\n",
        f"G0 C5. (POLARCHECK: ALLOW RAPID-IN-POLAR: {REASON})\n",
        f"G0 C5. (POLARCHECK ALLOW POLAR {REASON})\n",
        f"G0 C5. (POLARCHECK ALLOW POLAR, RAPID-IN-POLAR {REASON})\n",
        f"G0 C5. ; POLARCHECK ALLOW RAPID-IN-POLAR {REASON}\n",
        f"G0 C5. ; (POLARCHECK ALLOW RAPID-IN-POLAR {REASON})\n",
        f"G0 C5. (FAST) (POLARCHECK ALLOW RAPID-IN-POLAR {REASON}) (END)\n",
    ],
)
def test_in_the_block(block: str) -> None:
    program = HEAD + block + "G1 C-5.\nG13.1\n"
    assert silent(program) == [(4, "rapid-in-polar", REASON)]
    report = report_of(program, only=ONLY)
    assert (said(report), report.verdict) == ([], "pass")


@pytest.mark.parametrize("between", ["", "\n", "\n(ANOTHER COMMENT)\n\n", "N10\n", "/\n"])
def test_alone_before_the_block(between: str) -> None:
    comment = f"(POLARCHECK ALLOW RAPID-IN-POLAR {REASON})\n"
    program = HEAD + comment + between + "G0 C5.\nG0 C6.\nG1 C-5.\nG13.1\n"
    expected = [] if between == "/\n" else [(5 + between.count("\n"), "rapid-in-polar", REASON)]
    assert silent(program) == expected
    assert (6 + between.count("\n"), "rapid-in-polar") in said(report_of(program, only=ONLY))
