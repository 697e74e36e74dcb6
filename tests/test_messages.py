"""What messages say: the words as written, the numbers that differ, the addresses of the machine."""

from __future__ import annotations

import re

import pytest
from cases import looped
from programs import Changes, report_of

#: The coverage counts all of its cases: each is a way of its own through the package.
pytestmark = pytest.mark.one_in(1)

HEAD = "O1\nG21 G40 G97 G98 G18\nT0101\nG0 X50. Z2. C0\n"
TAIL = "\nG13.1\nM30\n"


def message(
    program: str,
    rule: str,
    machine: str = "fanuc",
    *tools: str,
    changes: Changes | None = None,
    job: Changes | None = None,
) -> str:
    """The one message of a rule."""
    report = report_of(program, machine, *tools, changes=changes, job=job)
    every = [one for finding in report.findings for one in (finding, *finding.follows)]
    found = [finding.message for finding in every if finding.rule == rule]
    assert len(found) == 1
    return found[0]


def polar(*blocks: str, head: str = HEAD) -> str:
    return f"{head}G12.1\n" + "\n".join(blocks) + TAIL


# ---- words as they are written ----


@pytest.mark.ci
@looped(
    ("block", "said"),
    [
        ("X10. X20.", "X is written twice in this block: X10. and X20.;"),
        ("C.5 X3. C - .25", "C is written twice in this block: C.5 and C-.25;"),
        ("X1. X2. X3.", "X is written 3 times in this block: X1., X2. and X3.;"),
        ("X1. X2. X3. X4. X5. X6.", "X is written 6 times in this block: X1., X2., X3., ... and X6.;"),
        ("X10. ,R1. ,R2.", ",R is written twice in this block: ,R1. and ,R2.;"),
    ],
)
def test_a_word_that_is_repeated_is_told_as_written(block: str, said: str) -> None:
    for machine in ("fanuc", "haas-lathe"):
        assert message(f"O1\nG0 {block}\nM30\n", "word-repeated", machine).startswith(said)


@pytest.mark.ci
def test_what_is_long_is_cut_off() -> None:
    long = "1" + "0" * 200
    assert message(f"O1\nG0 X{long}.\nM30\n", "too-many-digits") == f"X{long[:39]} ... has more than 9 digits"
    assert len(message(f"O1\nG0 X{long}..\nM30\n", "bad-number")) < 80
    comment = "3/4 DIA. CUTTER" + " FOR THE SQUARE" * 20
    head = HEAD.replace("T0101", f"({comment})\nT0101")
    program = polar("G1 G42 X40. F200", "C-20.", "G40 X80.", head=head)
    said = message(program, "radius-from-comment", job={"radius_from_comments": True})
    assert said.endswith("comment: 3/4 DIA. CUTTER FOR THE SQUARE FOR THE S ...")
    words = " ".join(f"{address}1.5" for address in "ABDEIJKUVW")
    assert "shares its block with A1.5 B1.5 D1.5 E1.5 I1.5 J1.5 and 4 more;" in message(
        f"{HEAD}G12.1 {words}\nG1 X40. F200{TAIL}", "polar-switch-not-alone"
    )


# ---- numbers ----


@pytest.mark.ci
@looped(
    ("feed", "limit", "said"),
    [
        ("1525", 1500, "F is 1525 mm/min, FANUC lathe control clamps it at 1500 mm/min"),
        ("1525.5", 1500, "F is 1525.5 mm/min,"),
        ("1525.", 1524.9999, "F is 1525 mm/min, FANUC lathe control clamps it at 1524.9999 mm/min"),
    ],
)
def test_a_programmed_feed_is_shown_as_it_is(feed: str, limit: float, said: str) -> None:
    changes = {"limits": {"polar_feed": limit}}
    assert message(polar(f"G1 X40. F{feed}", "C5."), "feed-above-polar-limit", changes=changes).startswith(said)


def test_a_programmed_feed_of_an_inch_program_is_shown_as_it_is() -> None:
    program = polar("G1 X1.5 F60.255", "C.2", head=HEAD.replace("G21", "G20").replace("X50.", "X2."))
    said = message(program, "feed-above-polar-limit", changes={"limits": {"polar_feed": 1500}})
    assert said.startswith("F is 60.255 inch/min, FANUC lathe control clamps it at 59.0551 inch/min")


@pytest.mark.ci
@looped(
    ("feed", "machine", "rate", "highest"),
    [
        ("125.67", "fanuc", "3600.2 deg/min with F125.67, FANUC lathe control allows 3600;", "125 mm/min"),
        ("125.664", "haas-lathe", "3600.01 deg/min with F125.664, Haas lathe allows 3600;", "125 mm/min"),
        ("127.", "fanuc", "3638 deg/min with F127., FANUC lathe control allows 3600;", "125 mm/min"),
    ],
)
def test_a_rate_and_its_limit_are_told_apart(feed: str, machine: str, rate: str, highest: str) -> None:
    program = polar("G1 X4. C5. F100", f"C-5. F{feed}")
    if machine == "haas-lathe":
        program = (
            program.replace("X4. C5.", "X2. Y5.").replace("C-5.", "Y-5.").replace("12.1", "112").replace("13.1", "113")
        )
    said = message(program, "c-feed-above-limit", machine, changes={"limits": {"c_feed": 3600}})
    assert said.startswith(f"C axis would turn at {rate}")
    assert said.endswith(f"highest F here: {highest}")


@pytest.mark.ci
def test_a_length_and_its_limit_are_told_apart() -> None:
    program = polar("G1 X40. F200", "C0", "X60.0002")
    said = message(program, "travel-limit", changes={"limits": {"x_maximum": 30.0}})
    assert said == "X would go to 60.0002 mm, its travel ends at 60 mm"
    program = polar("G1 X40. F200", "C10.", "X70.", head=HEAD.replace("X50.", "X75.9998"))
    said = message(program, "approach-inside-stock", "fanuc", "1:diameter=16", job={"stock": {"diameter": 60}})
    assert said == "X stands at 75.9998 mm at G12.1, since line 4; stock 60 mm and cutter 16 mm need 76 mm or more"


def test_the_clearance_is_named() -> None:
    program = polar("G1 X40. F200", "C10.", "X77.", head=HEAD.replace("X50.", "X77."))
    job = {"stock": {"diameter": 60, "clearance": 2}}
    assert message(program, "approach-inside-stock", "fanuc", "1:diameter=16", job=job) == (
        "X stands at 77 mm at G12.1, since line 4; stock 60 mm, cutter 16 mm and clearance 2 mm need 78 mm or more"
    )


@pytest.mark.ci
def test_a_ramp_and_its_radius_are_told_apart() -> None:
    program = polar("G1 G42 X72.0002 F200", "C10.", "G40 C14.", head=HEAD.replace("X50.", "X80."))
    assert message(program, "start-up-shorter-than-radius", "fanuc", "1:radius=4") == (
        "start-up moves 7.9998 mm in X on the diameter; with R 4 mm it needs 8 mm in X on the diameter; "
        "it begins at X80 C0 of line 4"
    )
    program = program.replace("X72.0002", "X70.")
    said = message(program, "cancel-shorter-than-radius", "fanuc", "1:radius=4.0001")
    assert said == "offset cancel moves 4 mm in C; with R 4.0001 mm it needs 4.0001 mm in C"


# ---- since when, and what leads nowhere ----


@pytest.mark.nightly
@looped(
    ("blocks", "said"),
    [
        ("T0202\nG0 X60.\nT0404\nG0 Z2. C0", "X is not known since T0404 in line 5;"),
        ("T0202\nG0 X60.\nG28 U0\nG0 Z2. C0", "X is not known since G28 U0 in line 5;"),
        ("G0 X60.\nT0404\nG30 U0.\nG0 Z2. C0", "X is not known since G30 U0. in line 5;"),
        ("G0 Z2. C0", "X has not been positioned in this program;"),
    ],
    one_in=2,
)
def test_since_when_x_is_not_known(blocks: str, said: str) -> None:
    program = polar("G1 X40. F200", "C10.", "X60.", head=f"O1\nG21 G40 G97 G98 G18\n{blocks}\n")
    assert message(program, "x-unknown-at-entry").startswith(said)
    inch = program.replace("G21", "G20").replace("12.1", "112").replace("13.1", "113")
    assert message(inch, "x-unknown-at-entry", "doosan").startswith(said)


# ---- where, and by which address ----


@looped(
    ("program", "places"),
    [
        ("HELLO\n%\nO1\nM30\n%\nAFTER\n", [(1, "HELLO"), (6, "AFTER")]),
        ("\n \nHELLO\n%\nO1\nM30\n%\n\nAFTER\nMORE\n", [(3, "HELLO"), (9, "AFTER")]),
        ("%\r\nO1\r\nM30\r\n%\r\nCHECK 2\r\n", [(5, "CHECK 2")]),
        ("%\rO1\rM30\r%\r  LAST\r", [(5, "LAST")]),
        ("%\nTITLE\nO1\nM30\n%", [(2, "TITLE")]),
    ],
)
def test_text_outside_a_program_is_shown_where_it_stands(program: str, places: list[tuple[int, str]]) -> None:
    report = report_of(program, only=["text-outside-program"])
    assert [(finding.line, finding.block) for finding in report.findings] == places


@pytest.mark.ci
@looped(("machine", "on", "off", "axis"), [
    ("fanuc", "G12.1", "G13.1", "C"), ("haas-lathe", "G112", "G113", "Y"), ("okuma-osp", "G137", "G136", "Y"),
])  # fmt: skip
def test_the_virtual_axis_has_the_address_of_the_machine(machine: str, on: str, off: str, axis: str) -> None:
    radius = "L" if machine == "okuma-osp" else "R"
    program = f"{HEAD}{on}\nG1 X20. F200\nX10. {axis}5. Z-1.\nG18\nG2 Z-5. {radius}10.\n{off}\nM30\n"
    said = {finding.rule: finding.message for finding in report_of(program, machine).findings}
    assert said["plane-selected-in-polar"].startswith(
        f"G18 in the polar mode: its plane is always that of X and {axis};"
    )
    # Where Z moves together with the plane it is a note with G41 or G42 alone.
    assert f"X10. {axis}5. Z-1." in said.get("z-with-plane-axis", "") or machine in ("haas-lathe", "okuma-osp")
    assert said["arc-off-polar-plane"].startswith(
        f"arc along Z; in the polar mode arcs lie in the plane of X and {axis}"
    )


@pytest.mark.nightly
@looped(
    ("machine", "on", "off", "axis"),
    [
        ("fanuc", "G12.1", "G13.1", "C"),
        ("haas-lathe", "G112", "G113", "Y"),
        ("siemens-transmit", "TRANSMIT", "TRAFOOF", "Y"),
    ],
    one_in=2,
)
def test_a_point_of_the_plane_has_the_words_of_the_machine(machine: str, on: str, off: str, axis: str) -> None:
    ends = [
        ("20.", "0"),
        ("20.", "20."),
        ("20.", "-20."),
        ("-20.", "20."),
        ("-20.", "-20."),
        ("20.", "-20."),
        ("20.", "0"),
    ]
    contour = "\n".join(f"G1 X{x} {axis}{y} F200." for x, y in ends)
    program = f"T1 D1\nG94 G97\nG0 X100. C0 Z5.\n{on}\nG42\n{contour}\nG40 X100.\n{off}\nM30\n"
    said = message(program, "contour-crosses-itself", machine, "1:radius=3")
    assert re.search(rf" at X[0-9.]+ {axis}[0-9.]+", said), said


@pytest.mark.ci
@looped(("machine", "said"), [("fanuc", "arc without R, I or J"), ("okuma-osp", "arc without L, I or J")])
def test_an_arc_has_the_addresses_of_the_machine(machine: str, said: str) -> None:
    program = f"{HEAD}G12.1\nG1 X40. F200\nG2 X20.\n{TAIL}"
    if machine == "okuma-osp":
        program = program.replace("12.1", "137").replace("13.1", "136")
    assert message(program, "arc-without-center", machine) == said
