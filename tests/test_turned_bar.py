"""The bar is what turning has left, at the depth that counts: programs that turn first, with the bar of the job."""

from __future__ import annotations

import re

import pytest
from cases import looped
from programs import report_of, tables_of
from turned_programs import KINDS, Program, drawn, slipped

HEAD = "G21 G40/T0303/G97 S1500 M3/"
AWAY = "/G0 X120. Z50./M5"
MILL = "/T0101/G98/G97 S3000 M13/G28 H0/"
END = "/Z2. F1500/G13.1/G0 Z50./M5/M30"
#: Ways to turn a spigot of 30 down to Z-12, of a bar of 50, with the face at Z0.
FACING = "G0 X54. Z0 G99/G1 X-1.6 F.15/G0 Z2./"
SPIGOTS = {
    "moves": f"{FACING}G0 X40. Z1./G1 Z-11.8 F.2/G0 X42. Z1./X30./G1 Z-12./X52.{AWAY}",
    "turning cycle": f"{FACING}G0 X54. Z2./G90 X42. Z-12. F.2/X36./X30.{AWAY}",
    "facing cycle": f"{FACING}G0 X54. Z2./G94 X30. Z-3. F.2/Z-6./Z-9./Z-12./G0 Z2.{AWAY}",
    "faced by moves": f"{FACING}G0 X54. Z-6./G1 X30. F.2/G0 Z2./X54./Z-12./G1 X30./G0 Z2.{AWAY}",
    "repetitive cycles": (
        f"{FACING}G0 X54. Z2./G71 U1.5 R.5/G71 P10 Q20 U.5 W.1 F.2/N10 G0 X30./G1 Z-12. F.1/N20 X54.{AWAY}"
        f"/T0404/G97 S1500 M3/G0 X54. Z2. G99/G70 P10 Q20{AWAY}"
    ),
    "two tools": (
        f"{FACING}G0 X31. Z1./G1 Z-11.8 F.2/X52.{AWAY}/T0404/G97 S1500 M3/G0 X30. Z1. G99/G1 Z-12. F.1/X52.{AWAY}"
    ),
    "with a chamfer": f"{FACING}G0 X26. Z1./G1 Z0 F.2/X30. Z-2./Z-12./X52.{AWAY}",
    "with an arc": f"{FACING}G0 X26. Z1./G1 Z0 F.2/G3 X30. Z-2. R2./G1 Z-12./X52.{AWAY}",
}
#: A hexagon of 24 across flats, at a depth, from an approach.
HEXAGON = (
    "G0 Z2./C0/X{x}/G12.1/G1 X{x} F1500/Z{z} F300/G42 X24. C0 F250/C6.928/X0 C13.856/X-24. C6.928/C-6.928/X0 C-13.856"
    "/X24. C-6.928/C0/G40 X{x}"
)


def told(program: str, radius: float = 6, **stock: float) -> list[tuple[str, str]]:
    report = report_of(
        f"O1\n{program.replace('/', chr(10))}\n", "fanuc-30i", f"1:radius={radius},nose=0", job={"stock": stock}
    )
    return [(one.rule, one.severity) for one in report.findings if one.severity != "note"]


def hexagon(spigot: str, x: str = "46.", z: str = "-6.") -> str:
    return HEAD + SPIGOTS[spigot] + MILL + HEXAGON.format(x=x, z=z) + END


INSIDE = [("approach-inside-stock", "error")]


@pytest.mark.nightly
@looped("spigot", list(SPIGOTS), one_in=18)
@looped("stock", [{"diameter": 50}, {"diameter": 56, "face": 1}, {"hexagon": 44}, {"diameter": 50, "bore": 8}, {}])
def test_the_approach_clears_what_was_turned(spigot: str, stock: dict[str, float]) -> None:
    assert told(hexagon(spigot), **stock) == []
    assert told(hexagon(spigot, x="40."), **stock) == INSIDE


@pytest.mark.nightly
@looped("spigot", list(SPIGOTS))
def test_below_the_spigot_the_bar_counts(spigot: str) -> None:
    assert told(hexagon(spigot, z="-15."), diameter=50) == INSIDE
    assert told(hexagon(spigot, x="64.", z="-15."), diameter=50) == []


@pytest.mark.ci
@looped(
    ("turning", "z", "radius"),
    [
        (SPIGOTS["moves"], -6.0, 15.0),
        (SPIGOTS["moves"], -15.0, 25.0),
        # A cone, half way down.
        (f"G0 X30. Z0 G99/G1 X40. Z-20. F.2/X52.{AWAY}", -10.0, 17.5),
        # A taper of the cycle: R is smaller at its start.
        (f"G0 X54. Z0 G99/G90 X40. Z-20. R-5. F.2{AWAY}", -10.0, 17.5),
        # Above a groove the bar stands as it was.
        (f"{SPIGOTS['moves']}/T0505/G97 S900 M3/G0 X54. Z-30. G99/G1 X20. F.1/G0 X54.{AWAY}", -30.0, 25.0),
        # A thread leaves what is within its root.
        (f"{SPIGOTS['moves']}/T0505/G97 S900 M3/G0 X34. Z3./G92 X28. Z-15. F1.5/X27.{AWAY}", -6.0, 13.5),
        # Of a variable nobody knows what it leaves.
        (f"G0 X#101 Z1. G99/G1 Z-30. F.2/X52.{AWAY}", -6.0, None),
    ],
)
def test_the_radius_at_a_depth(turning: str, z: float, radius: float | None) -> None:
    program = HEAD + turning + MILL + HEXAGON.format(x="64.", z="-6.") + END
    tables = tables_of(
        f"O1\n{program.replace('/', chr(10))}\n", "fanuc-30i", "1:radius=6,nose=0", job={"stock": {"diameter": 50}}
    )
    trace, bar = tables["trace"], tables["bar"]
    standing = bar.standing(int(trace.mode.sections.enter[0]), z)
    assert (standing[-1].diameter / 2 if standing else None) == (radius and pytest.approx(radius, abs=1e-4))


def test_what_is_turned_later_counts_later() -> None:
    """A hexagon on a bar of 50, then a spigot of 30 is turned, and the second hexagon begins nearer."""
    near, wide = HEXAGON.format(x="46.", z="-6."), HEXAGON.format(x="64.", z="-3.")
    up, turning = "/Z2. F1500/G13.1/G0 Z50./M5/T0303/G97 S1500 M3/", SPIGOTS["moves"].removeprefix(FACING)
    assert told(HEAD + FACING + AWAY[1:] + MILL + wide + up + turning + MILL + near + END, diameter=50) == []
    assert told(HEAD + FACING + AWAY[1:] + MILL + near + up + turning + MILL + near + END, diameter=50) == INSIDE


POCKET = "G0 Z{z}/C0/X{x}/G12.1/G1 X10. C3. F500/Z-3. F40/X8. F80/X10./Z2. F500/G13.1/G0 Z50./M5/M30"
FLAT = "G0 Z2./C0/X{x}/G12.1/G1 X{out} C0 F1500/C24./Z-3. F300/X20. F200/C-24./X{out} F1500/Z2./G13.1/G0 Z50./M5/M30"


@pytest.mark.nightly
@looped("x", ["34.", "43.6", "20."])
@looped("z", ["2.", "20."])
def test_above_the_face_nothing_is_hit(x: str, z: str) -> None:
    start = "G21 G98 G40" + MILL
    assert told(start + POCKET.format(x=x, z=z), 4, diameter=30) == []
    assert told(start + FLAT.format(x=x, out="60."), 4, diameter=30) == []
    assert told(start + FLAT.format(x=x, out="60.").replace("C24./Z-3.", "X30./Z-3."), 4, diameter=30) != []


SLOT = "X60. C{c}/Z-4. F500/X{end} F90/Z2. F1500/"


@pytest.mark.nightly
@looped("cs", [("6.",), ("6.", "-6."), ("-6.", "6."), ("6.", "0", "-6."), ("2.", "-2.")])
@looped("end", ["14.", "20.", "0"])
def test_slots_that_are_lifted_out_of_are_sound(cs: tuple[str, ...], end: str) -> None:
    slots = "".join(SLOT.format(c=c, end=end) for c in cs)
    program = f"G21 G98 G40{MILL}G0 X60. Z2. C0/G12.1/G98 G1 X60. C6. F1500/{slots}G13.1/G0 Z50./M5/M30"
    assert "pass-ends-inside-bar" not in [rule for rule, _ in told(program, 3, diameter=40)]


@pytest.mark.ci
@looped("after", ["G40 X60. F1500/Z2./", "Z2./G40 X60. F1500/"])
def test_a_flat_that_ends_inside_is_told(after: str) -> None:
    flat = f"G1 X60. C28. F1500/Z-4. F500/G41 X20. F200/C{{c}}/{after}"
    program = f"G21 G98 G40{MILL}G0 X60. Z2. C0/G12.1/{flat}G13.1/G0 Z50./M5/M30"
    assert told(program.format(c="-28."), 3, diameter=40) == []
    assert told(program.format(c="-2."), 3, diameter=40) == [("pass-ends-inside-bar", "warning")]


@pytest.mark.nightly
@looped("far", ["-112.", "112."])
def test_a_point_far_outside_the_bar_is_told(far: str) -> None:
    """The last word of a flat, of a bar of 46."""
    flat = "G1 X60. C{near}. F1500/Z-4. F500/{side} X20. F200/C{far}/G40 X60. F1500/Z2./"
    start, end = f"G21 G98 G40{MILL}G0 X60. Z2. C0/G12.1/", "G13.1/G0 Z50./M5/M30"
    side, near = ("G41", "32") if far[0] == "-" else ("G42", "-32")
    for stock in ({"diameter": 46}, {"hexagon": 42}):
        sound = far.replace("112.", "32.")
        assert told(start + flat.format(near=near, side=side, far=sound) + end, 3, **stock) == []
        assert told(start + flat.format(near=near, side=side, far=far) + end, 3, **stock) == [("cut-in-air", "warning")]


@pytest.mark.nightly
def test_a_contour_that_comes_round_ends_inside_the_bar_and_leaves_nothing() -> None:
    """It ends behind its own first cut, nearer to the center than the rim of the bar."""
    contour = (
        "G1 X60. C14. F1500/Z-4. F300/G42 X40.822 C2.765 F250/X0 C14.549/X-25.2 C7.275/C-7.275/X0 C-14.549"
        "/X25.2 C-7.275/C15.058/G40 X60. C15.058/Z2. F1500/G13.1/G0 Z50./M5/M30"
    )
    assert told(f"G21 G98 G40{MILL}G0 X60. Z2. C0/G12.1/{contour}", 5, diameter=40.775) == []
    assert (
        told(f"G21 G98 G40{MILL}G0 X60. Z2. C0/G12.1/{contour.replace('C15.058', 'C4.058')}", 5, diameter=40.775) != []
    )


@pytest.mark.parametrize("turn", [1, -1])
def test_a_contour_whose_extensions_meet_in_its_corner_leaves_nothing(turn: int) -> None:
    """The end of the first cut is where the last one begins, but for the rounding of its products."""
    points = "X-46.421 C3.676/X-34.866 C5.664/X0 C20./X34.866 C5.664/X34.866 C-5.664/X0 C-20./X-46.421 C-3.676"
    way = f"G1 X-6. C30. F1500/X-55.885 C5.749/Z-5. F300/G41 X-53.608 C2.44 F80/{points}/C3.676/C7.476/"
    contour = f"{way}G40 X-55.421 F1500/Z2./G13.1/G0 Z50./M5/M30"
    if turn < 0:
        contour = re.sub(r"C(-?)(?=[\d.])", lambda word: "C" if word[1] else "C-", contour).replace("G41", "G42")
    start = f"G21 G98 G40{MILL}G0 X60. Z2. C0/G12.1/"
    assert told(start + contour, 2, diameter=50) == []


def test_the_page_shows_the_bar_that_each_section_meets() -> None:
    """Two hexagons, the second on a spigot that is turned between them; the third goes below the spigot."""
    from test_pictures import drawn_of

    wide, near = HEXAGON.format(x="64.", z="-3."), HEXAGON.format(x="46.", z="-6.")
    deep = HEXAGON.format(x="64.", z="-15.")
    up, turning = "/Z2. F1500/G13.1/G0 Z50./M5/T0303/G97 S1500 M3/", SPIGOTS["moves"].removeprefix(FACING)
    again = "/Z2. F1500/G13.1/G0 Z50./M5" + MILL
    program = HEAD + FACING + AWAY[1:] + MILL + wide + up + turning + MILL + near + again + deep + END
    sections = drawn_of(
        f"O1\n{program.replace('/', chr(10))}\n",
        "1:radius=6,nose=0",
        machine="fanuc-30i",
        job={"stock": {"diameter": 50.0}},
    ).sections
    sizes = [max(abs(complex(*point)) for point in section.bar[0]) for section in sections]
    assert sizes == [pytest.approx(radius, abs=0.05) for radius in (25, 15, 25)]


# ---- programs that turn first, drawn at random ----


@pytest.mark.parametrize("seed", range(40))
def test_sound_programs_that_turn_first_are_told_nothing(seed: int) -> None:
    program = drawn(seed)
    assert report_words(program) == []


@pytest.mark.nightly
@looped("seed", range(40, 400))
def test_more_sound_programs_that_turn_first_are_told_nothing(seed: int) -> None:
    assert report_words(drawn(seed)) == []


@pytest.mark.ci
@pytest.mark.parametrize("kind", KINDS)
def test_a_slip_against_the_metal_is_told(kind: str) -> None:
    slips = (slipped(drawn(seed), kind) for seed in range(6000, 6400))
    assert report_words(next(slip for slip in slips if slip is not None)) != []


@pytest.mark.nightly
@looped(
    ("kind", "seed", "rule"),
    [
        # Either pass may be the wrong one, but for its digits and the turning.
        ("depth ten times", 20000, "pass-depth-differs"),
        ("depth ten times", 70004, "pass-depth-differs"),
        ("digit too many in the depth", 20000, "pass-depth-differs"),
        ("digit too many in the depth", 20010, "pass-depth-differs"),
        # The wrong corner lies on the wall on which the contour begins, or on another corner.
        ("contour C ten times", 20045, "nearly-regular-contour"),
        ("contour C doubled", 20014, "nearly-regular-contour"),
        ("contour C doubled", 70095, "nearly-regular-contour"),
        ("contour C without its sign", 20003, "nearly-regular-contour"),
        ("contour C without its sign", 20064, "nearly-regular-contour"),
        # The pass below cuts the same way.
        ("depth is missing", 70000, "cut-in-air"),
        ("depth is missing", 70004, "cut-in-air"),
        # Finish and roughing lie beside each other but for one point; two rectangles have no other symmetry.
        ("roughing too far in", 20013, "passes-differ"),
        ("finish too far in", 20033, "passes-differ"),
        # Five of six flats have G41.
        ("G42 for G41", 70013, "passes-differ"),
        # A drill on X0 cuts a place that is known at any angle of C.
        ("rapid traverse below the face", 70011, "rapid-through-stock"),
    ],
)
def test_slips_that_one_witness_tells(kind: str, seed: int, rule: str) -> None:
    slip = slipped(drawn(seed), kind)
    assert slip is not None
    assert report_words(slip) == [rule]


def report_words(program: Program) -> list[str]:
    report = report_of(program.text(), "fanuc-30i", *program.tools, job={"stock": program.stock})
    return [one.rule for one in report.findings if one.severity != "note"]
