"""
Each statement of the five documents: a program that breaks it and what is found then, and programs that keep it.

The numbers are those of docs/documents.md, and the programs those of the documents. A twin that breaks a statement says
in its own comments what must be found, and nothing else may be; the notes of the printed program stay as they are.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from operator import attrgetter
from typing import Any, NamedTuple

import numpy as np
import pytest
from cases import looped
from document_programs import FANUC, GSK_1, GSK_2, M700V, METHOD_A, METHOD_B, RECTANGLE, SAMPLE, Printed
from programs import ROOT, expected, report_of, tables_of, without_expectations

from polarcheck.foundation.finding import FileReport, Finding
from polarcheck.foundation.states import FeedMode, Motion, Side
from polarcheck.reports.pages import executed

INCH = 25.4
_notes: dict[str, set[tuple[str, str]]] = {}
TABLE = (ROOT / "docs" / "documents.md").read_text("utf-8")


class Case(NamedTuple):
    """A twin of a printed program that breaks, or keeps, a statement; tools, job and changes beside its own."""

    number: str
    printed: Printed
    edits: Mapping[str, str] = {}
    tools: tuple[str, ...] = ()
    job: Mapping[str, Any] = {}
    changes: Mapping[str, Any] = {}

    @property
    def program(self) -> str:
        return self.printed.edited(self.edits)

    @property
    def given(self) -> dict[str, Any]:
        return {"changes": self.changes or None, "job": self.job or None}

    def report(self) -> FileReport:
        return report_of(self.program, self.printed.machine, *self.printed.tools, *self.tools, **self.given)


class Value(NamedTuple):
    """What a column has at a block of a twin: an element of a table, or a field of `polarcheck trace --path tool`."""

    case: Case
    block: str
    column: str
    value: Any


def own_notes(printed: Printed) -> set[tuple[str, str]]:
    """The notes of a printed program, by their blocks."""
    if printed.text not in _notes:
        found = report_of(printed.text, printed.machine, *printed.tools).findings
        _notes[printed.text] = {(one.rule, one.block) for one in found if one.severity == "note"}
    return _notes[printed.text]


def beyond_its_notes(case: Case) -> list[Finding]:
    """What is found in a twin, but for the notes that the printed program has at the same blocks."""
    notes = own_notes(case.printed)
    return [one for one in case.report().findings if (one.rule, without_expectations(one.block).strip()) not in notes]


PRINTED = {
    "method A": METHOD_A,
    "method B": METHOD_B,
    "sample program": SAMPLE,
    "rectangle": RECTANGLE,
    "FANUC": FANUC,
    "GSK, first": GSK_1,
    "GSK, second": GSK_2,
    "M700V": M700V,
}
WHOLE = {"": "%\nO0001", "M1": "M1\nM30\n%"}
STOCK = {"stock": {"diameter": 1.3, "clearance": 0.1}}
MILL = "8:diameter=.75"
LIMIT = {"limits": {"c_feed": 250}}
RADIUS_X = {
    "G41 X1.5": "G41 X.75",
    "G2 X1. C-.5 R.25": "G2 X.5 C-.5 I-.25 J0",
    "G1 X-1.": "G1 X-.5",
    "G2 X-1.5 C-.25 I0 J.25": "G2 X-.75 C-.25 I0 J.25",
    "G2 X-1. C.5 R.25": "G2 X-.5 C.5 I.25 J0",
    "G1 X1.": "G1 X.5",
    "G2 X1.5 C.25 R.25": "G2 X.75 C.25 I0 J-.25",
}
WITHOUT_C = {
    "C-.25": "",
    "G2 X1. C-.5 R.25": "G2 X1. I-.25 J0",
    "G1 C.25": "",
    "G2 X-1. C.5 R.25": "G2 X-1. I.25 J0",
    "G2 X-1.5 C-.25 I0 J.25": "G2 X-1.5 I0 J.25",
    "G2 X1.5 C.25 R.25": "G2 X1.5 I0 J-.25",
    "G1 C0": "G1",
}
BY_INCREMENTS = {
    "G1 G98 C.5339 F60.": "G1 G98 H.5339 F60.",
    "G1 G41 X1.75F7. (1)": "G1 G41 U-.4 F7.",
    "G1 C-.5339 (2)": "G1 H-1.0678",
    "G2 X-1.75 R1.025 F60. (3)": "G2 U-3.5 R1.025 F60.",
    "G1 C.5339 F7. (4)": "G1 H1.0678 F7.",
    "G1 G40 X-2.15 F60.": "G1 G40 U-.4 F60.",
}
PER_REVOLUTION = {"G17 G90 G94 G40 G97": "G17 G90 G95 G40 G97 F.2"}
A_MACRO = {"G12.1": "G12.1\nG65 P9010", "M30": "M30\nO9010\nG4 X1.\nM99"}

#: The first E that is too large, in mm and inch, of both increment systems.
ISC = {"control": {"least_increment": 0.0001, "least_increment_inch": 0.00001}}
EDGES = [
    ("003-23", "G21", "1000000.", {}),
    ("003-24", "G20", "100000.", {}),
    ("003-25", "G21", "100000.", ISC),
    ("003-26", "G20", "10000.", ISC),
]

#: What is worth a note only.
NOTES = frozenset(
    {
        "000-20",
        "000-22",
        "000-23",
        "000-39",
        "000-45",
        "000-41",
        "000-58",
        "000-61",
        "000-80",
        "000-133",
        "001-16",
        "003-9",
    }
)

#: 7 inch per revolution, where G99 is in force.
SEVEN_INCH = {"G1 G41 X1.75F7. (1)": "G1 G41 X1.75F7. (expect: feed-per-revolution-in-polar)"}

BROKEN = [
    # ---- the builder's guide ----
    Case("000-1", SAMPLE, {"M35": "", "G12.1": "G12.1 (expect: c-axis-not-engaged)"}),
    Case("000-1", RECTANGLE, WITHOUT_C | {"G12.1": "G12.1 (expect: second-axis-never-programmed)"}),
    Case("000-3", SAMPLE, {"G12.1": "G12.1 (expect: flat-end-mill-at-od)"}, ("8:mount=radial,shape=flat",)),
    Case(
        "000-3",
        SAMPLE,
        {"G97 S2000 M33": "G97", "G1 G98 C.5339 F60.": "G1 G98 C.5339 F60. (expect: live-tool-stopped-in-cut)"},
    ),
    Case("000-4", METHOD_A, {"C-0.4153": "Y-0.4153 (expect: wrong-axis-address-in-polar)"}),
    Case("000-5", RECTANGLE, {"G1 X-1.": "G28 U0 (expect: code-not-allowed-in-polar)\nG1 X-1."}),
    Case("000-5", RECTANGLE, {"G1 X-1.": "G0 X-1. (expect: rapid-in-polar)"}),
    Case("000-6", RECTANGLE, {"G41 X1.5": "G42 X1.5 (expect: side-of-compensation-mirrored)"}),
    Case("000-8", RECTANGLE, {"G2 X1. C-.5 R.25": "G3 X1. C-.5 R.25 (expect: arc-sense-reversed)"}),
    Case("000-9", RECTANGLE, RADIUS_X | {"G12.1": "G12.1 (expect: diameter-radius-mixed)"}),
    Case("000-11", SAMPLE, {"G1 C-.5339 (2)": "G1 C-90. (expect: degrees-in-polar)"}),
    Case("000-11", RECTANGLE, {"C-.25": "C-90. (expect: degrees-in-polar)"}),
    Case("000-11", RECTANGLE, {"G2 X1. C-.5 R.25": "G2 X1. C-90. R.25 (expect: degrees-in-polar)"}),
    Case("000-12", SAMPLE, {"G12.1": "G17\nG12.1 (expect: plane-wrong-at-entry)"}),
    Case("000-12", SAMPLE, {"G12.1": "G12.1\nG17 (expect: plane-selected-in-polar)"}),
    Case("000-12", RECTANGLE, {"G1 X1.": "G19 (expect: plane-selected-in-polar)\nG1 X1."}),
    Case("000-13", METHOD_B, {"": "G17", "G12.1": "G12.1 (expect: plane-wrong-at-entry)"}),
    Case("000-15", SAMPLE, {"G12.1": "G12.1 (expect: origin-off-center)"}, job={"work_offsets": {"G54": {"x": 0.5}}}),
    Case("000-15", SAMPLE, {"G28 H0": "G28 H0\nG10 L2 P1 X.5", "G12.1": "G12.1 (expect: origin-off-center)"}),
    Case("000-16", SAMPLE, {"G12.1": "G52 X.5\nG12.1 (expect: origin-off-center)"}),
    Case("000-16", SAMPLE, {"G12.1": "G50 X2.2\nG12.1 (expect: origin-off-center)"}),
    Case("000-16", SAMPLE, {"G1 C-.5339 (2)": "G52 X.1 (expect: origin-shifted-in-polar)\nG1 C-.5339"}),
    Case(
        "000-17",
        SAMPLE,
        WHOLE | {"G28 H0": "", "G0Z.1 C0 M8": "G0 Z.1 M8", "G12.1": "G12.1 (expect: c-angle-unknown-at-entry)"},
        job={"severities": {"c-axis-not-referenced": "off"}},
    ),
    Case(
        "000-14",
        SAMPLE,
        {"G12.1": "G18\nG12.1 (expect: plane-wrong-at-entry)"},
        changes={"polar": {"plane_before": ["G17"]}},
    ),
    Case(
        "000-25",
        RECTANGLE,
        {"G1 X-1.": "G1 X-1. (expect: c-acceleration-above-limit)"},
        changes={"limits": {"c_acceleration": 0.1}},
    ),
    Case("000-19", METHOD_A, {"C-0.4153": "G0 C-0.4153 (expect: rapid-in-polar)"}),
    Case("000-19", SAMPLE, {"G1 G98 C.5339 F60.": "G98 C.5339 F60. (expect: rapid-in-polar)"}),
    Case("000-20", SAMPLE, {"G1 G98 C.5339 F60.": "G1 G98 C.5339 F100. (expect: feed-outside-recommended-range)"}),
    Case("000-21", SAMPLE, {"G1 G98 C.5339 F60.": "G1 G99 C.5339 F.01", **SEVEN_INCH}),
    Case("000-22", RECTANGLE, {"C-.25": "C-.25 F25. (expect: feed-outside-recommended-range)"}),
    Case("000-23", SAMPLE, {"G1 C.5339 F7. (4)": "G1 C.5339 F12. (expect: feed-outside-recommended-range)"}),
    Case("000-23", SAMPLE, {"G1 G41 X1.75F7. (1)": "G1 G41 X1.75F.5 (expect: feed-outside-recommended-range)"}),
    Case("000-24", RECTANGLE, {"G1 X-1.": "G1 X-1. (expect: c-feed-above-limit)"}, changes=LIMIT),
    Case("000-26", METHOD_A, {"C-0.4153": "G91 C-.8306 (expect: incremental-word-of-other-code-system)"}),
    Case("000-27", METHOD_A, {"C-0.4153": "V-.8306 (expect: wrong-axis-address-in-polar)"}),
    Case("000-28", RECTANGLE, {"G1 G98 Z-.25 F10.": "G1 G98 Z-.25 (expect: feed-missing-in-polar)"}),
    Case("000-29", RECTANGLE, {"G41 X1.5": "G41 X1.5 Z-.3 (expect: z-with-plane-axis)"}),
    Case("000-29", RECTANGLE, {"G2 X1. C-.5 R.25": "G2 X1. C-.5 Z-.3 R.25 (expect: helical-arc-in-polar)"}),
    Case("000-30", SAMPLE, {"Z-.88": "", "G1 C-.5339 (2)": "G1 Z-.88 C-.5339 (expect: z-with-plane-axis)"}),
    Case("000-31", RECTANGLE, {"G2 X1. C-.5 R.25": "G2 X1. C-.5 (expect: arc-without-center)"}),
    Case("000-32", RECTANGLE, {"G2 X1. C-.5 R.25": "G2 X1. C-.5 R.1 (expect: arc-radius-too-small)"}),
    Case("000-33", RECTANGLE, {"G2 X1. C-.5 R.25": "G2 X1. C-.5 R-.25 (expect: negative-arc-radius)"}),
    Case("000-34", RECTANGLE, {"G2 X-1.5 C-.25 I0 J.25": "G2 X-1.5 C-.25 I-.75 J-.25 (expect: arc-end-off-circle)"}),
    Case("000-35", RECTANGLE, {"G2 X1. C-.5 R.25": "G2 X1. C-.5 I-.5 J0 (expect: arc-end-off-circle)"}),
    Case("000-36", RECTANGLE, {"G2 X-1.5 C-.25 I0 J.25": "G2 X-1.5 C-.25 I0 K.25 (expect: arc-word-of-other-plane)"}),
    Case("000-37", SAMPLE, {"G2 X-1.75 R1.025 F60. (3)": "G2 X-1.75 I-1.75 J.5339 F60. (expect: arc-end-off-circle)"}),
    Case("000-38", SAMPLE, {"Z-.88": "Z-.88\nG2 X1.75 C.5339 R1.025 (expect: full-circle-by-radius)"}),
    Case(
        "000-39",
        SAMPLE,
        {
            "G12.1": "G12.1 (expect: no-compensation-in-polar)",
            "G1 G41 X1.75F7. (1)": "G1 X1.75 F7.",
            "G1 G40 X-2.15 F60.": "X-2.15 F60.",
        },
    ),
    Case("000-41", SAMPLE, {"G28 H0": "G28 H0\nG10 P8 U-.005 (expect: size-by-x-offset)"}),
    Case("000-58", METHOD_B, {"T0101": "G10 P1 U.005 (expect: size-by-x-offset)\nT0101"}),
    Case("000-61", SAMPLE, {"G28 H0": "G28 H0\nG10 P8 X-.005 (expect: size-by-x-offset)"}),
    Case("000-42", SAMPLE, {"G12.1": "G41\nG12.1 (expect: polar-switched-in-offset-mode)"}),
    Case("000-43", SAMPLE, {"G12.1": "G42\nG12.1 (expect: polar-switched-in-offset-mode)"}),
    Case(
        "000-43",
        SAMPLE,
        {"G12.1": "G41\nG12.1 (expect: polar-switched-in-offset-mode)", "G1 G41 X1.75F7. (1)": "G1 X1.75 F7."},
    ),
    Case("000-44", METHOD_A, {"G40 X1.8 F20.": "X1.8 F20.", "G13.1": "G13.1 (expect: polar-switched-in-offset-mode)"}),
    Case("000-45", METHOD_A, {"G1 G41 X1.0 F5.": "G41 (expect: start-up-without-move)\nG1 X1.0 F5."}),
    Case(
        "000-46",
        RECTANGLE,
        {
            "G41 X1.5": "G1 X1.5 C-.25",
            "C-.25": "",
            "G2 X1. C-.5 R.25": "G41 G2 X1. C-.5 R.25 (expect: start-up-on-arc)",
        },
    ),
    Case(
        "000-47",
        SAMPLE,
        {
            "G1 C.5339 F7. (4)": "C.5339",
            "G2 X-1.75 R1.025 F60. (3)": "G2 G40 X-1.75 R1.025 F60. (expect: cancel-on-arc)\nG1",
            "G1 G40 X-2.15 F60.": "X-2.15",
        },
    ),
    Case(
        "000-48",
        METHOD_A,
        {"X1.8": "X1.4", "G1 G41 X1.0 F5.": "G1 G41 X1.0 F5. (expect: start-up-shorter-than-radius)"},
    ),
    Case("000-48", METHOD_A, {"G40 X1.8 F20.": "G40 X1.4 F20. (expect: cancel-shorter-than-radius)"}),
    Case(
        "000-49",
        METHOD_A,
        {
            "G1 G98 C0.4153 F20.": "G1 G98 X1. C.66 F30.",
            "G1 G41 X1.0 F5.": "G41 C.4153 F5. (expect: start-up-shorter-than-radius)",
            "G40 X1.8 F20.": "G40 X1.8 F30.",
        },
    ),
    Case("000-49", METHOD_A, {"G40 X1.8 F20.": "G40 C-.66 (expect: cancel-shorter-than-radius)"}),
    Case(
        "000-52",
        METHOD_A,
        {"T0101": 'T0101 (1/2" DIA. CUTTER) (expect: radius-contradicts-comment)'},
        ("1:radius=.375",),
    ),
    Case("000-53", METHOD_A, {"G1 G41 X1.0 F5.": "G1 G41 X1.0 F5. (expect: nose-type-not-zero)"}, ("1:nose=3",)),
    Case("000-54", SAMPLE, {"G1 G41 X1.75F7. (1)": "G1 G41 X1.75 F7. (expect: nose-type-not-zero)"}, ("8:nose=9",)),
    Case(
        "000-55",
        SAMPLE,
        {
            'T0808 (3/4" DIA. CUTTER)': "T0800",
            "G1 G41 X1.75F7. (1)": "G1 G41 X1.75 F7. (expect: offset-number-missing)",
        },
    ),
    Case("000-56", METHOD_A, {"G1 G41 X1.0 F5.": "G1 G41 X1.0 F5. D1 (expect: d-word-on-lathe)"}),
    Case("000-56", SAMPLE, {"G12.1": "D08 (expect: d-word-on-lathe)\nG12.1"}),
    Case("000-59", METHOD_B, {"G12.1": "G12.1 (expect: flat-end-mill-at-od)"}, ("1:mount=radial,shape=flat",)),
    Case("000-63", METHOD_A, {"G12.1": "G12.1 (expect: flat-end-mill-at-od)"}, ("1:mount=radial,shape=flat",)),
    Case(
        "000-66",
        SAMPLE,
        {"X2.15": "X1.3", "G12.1": "G12.1 (expect: approach-inside-stock)", "G1 G40 X-2.15 F60.": "G40 X-2.15 F60."},
        (MILL,),
        STOCK,
    ),
    Case("000-67", SAMPLE, {"X2.15": "X1.9", "G12.1": "G12.1 (expect: approach-inside-stock)"}, (MILL,), STOCK),
    Case("000-68", SAMPLE, {"X2.15": "X2.14", "G12.1": "G12.1 (expect: approach-inside-stock)"}, (MILL,), STOCK),
    Case("000-68", SAMPLE, WHOLE | {"X2.15": "", "G12.1": "G12.1 (expect: x-unknown-at-entry)"}),
    Case("000-73", METHOD_A, {"X1.8": "X-1.8", "G12.1": "G12.1 (expect: x-not-positive-at-entry)"}),
    Case("000-75", SAMPLE, {"G28 H0": "", "G12.1": "G12.1 (expect: c-axis-not-referenced)"}),
    Case("000-77", METHOD_B, {"G0 Z0.1": "G0 Z0.1\nX-1.8 (expect: rapid-through-center)"}),
    Case("000-78", METHOD_A, {"G40 X1.8 F20.": "G40 X1.8 F20.\nC180. (expect: degrees-in-polar)"}),
    Case("000-78", METHOD_A, {"C-0.4153": "C180. (expect: degrees-in-polar)"}),
    Case(
        "000-80",
        SAMPLE,
        {"G2 X-1.75 R1.025 F60. (3)": "G2 X-1.75 R1.025 F100. (expect: feed-outside-recommended-range)"},
    ),
    Case(
        "000-82",
        METHOD_B,
        {"G1 G41 X1.0 F5.": "G1 G42 X1.0 F5.", "G40 X-1.8": "G40 X-1.8 (expect: start-up-sweeps-contour)"},
    ),
    Case("000-86", METHOD_A, {"G12.1": "", "G13.1": "G13.1 (expect: polar-never-entered)"}),
    Case(
        "000-87", METHOD_A, WHOLE | {"T0101": "", "G1 G41 X1.0 F5.": "G1 G41 X1.0 F5. (expect: offset-number-missing)"}
    ),
    Case("000-88", METHOD_A, {"": "G97 S500 M3", "M5": "", "G12.1": "G12.1 (expect: main-spindle-running-at-entry)"}),
    Case("000-89", METHOD_A, {"M35": "", "G12.1": "G12.1 (expect: c-axis-not-engaged)"}),
    Case("000-90", METHOD_A, {"G28 H0": "", "G12.1": "G12.1 (expect: c-axis-not-referenced)"}),
    Case(
        "000-91",
        METHOD_A,
        {"G97 S1000 M33": "G97 S1000", "G1 G98 C0.4153 F20.": "G1 G98 C0.4153 F20. (expect: live-tool-stopped-in-cut)"},
    ),
    Case("000-91", METHOD_A, {"G97 S1000 M33": "G96 S300 M33", "G12.1": "G12.1 (expect: modal-state-wrong-at-entry)"}),
    Case("000-91", METHOD_A, {"G97 S1000 M33": "G97 M33 (expect: live-tool-without-speed)"}),
    Case("000-92", METHOD_A, WHOLE | {"X1.8": "", "G12.1": "G12.1 (expect: x-unknown-at-entry)"}),
    Case("000-92", METHOD_A, {"X1.8": "X0", "G12.1": "G12.1 (expect: x-not-positive-at-entry)"}),
    Case("000-93", METHOD_A, {"G12.1": "G12.1 M8 (expect: polar-switch-not-alone)"}),
    Case(
        "000-95",
        METHOD_A,
        {"X1.8": "X1.49", "G1 G41 X1.0 F5.": "G1 G41 X1.0 F5. (expect: start-up-shorter-than-radius)"},
    ),
    Case(
        "000-96",
        METHOD_A,
        {
            "Z - .375 (depth of cut)": "Z-.2\nM8\nZ-.375",
            "G1 G41 X1.0 F5.": "G1 G41 X1.0 F5. (expect: movement-missing-in-offset-mode)",
        },
    ),
    Case("000-98", METHOD_A, {"G40 X1.8 F20.": "G40 X1.49 F20. (expect: cancel-shorter-than-radius)"}),
    Case("000-99", METHOD_A, {"G12.1": "G12.1 (expect: polar-never-left)", "G13.1": ""}),
    Case("000-99", METHOD_A, {"G13.1": "G13.1 M9 (expect: polar-switch-not-alone)"}),
    Case("000-102", METHOD_A, {"G0 X5. Z5. M35": "G0 X5. Z5.\nT0303 (expect: live-tool-never-stopped)"}),
    Case("000-106", METHOD_B, {"G40 X-1.8": "G40 X1.8 (expect: start-up-sweeps-contour)"}),
    Case("000-107", SAMPLE, {"": "G97 S500 M3", "M5": "", "G12.1": "G12.1 (expect: main-spindle-running-at-entry)"}),
    Case("000-108", SAMPLE, {"M35": "M35\nM34", "G12.1": "G12.1 (expect: c-axis-not-engaged)"}),
    Case(
        "000-109",
        SAMPLE,
        {
            "G12.1": "",
            "Z.1 M35": "Z.1 M35",
            "G40": "",
            "G13.1": "G40",
            "G1 G40 X-2.15 F60.": "G1 G40 X-2.15 F60.\nG13.1 (expect: polar-never-entered)",
        },
    ),
    Case("000-111", SAMPLE, {"G28 H0": "G28 U0", "G12.1": "G12.1 (expect: c-axis-not-referenced)"}),
    Case(
        "000-112",
        SAMPLE,
        {'T0808 (3/4" DIA. CUTTER)': 'T0808 (3/4" DIA. CUTTER) (expect: radius-contradicts-comment)'},
        ("8:radius=.1",),
    ),
    Case(
        "000-114",
        SAMPLE,
        {"G97 S2000 M33": "G97 S2000", "G1 G98 C.5339 F60.": "G1 G98 C.5339 F60. (expect: live-tool-stopped-in-cut)"},
    ),
    Case("000-116", SAMPLE, {"X2.15": "X2.05", "G12.1": "G12.1 (expect: approach-inside-stock)"}, (MILL,), STOCK),
    Case("000-118", SAMPLE, {"G1 G98 C.5339 F60.": "G1 G98 C30. F60. (expect: degrees-in-polar)"}),
    Case("000-119", SAMPLE, {"G1 G98 C.5339 F60.": "G1 G99 C.5339 F.02", **SEVEN_INCH}),
    Case(
        "000-125",
        SAMPLE,
        {"G1 G40 X-2.15 F60.": "G1 G40 X-1.755 F60. (expect: cancel-shorter-than-radius)"},
        ("8:radius=.005",),
    ),
    Case(
        "000-127",
        SAMPLE,
        {
            "G99 G0 X2.5": "G0 X2.5",
            "M1": "T0303\nG97 S500 M3\nG0 X1. Z.1\nG1 Z-.5 F.008 (expect: turning-feed-not-restored)\nM1",
        },
    ),
    Case("000-128", SAMPLE, {"Z.1 M35": "Z.1", "M1": "T0303 (expect: live-tool-never-stopped)\nM1"}),
    Case("000-130", SAMPLE, {"M5": "M5\tStop the main spindle (expect: text-without-parentheses)"}),
    Case(
        "000-133",
        RECTANGLE,
        {"G1 G98 Z-.25 F10.": "G1 G99 Z-.25 F.01", "G41 X1.5": "G41 X1.5 (expect: feed-per-revolution-in-polar)"},
    ),
    Case("000-134", METHOD_B, {"G1 C0.4153 F5.": "G0 C0.4153 (expect: rapid-in-polar)"}),
    Case(
        "000-136", METHOD_B, {"Z - .375 (depth of cut)": "", "C-0.4153": "C-.4153 Z-.375 (expect: z-with-plane-axis)"}
    ),
    Case("000-137", METHOD_B, {"G40 X-1.8": "X-1.8", "G13.1": "G13.1 (expect: polar-switched-in-offset-mode)\nG40"}),
    Case("000-138", METHOD_B, {"G1 G41 X1.0 F5.": "G1 G41 D01 X1.0 F5. (expect: d-word-on-lathe)"}),
    Case("000-139", METHOD_B, {"G1 G41 X1.0 F5.": "G1 G41 X1.0 F5. (expect: nose-type-not-zero)"}, ("1:nose=2",)),
    # ---- FANUC, page 51 ----
    Case("001-2", FANUC, {"C10.": "Y10. (expect: wrong-axis-address-in-polar)"}),
    Case("001-3", FANUC, {"G12.1": "G12.1 (expect: diameter-radius-mixed)"}, changes={"polar": {"x": "radius"}}),
    Case("001-15", FANUC, {"C10.": "G91 (expect: incremental-word-of-other-code-system)\nC10."}),
    Case("001-16", FANUC, {"G42 G1 X40. F200": "G99 G42 G1 X40. F.2 (expect: feed-per-revolution-in-polar)"}),
    *(
        Case("001-17", FANUC, {"C10.": f"{code} (expect: code-not-allowed-in-polar)\nC10."})
        for code in ("G93", "G80", "G28 U0", "G61", "G96 S100", "G32 Z-5.", "G68", "G31 X30.")
    ),
    Case("001-18", FANUC, {"G3 X-20. C-20. I10. J0": "G3 X-20. C-20. K10. J0 (expect: arc-word-of-other-plane)"}),
    Case("001-19", FANUC, {"G3 X-20. C-20. I10. J0": "G3 X-20. C-20. I10. K5. (expect: arc-word-of-other-plane)"}),
    Case("001-23", FANUC, {"G3 X20. C20. R10.": "G3 X20. C20. R6. (expect: arc-radius-too-small)"}),
    Case("001-24", FANUC, {"C10.": "C10. Z-1. (expect: z-with-plane-axis)"}),
    Case("001-27", FANUC, {"G12.1": "G12.1 (expect: origin-off-center)"}, job={"work_offsets": {"G54": {"x": 1}}}),
    Case("001-28", FANUC, {"G12.1": "G52 X1.\nG12.1 (expect: origin-off-center)"}),
    Case("001-29", FANUC, {"C10.": "G50 X20. (expect: origin-shifted-in-polar)\nC10."}),
    Case(
        "001-29",
        FANUC,
        {"G98 G40 G97": "G94 G90 G40 G97", "C10.": "G92 X20. (expect: origin-shifted-in-polar)\nC10."},
        changes={"control": {"g_code_system": "B"}},
    ),
    Case("001-30", FANUC, {"C10.": "G52 X1. (expect: origin-shifted-in-polar)\nC10."}),
    Case("001-31", FANUC, {"C10.": "G53 X0 (expect: origin-shifted-in-polar)\nC10."}),
    *(Case("001-33", FANUC, {"C10.": f"G{code} (expect: origin-shifted-in-polar)\nC10."}) for code in range(54, 60)),
    Case("001-34", FANUC, {"C10.": "G10 L2 P1 X1. (expect: origin-shifted-in-polar)\nC10."}),
    Case("001-34", FANUC, {"C10.": "#5221=1. (expect: origin-shifted-in-polar)\nC10."}),
    Case("001-35", FANUC, {"G12.1": "G42\nG12.1 (expect: polar-switched-in-offset-mode)"}),
    Case("001-36", FANUC, {"G40 X120.": "X120.", "G13.1": "G13.1 (expect: polar-switched-in-offset-mode)\nG40"}),
    Case("001-37", FANUC, {"G12.1": "G41\nG12.1 (expect: polar-switched-in-offset-mode)"}),
    # ---- FANUC, page 52 ----
    *(
        Case("002-2", FANUC, {"C10.": f"{code} (expect: tool-length-offset-in-polar)\nC10."})
        for code in ("G43 H1", "G44 H1", "G49")
    ),
    Case("002-3", FANUC, {"C10.": "G10 P1 R4. (expect: offset-changed-in-polar)\nC10."}),
    Case("002-3", FANUC, {"C10.": "#2001=4. (expect: offset-changed-in-polar)\nC10."}),
    Case("002-4", FANUC, {"T0101": "", "G42 G1 X40. F200": "G42 G1 X40. F200 (expect: offset-number-missing)"}),
    Case(
        "002-4",
        FANUC,
        {
            "T0101": "",
            "G12.1": "G12.1 (expect: no-tool-offset-at-entry)",
            "G42 G1 X40. F200": "G1 X40. F200",
            "G40 X120.": "X120.",
        },
    ),
    Case("002-5", FANUC, {"C10.": "T0102 (expect: offset-changed-in-polar)\nC10."}, ("2:radius=5", "2:nose=0")),
    Case("002-9", FANUC, {"C10.": "C10. (expect: c-feed-above-limit)"}, changes={"limits": {"c_feed": 450}}),
    Case("002-10", FANUC, {"C10.": "C10. (expect: c-feed-above-limit)"}, changes={"parameters": {"1422": 450}}),
    Case("002-14", FANUC, {"C10.": "C10. (expect: c-feed-above-limit)"}, changes={"limits": {"c_feed": 458}}),
    Case("002-12", FANUC, {"G40 X120.": "G40 X-120. (expect: path-through-center)"}),
    Case(
        "002-15",
        FANUC,
        {"G1 X-40.": "G1 X-40. F197. (expect: c-feed-above-limit)", "G42 G1 X40. F200": "G42 G1 X40. F190."},
        changes={"limits": {"c_feed": 450}},
    ),
    Case(
        "002-16",
        FANUC,
        {"G42 G1 X40. F200": "G42 G1 X40. F180.", "C10.": "C10. (expect: c-feed-above-limit)"},
        changes={"limits": {"c_feed": float(np.degrees(180 / 25))}},
    ),
    # ---- the GSK type ----
    Case("003-13", GSK_1, {"N110 G12.1;": "N110 G12.1 U5. (expect: polar-shift-incremental)"}),
    *(
        Case("003-22", GSK_1, {"N110 G12.1;": f"N110 G12.1 {words} (expect: polar-axis-number-wrong)"})
        for words in ("P0", "P1 Q99", "P3 Q3", "P1.5")
    ),
    *(
        Case(
            number,
            GSK_2,
            {"N000 T0202;": f"{units} T0202", "N110 G12.1 E8;": f"N110 G12.1 E{infeed} (expect: infeed-out-of-range)"},
            changes=changes,
        )
        for number, units, infeed, changes in EDGES
    ),
    Case("003-3", GSK_1, {"N110 G12.1;": "N110 G12.1 M8; (expect: polar-switch-not-alone)"}),
    Case(
        "003-9", GSK_1, {"N120 G42 G01 X80. F200;": "N120 G99 G42 G01 X80. F.2 (expect: feed-per-revolution-in-polar)"}
    ),
    Case("003-10", GSK_1, {"N130 C20.0;": "G28 U0 (expect: code-not-allowed-in-polar)\nN130 C20.0;"}),
    Case("003-10", GSK_1, {"N150 G01 X-40.0;": "N150 G00 X-40.0 (expect: rapid-in-polar)"}),
    Case("003-10", GSK_1, {"N130 C20.0;": "G18 (expect: plane-selected-in-polar)\nN130 C20.0;"}),
    Case("003-10", GSK_1, {"N130 C20.0;": "G91 (expect: incremental-word-of-other-code-system)\nN130 C20.0;"}),
    Case("003-11", GSK_1, {"N110 G12.1;": "N110 G12.1 (expect: polar-never-left)", "N230 G13.1;": ""}),
    Case("003-27", GSK_1, {"N140 G03 X40.0 C40.0 R20.0;": "G3 X40. C40. K-20. (expect: arc-word-of-other-plane)"}),
    Case("003-28", GSK_1, {"N140 G03 X40.0 C40.0 R20.0;": "G3 X40. C40. I-20. K1. (expect: arc-word-of-other-plane)"}),
    Case(
        "003-32",
        GSK_2,
        {"N120 G42 G01 X300 C0 F2000;": "G42 G1 X300 C0 F2000 (expect: feed-above-polar-limit)"},
        changes={"parameters": {"5450#1": 1, "5462": 1000}},
    ),
    Case(
        "003-33",
        GSK_1,
        {"N110 G12.1;": "N110 G12.1 (expect: diameter-radius-mixed)"},
        changes={"parameters": {"5450#6": 1}},
    ),
    Case(
        "003-36",
        GSK_1,
        {"N120 G42 G01 X80. F200;": "G42 G1 X80. F200 (expect: feed-above-polar-limit)"},
        changes={"parameters": {"5450#1": 1, "5462": 199}},
    ),
    Case("003-38", GSK_1, {"N110 G12.1;": "G52 X1.\nG12.1 (expect: origin-off-center)"}),
    Case("003-39", GSK_1, {"N130 C20.0;": "G55 (expect: origin-shifted-in-polar)\nN130 C20.0;"}),
    Case("003-41", GSK_1, {"N130 C20.0;": "G17 (expect: plane-selected-in-polar)\nN130 C20.0;"}),
    Case(
        "003-47",
        GSK_2,
        {
            "N110 G12.1 E8;": "N110 G12.1 E8 (expect: contour-open-with-infeed)",
            "N210 G01 C0;": "N210 G01 C-30.",
            "N220 G40 X300.0;": "N220 G40 X348.",
        },
    ),
    Case(
        "003-48",
        GSK_1,
        {"N110 G12.1;": "N110 G12.1 (expect: diameter-radius-mixed)"},
        changes={"polar": {"x": "radius"}},
    ),
    Case(
        "003-49",
        GSK_1,
        {"N10 T0202": "", "N120 G42 G01 X80. F200;": "G42 G1 X80. F200 (expect: offset-number-missing)"},
    ),
    Case(
        "003-50",
        GSK_1,
        {
            "N100 G00 X150. C0 Z0;": "N100 G00 X-150. C0 Z0;",
            "N110 G12.1;": "N110 G12.1 (expect: x-not-positive-at-entry)",
        },
    ),
    Case(
        "003-52",
        GSK_1,
        {
            "N100 G00 X150. C0 Z0;": "G0 X98. C0 Z0",
            "N120 G42 G01 X80. F200;": "G42 G1 X80. F200 (expect: start-up-shorter-than-radius)",
        },
    ),
    Case("003-54", GSK_1, {"N140 G03 X40.0 C40.0 R20.0;": "G3 X40. C40. R10. (expect: arc-radius-too-small)"}),
    Case("003-54", GSK_1, {"N140 G03 X40.0 C40.0 R20.0;": "G3 X40. C40. I-25. J0 (expect: arc-end-off-circle)"}),
    Case(
        "003-55",
        GSK_1,
        {
            "N120 G42 G01 X80. F200;": "G42 G1 X80. C5. F200",
            "N210 G01 C0;": "N210 G1 C-8. (expect: nearly-regular-contour)",
        },
    ),
    Case("003-56", GSK_1, {"N220 G40 X150.0;": "N220 G40 X98. (expect: cancel-shorter-than-radius)"}),
    Case("003-57", GSK_1, {"N230 G13.1;": "N230 G13.1 Z100. (expect: polar-switch-not-alone)"}),
    Case("003-59", GSK_1, {"N500 M30;": "", "N240 Z100.0;": "N240 Z100. (expect: program-end-missing)"}),
    Case(
        "003-60",
        GSK_2,
        {"N110 G12.1 E8;": "N110 G12.1 E8 (expect: diameter-radius-mixed)"},
        changes={"polar": {"x": "radius"}},
    ),
    Case(
        "003-65",
        GSK_2,
        {
            "N110 G12.1 E8;": "N110 G12.1 E8 (expect: contour-open-with-infeed)",
            "N200 G03 X300.0 C-80.0 R40.0;": "G3 X300. C-80. R40.",
            "N210 G01 C0;": "",
            "N220 G40 X300.0;": "G1 G40 X348.",
        },
    ),
    Case("003-66", GSK_2, {"N220 G40 X300.0;": "N220 G40 X310. (expect: cancel-shorter-than-radius)"}),
    Case("003-67", GSK_2, {"N110 G12.1 E8;": "N110 G42\nG12.1 E8 (expect: polar-switched-in-offset-mode)"}),
    Case(
        "003-67",
        GSK_1,
        {"N220 G40 X150.0;": "N220 X150.", "N230 G13.1;": "N230 G13.1 (expect: polar-switched-in-offset-mode)\nG40"},
    ),
    Case("003-68", GSK_1, {"N110 G12.1;": "G41\nN110 G12.1 (expect: polar-switched-in-offset-mode)"}),
    Case(
        "003-69", GSK_1, {"N130 C20.0;": "N130 C20. (expect: c-feed-above-limit)"}, changes={"limits": {"c_feed": 200}}
    ),
    Case(
        "003-70",
        GSK_1,
        {
            "N10 T0202": "",
            "N110 G12.1;": "G12.1 (expect: no-tool-offset-at-entry)",
            "N120 G42 G01 X80. F200;": "G1 X80. F200",
            "N220 G40 X150.0;": "X150.",
        },
    ),
    Case(
        "003-71",
        GSK_1,
        {"N130 C20.0;": "T0203 (expect: offset-changed-in-polar)\nN130 C20.0;"},
        ("3:radius=10", "3:nose=0"),
    ),
    Case("003-71", GSK_1, {"N130 C20.0;": "G10 P2 R9. (expect: offset-changed-in-polar)\nN130 C20.0;"}),
    # ---- Mitsubishi ----
    Case("004-1", M700V, PER_REVOLUTION | {"G1 G42 X20. F2000": "G1 G42 X20. (expect: feed-lost-from-per-revolution)"}),
    Case(
        "004-6",
        M700V,
        PER_REVOLUTION | {"G1 G42 X20. F2000": "G1 Z-1. (expect: feed-lost-from-per-revolution)\nG42 X20. F2000"},
    ),
    Case(
        "004-7",
        M700V,
        PER_REVOLUTION
        | {"G1 G42 X20. F2000": "G1 G42 X20. (expect: feed-lost-from-per-revolution)", "C10.": "C10. F2000"},
    ),
    Case(
        "004-11",
        M700V,
        PER_REVOLUTION
        | {
            "G1 G42 X20. F2000": "G1 G42 X20. (expect: feed-lost-from-per-revolution)",
            "G17 G90 G94 G40 G97": "G17 G99 G40 G97 F.2",
        },
        changes={"control": {"g_code_system": "A"}},
    ),
    Case(
        "004-17",
        M700V,
        PER_REVOLUTION | {"G1 G42 X20. F2000": "G1 G42 X20. F.2 (expect: feed-of-revolution-per-minute)"},
    ),
    Case("004-21", M700V, {"C10.": "C10. (expect: wrong-axis-address-in-polar)"}, changes={"parameters": {"1517": 0}}),
    Case("004-22", M700V, {"C10.": "Y10. (expect: wrong-axis-address-in-polar)"}, changes={"parameters": {"1517": 1}}),
    Case(
        "004-24",
        M700V,
        {"G12.1": "G12.1 (expect: diameter-radius-mixed)"},
        changes={"parameters": {"8111": 1, "1019": 1}},
    ),
]

#: The whole contour of the rectangle, but a circle instead.
CIRCLE = {"C-.25": "G2 I-.75"} | dict.fromkeys(
    (
        "G2 X1. C-.5 R.25",
        "G1 X-1.",
        "G2 X-1.5 C-.25 I0 J.25",
        "G1 C.25",
        "G2 X-1. C.5 R.25",
        "G1 X1.",
        "G2 X1.5 C.25 R.25",
    ),
    "",
)
BY_CENTER = {"G2 X-1.75 R1.025 F60. (3)": "G2 X-1.75 I-.875 J.5339 F60."}
SYSTEM_B = {"control": {"g_code_system": "B"}}
IN_B = {"G98 G40 G97": "G94 G90 G40 G97"}
IN_INCH = {"G98 G40 G97": "G20 G98 G40 G97", "G42 G1 X40. F200": "G42 G1 X40. F8."}
WITH_Y = {
    block: re.sub("C(?=-?[0-9])", "Y", block)
    for block in ("C10.", "G3 X10. C20. R10.", "C-10.", "G3 X-10. C-20. I10. J0", "C0")
}
LIMITED = {"parameters": {"1422": 450}}
PER_REVOLUTION_IN_A = {"G17 G90 G94 G40 G97": "G17 G99 G40 G97 F.2"}
SHIFT = {"N110 G12.1;": "N110 G12.1 X20. C5.;"}

KEPT = [
    Case("000-5", SAMPLE, {"G2 X-1.75 R1.025 F60. (3)": "G2 X0 C-1.025 R1.025 F60.\nX-1.75 C-.5339 R1.025"}),
    Case("000-12", SAMPLE, {"G12.1": "G12.1\nG18"}),
    Case("000-12", SAMPLE, {"": "G17", "G12.1": "G18\nG12.1"}),
    Case("000-15", SAMPLE, {"G28 H0": "G28 H0\nG10 L2 P1 X0\nG54"}),
    Case("000-16", SAMPLE, {"G28 H0": "G28 H0\nG52 X.5\nG52 X0"}),
    Case("000-17", METHOD_B, {"G0 Z.1 C0": "G0 Z.1 C60."}),
    Case("000-20", SAMPLE, {"G1 G98 C.5339 F60.": "G1 G98 C.5339 F30."}),
    Case("000-23", SAMPLE, {"G1 G41 X1.75F7. (1)": "G1 G41 X1.75 F1."}),
    Case("000-23", SAMPLE, {"G1 G41 X1.75F7. (1)": "G1 G41 X1.75 F10."}),
    Case("000-24", RECTANGLE, {"G1 G98 Z-.25 F10.": "G1 G98 Z-.25 F3."}, changes=LIMIT),
    Case("000-26", SAMPLE, BY_INCREMENTS),
    Case("000-27", SAMPLE, BY_INCREMENTS),
    Case("000-34", SAMPLE, BY_CENTER),
    Case("000-38", RECTANGLE, CIRCLE),
    Case("000-40", METHOD_A, tools=("1:radius=.245",)),
    Case("000-48", METHOD_A, {"X1.8": "X1.5", "G40 X1.8 F20.": "G40 X1.5 F20."}),
    Case(
        "000-49",
        METHOD_A,
        {
            "G1 G98 C0.4153 F20.": "G1 G98 X1. C.6653 F30.",
            "G1 G41 X1.0 F5.": "G41 C.4153 F5.",
            "G40 X1.8 F20.": "G40 C-.6653",
        },
    ),
    Case("000-52", METHOD_A, {"T0101": 'T0101 (1/2" DIA. CUTTER)'}),
    Case("000-57", METHOD_A, {"T0101": 'T0101 (1/2" DIA. CUTTER)'}, ("1:radius=.245",)),
    Case("000-64", SAMPLE, tools=("8:mount=radial,shape=ball",)),
    Case("000-68", SAMPLE, tools=(MILL,), job=STOCK),
    Case("000-69", METHOD_A, job={"stock": {"diameter": 1.25}}),
    Case("000-69", METHOD_B, job={"stock": {"diameter": 1.25}}),
    Case("000-113", SAMPLE, tools=("8:radius=-.005",)),
    Case("000-113", SAMPLE, tools=("8:radius=.005",)),
    Case("000-81", SAMPLE, {"G2 X-1.75 R1.025 F60. (3)": "G2 X-1.75 R1.025 F30."}),
    Case("000-135", SAMPLE, {"G1 G98 C.5339 F60.": "G98 G3 X1.8664 C.5339 R1.075 F60."}),
    Case("000-119", SAMPLE, {"": "G98", "G1 G98 C.5339 F60.": "G1 C.5339 F60."}),
    Case("001-28", FANUC, {"G12.1": "G52 X-1.\nG0 X120.\nG12.1"}, job={"work_offsets": {"G54": {"x": 1}}}),
    Case("001-11", FANUC, {"C10.": "G4 X1.\nC10."}),
    Case("001-14", FANUC, A_MACRO),
    Case("001-14", FANUC, A_MACRO | {"G12.1": "G12.1\nG66 P9010\nG1 X119. F200\nG67"}),
    Case("001-15", FANUC, IN_B | {"C10.": "G91 C10.\nG90"}, changes=SYSTEM_B),
    Case("001-16", FANUC, IN_B | {"C10.": "G94 C10."}, changes=SYSTEM_B),
    Case("001-7", FANUC, IN_INCH),
    Case("001-24", FANUC, {"C10.": "Z-1.\nC10."}),
    Case("002-1", FANUC, {"T0101": "T0101\nG43 H1", "G0 Z100.": "G49 G0 Z100."}),
    Case("002-3", FANUC, {"T0101": "G10 P1 R5.\nT0101"}),
    Case("002-11", FANUC, {"G42 G1 X40. F200": "G42 G1 X40. F196."}, changes=LIMITED),
    Case("002-15", FANUC, {"G42 G1 X40. F200": "G42 G1 X40. F196."}, changes=LIMITED),
    Case(
        "002-16",
        FANUC,
        {"G42 G1 X40. F200": "G42 G1 X40. F179.9"},
        changes={"limits": {"c_feed": float(np.degrees(180 / 25))}},
    ),
    *(
        Case(
            number,
            GSK_2,
            {"N000 T0202;": f"{units} T0202", "N110 G12.1 E8;": f"N110 G12.1 E-{int(float(infeed)) - 1}."},
            changes=changes,
        )
        for number, units, infeed, changes in EDGES
    ),
    Case("003-6", GSK_1, {"N130 C20.0;": "G4 X1.\nN130 C20.0;"}),
    Case("003-8", GSK_1, {"N110 G12.1;": "G12.1\nG65 P9010", "N500 M30;": "M30\nO9010\nG4 X1.\nM99"}),
    Case("003-9", GSK_1, {"N10 T0202": "N10 G98 T0202"}),
    Case("003-21", GSK_2, {"N110 G12.1 E8;": "N110 G12.1"}),
    Case("003-21", GSK_2, {"N110 G12.1 E8;": "N110 G12.1 E0"}),
    Case("003-19", GSK_2, {"N110 G12.1 E8;": "N110 G12.1 E-8."}),
    *(Case("003-41", GSK_1, {"N110 G12.1;": f"{plane}\nN110 G12.1"}) for plane in ("G17", "G18", "G19")),
    Case("004-2", M700V, {"G17 G90 G94 G40 G97": "G17 G90 G94 G40 G97 F2000", "G1 G42 X20. F2000": "G1 G42 X20."}),
    Case("004-16", M700V, PER_REVOLUTION),
    Case("004-16", M700V, PER_REVOLUTION_IN_A, changes={"control": {"g_code_system": "A"}}),
    Case("004-19", M700V, changes={"parameters": {"1516": "C"}}),
    Case("004-21", M700V, WITH_Y, changes={"parameters": {"1517": 0}}),
    Case("004-23", M700V, changes={"parameters": {"8111": 0, "1019": 0}}),
    Case("004-24", M700V, changes={"parameters": {"8111": 1, "1019": 0}}),
]

PER_MINUTE = {"G17 G90 G94 G40 G97": "G17 G90 G94 G40 G97 F1500"}
NO_FEED = {"G1 G42 X20. F2000": "G1 G42 X20."}
#: Numbers of F in the mode and after it; G94 or G95 before, F or none in the mode; both values of F.
FEEDS = [
    ("004-2 004-3", PER_MINUTE, NO_FEED, 1500, 1500),
    ("004-7 004-8", PER_REVOLUTION, {}, 2000, 0.2),
    ("004-9 004-10", PER_MINUTE, NO_FEED, 1500, 1500),
    ("004-6 004-12", PER_REVOLUTION, NO_FEED, np.nan, 0.2),
    ("004-14 004-15", PER_MINUTE, {}, 2000, 2000),
    ("004-16 004-18", PER_REVOLUTION, {}, 2000, 0.2),
]


def degrees(*points: complex) -> list[float]:
    return np.degrees(np.angle(points)).tolist()


A, B, S, R, F = (Case("", printed) for printed in (METHOD_A, METHOD_B, SAMPLE, RECTANGLE, FANUC))
G1, G2, M = (Case("", printed) for printed in (GSK_1, GSK_2, M700V))
FLAT, START, ARC, SECOND = "C-0.4153", "G1 G41 X1.0 F5.", "G2 X-1.75 R1.025 F60. (3)", "G1 C-.5339 (2)"
POINT = 0.875 - 0.5339j
#: The tool center at the ends of the first flat of method A and B.
AT_FLAT = 0.75 + 0.4153j


def of(number: str, case: Case, block: str, column: str, value: Any, **more: Any) -> Value:
    return Value(case._replace(number=number, **more), block, column, value)


VALUES = [
    of("000-1", S, SECOND, "mode.in_polar", True),
    of("000-2", R, "G1 X-1.", "moves.end", INCH * (-0.5 - 0.75j)),
    of("000-4", S, SECOND, "path.end", INCH * POINT),
    of("000-5", S, ARC, "axes.motion", Motion.CW),
    of("000-6", A, FLAT, "compensation.radius", 0.25 * INCH),
    of("000-6", S, SECOND, "compensation.radius", 0),
    of("000-7", S, SECOND, "move.x_axis", [INCH * abs(POINT)] * 2),
    of("000-7", S, SECOND, "move.c_axis", degrees(POINT.conjugate(), POINT)),
    of("000-8", S, ARC, "path.center", 0),
    of("000-9", S, "G1 G41 X1.75F7. (1)", "path.end", INCH * POINT.conjugate()),
    of("000-10", S, "G1 C.5339 F7. (4)", "path.end", -INCH * POINT),
    of("000-17", A, FLAT, "move.c_axis", [180 + angle for angle in degrees(AT_FLAT, AT_FLAT.conjugate())]),
    of(
        "000-18",
        A,
        FLAT,
        "move.c_axis",
        [60 + angle for angle in degrees(AT_FLAT, AT_FLAT.conjugate())],
        edits={"G0 C180.": "G0 C60."},
    ),
    of("000-21", S, SECOND, "feedrate.feed_mode", FeedMode.PER_MINUTE),
    of(
        "000-21",
        S,
        SECOND,
        "feedrate.feed_mode",
        FeedMode.PER_REVOLUTION,
        edits={"G1 G98 C.5339 F60.": "G1 G99 C.5339 F.01"},
    ),
    of("000-26", S, "G2 U-3.5 R1.025 F60.", "path.end", -INCH * POINT.conjugate(), edits=BY_INCREMENTS),
    of("000-27", S, "G1 H-1.0678", "path.end", INCH * POINT, edits=BY_INCREMENTS),
    of("000-28", R, "C-.25", "axes.motion", Motion.LINE),
    of("000-31", S, ARC, "axes.motion", Motion.CW),
    of("000-33", R, "G2 X1. C-.5 R.25", "path.center", INCH * (0.5 - 0.25j)),
    of("000-34", S, BY_CENTER[ARC], "path.center", 0, edits=BY_CENTER),
    of(
        "000-35",
        R,
        "G2 X1. C-.5 I-.25",
        "path.center",
        INCH * (0.5 - 0.25j),
        edits={"G2 X1. C-.5 R.25": "G2 X1. C-.5 I-.25"},
    ),
    of("000-36", R, "G2 X-1.5 C-.25 I0 J.25", "path.center", INCH * (-0.5 - 0.25j)),
    of("000-37", R, "G2 X-1.5 C-.25 I0 J.25", "arcs.sweep", 90),
    of("000-38", R, "G2 I-.75", "arcs.sweep", 360, edits=CIRCLE),
    of("000-40", A, FLAT, "moves.nearest", 0.745 * INCH, tools=("1:radius=.245",)),
    of("000-46", A, START, "compensation.starts_up", True),
    of("000-47", A, "G40 X1.8 F20.", "compensation.cancels", True),
    of("000-50", A, START, "compensation.radius", 0.25 * INCH),
    of("000-51", S, SECOND, "compensation.radius", 0),
    of("000-52", B, FLAT, "compensation.radius", 0.25 * INCH),
    of("000-53", A, START, "offsets.nose", 0),
    of("000-55", S, SECOND, "tools.offset_number", 8),
    of("000-57", A, FLAT, "moves.nearest", 0.7475 * INCH, tools=("1:radius=.2475",)),
    of("000-67", S, "G12.1", "approaches.x_needed", 1.075 * INCH, tools=(MILL,), job=STOCK),
    of("000-68", S, "G12.1", "approaches.x_needed", 1.075 * INCH, tools=(MILL,), job=STOCK),
    of("000-69", A, FLAT, "lengths.stock_diameter", 1.25 * INCH, job={"stock": {"diameter": 1.25}}),
    of("000-70", A, FLAT, "path.end", INCH * (0.5 - 0.4153j)),
    of("000-71", A, FLAT, "path.z", -0.375 * INCH),
    of("000-72", A, FLAT, "compensation.radius", 0.25 * INCH),
    of("000-72", A, FLAT, "offsets.cutter_diameter", 0.5 * INCH),
    of("000-73", B, "G1 G98 C0.4153 F20.", "move.c_axis", degrees(0.9 + 0j, 0.9 + 0.4153j)),
    of("000-74", B, START, "move.c_axis", degrees(0.9 + 0.4153j, AT_FLAT)),
    of("000-76", S, SECOND, "move.x_axis", [INCH * abs(POINT)] * 2),
    of("000-76", S, SECOND, "move.c_axis", degrees(POINT.conjugate(), POINT)),
    of("000-77", S, "G1 C.5339 F7. (4)", "move.x_axis", [INCH * abs(POINT)] * 2),
    of("000-78", A, FLAT, "move.c_axis", [180 + angle for angle in degrees(AT_FLAT, AT_FLAT.conjugate())]),
    of("000-79", B, "G1 C0.4153 F5.", "path.end", INCH * (-0.5 + 0.4153j)),
    of("000-80", B, "G2 X-1.0 R.650 F60.", "moves.nearest", 0.9 * INCH),
    of("000-82", B, FLAT, "compensation.side", Side.LEFT),
    of("000-83", A, START, "path.end", INCH * (0.5 + 0.4153j)),
    of("000-84", A, FLAT, "compensation.side", Side.LEFT),
    of("000-85", A, FLAT, "compensation.radius", 0.25 * INCH),
    of("000-96", A, "Z - .375 (depth of cut)", "path.z", -0.375 * INCH),
    of("000-97", A, FLAT, "path.length", 0.8306 * INCH),
    of("000-100", A, "G0 C180.", "path.c_angle", 180),
    of("000-101", A, FLAT, "mode.section", 1),
    of("000-104", B, "G2 X-1.0 R.650 F60.", "path.center", 0),
    of("000-105", B, "G1 C0.4153 F5.", "feedrate.feed", 5 * INCH),
    of("000-110", S, "G30 U0 W0", "path.x", np.nan),
    of("000-115", S, "G0Z.1 C0 M8", "path.c_angle", 0),
    of("000-112", S, SECOND, "compensation.radius", 0),
    of("000-113", S, SECOND, "moves.nearest", (0.875 - 0.005) * INCH, tools=("8:radius=-.005",)),
    of("000-117", S, "G12.1", "mode.enters", True),
    of("000-118", S, "G1 G98 C.5339 F60.", "path.end", INCH * (1.075 + 0.5339j)),
    of("000-120", S, "G1 G41 X1.75F7. (1)", "compensation.starts_up", True),
    of("000-121", S, "Z-.88", "path.z", -0.88 * INCH),
    of("000-122", S, SECOND, "path.end", INCH * POINT),
    of("000-123", S, ARC, "path.center", 0),
    of("000-124", S, "G1 C.5339 F7. (4)", "path.end", -INCH * POINT),
    of("000-126", S, "G13.1", "mode.leaves", True),
    of("000-131", R, "G1 X1.", "axes.motion", Motion.LINE),
    of("000-132", R, "G2 X-1.5 C-.25 I0 J.25", "path.center", INCH * (-0.5 - 0.25j)),
    of("001-1", F, "C10.", "path.end", 20 + 10j),
    of("001-4", F, "G42 G1 X40. F200", "path.start", 60, edits={"G54 G0 X120. C0 Z5.": "G0 X120. C30. Z5."}),
    of("001-5", F, "G42 G1 X40. F200", "move.c_axis", [30, 30], edits={"G54 G0 X120. C0 Z5.": "G0 X120. C30. Z5."}),
    of("001-6", F, "C10.", "move.feed", 200),
    of("001-6", F, "C10.", "move.time", 3),
    of("001-7", F, "C10.", "path.end", INCH * (20 + 10j), edits=IN_INCH),
    of("001-8", F, "C10.", "feedrate.feed", 8 * INCH, edits=IN_INCH),
    of("001-9", F, "C10.", "axes.motion", Motion.LINE),
    of("001-10", F, "G3 X20. C20. R10.", "axes.motion", Motion.CCW),
    of("001-12", F, "C10.", "compensation.side", Side.RIGHT),
    of("001-13", F, "C10.", "move.end", [25, 10]),
    of("001-13", F, "C10.", "moves.nearest", 25),
    of("001-15", F, "G91 C10.", "modal.incremental", True, edits=IN_B | {"C10.": "G91 C10.\nG90"}, changes=SYSTEM_B),
    of("001-23", F, "G3 X20. C20. R10.", "path.center", 10 + 10j),
    of("001-24", F, "C10.", "path.z", -1, edits={"C10.": "Z-1.\nC10."}),
    of("002-7", F, "C10.", "move.x_axis", [25, abs(25 + 10j)]),
    of("002-7", F, "C10.", "move.c_axis", degrees(25, 25 + 10j)),
    of("002-8", F, "C10.", "moves.c_feed", np.degrees(200 / 25)),
    of("002-8", F, "C10.", "moves.c_feed", np.degrees(200 / 22), tools=("1:radius=2",)),
    of("002-13", F, "C10.", "moves.nearest", 25),
    of("002-13", F, "C10.", "move.nearest", 25),
    of(
        "002-16",
        F,
        "G1 X-40.",
        "tool_center.is_at_c_feed_limit",
        True,
        edits={"G42 G1 X40. F200": "G42 G1 X40. F180."},
        changes={"limits": {"c_feed": float(np.degrees(180 / 25))}},
    ),
    of("002-18", F, "C10.", "moves.c_feed", np.degrees(200 / 22), tools=("1:radius=2",)),
    of("002-19", F, "C10.", "moves.c_feed", np.degrees(200 / 25)),
    of("003-1", G1, "N130 C20.0;", "move.x_axis", [50, abs(50 + 20j)]),
    of("003-1", G1, "N130 C20.0;", "move.c_axis", degrees(50, 50 + 20j)),
    of("003-4", G1, "N130 C20.0;", "axes.motion", Motion.LINE),
    of("003-5", G1, "N140 G03 X40.0 C40.0 R20.0;", "axes.motion", Motion.CCW),
    of("003-7", G1, "N130 C20.0;", "compensation.side", Side.RIGHT),
    of("003-9", G1, "N130 C20.0;", "feedrate.feed_mode", FeedMode.PER_MINUTE, edits={"N10 T0202": "G98 T0202"}),
    of("003-9", G1, "N130 C20.0;", "feedrate.feed_mode", FeedMode.PER_REVOLUTION, edits={"N10 T0202": "G99 T0202"}),
    of("003-11", G1, "N230 G13.1;", "mode.leaves", True),
    of("003-12", G1, "N130 C20.0;", "path.center_shift", 10 + 5j, edits=SHIFT),
    of("003-14", G2, "N130 C80.0;", "move.c_axis", [30, 30 + degrees(160 + 80j)[0]], edits={"N110 G12.1 E8;": "G12.1"}),
    of("003-19", G2, "N110 G12.1 E-8.", "infeed.depth", 8, edits={"N110 G12.1 E8;": "N110 G12.1 E-8."}),
    of("003-31", G1, "N140 G03 X40.0 C40.0 R20.0;", "path.center", 20 + 20j),
    of("003-37", G1, "N130 C20.0;", "move.feed", 200),
    of("003-37", G1, "N130 C20.0;", "move.time", 6),
    of("003-40", G1, "N130 C20.0;", "path.end", 40 + 20j),
    of("003-48", G1, "N140 G03 X40.0 C40.0 R20.0;", "path.end", 20 + 40j),
    of("003-50", G1, "N100 G00 X150. C0 Z0;", "path.x", 75),
    of("003-51", G1, "N110 G12.1;", "mode.enters", True),
    of("003-54", G1, "N160 G03 X-80.0 C20.0 R20.0;", "path.center", -20 + 20j),
    of("003-58", G1, "N130 C20.0;", "feedrate.feed_mode", FeedMode.PER_MINUTE),
    of("003-61", G2, "N100 G00 X348 C30;", "path.x", 174),
    of("003-61", G2, "N130 C80.0;", "move.c_axis", [30, 30 + degrees(160 + 80j)[0]], edits={"N110 G12.1 E8;": "G12.1"}),
    of("003-62", G2, "N110 G12.1 E8;", "infeed.depth", 8),
    of("003-63", G2, "N110 G12.1 E8;", "infeed.depth", 8),
    of("003-64", G2, "N120 G42 G01 X300 C0 F2000;", "compensation.starts_up", True),
    # ---- F in the mode, and after it at the last block that moves ----
    *(
        of(number, M, block, column, value, edits=before | inside)
        for numbers, before, inside, in_mode, after in FEEDS
        for number, block, column, value in zip(
            numbers.split(),
            ("C10.", "G0 Z100."),
            ("feedrate.feed", "feedrate.feed_number"),
            (in_mode, after),
            strict=True,
        )
    ),
    of("004-1", M, "C10.", "feedrate.feed", np.nan, edits=PER_REVOLUTION | NO_FEED),
    of("004-4", M, "G0 Z100.", "feedrate.feed_number", 300, edits=PER_MINUTE | {"C10.": "C10. F300"}),
    of("004-5", M, "C10.", "feedrate.feed", 1500, edits=PER_MINUTE | NO_FEED),
    of("004-17", M, "C10.", "feedrate.per_minute", True, edits=PER_REVOLUTION),
    *(
        of(
            "003-42",
            G1,
            "G12.1",
            "entry.plane_is_right",
            plane == "G18",
            edits={"N110 G12.1;": f"{plane}\nN110 G12.1", "N240 Z100.0;": "G0 Z100.\nG12.1\nG13.1"},
            changes={"polar": {"plane_before": ["G18"]}},
        )
        for plane in ("G17", "G18")
    ),
]


def name(case: Case) -> str:
    return case.number


@pytest.mark.ci
@looped("printed", PRINTED.values(), ids=PRINTED, one_in=3)
def test_printed_program(printed: Printed) -> None:
    """No error and no warning, and all that matters is known, but for the limit of C where the document has none."""
    report = report_of(printed.text, printed.machine, *printed.tools)
    assert {(found.rule, found.severity) for found in report.findings} <= {
        ("feed-outside-recommended-range", "note"),
        ("cancel-shorter-than-radius", "note"),
        ("omitted-text", "note"),
    }
    assert {entry.rule for entry in report.not_evaluated if entry.matters} <= {"c-feed-above-limit"}


def test_a_forgotten_radius_is_a_note() -> None:
    """The sample program as printed, its R taken from its comment: 0, since no ramp fits a cutter of .75."""
    report = report_of(SAMPLE.text, SAMPLE.machine, job={"radius_from_comments": True})
    assert [(found.rule, found.severity) for found in report.findings] == [("radius-from-comment", "note")]


@pytest.mark.nightly
@looped("case", BROKEN, ids=name, one_in=96)
def test_broken_statement(case: Case) -> None:
    """The finding that the document speaks of, and no other."""
    found = beyond_its_notes(case)
    assert sorted((one.line, one.rule) for one in found) == expected(case.program)
    rules = set(re.findall(r"`([a-z0-9-]+)`", row_of(case.number)))
    assert {one.rule for one in found} & rules, "the row names it"
    severities = {one.severity for one in found}
    assert (severities == {"note"}) == (case.number in NOTES)


@pytest.mark.nightly
@looped("case", KEPT, ids=name, one_in=36)
def test_kept_statement(case: Case) -> None:
    assert [(one.line, one.rule) for one in beyond_its_notes(case)] == []


@pytest.mark.parametrize("value", VALUES, ids=lambda value: f"{value.case.number}-{value.column}")
def test_column_of_statement(value: Value) -> None:
    case = value.case
    tables = tables_of(case.program, case.printed.machine, *case.printed.tools, *case.tools, **case.given)
    line = [number for number, block in enumerate(case.program.split("\n"), 1) if block == value.block][-1]
    table, _, field = value.column.partition(".")
    if table == "move":
        moves = executed.moves(tables["trace"], tables["tool_center"], "tool")
        found = next(getattr(move, field) for move in moves if move.line == line)
    else:
        column, lines = attrgetter(value.column)(tables), tables["trace"].blocks.line
        found = column[(lines[tables["moves"].row] if table == "moves" else lines) == line][0]
    assert found == pytest.approx(value.value, abs=0.01, nan_ok=True)
    assert f"`{value.column}`" in row_of(case.number)


def row_of(number: str) -> str:
    """The row of a statement in the table."""
    (row,) = [line for line in TABLE.splitlines() if line.startswith(f"| {number} |")]
    return row


@looped(
    ("test", "numbers"),
    [
        ("test_broken_statement", {case.number for case in BROKEN}),
        ("test_kept_statement", {case.number for case in KEPT}),
        ("test_column_of_statement", {value.case.number for value in VALUES}),
    ],
)
def test_the_table_names_the_tests_of_each_statement(test: str, numbers: set[str]) -> None:
    named = {line.split()[1] for line in TABLE.splitlines() if f"`{test}`" in line and line.startswith("| 0")}
    assert named == numbers
