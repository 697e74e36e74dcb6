"""A program for another machine is never green: codes that begin the polar mode elsewhere, and one finding for them."""

from __future__ import annotations

import functools
import itertools
from collections.abc import Iterator
from pathlib import Path

import pytest
from cases import looped
from programs import ROOT, machine_of, report_of, said, tables_of

from polarcheck.checking import survey
from polarcheck.columns.modes import other_mode
from polarcheck.foundation.errors import enumerated
from polarcheck.foundation.finding import FileReport, Finding
from polarcheck.program.machines import profiles

RULE = "polar-code-of-another-control"
SAMPLES = ROOT / "sample_programs"
#: Programs that a machine reads as if they were its own, beside those that it writes the same way.
WRONG = ("haas-lathe", "okuma-osp")
TURNING = "O1\nG98 G0 X60. Z2.\n{}G1 Z-10. F200\nG0 X80.\nM30\n"


def programs() -> Iterator[tuple[str, str]]:
    """Each sample program with the machine that it is for; those for a lathe of a shop lie beside its file."""
    of_machines = (path for path in sorted(SAMPLES.rglob("*.[nm]*")) if not (path.parent / "lathe.toml").exists())
    for path in of_machines:
        own = path.parent.name if path.parent != SAMPLES else profiles.DEFAULT
        yield path.relative_to(SAMPLES).as_posix(), own


def _pairs() -> Iterator[tuple[str, str, str]]:
    """
    The programs of each machine on each other machine, by turns: each program is read, and each machine reads one of
    each other. All of them took minutes.
    """
    of_machine: dict[str, list[str]] = {}
    for path, own in programs():
        of_machine.setdefault(own, []).append(path)
    for own, paths in of_machine.items():
        others = [name for name in profiles.names() if name != own]
        for number in range(max(len(paths), len(others))):
            yield paths[number % len(paths)], own, others[number % len(others)]


PAIRS = [*_pairs()]


def alike(name: str, own: str) -> bool:
    """Whether one machine begins the mode as the other writes it, in its own language too."""
    own_words = machine_of(own).control.native_words.keys() - machine_of(name).control.native_words.keys()
    return not own_words & {"TRANSMIT"} and bool({*machine_of(name).polar.on} & {*machine_of(own).polar.on})


def the_one(report: FileReport) -> Finding:
    (found,) = report.findings
    assert found.rule == RULE
    return found


def test_all_sample_programs_have_a_machine_and_there_are_enough_of_them() -> None:
    assert {own for _, own in programs()} == {*profiles.names()}
    assert {path for path, _, _ in PAIRS} == {path for path, _ in programs()}
    assert {(own, name) for _, own, name in PAIRS} == {*itertools.permutations(profiles.names(), 2)}


@functools.cache
def own_sections(path: str, own: str) -> int:
    """How many polar sections a sample program has on its own machine."""
    return len(tables_of((SAMPLES / path).read_bytes(), own)["sections"])


@functools.cache
def has_statements(path: str, own: str) -> bool:
    """Whether a sample program has statements of a language beside G code: each control reads them otherwise."""
    blocks = tables_of((SAMPLES / path).read_bytes(), own)["text"].blocks
    return machine_of(own).macro.language != "custom-macro" and bool(blocks.is_macro.any())


@pytest.mark.nightly
@looped("name", profiles.names(), one_in=20)
def test_a_program_for_another_machine_is_read_or_fails_with_one_finding(name: str) -> None:
    for path, own, other in PAIRS:
        if other != name:
            continue
        report = report_of((SAMPLES / path).read_bytes(), name, "1:radius=4", "8:radius=4", path=path)
        rules = [found.rule for found in report.findings if found.severity != "note"]
        # A control with a language of its own takes the words of another one's for statements that it does not know.
        is_spoken = machine_of(name).macro.language != "custom-macro" and report.sections < own_sections(path, own)
        # A control of the same family reads the channels as its own does.
        is_read = alike(name, own) and report.sections >= own_sections(path, own)
        if has_statements(path, own) or is_spoken or "channels" in path:
            assert report.verdict != "pass" or ("channels" in path and is_read), (path, name)
        elif report.sections < own_sections(path, own):
            assert report.verdict == "fail", (path, name)
            assert rules == [RULE], (path, name, rules)
        else:
            assert alike(name, own), (path, name)
            assert RULE not in rules, (path, name)


@pytest.mark.ci
@looped("name", WRONG, one_in=2)
@looped(
    ("program", "line"),
    [
        ("rapid_in_polar", 9),
        ("narrow_groove", 9),
        ("arc_off_circle", 9),
        ("polar_never_left", 9),
        ("ramp_too_short", 9),
        ("through_the_center", 9),
        ("c_axis_too_fast", 9),
    ],
)
def test_a_program_full_of_faults_does_not_pass_under_the_wrong_machine(program: str, line: int, name: str) -> None:
    report = report_of((SAMPLES / f"{program}.nc").read_bytes(), name, "8:radius=9.525")
    assert report.verdict == "fail"
    assert the_one(report).severity == "error"
    assert the_one(report).line == line
    polar = machine_of(name).polar
    assert f"; write {polar.on[0]}" in the_one(report).message
    assert f"{polar.off[0]} for G13.1" in the_one(report).message or program == "polar_never_left"


@pytest.mark.ci
@looped(
    ("program", "name", "machines"),
    [
        ("O1\nG98 G0 X50. Z2. C0\nG112\nG1 X40. Y5. F200\nG113\nM30\n", "okuma-osp", "haas-lathe"),
        ("O1\nG20 G98 G0 X2. C0\nG112\nG1 X1.5 C.2 F8.\nM30\n", "okuma-osp", "fanuc, gsk-988 or lsis"),
        ("O1\nG98 G0 X50. Z2. C0\nG137 C0\nG1 X40. Y5. F200\nG136\nM30\n", "fanuc", "okuma-osp"),
        ("O1\nG98 G0 X50. Z2. C0\nG137 C0\nG101 X40. Y5. F200\nM30\n", "haas-lathe", "okuma-osp"),
        ("O1\nG98 G0 X50. Z2. C0\nG137 C15.\nG136\nM30\n", "mazak-eia", "okuma-osp"),
        ("O1\nG94 G0 X50. C0\nG112\nG1 X40. F200\nG113\nM30\n", "siemens-transmit", "fanuc, gsk-988"),
        ("O1\nG98 G0 X50. C0\nG12.1 E2.\nG1 X40. C5. F200\nG13.1\nM30\n", "haas-lathe", "gsk-988"),
        ("O1\nG98 G0 X50. C0\nG12.1 D0 E=C\nG1 X40. Y5. F200\nG13.1\nM30\n", "lsis", "citizen"),
        ("G0 X60 Y0\nTRANSMIT\nG1 X40 Y5 F9\nTRAFOOF\nM30\n", "fanuc", "siemens-transmit"),
        ("G0 X60 Y0\nDIAMOF\ntransmit(1)\nG3 X40 Y5 CR=9\nTRAFOOF\nDIAMON\nM30\n", "haas-lathe", "siemens-transmit"),
    ],
    one_in=2,
)
def test_the_machines_that_know_the_code_are_named(program: str, name: str, machines: str) -> None:
    """Only where nobody has chosen a machine: the code is to be changed on a lathe that is there."""
    found = the_one(report_of(program, name))
    assert found.severity == "error"
    assert ("--machine" in found.message) == (name == "fanuc")
    assert enumerated(known(program, name)[:3], "or").startswith(machines)


def known(program: str, name: str) -> list[str]:
    """The machines that know the code with which a program begins the mode of another control."""
    table = tables_of(program, name)["other_mode"]
    return [profile.name for profile in table.machines(int(table.begins.argmax()))]


def test_no_machine_is_named_for_a_code_that_its_own_files_do_not_have() -> None:
    """On siemens-transmit G12.1 is what TRANSMIT is read as."""
    assert known(TURNING.format("G12.1\n"), "haas-lathe")[:3] == ["fanuc", "gsk-988", "mazak-eia"]
    turned = known("O1\nG98 G0 X50. C0\nG12.1\nG1 X40. Y5. F200\nG13.1\nM30\n", "haas-lathe")
    assert "siemens-transmit" not in turned


WRITTEN = "O1\nG0 X50. C0\n{}\nG1 X40. {}5. F200\n{}\nM30\n"


@pytest.mark.ci
@looped(
    ("words", "name", "remedy"),
    [
        (("G12.1", "Y", "G13.1"), "haas-lathe", "G112 for G12.1 and G113 for G13.1"),
        (("G12.1", "C", "G13.1"), "haas-lathe", "G112 for G12.1, G113 for G13.1 and Y for C"),
        (("G12.1", "Y", "G113"), "haas-lathe", "G112 for G12.1"),
        (("G137 C0", "Y", "G136"), "haas-lathe", "G112 for G137 and G113 for G136"),
        (("G112", "Y", "G113"), "okuma-osp", "G137 C0 for G112 and G136 for G113"),
        (("G112", "Y", "G113"), "siemens-transmit", "TRANSMIT for G112 and TRAFOOF for G113"),
        (("TRANSMIT", "Y", "TRAFOOF"), "haas-lathe", "G112 for TRANSMIT and G113 for TRAFOOF"),
        (("G112", "Y", "G113"), "mazak-quick-turn", "G12.1 for G112, G13.1 for G113, C for Y and X as a diameter"),
        (("G137 C0", "Y", "G136"), "citizen", "G12.1 for G137 and G13.1 for G136"),
    ],
)
def test_on_a_lathe_that_is_chosen_the_code_is_to_be_changed(
    words: tuple[str, str, str], name: str, remedy: str
) -> None:
    """As on the command line, where the job holds the machine, too; on FANUC that alone tells that it was chosen."""
    program = WRITTEN.format(*words)
    found = [one for one in report_of(program, name, "1:radius=4").findings if one.rule == RULE]
    assert [one.message.partition("; write ")[2] for one in found] == [remedy]


def test_a_default_machine_that_somebody_names_is_chosen_all_the_same() -> None:
    program = WRITTEN.format("G137 C0", "Y", "G136")
    assert "check it with --machine okuma-osp" in the_one(report_of(program)).message
    chosen = the_one(report_of(program, job={"machine": "fanuc"})).message
    assert chosen.endswith("; write G12.1 for G137, G13.1 for G136, C for Y and X as a diameter")


@looped(("code", "name"), [("G137", "fanuc"), ("G112", "okuma-osp"), ("G12.1", "haas-lathe"), ("G112", "mazak-eia")])
def test_a_code_that_stands_alone_may_be_a_macro(code: str, name: str) -> None:
    report = report_of(TURNING.format(f"{code}\n"), name)
    assert the_one(report).severity == "warning"
    assert "macro of the builder" in the_one(report).message
    (entry,) = report.not_evaluated
    assert f"{code} in line 3" in entry.reason
    assert "--machine" in entry.reason


def test_where_statements_have_names_a_word_of_another_control_is_told_by_its_own() -> None:
    report = report_of(TURNING.format("TRANSMIT\n"), "okuma-osp")
    assert report.verdict == "unverified"
    assert "TRANSMIT is not simulated" in [entry.reason for entry in report.not_evaluated]


@looped("name", ["fanuc", "haas-lathe", "mazak-eia"])
def test_a_word_that_stands_alone_is_no_macro(name: str) -> None:
    report = report_of(TURNING.format("TRANSMIT\n"), name)
    assert report.verdict == "fail"
    assert the_one(report).severity == "error"
    remedy = {"fanuc": "check it with --machine siemens-transmit", "haas-lathe": "write G112 for TRANSMIT"}
    assert the_one(report).message.endswith(remedy.get(name, "write G12.1 for TRANSMIT"))
    assert report.not_evaluated == []


def test_what_follows_behind_the_next_tool_or_in_a_section_of_this_control_tells_nothing() -> None:
    section = "G0 X60. C0\nG12.1\nG1 X40. F200\nC10.\nX60.\nG13.1\nG0 Z50.\n"
    found = [one for one in report_of(TURNING.format(f"G137\n{section}")).findings if one.rule == RULE]
    assert [one.severity for one in found] == ["warning"]
    turning = TURNING.format("T0101\nG137\nT0202\nG1 C90. F500\n")
    assert [(one.rule, one.severity) for one in report_of(turning).findings] == [(RULE, "warning")]


def test_one_finding_stands_for_the_program() -> None:
    section = "G0 X60. C0\nG137 C0\nG101 X40. Y5. F200\nG136\n"
    assert said(report_of(TURNING.format(section * 3))) == [(4, RULE)]
    assert the_one(report_of(TURNING.format(f"G137\n{section}"))).line == 5


@looped(
    ("program", "name"),
    [
        ("O1\nG0 X20. Z2.\nG112 X24. Z-8. L4. F1.5\nG113 X20. Z-12. L4. F1.5\nM30\n", "okuma-osp"),
        ("N10 G0 X20 Z2\nN20 G112 X10 Y5\nN30 M30\n", "siemens-transmit"),
        ("O1 (NOT FOR TRANSMIT)\nG0 X20. Z2.\n(G137 C0)\nM30\n", "fanuc"),
    ],
)
def test_a_code_in_its_own_meaning_is_none_of_another_control(program: str, name: str) -> None:
    assert RULE not in {found.rule for found in report_of(program, name).findings}


@looped("skipped", ["/G137 C0\n", "/G137 C0\n/G136\n"])
def test_a_skipped_code_is_said_once(skipped: str) -> None:
    report = report_of(TURNING.format(skipped))
    assert [(one.line, one.rule) for one in report.findings] == [(3, RULE)]
    assert report.findings[0].message.endswith("(with block skip off)")


def test_a_code_with_a_computed_word_is_seen() -> None:
    program = "O1\n#1=15.\nG98 G0 X50. Z2.\nG137 C#1\nG1 X40. Y5. F200\nG136\nM30\n"
    assert said(report_of(program)) == [(4, RULE)]


def test_only_a_program_with_such_a_code_makes_other_machines_be_looked_at(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[str] = []
    monkeypatch.setattr(other_mode, "known_by", lambda name: asked.append(name) or ())
    report_of((SAMPLES / "hexagon.nc").read_bytes(), "fanuc", "8:radius=4")
    assert asked == []
    report_of((SAMPLES / "hexagon.nc").read_bytes(), "haas-lathe", "8:radius=4")
    assert asked == ["G12.1"]


def test_an_unknown_code_elsewhere_is_still_said() -> None:
    program = "O1\nG98 G0 X50. C0\nG137 C0\nG101 X40. Y5. F200\nG136\nG12.11\nX F5\nM30\n"
    of_chosen = report_of(program, job={"machine": "fanuc"})
    assert said(of_chosen) == [(3, RULE), (6, "unknown-code"), (7, "bad-number")]


def test_every_code_that_begins_the_mode_is_known_everywhere() -> None:
    listed = set(machine_of().polar.on_of_other_controls)
    for name in profiles.names():
        machine = machine_of(name)
        words = machine.control.native_words
        assert {code for code in machine.polar.on if code != words.get("G16 XC")} <= listed, name
        assert {word for word, code in words.items() if code in machine.polar.on} <= listed, name
        assert set(machine.polar.on_of_other_controls) == listed, name


# ---- cylindrical interpolation ----


@looped(
    ("code", "blocks", "name"),
    [
        ("G7.1 C20.\nG1 G41 C30. F200\nZ-5.\nG7.1 C0\n", 3, "fanuc"),
        ("G20\nG107 C.75\nG1 C30. F8.\nG107 C0\n", 2, "fanuc-30i"),
        ("G107 C0 Q2.5\nG1 C30. F8.\nG107\n", 2, "haas-lathe"),
    ],
)
def test_cylindrical_interpolation_is_not_simulated(code: str, blocks: int, name: str) -> None:
    report = report_of(TURNING.format(f"T0101\n{code}"), name)
    told = [entry for entry in report.not_evaluated if "cylindrical interpolation" in entry.reason]
    assert [entry.blocks for entry in told] == [blocks]
    assert f"from line {4 + code.startswith('G20')} on" in told[0].reason
    assert report.verdict != "pass"


@looped("code", ["G7.1 C0\n", "G107\n", ""])
def test_a_program_that_only_cancels_it_is_simulated(code: str) -> None:
    assert report_of(TURNING.format(code)).verdict == "pass"


MAPPED = "O1\nG94 G0 X40. C0\n{}\nG17\nG1 X20. Y5. F300\nY-5.\n{}\nM30\n"


@pytest.mark.ci
@looped("name", ["fanuc", "haas-lathe", "okuma-osp", "doosan", "siemens-transmit"], one_in=3)
@looped(("on", "off"), [("G101", "G109"), ("G105", "G110"), ("N9 G101", "N20 G109"), ("G101", "G103")])
def test_a_map_with_its_moves_and_its_end_is_the_mode_of_another_control(on: str, off: str, name: str) -> None:
    report = report_of(MAPPED.format(on, off), name)
    told = [found for found in report.findings if found.rule == RULE]
    if off == "G103":  # which does something else on each of them
        assert not told
    else:
        assert [found.severity for found in told] == ["error"]
        assert known(MAPPED.format(on, off), name) == ["hurco"]


def test_a_map_in_one_program_makes_no_map_of_a_macro_in_another() -> None:
    macro = "O1\nG101\nG1 X50. F200\nM30\n"
    report = report_of(macro + MAPPED.format("G101", "G109").replace("O1", "O2"), "fanuc")
    assert [found.line for found in report.findings if found.rule == RULE] == [7]


@pytest.mark.nightly
@looped("name", ["fanuc", "haas-lathe", "doosan"])
@looped(
    ("on", "off"),
    [
        ("G101", "G80"),  # a macro of the builder, and a real Y axis
        ("G105 X10. P1", "G109"),  # the bar feeder
        ("G101 X0", "G100 X0"),  # mirror image
        ("G101 A1. B2.", "G109"),
        ("G1 G101", "G110"),
    ],
)
def test_a_macro_of_the_builder_is_no_map(on: str, off: str, name: str) -> None:
    report = report_of(MAPPED.format(on, off), name)
    assert RULE not in {found.rule for found in report.findings}
    assert not [reason for reason in report.not_evaluated if "polar mode on another" in reason.reason]


# ---- where nobody has said which machine it is ----

OKUMA = """O1000
NAT01 G0 X200 Z200 (NOTE)
T080808
SB=1500 M13
VC1=5
G94 G0 X60 Z2 C0
G137 C0
G101 X40. Y0 F500
G101 X=VC1*2 Y10.
G103 X-40. Y-10 L5
G136
CALL OABC
M2
"""
SIEMENS = """T="MILL8" D1 ; 8 MM
SETMS(2)
S2000 M3
SPOS[1]=0
TRANSMIT
G1 X12 Y0 F200
Y10
TRAFOOF
MSG("READY")
M30
"""
FAGOR = "G90 G94\nG15\nG16 XC\n#(1)=2\nG1 G42 X30 C0 F200\nC10\nG40 X40\nG15\nM30\n"


@pytest.mark.ci
@looped(("program", "name"), [(OKUMA, "okuma-osp"), (SIEMENS, "siemens-transmit"), (FAGOR, "fagor-8055t")], one_in=1)
def test_nothing_is_told_but_which_machine_it_is_for(program: str, name: str) -> None:
    report = report_of(program)
    assert [one.rule for one in report.findings] == [RULE]
    assert report.findings[0].message.endswith(f"check it with --machine {name}")
    assert (list(report.findings[0].follows), report.not_evaluated, report.looked_at) == ([], [], [])
    chosen = report_of(program, job={"machine": "fanuc"})
    assert len(chosen.findings) > 1


@pytest.mark.nightly
@looped(("program", "name"), [(OKUMA, "okuma-osp"), (SIEMENS, "siemens-transmit"), (FAGOR, "fagor-8055t")], one_in=1)
def test_a_new_job_names_the_same_machine(tmp_path: Path, program: str, name: str) -> None:
    path = tmp_path / "a.nc"
    path.write_text(program, "utf-8")
    found = survey.survey([str(path)], None)
    assert (found.polar, found.machine, found.fitting[:1]) == ([str(path)], name, [name])
