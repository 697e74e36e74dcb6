"""What mills touch on their way to a place, and sections that cut nothing: the bar, the part and the rules on them."""

from __future__ import annotations

from typing import Any

import pytest
import shapely  # type: ignore[import-untyped]
from cases import looped
from programs import report_of

from polarcheck.geometry.polygons import areas

HEAD = "G21 G98 G40/T0101/G28 H0/G97 S3000 M13/G0 X60. Z2. C0/G12.1/G1 X60. F1500/Z-5."
HEXAGON = "C8.66/X0 C17.321/X-30. C8.66/C-8.66/X0 C-17.321/X30. C-8.66/C0"
END = "G40 X60. F1500/Z2./G13.1/G0 X100. Z50./M30"
CONTOUR = f"G42 X30. C0 F200/{HEXAGON}"
HOLE = "G0 X26. Z2. C0/G12.1/G1 X26. F500/Z-4. F40/G41 X34. F80/G3 I-4./G1 G40 X26."
TURNING = "T0303/G97 S1500 M3/G0 X42. Z2. G99/G1 Z0 F0.2/X-1.6/G0 X40. Z1./G1 Z-30./X44./G0 X100. Z50./M5"


def found(program: str, radius: float = 4, **job: object) -> dict[str, str]:
    """Rule and severity of the findings that count, of blocks parted by `/`."""
    blocks = f"O1\n{program.replace('/', chr(10))}\n"
    report = report_of(blocks, "fanuc-30i", f"1:radius={radius},nose=0", job=job or None)
    return {finding.rule: finding.severity for finding in report.findings if finding.severity != "note"}


def bar(diameter: float, **more: object) -> dict[str, object]:
    return {"stock": {"diameter": diameter, **more}}


def test_a_hexagon_is_sound() -> None:
    assert found(f"{HEAD}/{CONTOUR}/{END}") == {}
    assert found(f"{HEAD}/{CONTOUR}/{END}", **bar(40)) == {}


@looped(("feed", "expected"), [(" F1500", {}), ("", {"cut-in-air": "warning"})])
def test_the_way_between_two_cuts_of_one_compensation_is_no_cut(feed: str, expected: dict[str, str]) -> None:
    flats = f"C-20./Z-5./G42 X28. C-16. F200/C20./Z2.{feed}/X-28. C20./Z-5./C-20. F200/G40 X-60. C-22. F1500/Z2."
    assert found(f"{HEAD.removesuffix('/Z-5.')}/{flats}/G13.1/G0 X100. Z50./M30") == expected


@pytest.mark.ci
@looped(("x", "expected"), [("54.", {}), ("44.", {"approach-inside-stock": "error"})])
def test_beyond_the_turned_bar_no_wall_stands(x: str, expected: dict[str, str]) -> None:
    """Two flats, each longer than the spigot of 31 mm is wide: beside it the line of the other is in the air."""
    turning = "T0303/G97 S1500 M3/G0 X31. Z2. G99/G1 Z-17. F0.2/X34./G0 X100. Z50./M5/T0101/G98/G28 H0/G97 S3000 M13"
    flat = "G12.1/G1 C-22. F800/X40./G42 X20. F80/C22./G40 X40. F800/G13.1/G0 Z2."
    program = f"G21/{turning}/G0 X{x} Z2. C0/Z-5./{flat}/C90./X54./Z-5./{flat}/X100. Z50./M30"
    assert found(program, 8) == expected


@pytest.mark.nightly
@looped("job", [{}, bar(40), bar(60)], one_in=3)
def test_an_index_with_the_cutter_in_a_hole_goes_through_the_part(job: dict[str, object]) -> None:
    program = f"G21 G98 G40/T0101/G97 S3000 M13/{HOLE}/{{retract}}G13.1/G0 C120./Z50./X100./M30"
    assert found(program.format(retract="Z2./"), 2.5, **job) == {}
    assert found(program.format(retract=""), 2.5, **job) == {"rapid-through-part": "error"}
    assert found(program.format(retract="").replace("C120.", "X60."), 2.5, **job) == {
        "uncompensated-cut-into-part": "error"
    }


START = "G21 G98 G40/T0101/G97 S3000 M13"
CENTER = "G0 X0 Z2. C0/G12.1/G1 X0 F500/Z-4. F40/G41 X8. F80/G3 I-4./G1 G40 X0/Z2./G13.1"


@pytest.mark.ci
def test_walls_are_widened_one_by_one(monkeypatch: pytest.MonkeyPatch) -> None:
    """GEOS takes a thousand times as long for all chords of an arc in one go, where their parallels all but meet."""
    together: list[bool] = []

    def buffer(geometry: Any, *arguments: Any, **how: Any) -> Any:
        together.append(bool((shapely.get_type_id(geometry) == shapely.GeometryType.MULTILINESTRING).any()))
        return plain_buffer(geometry, *arguments, **how)

    plain_buffer = areas.buffer
    monkeypatch.setattr(areas, "buffer", buffer)
    program = f"G21 G98 G40/T0101/G97 S3000 M13/{HOLE}/G13.1/G0 C120./Z50./X100./M30"
    assert found(program, 2.5) == {"rapid-through-part": "error"}
    assert together
    assert not any(together)


def test_a_part_is_gone_through_far_from_its_center_too() -> None:
    """A hole on the center is milled before the one that the cutter stays in."""
    program = f"{START}/{CENTER}/{HOLE}/{{retract}}G13.1/G0 C120./Z50./X100./M30"
    assert "rapid-through-part" not in found(program.format(retract="Z2./"), 2.5)
    assert found(program.format(retract=""), 2.5)["rapid-through-part"] == "error"


@pytest.mark.nightly
def test_where_the_face_is_not_known_the_part_stands_up_to_its_contours() -> None:
    """The origin lies at the back: one hole is milled down to Z25, the other down to Z10."""
    center = CENTER.replace("Z2.", "Z32.").replace("Z-4.", "Z25.")
    hole = HOLE.replace("Z2.", "Z32.").replace("Z-4.", "Z10.")
    program = f"{START}/{center}/{hole}/{{retract}}/G13.1/G0 C120./Z50./X100./M30"
    assert "rapid-through-part" not in found(program.format(retract="Z15."), 2.5)
    assert found(program.format(retract="Z9."), 2.5)["rapid-through-part"] == "error"


def test_of_a_mill_along_z_all_is_evaluated() -> None:
    slot = f"{START}/G0 X24. Z2. C0/Z-3./G12.1/G1 X10. F200/X24./Z2. F1000/G13.1/G0 Z50./M30".replace("/", "\n")
    report = report_of(slot, "fanuc-30i", "1:radius=4,nose=0", job=bar(40))
    assert ([one.rule for one in report.findings], report.not_evaluated) == (["rapid-plunge-into-stock"], [])


@pytest.mark.nightly
def test_a_rapid_plunge_needs_a_bar() -> None:
    slot = "G21 G98 G40/T0101/G97 S3000 M13/G0 X24. Z2. C0/{plunge}/G12.1/G1 X10. F200/X24./Z2. F1000/G13.1/G0 Z50./M30"
    assert found(slot.format(plunge="Z-3.")) == {}
    assert found(slot.format(plunge="Z-3."), **bar(40)) == {"rapid-plunge-into-stock": "error"}
    assert found(slot.format(plunge="G1 Z-3. F60"), **bar(40)) == {}
    turned = slot.replace("T0101", f"{TURNING}/T0101/G98", 1)
    assert found(turned.format(plunge="Z-3.")) == {"rapid-plunge-into-stock": "error"}
    assert found(turned.format(plunge="G1 Z-3. F60")) == {}
    assert found(turned.format(plunge="Z-3."), stock={"unknown": True}) == {}


def test_what_is_milled_off_is_no_longer_in_the_way() -> None:
    """The second pass of a slot is entered in rapid traverse down to the first one."""
    slot = (
        "G21 G98 G40/T0101/G97 S3000 M13/G0 X24. Z2. C0/G1 Z-3. F60/G12.1/G1 X10. F200/X24./Z2. F1000/G13.1/"
        "G0 Z{first}/G1 Z-6. F60/G12.1/G1 X10. F200/X24./Z2. F1000/G13.1/G0 Z50./M30"
    )
    assert found(slot.format(first="-2.5"), **bar(40)) == {}
    assert found(slot.format(first="-4.5"), **bar(40)) == {"rapid-plunge-into-stock": "error"}


# ---- the bar ----


@pytest.mark.nightly
@looped(
    ("turning", "diameter", "face"),
    [
        ("G0 X42. Z2. G99/G1 Z0 F0.2/X-1.6/G0 X40. Z1./G1 Z-30./X44.", 40, 0),
        ("G0 X42. Z2./G94 X-1.6 Z0 F.2/G90 X38. Z-30. F.2/X36.", 36, 0),
        (
            "G0 X42. Z2./G71 U1.5 R0.5/G71 P100 Q200 U0.5 W0.1 F.2/N100 G0 X34./G1 Z-30./N200 X44./G70 P100 Q200",
            34,
            None,
        ),
        # Boring: the tool moves towards the center behind a cut along Z.
        ("G0 X20. Z2. G99/G1 Z-30. F0.2/X19./G0 Z2.", None, None),
        # A spigot: the smaller diameter is what stands for certain.
        ("G0 X42. Z2. G99/G0 X30. Z1./G1 Z-3. F0.2/X40./Z-30./X44.", 30, None),
    ],
)
def test_the_bar_that_is_turned(turning: str, diameter: float | None, face: float | None) -> None:
    program = f"O1/T0303/G97 S1500 M3/{turning}/G0 X100. Z50. M5/T0101/G98/G28 H0/G0 X60. Z2. C0/G12.1/G1 Z-5. F500/"
    program += f"{CONTOUR}/G40 X60. F1500/Z2./G13.1/G0 Z50./M30"
    stock = report_of(program.replace("/", "\n"), "fanuc-30i", "1:radius=4,nose=0").stock
    assert (stock and stock.diameter) == diameter
    assert (stock and stock.face) == face
    assert (stock and stock.bore) == (diameter and 0)


def test_a_pass_names_its_bar() -> None:
    stock = report_of("(BAR DIA 50)\nT0101\nG98 G0 X60. Z2. C0\nG12.1\nG1 X50. F200\nG13.1", "fanuc-30i").stock
    assert stock is not None
    assert (stock.source, stock.diameter, stock.line) == ("comment", 50, 1)
    job = {"stock": {"unknown": True}}
    assert report_of("(BAR DIA 50)\nT0101\nG98 G0 X60. Z2. C0\nG12.1\nG13.1", "fanuc-30i", job=job).stock is None


@looped("stock", [{"diameter": 40, "hexagon": 30}, {"diameter": 40, "unknown": True}, {"diameter": 20, "bore": 20}])
def test_what_a_bar_cannot_be(stock: dict[str, object]) -> None:
    with pytest.raises(Exception, match="stock"):
        found(CONTOUR, stock=stock)


@pytest.mark.nightly
def test_a_pocket_is_entered_from_inside() -> None:
    """The wall of a pocket lies R farther out than the cutter center: that is not the rim of the bar."""
    pocket = "G21 G98 G40/T0101/G97 S3000 M13/G0 X24. Z2. C0/G12.1/G1 X24. F500/Z-4. F40/G41 X34. F80/G3 I-17./"
    pocket += "G1 G40 X24./Z2./G13.1/G0 Z50./M30"
    for diameter in (36, 40, 41.8, 60):
        assert found(pocket, **bar(diameter)) == {}


@pytest.mark.nightly
@looped("job", [{}, bar(40)])
def test_a_cutter_on_the_far_side_of_a_wall_is_seen_whatever_the_bar(job: dict[str, object]) -> None:
    assert list(found(f"{HEAD}/G1 X60. C-25. F1500/G41 X16. F200/C25./{END}", **job)) == [
        "side-of-compensation-mirrored"
    ]


# ---- cuts in air ----


@pytest.mark.nightly
@looped("turning", ["", f"{TURNING}/G98/"])
@looped("depth", ["", "/Z5."])
def test_a_section_in_air(turning: str, depth: str) -> None:
    head = HEAD.replace("/Z-5.", depth).replace("T0101", f"{turning}T0101")
    assert found(f"{head}/{CONTOUR}/{END}") == {"cut-in-air": "warning"}


@pytest.mark.ci
@looped(
    ("before", "behind", "rules"),
    [
        ("G0 Z-5.", "G0 Z2.", {}),
        ("G0 Z5.", "G0 Z2.", {"cut-in-air": "warning"}),
        ("G0 Z5.", "G0 Z20.", {}),
        ("M8", "G0 Z2.", {"cut-in-air": "warning"}),
        ("M8", "G0 Z20.", {}),
    ],
)
def test_a_section_in_air_whose_depth_stands_before_the_mode(before: str, behind: str, rules: dict[str, str]) -> None:
    head = HEAD.replace("/Z-5.", "").replace("G12.1", f"{before}/G12.1")
    assert found(f"{head}/{CONTOUR}/G40 X60. F1500/G13.1/{behind}/G0 X100. Z50./M30") == rules


@pytest.mark.nightly
def test_an_offset_cancel_that_crosses_the_part_is_told_once_for_all_passes() -> None:
    start = HEAD.removesuffix("/Z-5.")
    sub = f"O100/{CONTOUR}/G40 X{{}} F1500/M99"
    calls = f"{start}/G1 Z-3./M98 P100/G1 Z-6./M98 P100/Z2./G13.1/G0 X100. Z50./M30"
    assert found(f"{calls}/{sub.format('60.')}") == {}
    mirrored = sub.format("60.").replace("G42", "G41")
    assert found(f"{calls}/{mirrored}") == {"side-of-compensation-mirrored": "error"}
    assert found(f"{calls}/{sub.format('6.')}") == {"start-up-sweeps-contour": "error"}
    report = report_of(f"O1/{calls}/{sub.format('6.')}/".replace("/", "\n"), "fanuc-30i", "1:radius=4,nose=0")
    (line,) = {finding.line for finding in report.findings if finding.severity != "note"}
    assert line == 26


@pytest.mark.ci
@looped(("across", "rules"), [(44, {}), (50, {"cut-in-air": "warning"}), (90, {"cut-in-air": "warning"})])
def test_a_contour_around_the_bar_cuts_air(across: int, rules: dict[str, str]) -> None:
    """The sides of a square, R4 outside of them, and a bar of 40: of 50 across flats nothing is cut any more."""
    head, end = (blocks.replace("X60.", "X140.") for blocks in (HEAD, END))
    square = f"G42 X{across}. C0 F200/C{across / 2}/X-{across}./C-{across / 2}/X{across}./C0"
    assert found(f"{head}/{square}/{end}", **bar(40)) == rules


def test_an_origin_at_the_back_is_no_air() -> None:
    head = HEAD.replace("Z2.", "Z32.").replace("Z-5.", "Z25.")
    assert found(f"{head}/{CONTOUR}/{END.replace('Z2.', 'Z32.')}") == {}


@pytest.mark.nightly
def test_the_same_section_again() -> None:
    section = f"{HOLE.replace(' C0', '')}/Z2./G13.1"
    head = "G21 G98 G40/T0101/G97 S3000 M13"
    indexed = "{head}/G0 C0/{section}/{first}{section}/G0 C240./{section}/G0 Z50./M30"
    assert found(indexed.format(head=head, section=section, first="G0 C120./"), 2.5) == {}
    assert found(indexed.format(head=head, section=section, first=""), 2.5) == {"cut-in-air": "warning"}
    assert found(indexed.format(head=head, section=section, first="G0 C240./"), 2.5) == {"cut-in-air": "warning"}
    # A spring pass at each angle is meant.
    twice = f"{head}/G0 C0/{section}/{section}/G0 C120./{section}/{section}/G0 Z50./M30"
    assert found(twice, 2.5) == {}


@pytest.mark.ci
def test_an_angle_that_is_none_but_for_rounding_is_written_as_0() -> None:
    cut = (
        "G12.1/G1 Z-6. F800/G42 X54. C-5.5 F100/X18./G2 X7. C0 I0 J5.5/X18. C5.5 I5.5 J0/G1 X54./G40 X63. C0/Z2./G13.1"
    )
    program = f"O1/G21 G98 G40/T0101/G97 S3000 M13/G0 X63. Z2. C0/{cut}/G0 X63. Z2./{cut}/G0 C240./{cut}/G0 Z50./M30"
    report = report_of(program.replace("/", "\n") + "\n", "fanuc-30i", "1:radius=2.5,nose=0")
    (again,) = (finding.message for finding in report.findings if finding.rule == "cut-in-air")
    assert "at the same angle of C (0 deg)" in again


def test_a_move_of_several_axes_is_said_and_not_judged() -> None:
    """X and Z at once, out of a pocket with little room: whether it clears depends on the lathe."""
    program = f"G21 G98 G40/T0101/G97 S3000 M13/{HOLE}/Z-2./G13.1/G0 X300. Z50./M30"
    report = report_of(f"O1\n{program.replace('/', chr(10))}\n", "fanuc-30i", "1:radius=3.5,nose=0")
    assert [finding.rule for finding in report.findings if finding.severity != "note"] == ["rapid-through-part"]


@pytest.mark.ci
def test_too_many_ways_are_said() -> None:
    """Each index goes down into the bar: more of them than are followed."""
    index = "G0 C{}/G1 Z-3. F60/G12.1/G1 X10. F200/X24./G13.1/G0 Z-2."
    blocks = "/".join(index.format(number % 360) for number in range(260))
    program = f"O1/G21 G98 G40/T0101/G97 S3000 M13/G0 X24. Z2. C0/{blocks}/G0 Z50./M30"
    report = report_of(program.replace("/", "\n"), "fanuc-30i", "1:radius=4,nose=0", job=bar(40))
    reasons = {missing.rule: missing.reason for missing in report.not_evaluated}
    assert "too many to follow the metal" in reasons["rapid-through-stock"]
    assert report.verdict != "pass"
