"""Where findings are on the face, which lines they stand for, how large a window shows them; and what else is shown."""

from __future__ import annotations

import math
from typing import Any

import pytest
from cases import looped
from programs import job_of, machine_of, report_of
from test_pictures import CORNERS, END, GROOVE, HEAD, HEXAGON

from polarcheck.checking import check
from polarcheck.editor.section_lenses import summary
from polarcheck.program.reading.source import read_source
from polarcheck.reports.pages.resting import resting
from polarcheck.rules.examples import examples
from polarcheck.rules.rule import load_all
from polarcheck.view.finding_views import with_followers
from polarcheck.view.picture_data import Drawn, FindingLocation, key_of
from polarcheck.view.run_drawing import drawn, listing, split


def pictured(program: str, *tools: str, **changes: Any) -> tuple[dict[str, FindingLocation], Drawn]:
    """The place of the first finding of each rule, and all that is drawn."""
    runs = check.read(program.encode(), machine_of("fanuc", changes), job_of(*tools), "x.nc")
    report, found = split(drawn(check.check_runs(runs, list(load_all().values())), runs))
    assert found is not None
    places: dict[str, FindingLocation] = {}
    for finding in with_followers([*report.findings, *report.silenced]):
        places.setdefault(finding.rule, found.places[key_of(finding)])
    return places, found


def contour(*corners: str) -> str:
    return HEAD + "G1 Z-2. F300\nG42 X30. F200\n" + "".join(f"{corner}\n" for corner in corners) + END


FAST = HEAD + "G1 X2. C8. F3000\n" + "C-8.\nC8.\n" * 10 + "X80. F100\nG13.1\nM30\n"
REVERSED = contour(*(f"X{x:.1f} C{c:.6f}" for x, c in CORNERS[:1]), "X0.2 C17.26", "X0.21 C17.255", "X0 C17.320508",
                   *(f"X{x:.1f} C{c:.6f}" for x, c in CORNERS[2:]))  # fmt: skip


@pytest.mark.nightly
@looped(
    ("program", "rule", "place", "span"),
    [
        (HEAD + "G1 X40. F200\nX-40.\nG13.1\nM30\n", "path-through-center", (0, 0), 24.0),
        (HEAD + "G1 X40. F200\nX-40. C1.\nG13.1\nM30\n", "path-near-center", (0.0125, 0.5), 4.0),
        (FAST, "c-feed-above-limit", (1, 0), 8.0),
        (GROOVE, "overcut", (15, -3), 16.0),
        # 0.007 mm back: marked at the block, in a window of a few hundredths.
        (REVERSED, "interference", (0.1025, 17.2575), 0.05),
        (HEXAGON.replace("G42 X30.", "G42 X78."), "start-up-shorter-than-radius", (39.5, 0), 24.0),
        (HEXAGON.replace("X0.0 C17.320508", "G0 X0.0 C17.320508\nG1"), "rapid-in-polar", (9.5, 16.4545), 51.9615),
    ],
    one_in=6,
)  # fmt: skip
def test_a_finding_is_marked_where_it_is_at_its_scale(
    program: str, rule: str, place: tuple[float, float], span: float
) -> None:
    places, found = pictured(program, "8:radius=4", limits={"c_feed": 3600.0, "keep_out": 1.0})
    mark = places[rule]
    assert not mark.is_beside
    assert mark.section == 0
    assert mark.places[0] == pytest.approx(place, abs=1e-3)
    assert mark.span == pytest.approx(span, rel=1e-3)
    assert mark.move is not None
    assert 0 <= mark.move < len(found.sections[0].moves.line)


@pytest.mark.nightly
def test_the_other_lines_of_a_finding_are_listed() -> None:
    places, _ = pictured(FAST, limits={"c_feed": 3600.0})
    mark = places["c-feed-above-limit"]
    assert mark.also == [4, *range(6, 25)]
    assert mark.places == [(1, 0), (1.6151, 7.8738)]
    both = pictured(GROOVE, "8:radius=4")[0]["overcut"]
    assert both.also == [13]
    assert both.places[0][1] == -both.places[1][1] == -3


@pytest.mark.nightly
@looped(
    ("before", "behind", "rule", "place"),
    [
        # Where the tool stands at a block outside of the section, by X and C.
        ("", "G0 X0\n", "rapid-through-part", (0, 0)),
        ("G0 X100. C90.\n(POLARCHECK ALLOW)\n", "", "allow-not-understood", (0, 50)),
        ("", "(POLARCHECK ALLOW)\n", "allow-not-understood", (40, 0)),
    ],
)
def test_what_is_outside_the_section_is_marked_where_the_tool_stands(
    before: str, behind: str, rule: str, place: tuple[float, float]
) -> None:
    program = HEXAGON.replace("G0 X80. C0 Z2.\n", f"{before}G0 X80. C0 Z2.\n").replace("M30\n", f"{behind}M30\n")
    places, found = pictured(program, "8:radius=4")
    mark = places[rule]
    assert mark.is_beside
    assert mark.section == 0
    assert mark.move == (0 if before else len(found.sections[0].moves.line) - 1)
    assert mark.places == [pytest.approx(place, abs=1e-3)]


@pytest.mark.ci
def test_of_several_sections_the_nearest_one_has_it() -> None:
    note = "(POLARCHECK ALLOW)\n"
    twice = HEXAGON.replace("M30\n", f"M9\nM9\nM9\n{note}") + HEXAGON
    assert pictured(twice, "8:radius=4")[0]["allow-not-understood"].section == 1
    twice = HEXAGON.replace("M30\n", f"{note}M9\nM9\nM9\nM9\n") + HEXAGON
    assert pictured(twice, "8:radius=4")[0]["allow-not-understood"].section == 0


@looped("program", ["", "G0 X10.\n(POLARCHECK ALLOW)\nM30\n", "%\n", "G12.1\n"])
def test_without_a_section_nothing_has_a_place(program: str) -> None:
    places, _ = pictured(program)
    assert all(not place.places for place in places.values())


#: Rules whose examples leave all positions of the section unknown.
NOWHERE = {"number-without-point", "too-many-digits"}


@pytest.mark.nightly
def test_all_findings_of_drawn_sections_have_a_place() -> None:
    rules = load_all()
    seen = set[str]()
    for rule in rules.values():
        if rule.group not in ("compensation", "feed", "motion", "metal", "setup", "text"):
            continue
        for example in examples(rule.page):
            if example.settings or example.machine:
                continue
            runs = check.read(example.program.encode(), machine_of("fanuc"), job_of(*example.tools), "x.nc")
            report, found = split(drawn(check.check_runs(runs, list(rules.values())), runs))
            assert found is not None
            for finding in with_followers(report.findings):
                place = found.places[key_of(finding)]
                if found.sections and finding.rule not in NOWHERE:
                    assert place.places, finding
                    assert place.section is not None
                    seen.add(finding.rule)
                assert not place.also or len(place.also) + 1 == finding.count
    assert len(seen) > 60


# ---- the part where the path is that of the tool ----

TOOL_PATH = (
    HEAD + "G1 Z-2. F300\nX38. F200\n" + "".join(f"X{38 / 30 * x:.4f} C{19 / 15 * c:.6f}\n" for x, c in CORNERS)
    + "X80.\nG13.1\nM30\n"
)  # fmt: skip


def area_of(polygons: Any) -> float:
    import shapely

    return sum(shapely.Polygon(outside, holes).area for outside, *holes in polygons)


@pytest.mark.ci
@looped(("stock", "known"), [({"diameter": 40.0}, True), ({"diameter": 40.0, "bore": 10.0}, True), (None, False)])
def test_without_compensation_the_part_is_the_bar_without_what_is_swept(stock: Any, known: bool) -> None:
    runs = check.read(
        TOOL_PATH.encode(), machine_of("fanuc"), job_of("8:radius=4", job={"stock": stock} if stock else None), "x.nc"
    )
    _, found = split(drawn(check.check_runs(runs, []), runs))
    assert found is not None
    (section,) = found.sections
    (part,) = section.parts
    assert (part.z, part.known_outside) == (-2, known)
    assert "hexagon, 30.000 across flats" in part.text
    hexagon = 6 * 15**2 * math.tan(math.pi / 6)
    bore = math.pi * 25 if stock and "bore" in stock else 0
    if known:
        assert area_of(part.polygons) == pytest.approx(hexagon - bore, rel=1e-3)
        assert len(section.bar) == len(stock)
        assert min(section.frame[2:]) > 20
    else:
        assert section.bar == []
        assert area_of(part.polygons[-1:]) < area_of(part.polygons)
    assert section.frame[2] > 44


def test_what_is_cleared_below_is_cleared_above() -> None:
    deeper = TOOL_PATH.replace("X80.\nG13.1", "X80.\nZ-3.\nX0\nX80.\nG13.1")
    runs = check.read(
        deeper.encode(), machine_of("fanuc"), job_of("8:radius=4", job={"stock": {"diameter": 40.0}}), "x.nc"
    )
    _, found = split(drawn(check.check_runs(runs, []), runs))
    assert found is not None
    upper, lower = found.sections[0].parts
    assert (upper.z, lower.z) == (-2, -3)
    # The slot to the middle, at both depths.
    slot = 15 * 8 + math.pi * 16 / 2
    hexagon = 6 * 15**2 * math.tan(math.pi / 6)
    assert area_of(upper.polygons) == pytest.approx(hexagon - slot, rel=2e-2)
    assert area_of(lower.polygons) > area_of(upper.polygons)


def test_without_r_the_path_is_a_line_and_it_is_said_what_to_give() -> None:
    (section,) = pictured(TOOL_PATH)[1].sections
    assert section.parts == []
    assert len(section.tool.x) == 10
    assert "--tool 8:radius=..." in section.makes[0]


@pytest.mark.nightly
def test_what_the_job_asks_for_lies_as_the_section_writes_it() -> None:
    part = {"shape": "hexagon", "across_flats": 30.0, "turned": 0.0}
    program = HEXAGON.replace("X80. C0 Z2.", "X80. C30. Z2.")
    for job, agrees in (
        ({"part": [part]}, False),
        ({"part": [{**part, "turned": 30.0}]}, True),
        ({"part": [{**part, "section": 2}]}, None),
    ):
        runs = check.read(program.encode(), machine_of("fanuc"), job_of("8:radius=4", job=job), "x.nc")
        _, found = split(drawn(check.check_runs(runs, []), runs))
        assert found is not None
        asked = found.sections[0].drawing
        if agrees is None:
            assert asked == []
            continue
        (one,) = asked
        assert (one.title, one.z, one.agrees, one.lines) == ("the hexagon asked for", -2, agrees, [])
        (ring,) = one.rings
        assert len(ring) == 6
        # Turned by C at G12.1: where the section writes a flat at the right, the part has a corner.
        flat = min(abs(complex(*point) - 17.3205) for point in ring)
        assert flat == pytest.approx(0 if not agrees else 8.966, abs=1e-2)


# ---- the source ----


def test_the_lines_of_the_file_are_on_the_page() -> None:
    found = pictured(HEXAGON, "8:radius=4")[1]
    assert found.source == HEXAGON.splitlines()
    assert (found.source_line, found.source_lines) == (1, len(HEXAGON.splitlines()))


def test_very_long_files_are_shown_in_part(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("polarcheck.view.run_drawing._LINES", 500)
    text = "".join(f"N{number} G1 X{number % 7}.\n" for number in range(1, 2001))
    lines, first, count = listing(read_source(text.encode()), [1000, 1500])
    assert (len(lines), first, count) == (500, 800, 2000)
    assert lines[0] == "N800 G1 X2."
    monkeypatch.setattr("polarcheck.view.run_drawing._CHARACTERS", 3000)
    lines, first, _ = listing(read_source(text.encode()), [])
    assert first == 1
    assert 2500 < sum(map(len, lines)) <= 3000
    (long,), _, _ = listing(read_source(b"(" + b"A" * 100_000 + b")"), [1])
    assert len(long) < 410


# ---- the center, in words ----


@pytest.mark.ci
@looped(
    ("blocks", "said"),
    [
        ("G1 X40. F200\nX-40.\n", "C has no angle at the center, in line 5 (no limit given)"),
        ("G1 X40. C5. F200\nX0 C0\nC5.\n", "and no angle at the center, in line 5 (no limit given)"),
        ("G1 X40. F200\n", "C does not turn (no limit given)"),
    ],
)
def test_at_the_center_c_has_no_angle(blocks: str, said: str) -> None:
    report = report_of(f"{HEAD}{blocks}G13.1\nM30\n")
    assert any(said in line for line in resting(report))
    assert ("no angle at the center in line 5" in summary(report.polar_sections[0])) == ("no angle" in said)
