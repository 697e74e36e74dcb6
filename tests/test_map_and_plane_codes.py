"""Modes that are ended by what selects another plane or map, and planes that do not turn with C."""

from __future__ import annotations

import numpy as np
import pytest
from cases import looped
from programs import moves_of, report_of, said, tables_of, trace_of

from polarcheck.program.reading import source
from polarcheck.program.reading.translation import spans, translated

SQUARE = ((30.0, 10.0), (10.0, 10.0), (10.0, -10.0), (-10.0, -10.0), (-10.0, 10.0), (30.0, 10.0))
FANUC = "O1\nT0101\nG98 G0 X{} C0 Z5.\nG12.1\n{}G13.1\nM30\n"
HURCO = "O1\nG90 G94\nT0101\nM33 S3000\nG7\nG109\nG0 Z5.\nG0 X{}\nG0 C{}\n{}\nG17\n{}{}\nG0 Z100.\nM35\nM30\n"
FAGOR = "%P,MX,\nG71 G90 G18\nT1 D1 M6\nG94\nM51\nG15\n{}\nG0 X{} C0\n{}{}\nM50\nM30\n"


def cuts(factor: float, axis: str) -> str:
    """The moves of the square, X with this factor."""
    return "".join(f"G1 X{x * factor:.3f} {axis}{c:.3f} F300\n" for x, c in SQUARE)


def path(program: str, machine: str) -> np.ndarray:
    moves = moves_of(program, machine, "1:radius=2")
    return np.array([moves.start, moves.end])


TWIN = FANUC.format("80.", cuts(2, "C"))


@pytest.mark.ci
@looped("on", ["G101", "G105"], one_in=12)
@looped("off", ["G109", "G110", "G103", "G104", "G107", "G108"])
def test_a_map_gives_the_path_of_its_twin_whichever_map_ends_it(on: str, off: str) -> None:
    program = HURCO.format("40.", "0", on, cuts(1, "Y"), off)
    np.testing.assert_allclose(path(program, "hurco"), path(TWIN, "fanuc"), atol=1e-9)
    assert not report_of(program, "hurco").findings


@pytest.mark.nightly
@looped("on", ["G16 XC", "G16XC", "G16  XC", "N70 G16\tXC", "g16 xc"], one_in=24)
@looped("off", ["G18", "G17", "G19", "G16 ZC", "G18 G40", "G18 G0 X80."])
def test_a_plane_gives_the_path_of_its_twin_whichever_plane_ends_it(on: str, off: str) -> None:
    program = FAGOR.format(on, "40.", cuts(1, "C"), off)
    ours, twin = path(program, "fagor-8055t"), path(TWIN, "fanuc")
    np.testing.assert_allclose(ours[:, 1:], twin, atol=1e-9)
    assert {rule for _, rule in said(report_of(program, "fagor-8055t"))} <= {"lower-case-word"}


@looped("angle", [-150.0, -90.0, 0.0, 45.0, 90.0, 180.0, 270.0, 405.0])
def test_the_plane_that_stays_with_the_part_begins_where_c_stands(angle: float) -> None:
    program = HURCO.format("40.", f"{angle}", "G101", cuts(1, "Y"), "G109")
    moves = moves_of(program, "hurco")
    np.testing.assert_allclose(moves.start[0], 40 * np.exp(1j * np.radians(angle)), atol=1e-9)
    np.testing.assert_allclose(moves.c_angles[0][0], angle, atol=1e-9)
    np.testing.assert_allclose(moves.end, [complex(*point) for point in SQUARE], atol=1e-9)
    at_corner = np.degrees(np.angle(moves.end)) - moves.c_angles[1]
    np.testing.assert_allclose(at_corner / 360, np.round(at_corner / 360), atol=1e-9)


def test_steps_go_on_from_where_c_stands() -> None:
    program = HURCO.format("40.", "90.", "G101", "G91\nG1 X5. F300\nY-10.\nG90\n", "G109")
    np.testing.assert_allclose(moves_of(program, "hurco").end, [5 + 40j, 5 + 30j], atol=1e-9)


def test_x_behind_the_map_is_where_the_machine_stands() -> None:
    trace = trace_of(HURCO.format("40.", "90.", "G101", "G1 Y30. F300\n", "G109"), "hurco")
    np.testing.assert_allclose(trace.path.x[-1], 30.0, atol=1e-9)
    assert trace.path.x[trace.mode.enters].tolist() == [40.0]


def test_without_c_before_the_map_it_is_taken_to_begin_at_c0_and_said_to_be_open() -> None:
    program = HURCO.replace("G0 C{}\n", "").format("40.", "G101", cuts(1, "Y"), "G109")
    moves = moves_of(program, "hurco")
    assert moves.start[0] == 40
    assert not np.isnan(moves.end).any()
    assert "c-angle-unknown-at-entry" in {rule for _, rule in said(report_of(program, "hurco"))}


def test_a_map_code_of_turning_ends_nothing_and_a_contour_with_a_real_y_needs_no_polar_map() -> None:
    program = "O1\nG90 G94\nT0101\nM33\nG103\nG17\nG0 X40. Y0\nG1 G42 X20. F300\nY10.\nG40 X40.\nG109\nM35\nM30\n"
    report = report_of(program, "hurco", "1:radius=2")
    assert not [found for found in report.findings if found.severity != "note"]
    assert report.sections == 0


def test_a_map_that_is_never_left_is_told_with_the_code_that_ends_it() -> None:
    (found,) = report_of(HURCO.format("40.", "0", "G105", cuts(1, "Y"), "M9"), "hurco").findings
    assert found.rule == "polar-never-left"
    assert "G110" in found.message


def test_a_blank_in_a_native_word_stands_for_any_number_of_them() -> None:
    found = source.read_source(b"G17 XC G17XC G17 \t XC G117XC G17XCA\n", "-")
    assert [len(ends) for ends in spans(found, "G17 XC")] == [3, 3]
    read = translated(found, {"G17 XC": "G12.1"}).code.tobytes()
    assert read == b"G012.1 G12.1 G00000012.1 G117XC G17XCA\n".replace(b"G00000012.1", b"G" + b"12.1".rjust(7, b"0"))


def test_an_axis_without_an_incremental_address_has_none() -> None:
    program = "O1\nT0101\nG98 G0 X60. C0\nG12.1\nG1 X40. H5. F200\nC10.\nX60.\nG13.1\nM30\n"
    tables = tables_of(program, changes={"polar": {"virtual_axis_incremental": ""}})
    assert tables["trace"].path.end[5] == 20 + 10j
    assert report_of(program, changes={"polar": {"virtual_axis_incremental": ""}}).findings == []
