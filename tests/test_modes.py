"""One mistake in the polar mode or in its compensation is one finding, and what looks like one is none."""

from __future__ import annotations

import textwrap

from cases import looped
from programs import report_of_example, said

from polarcheck.rules.examples import examples

PROGRAMS = {
    "a forgotten G13.1 says nothing of what follows": """
        Bad, tool 1:radius=4:

            O1
            T0101
            G98 G0 X60. Z2. C0
            G12.1              (expect: polar-never-left)
            G1 C20. F500
            G1 G41 X40. F200
            C-10.
            G0 Z50.
            G28 U0 W0
            T0202
            G96 S100
            G0 X50. Z2.
            G71 U2. R1.
            G92 X20. Z-30. F2.
            M30
        """,
    "a forgotten G40 says nothing of the next section": """
        Bad, tool 1:radius=4:

            T0101
            G98 G0 X60. C0
            G12.1
            G1 C20. F500
            G41 X40. F200
            C-20.
            G13.1              (expect: polar-switched-in-offset-mode)
            G0 X60. C0
            G12.1
            G1 C20.
            G41 X40.
            C-20.
            G40 X60.
            G13.1
        """,
    "G41 without a move is no offset mode": """
        Bad, tool 1:radius=4:

            T0101
            G98 G0 X60. C0
            G12.1
            G1 X40. F200
            G41                (expect: start-up-shorter-than-radius)
            G40
            C-20.
            X60.
            G41                (expect: start-up-shorter-than-radius)
            G13.1
        """,
    "with R 0 a ramp needs no length": """
        Good, tool 1:radius=0:

            T0101
            G98 G0 X60. C0
            G12.1
            G1 X40. F200
            G41
            C-20.
            G40
            G13.1
        """,
    "G40 beside G13.1": """
        Bad, tool 1:radius=4:

            T0101
            G98 G0 X60. C0
            G12.1
            G1 C20. F500
            G41 X40. F200
            C-20.
            X60.
            G40 G13.1          (expect: polar-switch-not-alone)
        """,
    "G0 beside a code that can only stand outside": """
        Bad:

            G98 G0 X60. C0
            G12.1
            G1 X40. F200
            C-20.
            G0 G53 X0          (expect: origin-shifted-in-polar)
            G1 X50.
            G0 G28 U0          (expect: code-not-allowed-in-polar)
            G1 X50.
            C10.
            G13.1
        """,
    "a tool called in the mode": """
        Bad:

            T0101
            G98 G0 X60. C0
            G12.1
            G1 X40. F200
            T0202              (expect: offset-changed-in-polar)
            C-20.
            X60.
            G13.1
        """,
    "neighbouring blocks in one narrow place": """
        Bad, tool 1:radius=4:

            T0101
            G98 G0 X100. C0
            G12.1
            G1 C20. F500
            G41 X60. F200
            C3.
            X57. C2.598
            X54.804 C1.5       (expect: interference)
            X54. C0
            X54.804 C-1.5
            X57. C-2.598
            X60. C-3.
            C-20.
            G40 X100.
            G13.1
        """,
    "a ramp on an arc that is too small": """
        Bad, tool 1:radius=4:

            T0101
            G98 G0 X60. C0
            G12.1
            G1 X50. F200
            G41 G3 X46. C2. I-2. J0   (expect: start-up-on-arc)
            G1 X20.
            G40 C-20.
            G13.1
        """,
    "a start-up while G0 of the approach is in force": """
        Bad, tool 1:radius=4:

            O1
            G21 G40 G97 G98 G18
            T0101
            G0 X60. C0 Z2.
            G12.1
            X60. C20.              (expect: rapid-in-polar)
            G42 X40. C0 F200
            G1 C10.
            X-40.
            C-10.
            X40.
            C0.
            G40 X60.
            G13.1
        """,
    "start-ups at G0 in one section after the other": """
        Bad, tool 1:radius=4:

            T0101
            G98 G0 X60. C0 Z2.
            G12.1
            G42 X40. C0 F200       (expect: rapid-in-polar)
            G1 C10.
            X-40.
            C-10.
            X40.
            C5.
            G40 X60.
            G13.1
            G0 X80. C0
            G12.1
            G42 X60. C0            (expect: rapid-in-polar)
            G1 C10.
            X-60.
            C-10.
            X60.
            C5.
            G40 X80.
            G13.1
        """,
    "G41 and G40 alone before moves in rapid traverse": """
        Bad, tool 1:radius=4:

            T0101
            G98 G0 X60. C0 Z2.
            G12.1
            G41
            X40. C0 F200           (expect: rapid-in-polar)
            G1 C-10.
            X-40.
            C10.
            X40.
            C0.
            G40
            G0 X60.                (expect: rapid-in-polar)
            G13.1
        """,
    "a start-up at G0 that is too short, too": """
        Bad, tool 1:radius=4:

            T0101
            G98 G0 X60. C0 Z2.
            G12.1
            G1 X44. F500
            G0 G42 X40.            (expect: rapid-in-polar, start-up-shorter-than-radius)
            G1 C10.
            X-40.
            C-10.
            X40.
            C0.
            G40 X60.
            G13.1
        """,
    "a start-up in rapid traverse where the control takes it": """
        Good, machine haas-lathe, tool 1:radius=0.25:

            T101
            G98 G17
            G0 X3. Y0 C0
            G112
            G0 Y-.75
            G41 X1. Y0
            G1 Y-.5 F5.
            X-1.
            Y.5
            X1.
            Y0
            G0 G40 X3.
            G113
            G18
        """,
    "a drilling cycle ends at G0": """
        Good:

            G98 G0 X60. Z2. C0
            G83 X30. C0 Z-5. R1. F50
            C90.
            G0 X60. C0
            G12.1
            G1 X40. F200
            C-20.
            X60.
            G13.1
        """,
    "a subprogram called in another file": """
        Good:

            O2
            G12.1
            G1 G42 X40. F200
            C-20.
            G40 X60.
            G13.1
            M99
        """,
    "the example of the manuals": """
        Good, tool 1:radius=4, set control.g_code_system="B":

            O1
            T0101
            G90 G94 G00 X120.0 C0 Z5.
            G12.1
            G42 G01 X40.0 F100
            C10.0
            G03 X20.0 C20.0 R10.0
            G01 X-40.0
            C-10.0
            G03 X-20.0 C-20.0 I10.0 J0
            G01 X40.0
            C0
            G40 X120.0
            G13.1
            Z50.
            M30
        """,
    "rapid traverse and a plane where the control takes them": """
        Good, machine haas-lathe, tool 1:radius=0.25:

            T101
            G98 G17
            G0 X3. Y0 C0
            G112
            G17
            G0 X1.5 Y.5
            G1 G41 X1. F5.
            Y-.5
            G40 X1.5
            G0 X2.
            G113
            G18
        """,
}


@looped("page", PROGRAMS.values(), ids=PROGRAMS, one_in=12)
def test_one_mistake_is_one_finding(page: str) -> None:
    (example,) = examples(textwrap.dedent(page).strip("\n"))
    assert said(report_of_example(example, only=("compensation", "polar"))) == sorted(example.expected)
