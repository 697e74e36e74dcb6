"""Where the tool stands behind cycles of turning: where they began."""

from __future__ import annotations

import math

import numpy as np
import pytest
from cases import looped
from programs import report_of, said, tables_of, trace_of

from polarcheck.foundation.states import Motion

NAN = math.nan
_ROUGHED = "G0 X52. Z2.\nG71 U1. R0.5\nG71 P100 Q200 U0.4 W0.1 F0.25\nN100 G0 X20.\nG1 Z-10. F0.1\nN200 X52.\n"
_SYSTEM_B = {"control": {"g_code_system": "B"}}


def after(program: str, **more: object) -> list[tuple[float, float]]:
    """X [radius] and Z after each block, the first left out."""
    path = trace_of(program, **more).path  # type: ignore[arg-type]
    return list(zip(path.x.tolist(), path.z.tolist(), strict=True))[1:]


@looped(
    ("program", "expected"),
    [
        ("G0 X52. Z2.\nG90 X46. Z-30. F.2\nX44.\nX42. R-2.\nG0 X100.\n", [(26, 2)] * 3 + [(50, 2)]),
        ("G0 X52. Z2.\nG90 U-6. W-32. F.2\nU-8.\nG0 W3.\n", [(26, 2), (26, 2), (26, 5)]),
        ("G0 X32. Z5.\nG92 X29. Z-20. F1.5\nX28.5\nG0 Z9.\n", [(16, 5), (16, 5), (16, 9)]),
        ("G0 X52. Z2.\nG94 X-1. Z0 F.2\nZ-1.\nG1 X20.\n", [(26, 2), (26, 2), (10, 2)]),
        ("G0 X18. Z2.\nG90 X20. Z-30. F.2\nX21.\nG0 Z5.\n", [(9, 2), (9, 2), (9, 5)]),
        ("G0 X52. Z2.\nG75 R1.\nG75 X30. Z-20. P2000 Q3000 F.1\nG0 Z9.\n", [(26, 2), (26, 2), (26, 9)]),
        ("G0 X32. Z5.\nG76 P010060 Q100 R.1\nG76 X28. Z-20. P920 Q300 F1.5\nU2.\n", [(16, 5), (16, 5), (17, 5)]),
        ("G0 X0 Z5.\nG74 R1.\nG74 Z-40. Q5000 F.1\nG0 X50.\n", [(0, 5), (0, 5), (25, 5)]),
        # Of two codes of one group in a block the last counts: no cycle here.
        ("G0 X52. Z2.\nG90 G0 X46. Z-30.\nX44.\n", [(23, -30), (22, -30)]),
        # One pass of a thread ends where its words say, and the other axis stays.
        ("G0 X29. Z5.\nG32 Z-20. F1.5\nG0 X34.\nZ5.\n", [(14.5, -20), (17, -20), (17, 5)]),
        # The bottom of a hole is not where the tool stays.
        ("G0 X40. Z5. C0\nG83 Z-20. R3. F.1\nC90.\nG80\nG0 Z9.\n", [(20, NAN)] * 3 + [(20, 9)]),
        ("G0 X40. Z5. C0\nG83 X30. Z-20. R3. F.1\nG80\nG0 Z9.\n", [(15, NAN)] * 2 + [(15, 9)]),
    ],
)
def test_cycles_end_where_they_began(program: str, expected: list[tuple[float, float]]) -> None:
    for found, meant in zip(after(program), expected, strict=True):
        assert found == pytest.approx(meant, nan_ok=True)


def test_cycles_of_system_b() -> None:
    program = "G90\nG0 X52. Z2.\nG77 X46. Z-30. F.2\nG91 X-8.\nG90\nG79 X0 Z-1.\nG0 X60.\n"
    assert after(program, changes=_SYSTEM_B) == [(26, 2)] * 5 + [(30, 2)]


def test_cycles_of_okuma_and_in_inches() -> None:
    assert after("G0 X32 Z5\nG33 X29 Z-20 F1.5\nX28.5\nG0 Z9\n", machine="okuma-osp") == [(16, 5), (16, 5), (16, 9)]
    inches = after("G20\nG0 X2. Z.1\nG90 X1.8 Z-1. F.01\nX1.6\nG0 Z1.\n")
    assert inches == [pytest.approx(place) for place in [(25.4, 2.54)] * 3 + [(25.4, 25.4)]]


def test_the_program_goes_on_behind_a_contour_from_where_its_cycle_began() -> None:
    contour = [(10, 2), (10, -10), (26, -10)]
    assert after(_ROUGHED + "W1.\nG70 P100 Q200\nG0 X60.\n") == [
        *[(26, 2)] * 2, *contour, (26, 3), (26, 3), (30, 3),
    ]  # fmt: skip
    trace = trace_of(_ROUGHED + "G1 W-1.\nG70 P100 Q200\nG0 X60.\n")
    assert [Motion(kind).name for kind in trace.path.motion[2:8]] == ["NONE", *["CYCLE"] * 3, "LINE", "NONE"]
    # Before the block behind it the tool stands where the cycle began, not at the end of the contour.
    assert (trace.path.x_before[6], trace.path.z_before[6]) == (26, 2)


@looped(
    "program",
    [
        # In increments, with the finishing cycle before the contour, and twice with the same numbers.
        _ROUGHED.replace("X20.", "U-32.").replace("X52.\n", "U32.\n").replace("G0 U32. Z2.", "G0 X52. Z2."),
        _ROUGHED.replace("N100", "G70 P100 Q200\nN100"),
        _ROUGHED + "G70 P100 Q200\n" + _ROUGHED,
        _ROUGHED.replace("G71 U1. R0.5\n", "").replace("U0.4", "D1. U0.4"),
        _ROUGHED.replace("G71 U1. R0.5\nG71", "G73 U5. W2. R3\nG73"),
    ],
)
def test_contours_of_other_forms(program: str) -> None:
    assert after(program + "G1 W-1.\n")[-1] == (26, 1)


def test_a_contour_of_okuma_is_run_by_the_cycles_that_name_it() -> None:
    contour = "NLAP1 G81\nG0 X20\nG1 Z-10 F0.1\nX52\nG80\n"
    along = [(26, 2), (10, 2), (10, -10), (26, -10), (26, 2)]
    behind = "G0 X52 Z2\nG85 NLAP1 D2 F0.2 U0.4 W0.1\n" + contour + "G87 NLAP1\nG1 Z1\n"
    assert after(behind, machine="okuma-osp") == [(26, 2), *along, (26, 2), (26, 1)]
    above = "G0 X52 Z2\n" + contour + "G0 Z5\nG85 NLAP1 D2 F0.2\nG0 X60\n"
    assert after(above, machine="okuma-osp") == [*along, (26, 5), (26, 5), (30, 5)]


@looped(
    ("cycle", "expected"),
    [
        ("G90 X46. Z-130. F.2", [5]),
        ("G90 U-6. W-132. F.2", [5]),
        ("G90 X46. Z-30. F.2\nX-60.", [6]),
        ("G83 Z-120. R2. F.2", [5]),
        ("G90 X46. Z-30. F.2\nX44.", []),
    ],
)
def test_cycles_may_leave_the_travel_of_the_machine(cycle: str, expected: list[int]) -> None:
    program = f"O1\nG21 G99\nT0101\nG0 X52. Z2.\n{cycle}\nG0 X60.\nM30\n"
    report = report_of(program, changes={"limits": {"z_minimum": -100.0, "x_minimum": -20.0}})
    assert [line for line, rule in said(report) if rule == "travel-limit"] == expected


def test_a_number_that_names_no_contour_behind_the_cycle_changes_nothing() -> None:
    # The contour stands before; a later block that has its number is no contour of this cycle.
    program = _ROUGHED + "G70 P100 Q200\nG0 X60.\nN100 G1 X50.\nZ-5.\nN200 X40.\nG0 U2.\n"
    assert after(program)[-4:] == [(25, 2), (25, -5), (20, -5), (21, -5)]


@looped(
    "turned",
    [
        "G0 X62. Z2.\nG90 X52. Z-30. F.2\nX44.\nG0 X100. Z50.\n",
        "G0 X62. Z2.\nG71 U2. R1.\nG71 P10 Q20 U0.4 W0.1 F.2\nN10 G0 X44.\nG1 Z-30.\nN20 X62.\nG70 P10 Q20\nG0 X100.\n",
    ],
)
def test_what_cycles_take_off_is_not_lost(turned: str) -> None:
    head = "O1\nG21 G40 G99\nT0101\nG97 S1000 M3\n"
    mill = (
        "M5\nT0303\nM45\nG28 H0\nM133 S2000\nG98\nG0 X60. Z2. C0\nG12.1\nG1 G42 X30. F100\nZ-3.\n"
        "C10.\nX-30.\nC-10.\nX30.\nC0\nG40 X60.\nG13.1\nM30\n"
    )
    tables = tables_of(head + turned + mill, "fanuc", "3:radius=4", job={"stock": {"diameter": 62.0}})
    known = tables["bar"].known
    assert (known.source, known.smallest, known.largest) == ("turning", 44, 44)


_SIEMENS = """DIAMON
T1 D1
G95 G90 G96 S200 M3
G0 X66 Z2
{turning}
G0 X100 Z50
M5
T8 D1
G94 G97 S2=1000 M2=3
DIAMOF
G0 X70 Z2 C0
TRANSMIT
G17
G0 X26 Y0
G0 Z-5
G1 G42 X15 Y1 F300
Y15
X-15
Y-15
X15
Y1
G40 X35
G0 Z5
TRAFOOF
M2=5
M30
"""


@pytest.mark.nightly
@looped(
    "turning",
    [
        'CYCLE95("CONTOUR",2,0.1,0.2,,0.3,0.2,0.1,9,,,0.5)',
        "CYCLE951(0,0,20,30,20,30,2,1,0.1,0.1,12,0,0,0,0,0.2,0,2)",
        'CYCLE62("CONTOUR",1,,)\nCYCLE952("P",,"",2101311,0.2,,0,1,0.1,0.1)',
        "CYCLE93(66,-5,8,20,,,,,,,,0.2,0.2,2,1,5)",
        'G1 X60 F.2\nZ-30\nG0 X66\nZ2\nCYCLE95("CONTOUR",2,0.1,0.2)',
        'CYCLE95("CONTOUR",2,0.1,0.2)\nG0 X66 Z2\nG1 X60 F.2\nZ-30\nG0 X66',
    ],
)
@looped("stock", [{"stock": {"diameter": 62.0}}, {}])
def test_what_a_cycle_of_siemens_leaves_of_the_bar_is_not_known(turning: str, stock: dict[str, object]) -> None:
    """It cuts nobody knows where: not even that the mill goes down into the bar can be told."""
    program = _SIEMENS.format(turning=turning)
    tables = tables_of(program, "siemens-transmit", "8:radius=4,nose=0", job=stock)
    known = tables["bar"].known
    assert (math.isnan(known.smallest), known.largest) == (True, pytest.approx(62 if stock else NAN, nan_ok=True))
    cycles = tables["trace"].run.unknown
    assert cycles.any()
    assert np.isnan(tables["trace"].path.x[cycles]).all()
    assert report_of(program, "siemens-transmit", "8:radius=4,nose=0", job=stock).findings == []


@pytest.mark.ci
def test_the_same_mill_goes_down_into_a_bar_that_no_cycle_has_turned() -> None:
    found = report_of(
        _SIEMENS.format(turning="G0 X66"), "siemens-transmit", "8:radius=4", job={"stock": {"diameter": 62.0}}
    )
    assert "approach-inside-stock" in [rule for _, rule in said(found)]
