"""Dwells in the words of each control: how long they take, and that their words are nothing else."""

from __future__ import annotations

import math
from typing import Any

import msgspec
import numpy as np
import pytest
from cases import looped
from programs import report_of, tables_of

from polarcheck.reports.pages import resting
from polarcheck.rules.tables import Tables

#: A section on each control, with room for a dwell between two moves at F100.
SECTIONS = {
    "fanuc": "G98 G0 X60. Z2. C0\nG12.1\nG1 X40. F100\n{}\nC10.\nG13.1\nM30\n",
    "gsk-988": "G98 G0 X60. Z2. C0\nG12.1\nG1 X40. F100\n{}\nC10.\nG13.1\nM30\n",
    "doosan": "G98 G0 X60. Z2. C0\nG12.1\nG1 X40. F100\n{}\nC10.\nG13.1\nM30\n",
    "mitsubishi-m700": "G94 G0 X60. Z2. C0\nG12.1\nG1 X20. F100\n{}\nC10.\nG13.1\nM30\n",
    "citizen": "G98 G0 X60. Z2. C0\nG12.1 D0 E=C\nG17\nG1 X20. F100\n{}\nY10.\nG13.1\nM30\n",
    "mazak-integrex": "G94 G0 X60. Z2. C0\nG10.9 X0\nG17 XC\nG12.1\nG1 X20. F100\n{}\nC10.\nG13.1\nM30\n",
    "siemens-iso": "G94 G0 X60. Z2. C0\nG12.1\nG1 X40. F100\n{}\nC10.\nG13.1\nM30\n",
    "siemens-transmit": "G71 G94 G0 X60 Z2 C0\nTRANSMIT\nG17\nG1 X20 Y0 F100\n{}\nY10\nTRAFOOF\nM30\n",
    "haas-lathe": "G21 G98 G0 X60. Z2. C0\nG17\nG112\nG1 X20. Y0 F100.\n{}\nY10.\nG113\nG18\nM30\n",
    "okuma-osp": "G94 G0 X60. Z2. C0\nG137 C0\nG17\nG101 X20. Y0 F100\n{}\nG101 Y10.\nG136\nM2\n",
    "hurco": "G94 G0 X60. Z2. C0\nG7\nG101\nG17\nG1 X20. Y0 F100.\n{}\nY10.\nG109\nM30\n",
    "fagor-8055t": "G94 G15\nG0 X60. Z2. C0\nG16 XC\nG1 X20. C0 F100.\n{}\nC10.\nG18\nM30\n",
}


def dwell_of(machine: str, words: str, **more: Any) -> tuple[Tables, float]:
    """The tables of the section with a dwell, and its time [s]."""
    tables = tables_of(SECTIONS[machine].format(words), machine, **more)
    rows = np.flatnonzero(tables["dynamics"].dwells)
    assert len(rows) == 1
    return tables, float(tables["dynamics"].time[rows[0]])


@looped(
    ("machine", "words", "seconds"),
    [
        ("fanuc", "G4 X2.", 2),
        ("fanuc", "G04 U.5", 0.5),
        ("fanuc", "G4 P1500", 1.5),
        ("fanuc", "G04 X2", 0.002),
        ("fanuc", "#1=2\nG4 X#1", 2),
        ("fanuc", "#1=500\nG4 P#1", 0.5),
        ("fanuc", "G4 X2. K5", 2),
        ("doosan", "G4 U2.", 2),
        ("gsk-988", "G4 P500", 0.5),
        ("mitsubishi-m700", "G4 X1.5", 1.5),
        ("citizen", "G4 U2.", 2),
        ("mazak-integrex", "G4 P2000", 2),
        ("siemens-iso", "G4 X2.", 2),
        ("siemens-transmit", "G4 F2", 2),
        ("siemens-transmit", "G4 F=0.5", 0.5),
        ("siemens-transmit", "R1=3\nG4 F=R1/2", 1.5),
        ("haas-lathe", "G4 P2.", 2),
        ("haas-lathe", "G04 P2000", 2),
        ("haas-lathe", "G04 P.5", 0.5),
        ("okuma-osp", "G4 F2", 2),
        ("okuma-osp", "VC1=0.5\nG04 F=VC1", 0.5),
        ("hurco", "G4 U2.", 2),
        ("fagor-8055t", "G04 K200", 2),
    ],
    one_in=12,
)
def test_a_dwell_in_the_words_of_its_control(machine: str, words: str, seconds: float) -> None:
    tables, time = dwell_of(machine, words)
    assert time == pytest.approx(seconds)
    # No word of it is anything else: X stays at 20, F at 100, and 10 mm take 6 s.
    last = int(np.flatnonzero(tables["dynamics"].on_path)[-1])
    trace = tables["trace"]
    assert trace.path.end[last] == pytest.approx(20 + 10j)
    assert trace.feedrate.feed[last] == 100
    assert tables["dynamics"].time[last] == pytest.approx(6)
    assert set(trace.blocks.program.tolist()) == {0}
    expected = float(tables["dynamics"].section_time[0])
    report = report_of(SECTIONS[machine].format(words), machine)
    if not math.isnan(expected):
        assert report.polar_sections[0].time == pytest.approx(expected, abs=1e-6)
    assert not [one.rule for one in report.findings if words.splitlines()[-1] in one.block]


@pytest.mark.ci
@looped(
    ("machine", "words", "reason"),
    [
        ("fanuc", "G4 F2.", "dwell in line 4"),
        ("fanuc", "G4 X2. P500", "dwell in line 4"),
        ("fanuc", "G4 U-1.", "dwell in line 4"),
        ("haas-lathe", "G4 K2", "dwell in line 5"),
        ("haas-lathe", "#1=2\nG4 P#1", "dwell in line 6"),
        ("okuma-osp", "G4 P500", "dwell in line 5"),
        ("siemens-transmit", "G4 X2", "dwell in line 5"),
        ("siemens-transmit", "G4 S30", "dwell in turns of a spindle in line 5"),
        ("siemens-transmit", "G4 S2=30", "dwell in line 5"),
        ("siemens-transmit", "G4 F=R9", "dwell in line 5"),
    ],
    one_in=2,
)
def test_a_dwell_that_is_not_known_is_the_reason(machine: str, words: str, reason: str) -> None:
    section = report_of(SECTIONS[machine].format(words), machine).polar_sections[0]
    assert section.time is None
    assert section.time_not_known == [reason]


def test_the_time_of_the_other_blocks_is_there() -> None:
    """Also where block skip takes the dwell out of one of two runs."""
    report = report_of(SECTIONS["fanuc"].format("/G4 F2."), "fanuc")
    (section,) = report.polar_sections
    assert (section.time, section.time_known, section.time_not_known) == (None, 12, ["dwell in line 4"])
    assert any("12 s without dwell in line 4" in line for line in resting.resting(report))
    whole = report_of(SECTIONS["fanuc"].format("/G4 X2."), "fanuc").polar_sections[0]
    assert (whole.time, whole.time_known, whole.time_not_known) == (14, msgspec.UNSET, msgspec.UNSET)


def test_feed_per_revolution_makes_turns_of_it_where_the_control_does() -> None:
    """ISO Milling p. 3-67: in G95 a dwell is turns of the spindle; on FANUC parameter 3405#1 says so."""
    for machine, changes, is_known in (
        ("siemens-iso", {}, False),
        ("fanuc", {}, True),
        ("fanuc", {"feed": {"dwell_per_revolution": "turns"}}, False),
        ("fanuc", {"parameters": {"3405#1": 1}}, False),
    ):
        code = "G95" if machine == "siemens-iso" else "G99"
        program = f"{code} G0 X60. Z2. C0\nG4 X2.\nM30\n"
        time = float(tables_of(program, machine, changes=changes)["dynamics"].time[1])
        assert (time == 2) if is_known else math.isnan(time)


def test_an_owner_says_the_words_of_the_lathe() -> None:
    words = {"feed": {"dwell_words": {"R": "hundredths"}}, "control": {"number_without_point": "whole-unit"}}
    assert dwell_of("fanuc", "G4 R150", changes=words)[1] == pytest.approx(1.5)
    # A control that reads X2 as 2 mm reads a dwell of X2 as 2 s.
    assert dwell_of("fanuc", "G04 X2", changes={"parameters": {"3401#0": 1}})[1] == 2
