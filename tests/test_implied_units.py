"""A program whose sizes are those of the other unit: one finding, and none for sound programs in either unit."""

from __future__ import annotations

from typing import Any

import pytest
from cases import looped
from hexagon_program import HEX
from programs import report_of

#: A hexagon of 30 mm in inches, with a cutter of 3/8; a / stands for the end of a block.
INCH = (
    "O1/{head}/T0808/M13 S2000/G28 H0/G0 X3. Z.1 C0/G12.1/G1 X2.4 F50./Z-.2 F5./G42 X1.1811/C.341/X0 C.6819/"
    "X-1.1811 C.341/C-.341/X0 C-.6819/X1.1811 C-.341/C0/G40 X2.4/Z.1 F50./G13.1/G0 X6. Z4./M5/M30"
)
MM = HEX.replace("G21 G98 G40", "{head}")
IN_MM = {"units": "mm", "tools": {"8": {"radius": 4.7625}, "1": {"radius": 4}}, "stock": {"diameter": 42}}
IN_INCH = {"units": "inch", "tools": {"8": {"radius": 0.1875}, "1": {"radius": 0.15748}}, "stock": {"diameter": 1.65}}
WITHOUT_UNITS = {"tools": {"8": {"radius": 0.1875}}}
NO_BAR = {key: value for key, value in IN_MM.items() if key != "stock"}


def findings(program: str, head: str, machine: str, job: dict[str, Any]) -> list[tuple[int, str]]:
    report = report_of(program.format(head=head).replace("/", "\n") + "\n", machine, job=job)
    return [(one.line, one.message.partition(":")[0]) for one in report.findings if one.severity != "note"]


@pytest.mark.nightly
@looped(
    ("program", "head", "job", "said"),
    [
        (INCH, "G98 G40", IN_MM, "G20 is missing"),
        (INCH, "G98 G40", IN_INCH, "G20 is missing"),
        (INCH, "G98 G40", NO_BAR, "G20 is missing"),
        (INCH, "G21 G98 G40", IN_MM, "write G20 instead of G21"),
        (MM, "G20 G98 G40", IN_MM, "write G21 instead of G20"),
        (MM, "G20 G98 G40", IN_INCH, "write G21 instead of G20"),
    ],
)
def test_the_other_unit_is_one_finding(program: str, head: str, job: dict[str, Any], said: str) -> None:
    assert findings(program, head, "fanuc-30i", job) == [(2, said)]


@pytest.mark.nightly
@looped("job", [IN_MM, IN_INCH, NO_BAR, {**IN_MM, "stock": {"diameter": 200}}])
def test_sound_programs_in_both_units(job: dict[str, Any]) -> None:
    assert findings(INCH, "G20 G98 G40", "fanuc-30i", job) == []
    assert findings(MM, "G21 G98 G40", "fanuc-30i", job) == []


@pytest.mark.ci
def test_a_lathe_that_powers_up_in_inches_reads_numbers_as_meant() -> None:
    assert findings(INCH, "G98 G40", "fanuc-30i", WITHOUT_UNITS) == []


def test_one_size_alone_says_nothing() -> None:
    """Of a small part with a low F, a job without units, and a cutter that is far too large for its contour."""
    small = "O1/G21 G98/T0808/M13 S2000/G28 H0/G0 X9. Z2. C0/G12.1/G1 X8. F50./Z-2. F15./G42 X3./C1.5/G40 X8./G13.1/M30"
    program = small.replace("/", "\n") + "\n"
    for job in ({"tools": {"8": {"radius": 1}}}, {"units": "mm", "tools": {"8": {"radius": 6}}}):
        report = report_of(program, "fanuc-30i", job=job, only=["units-contradict-sizes"])
        assert report.findings == []
