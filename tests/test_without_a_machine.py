"""A check where nobody has said which lathe it is: the finding names the machine, and nothing else is told."""

from __future__ import annotations

from pathlib import Path

import pytest
from cases import looped
from programs import report_of

from polarcheck.checking import survey
from polarcheck.program.reading import translation
from polarcheck.rules import other_machine

OKUMA = "O1000\nT0808\nSB=1500 M13\nG94 G0 X60 Z2 C0\n{}\nM2\n"
SIEMENS = "{}\nG94 S2=2000 M2=3\nG0 X60 Z5 C0\n{}\nG1 X40 Y0 F200\nX30 Y10\n{}\nM30\n"
FAGOR = "{}\nG90 G94 G0 X60 Z5\n{}\nG1 G42 X30 C0 F100\nC10\nG40 X60\n{}\nM30\n"
MAZAK = (
    "O1\nT0808\nM200\nG94 G0 X60. Z5. C0\n{}\nG1 G42 X40. F100\nC10.\nX-40.\nC-10.\nX40.\nC0.\nG40 X60.\nG13.1\nM30\n"
)
HAAS = "%\nO1\nG54\nT808\nM154\nG98 G97 P1000 M133\nG0 X60. Z5. C0\nG17\n{}\nM135\nM155\nM30\n%\n"
MOVES_OF_HAAS = "G1 G42 X40. Y0 F100.\nY10.\nX-40.\nY-10.\nX40.\nY0\nG40 X60."

#: The machine, its program, and the rule that names it.
PROGRAMS = [
    ("okuma-osp", OKUMA.format("G137 C0\nG101 X40. Y0 F500\nG101 X30. Y10.\nG136"), "polar-code-of-another-control"),
    ("okuma-osp", OKUMA.format("G137\nG101 X40 Y0 F500\nX30 Y10\nG136"), "polar-code-of-another-control"),
    ("okuma-osp", OKUMA.format("VC1=40\nG137 C=VC1\nG101 X=VC1 Y0 F500\nG136"), "polar-code-of-another-control"),
    ("okuma-osp", OKUMA.format("P10\nG137 C0\nG101 G42 X40. Y0 F500\nX30. Y10."), "polar-code-of-another-control"),
    ("siemens-transmit", SIEMENS.format("SETMS(2)", "TRANSMIT", "TRAFOOF"), "polar-code-of-another-control"),
    ("siemens-transmit", SIEMENS.format("def real A", "transmit(1)", "trafoof"), "polar-code-of-another-control"),
    ("siemens-transmit", SIEMENS.format("WAITM(1,1,2)", "N20 TRANSMIT ; ON", ""), "polar-code-of-another-control"),
    ("siemens-transmit", SIEMENS.format('MSG("A")', "TRANSMIT\nG17", "TRAFOOF"), "polar-code-of-another-control"),
    ("fagor-8055t", FAGOR.format("%A,MX--,", "G15\nG16 XC", "G16 ZX"), "polar-code-of-another-control"),
    ("fagor-8055t", FAGOR.format("(P0=1)", "G15\nG16XC", "G15"), "polar-code-of-another-control"),
    ("fagor-8055t", FAGOR.format("", "g15 c0\ng16 xc", "g18"), "polar-code-of-another-control"),
    ("fagor-8055t", FAGOR.format("T8.8", "N10 G15\nN20 G16 XC", "N30 G16 ZX"), "polar-code-of-another-control"),
    ("mazak-eia", MAZAK.format("G17 XC\nG12.1"), "bad-number"),
    ("mazak-eia", MAZAK.format("G17XC\nG12.1"), "bad-number"),
    ("mazak-eia", MAZAK.format("N10 G12.1\nN20 G17 X C"), "bad-number"),
    ("mazak-eia", MAZAK.format("g17 uh\ng12.1"), "bad-number"),
    ("haas-lathe", HAAS.format(f"G112\n{MOVES_OF_HAAS}\nG113"), "wrong-axis-address-in-polar"),
    ("haas-lathe", HAAS.format(f"N10 G112\n{MOVES_OF_HAAS}\nN20 G113\nG18"), "wrong-axis-address-in-polar"),
    ("haas-lathe", HAAS.format("G112\nG0 X40. Y0\nG1 Y10. F100.\nG0 X60.\nG113"), "wrong-axis-address-in-polar"),
    ("haas-lathe", HAAS.format(f"G112\n{MOVES_OF_HAAS}\nG113\n" * 2), "wrong-axis-address-in-polar"),
]


@pytest.mark.nightly
@looped(("name", "program", "rule"), PROGRAMS)
def test_one_finding_names_the_machine(name: str, program: str, rule: str) -> None:
    report = report_of(program)
    (finding,) = report.findings
    assert (finding.rule, finding.severity, list(finding.follows)) == (rule, "error", [])
    assert f"--machine {name}" in finding.message
    assert (report.verdict, report.not_evaluated, report.looked_at) == ("fail", [], [])


@pytest.mark.nightly
@looped(("name", "program"), [(name, program) for name, program, _ in PROGRAMS], one_in=9)
def test_a_new_job_names_the_same_machine(tmp_path: Path, name: str, program: str) -> None:
    path = tmp_path / "a.nc"
    path.write_text(program)
    found = survey.survey([str(path)], None)
    assert (found.polar, found.machine) == ([str(path)], name)


@pytest.mark.nightly
@looped(("name", "program", "rule"), PROGRAMS, one_in=4)
def test_a_lathe_that_is_chosen_is_checked_as_such(name: str, program: str, rule: str) -> None:
    of_own, of_default = report_of(program, name), report_of(program, job={"machine": "fanuc"})
    assert rule not in {finding.rule for finding in of_own.findings}
    assert f"--machine {name}" not in "".join(finding.message for finding in of_default.findings)
    assert of_own.looked_at
    assert of_default.looked_at


G12 = "O1\nG98 G0 X60. C0\nT0808\nG12.1\n{}\nG13.1\nM30\n"


@pytest.mark.ci
@looped(
    "moves",
    [
        "G1 G42 X40. F100\nY10.\nC-10.\nG40 X60.",  # one slip in a program of this lathe
        "G1 G42 X40. F100\nC10.\nX\nG40 X60.",
        "G1 G42 X40. F100\nC10.\nX F200 (G17 XC)\nG40 X60.",
        "G1 G42 X40. F100\nC10.\nG17 XC\nX\nG40 X60.",
    ],
)
def test_what_no_machine_reads_well_is_told_with_all_the_rest(moves: str) -> None:
    report = report_of(G12.format(moves))
    assert report.looked_at
    assert report.not_evaluated
    assert "it reads well on" not in "".join(finding.message for finding in report.findings)


@looped(
    ("block", "machine", "hint"),
    [
        ("WAITM( )", "fanuc", "WAITM is a word of siemens-iso and siemens-transmit (--machine)"),
        ("N5 WAITM(1,1,2)", "mazak-eia", "WAITM is a word of siemens-iso and siemens-transmit (--machine)"),
        ("setms(2)", "haas-lathe", "SETMS is a word of siemens-iso and siemens-transmit (--machine)"),
        ("G17 XC", "fanuc-30i", "G17 XC is a word of mazak-eia, mazak-integrex and mazak-quick-turn (--machine)"),
        ("G1 X F100", "fanuc", ""),
        ("G1 X F100 (WAITM)", "fanuc", ""),
        ("X. G17", "fanuc", ""),
    ],
)
def test_a_word_of_another_control_is_named(block: str, machine: str, hint: str) -> None:
    report = report_of(f"O1\nT0101\n{block}\nG0 X60. Z5.\nM30\n", machine)
    (finding,) = (one for one in report.findings if one.rule == "bad-number")
    assert finding.message.endswith(f": no digits after the address{hint and '; '}{hint}")


def test_a_long_line_is_searched_for_words_near_the_fault_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    """A line of 12 MB would be searched for each word of each machine."""
    lengths = []

    def stands_in(text: str, word: str) -> bool:
        lengths.append(len(text))
        return translation.stands_in(text, word)

    monkeypatch.setattr(other_machine, "stands_in", stands_in)
    report = report_of(f"O1\nT0101\n{'X1.' * 9000} WAITM( ) {'X1.' * 9000}\nG0 X60. Z5.\nM30\n", "fanuc")
    (finding,) = (one for one in report.findings if one.rule == "bad-number")
    assert "; WAITM is a word of siemens-iso" in finding.message
    assert lengths
    assert max(lengths) < 10_000
