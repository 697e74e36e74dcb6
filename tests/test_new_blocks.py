"""New blocks in the place of those of a program: N words, comments, block skip, line ends, several blocks on a line."""

from __future__ import annotations

from pathlib import Path

import pytest
from cases import looped
from programs import CORPUS, machine_of, tables_of

from polarcheck.checking.settings import Settings
from polarcheck.program.machines.job import Job, Running
from polarcheck.rewrite.writing import original
from polarcheck.rewrite.writing.new_blocks import NewBlock, edit_behind, edits_of, edits_of_signs, with_edits
from polarcheck.rewrite.writing.style import PLAIN, Style
from polarcheck.rewrite.writing.style_of import style_of

NEW = {
    "none": (),
    "one": (NewBlock(("G1", "X5.")),),
    "two": (NewBlock(("G1", "X5.")), NewBlock(("Y6.",), "IN TWO")),
    "three": (NewBlock(("G1", "X5.")), NewBlock(("Y6.",)), NewBlock(("G113",))),
}


def rewritten(program: bytes, line: int, new: str, target: str = "fanuc", machine: str = "fanuc") -> bytes:
    """A program with new blocks in the place of the first block of a line."""
    job = Job(run=Running(block_skip="off"))
    settings = Settings(machine, machine_of(machine), job, {}, {}, encoding=None)
    program_read = original.read("-", program, settings)
    text = program_read.trace.text
    index = text.blocks.line.tolist().index(line)
    profile = machine_of(target)
    edits = edits_of(program_read, {index: NEW[new]}, style_of(program_read.trace), profile)
    return with_edits(program_read, [*edits, *edits_of_signs(program_read, profile)])[0]


@pytest.mark.ci
@looped(
    ("program", "line", "new", "expected"),
    [
        # N words, in the step of the program where there is room
        (b"N10 G0 X1.\nN20 G1 X2. F9.\nN30 X3.\n", 2, "one", b"N10 G0 X1.\nN20 G1 X5.\nN30 X3.\n"),
        (b"N10 G0 X1.\nN20 X2.\nN30 X3.\n", 2, "two", b"N10 G0 X1.\nN20 G1 X5.\nN25 Y6. (IN TWO)\nN30 X3.\n"),
        (b"N10 G0 X1.\nN20 X2.\nN30 X3.\n", 3, "three", b"N10 G0 X1.\nN20 X2.\nN30 G1 X5.\nN40 Y6.\nN50 G113\n"),
        (b"N0010G0X1.\nN0020X2.\nN0030X3.\n", 2, "two", b"N0010G0X1.\nN0020G1X5.\nN0025Y6. (IN TWO)\nN0030X3.\n"),
        (b"N1 G0 X1.\nN2 X2.\nN3 X3.\n", 2, "two", b"N1 G0 X1.\nN2 G1 X5.\nY6. (IN TWO)\nN3 X3.\n"),
        (b"N10 X1.\nN20 X2.\nN21 #1=2\nN30 X3.\n", 2, "two", b"N10 X1.\nN20 G1 X5.\nY6. (IN TWO)\nN21 #1=2\nN30 X3.\n"),
        (b"G0 X1.\nX1.\nN20 X2.\nX3.\nX4.\n", 3, "two", b"G0 X1.\nX1.\nN20 G1 X5.\nY6. (IN TWO)\nX3.\nX4.\n"),
        # comments, block skip, line ends
        (b"G0 X1.\nG1 X2. (HERE) F9.\nX3.", 2, "two", b"G0 X1.\nG1 X5. (HERE)\nY6. (IN TWO)\nX3."),
        (b"G0 X1.\r\n/2 G1 X2.\r\nX3.\r\n", 2, "two", b"G0 X1.\r\n/2 G1 X5.\r\n/2 Y6. (IN TWO)\r\nX3.\r\n"),
        (b"G0 X1.;\nG1 X2.;\nX3.;\n", 2, "two", b"G0 X1.;\nG1 X5.;\nY6. (IN TWO);\nX3.;\n"),
        (b"G0 X1.\nX2.; X3.; X4.\n", 2, "two", b"G0 X1.\nG1 X5.; Y6. (IN TWO); X3.; X4.\n"),
        (b"G0 X1.\nX2.", 2, "two", b"G0 X1.\nG1 X5.\nY6. (IN TWO)"),
        (b"G0 X1.\n  X2.\n", 2, "one", b"G0 X1.\n  G1 X5.\n"),
        # taken out: with its line, but for a comment, or an N word that something leads to
        (b"G0 X1.\nN20 X2.\nX3.\n", 2, "none", b"G0 X1.\nX3.\n"),
        (b"G0 X1.\nN20 X2. (HERE)\nX3.\n", 2, "none", b"G0 X1.\nN20 (HERE)\nX3.\n"),
        (b"G0 X1.\nN20 X2.\nX3.\nM99 P20\n", 2, "none", b"G0 X1.\nN20\nX3.\nM99 P20\n"),
        (b"G0 X1.\nN20 X2.\nX3.\nIF[#100GT1]GOTO20\n", 2, "none", b"G0 X1.\nN20\nX3.\nIF[#100GT1]GOTO20\n"),
        (b"G0 X1.;X2.;X3.\n", 1, "none", b"X2.;X3.\n"),
    ],
)  # fmt: skip
def test_new_blocks_stand_as_the_program_writes_its_own(program: bytes, line: int, new: str, expected: bytes) -> None:
    assert rewritten(program, line, new) == expected


@looped(
    ("program", "expected"),
    [
        (b"G0 X1. (A)\nX2. (B (C)\nX3.\n", b"G0 X1. (A)\nG1 X5. ; B (C\nY6. ; IN TWO\nX3.\n"),
        (b"G0 X1.; X2.;X3.;\nG1 X2.; X3.;\n", b"G0 X1.\nX2.\nX3.;\nG1 X5.\nY6. ; IN TWO\nX3.;\n"),
    ],
)
def test_a_semicolon_that_is_a_comment_there_parts_no_blocks(program: bytes, expected: bytes) -> None:
    assert rewritten(program, 2, "two", "siemens-transmit") == expected


def test_comments_change_their_signs() -> None:
    back = rewritten(b"G0 X1\nG1 X2 ; part (A)\nX3\n", 2, "one", "fanuc", "siemens-transmit")
    assert back == b"G0 X1\nG1 X5. (part [A])\nX3\n"
    kept = rewritten("G0 X1.\nX2. (äö)\n".encode(), 2, "two")
    assert kept == "G0 X1.\nG1 X5. (äö)\nY6. (IN TWO)\n".encode()


def test_blocks_may_stand_beside_one_that_stays() -> None:
    settings = Settings("fanuc", machine_of("fanuc"), Job(), {}, {}, encoding=None)
    program = original.read("-", b"G0 X1.\r\nX2.\r\n", settings)
    edit = edit_behind(program, 0, NEW["two"], PLAIN, machine_of("fanuc"))
    data, lines = with_edits(program, [edit])
    assert data == b"G0 X1.\r\nG1 X5.\r\nY6. (IN TWO)\r\nX2.\r\n"
    assert lines == [1, 1, 1, 2]


# ---- style ----

HEAD = "O1\nG98 G0 X60. C0\nG12.1\n"


@looped(
    ("blocks", "style"),
    [
        ("G1 X40. F200\nC10.\nX20.5 C0.5\n", Style()),
        ("G01X40.000F200.0\nC10.000\nX20.500C-0.500\nX10.000F100.0\n",
         Style(blank="", code_digits=2, decimals=3, feed_decimals=1, feed_point=True)),
        ("G1 X40. C0. F200.\nG1 X40. C10. F200.\nG1 X20.5 C10. F200.\n",
         Style(repeats_motion=True, repeats_axes=True, repeats_feed=True, feed_point=True, zero_point=True)),
        ("G1 X40. F200\nC.5\nX.25\n", Style(leading_zero=False)),
        ("N0100 G1 X40. F200\nN0105 C10.\nN0110 X20.\nN0115 X10.\nN0120 C0\n",
         Style(numbered="all", number_step=5, number_digits=4)),
        ("N1 G1 X40. F200\nC10.\nX20.\nX10.\nC0\nX1.\nN2 X3.\n", Style(numbered="some", number_step=1)),
        ("G1 X40. F200\nG3 X20. C10. R10.\nG1 C5.\n", Style(by_center=False)),
        ("G1 X40. F200\nG3 X20. C10. I-10. J0\nG1 C5.\n", Style(by_center=True)),
    ],
)  # fmt: skip
def test_the_style_of_a_program_is_recognized(blocks: str, style: Style) -> None:
    # HEAD is in the default style, so that few of the words may be in that.
    back = style_of(
        tables_of(HEAD + blocks * (1 if "N" in blocks or "G3" in blocks else 8) + "G13.1\nM30\n", "fanuc")["trace"]
    )
    assert back == style


def test_a_program_without_words_has_the_default_style() -> None:
    assert style_of(tables_of("%\n", "fanuc")["trace"]) == PLAIN


@pytest.mark.nightly
def test_styles_of_the_corpus_are_recognized() -> None:
    if not CORPUS.is_dir():
        pytest.skip("the corpus is not beside the checkout")
    for path in sorted(Path(CORPUS).rglob("*"))[:60]:
        if path.is_file() and path.stat().st_size < 200_000:
            style = style_of(tables_of(path.read_bytes(), "fanuc")["trace"])
            assert style.number_step > 0
