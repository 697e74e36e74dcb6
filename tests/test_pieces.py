"""A large program in pieces gives the report of the same program as one table, or is one table."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from itertools import islice
from pathlib import Path
from typing import Any

import pytest
from in_pieces import SOUND, in_pieces, several
from programs import job_of, machine_of, report_of

from polarcheck.checking import batch, pieces, piecewise
from polarcheck.checking.rule import Rule, load_all
from polarcheck.checking.settings import Settings
from polarcheck.errors import IsOneError
from polarcheck.machines.job import Job
from polarcheck.reading import source
from polarcheck.reading.words import Text
from polarcheck.table.trace import Trace

TOOL = "2:radius=4"


def program(operations: Sequence[Sequence[str]]) -> str:
    """One program of some operations."""
    return "\n".join(["%", "O0001", *(block for one in operations for block in one), "M30", "%", ""])


def changed(old: str, new: str, *numbers: int, count: int = 6) -> str:
    """Six operations, or so many, in some of which a block is another one; in all of them where no number is given."""
    return program(
        [
            [re.sub(old, new, block) if number in numbers or not numbers else block for block in SOUND]
            for number in range(count)
        ]
    )


@pytest.mark.parametrize("rule", load_all().values(), ids=load_all())
def test_examples_of_a_rule_among_sound_operations(rule: Rule) -> None:
    """Where a program can be cut, nothing is found otherwise, whatever stands in another piece."""
    for text in islice(several(rule), 1):
        found = in_pieces(text.encode(), "fanuc", "1:radius=4", size=600, near=16)
        assert found is None or found == report_of(text, "fanuc", "1:radius=4")


def test_most_examples_can_be_cut() -> None:
    """The test above compares something."""
    programs = [text for rule in load_all().values() for text in several(rule)][::5]
    cut = [in_pieces(text.encode(), "fanuc", size=600, near=16) is not None for text in programs]
    assert sum(cut) > len(cut) / 2


def test_sound_operations() -> None:
    """Nothing is found in the first piece nor in the last."""
    found = in_pieces(program([SOUND] * 6).encode(), "fanuc-30i", TOOL)
    assert found == report_of(program([SOUND] * 6), "fanuc-30i", TOOL)
    assert (found.verdict, found.sections, found.findings) == ("pass", 6, [])


@pytest.mark.parametrize(
    "text",
    [
        pytest.param(changed("X0. C23", "G0 X0. C23"), id="rapid in every section"),
        pytest.param(changed("X0. C23", "G0 X0. C23", 4), id="rapid in one section"),
        pytest.param(changed("F200", "F9000"), id="F too high in every section"),
        pytest.param(changed("F200", "F9000", 5), id="F too high in the last section"),
        pytest.param(changed("G13.1", "M0", 2), id="one G13.1 missing"),
        pytest.param(changed("G13.1", "M0"), id="every G13.1 missing"),
        pytest.param(changed("G18 ", ""), id="no plane"),
        pytest.param(changed("G40 X60", "X60", 1), id="G40 missing once"),
        pytest.param(changed("T0202 .*", "T0202"), id="no comments"),
        pytest.param(changed("X60. Z2", "Z2"), id="X not programmed"),
        pytest.param(program([SOUND] * 6).replace("M30", ""), id="no M30"),
        pytest.param(program([SOUND] * 3 + [["M30", "O0002"]] + [SOUND] * 3), id="two programs"),
    ],
)
def test_faults_in_several_pieces(text: str) -> None:
    """Each is told as in one table: in its block, with its count, what follows from it, and what was not evaluated."""
    for machine, tools in (("fanuc", (TOOL,)), ("fanuc-30i", ())):
        found = in_pieces(text.encode(), machine, *tools)
        assert found is not None
        assert found == report_of(text, machine, *tools)


@pytest.mark.parametrize(
    "text",
    [
        pytest.param(changed("M35", "M9"), id="C never engaged"),
        pytest.param(changed("G98 ", "", 3), id="feed per revolution in one section"),
        pytest.param(changed("G28 H0", "M9"), id="C is not referenced"),
        pytest.param(changed("C11.547 F200.", "G3 X40. C11.547 R1."), id="arcs that cannot be"),
        pytest.param(changed("G18 ", "(ÄÖ) G18 "), id="letters outside of ASCII"),
        pytest.param(changed(r"\(END MILL D8.\)", "(D10.)", 5), id="another comment later"),
        pytest.param(changed("F200.", "F200. (POLARCHECK ALLOW C-FEED-ABOVE-LIMIT)"), id="allow comments"),
        pytest.param(changed("X40. C1", "X#1 C1", 3), id="macro"),
        pytest.param(changed("M34", "M98 P100", 3), id="call"),
        pytest.param(changed("M34", "/M34", 3), id="block skip"),
        pytest.param(changed("M34", "G10 P2 R4. Q0", 3), id="sets an offset"),
        pytest.param(changed("M34", "%\nTEXT\n%", 3), id="text between programs"),
        pytest.param(changed("M34", "M34 G987"), id="one code in several pieces"),
        pytest.param(changed("X40. ", "X40000 ", 0, 4), id="numbers without a point"),
        pytest.param(changed(" F200.", " E1."), id="words of no lathe"),
        pytest.param(program([SOUND] * 6).replace("\n", "\r"), id="no line ends"),
        pytest.param(program([SOUND] * 6) + "\x1a", id="Ctrl-Z"),
    ],
)
def test_what_hangs_together_is_one_table(text: str) -> None:
    """What one piece says of the others: nothing is guessed."""
    for machine in ("fanuc", "fanuc-30i", "turning-center"):
        found = in_pieces(text.encode("latin-1"), machine, TOOL)
        assert found is None or found == report_of(text.encode("latin-1"), machine, TOOL)


def test_a_comment_that_comes_later_makes_one_table() -> None:
    """It holds for the calls before it, too."""
    text = changed(r"T0202 .*", "T0202", *range(5))
    assert in_pieces(text.encode(), "fanuc-30i", TOOL) is None
    assert in_pieces(changed(r"T0202 .*", "T0202").encode(), "fanuc-30i", TOOL) is not None


def test_c_that_has_turned_on_is_no_end_of_a_piece(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where C stands behind a section is known by its next word alone: G13.1 is not where a piece can end."""
    monkeypatch.setattr(pieces, "SIZE", 300)
    monkeypatch.setattr(pieces, "NEAR", 6)
    text = program([SOUND] * 6)
    found = pieces.in_pieces(source.read(text.encode()), machine_of("fanuc"), Job())
    ends = []
    for piece in found:
        trace: Trace = piece.tables["trace"]
        rows = piece.own_rows
        assert not trace.in_polar[rows.stop - 1]
        assert not trace.offset_mode[rows.stop - 1]
        ends.append(text.splitlines()[int(trace.line[rows.stop - 1]) - 1])
    assert len(ends) > 4
    assert not {end for end in ends[:-1] if "G13.1" in end}


@pytest.mark.parametrize("is_one", [False, True], ids=["in pieces", "one table"])
def test_a_large_file_is_checked_in_pieces(is_one: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """By whatever command; the report is that of one table, and the offsets that it calls are known."""
    text = changed("M34", "M98 P100" if is_one else "M0")
    path = tmp_path / "large.nc"
    path.write_text(text)
    settings = Settings("fanuc-30i", machine_of("fanuc-30i"), job_of(TOOL), [*load_all().values()], {})
    whole = batch.outcome(batch.Task(str(path), settings))
    began: list[Callable[..., object]] = []
    monkeypatch.setattr(batch, "LARGE", 1000)
    monkeypatch.setattr(pieces, "SIZE", 300)
    real = pieces.Piece.own_rows.fget  # type: ignore[attr-defined]
    monkeypatch.setattr(pieces.Piece, "own_rows", property(lambda piece: began.append(real) or real(piece)))
    assert batch.outcome(batch.Task(str(path), settings)) == whole
    assert whole.called == {"1", "2"}
    assert began or is_one


def test_pieces_end_where_the_program_is_known_anew() -> None:
    """A section is never cut, however long it is."""
    text = program([[*SOUND[:18], *SOUND[18:25] * 100, *SOUND[25:]]])
    assert len(text) > 20 * 300
    found = in_pieces(text.encode(), "fanuc-30i", TOOL)
    assert found == report_of(text, "fanuc-30i", TOOL)
    assert found.sections == 1


def test_a_file_of_several_channels_is_one_table() -> None:
    """Each of them runs for itself."""
    text = "$1\n" + program([SOUND] * 3) + "$2\n" + program([SOUND] * 3)
    machine = machine_of("citizen")
    with pytest.raises(IsOneError):
        next(pieces.in_pieces(source.read(text.encode()), machine, Job()))


@pytest.mark.parametrize(
    "text",
    [
        pytest.param("(NOTHING)\n" * 300, id="comments"),
        pytest.param("\n" * 3000, id="empty lines"),
        pytest.param("%\n" + "(NOTHING)\n" * 300 + "G0 X1.\nM30\n%\n", id="a block behind comments"),
        pytest.param("G0 X1.\n" + "(NOTHING)\n" * 300, id="a block before comments"),
        pytest.param("G28 U0\nG0 X1.\n" * 300, id="no mode"),
        pytest.param("TEXT OF ANY KIND\n" * 300, id="prose"),
    ],
)
def test_files_with_hardly_any_blocks(text: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(pieces, "SIZE", 300)
    rules = [*load_all().values()]
    try:
        found, _ = piecewise.check_in_pieces(source.read(text.encode()), machine_of("fanuc"), Job(), rules, None)
    except IsOneError:
        return
    assert found == report_of(text, "fanuc")


def test_a_program_without_an_end_is_read_once_and_a_bit(monkeypatch: pytest.MonkeyPatch) -> None:
    """Each time no end is found twice as much is read, so that the cost grows in a straight line."""
    monkeypatch.setattr(pieces, "SIZE", 300)
    looked_at: list[int] = []
    real = pieces._ended

    def counted(text: Text, *more: Any) -> Any:
        looked_at.append(len(text.blocks))
        return real(text, *more)

    monkeypatch.setattr(pieces, "_ended", counted)
    text = program([[*SOUND[:18], *SOUND[18:25] * 600, *SOUND[25:]]])
    assert sum(len(piece.own) for piece in pieces.in_pieces(source.read(text.encode()), machine_of("fanuc"), Job()))
    assert sum(looked_at) < 2 * len(text.splitlines())
