"""
No word is lost and nothing is invented when a program is written for another lathe, whatever the pair of machines.

A square of round corners in the hand of each control gets blocks that no profile explains, inside the mode and behind
it. What becomes of them is read from the text alone: a word stands in the new program, in a comment of it, in a note,
or in the reason why nothing is written; numbers that a macro may take, or that belong to the machine, are in comments.
"""

from __future__ import annotations

import re
from collections.abc import Callable

import pytest
from cases import run
from test_convert import convert
from test_every_machine import HANDS, Part, written

from polarcheck.files.settings.of_programs import OfPrograms, Options
from polarcheck.rewrite.roll.rolling import Rolling, rolled
from polarcheck.rewrite.unroll.unrolling import Unrolling, unrolled
from polarcheck.rewrite.writing.original import Original
from polarcheck.rewrite.writing.outcome import Outcome, RefusedError
from polarcheck.rewrite.writing.rewritten_program import rewritten

PART = Part(10.0, 300.0)
#: Blocks with words that the geometry does not have; each number stands nowhere else.
IN_SECTION = ("M627", "G61", "G64", "G5.1 P71", "G10 P73 R4.77", "M8", "M629 P37")
BESIDE_A_MOVE = ("M631", ",R3.31", ",C2.27", "E79")
#: Blocks behind the mode that go into a comment whole: (block, the numbers that must not move anything).
WHOLE = (
    ("G300 Z-21.37", "21.37"), ("M641 Z-23.91", "23.91"), ("G53 G0 Z-27.13", "27.13"),
    ("G30 P2 W29.17", "29.17"), ("G10 L2 P1 Z31.19", "31.19"),
)  # fmt: skip
BEHIND = ("M643", "G54", "G5.1 P83", "Z41. M647")
#: Blocks in the mode that lead to where nobody knows.
REFUSED = ("G300 X41.37 F83", "G31 X43.91 F87", "M653 X47.11")
NAMES = sorted(set(HANDS) - {"fanuc-16i", "colchester"})


def program_of(name: str, in_section: tuple[str, ...], behind: tuple[str, ...]) -> str:
    hand = HANDS[name]
    lines = written(PART, hand).split("\n")
    off = lines.index(hand.off.split("\n")[0])
    lines[off + hand.off.count("\n") + 1 : off + hand.off.count("\n") + 1] = behind
    if in_section:
        lines[off - 3] += f" {' '.join(BESIDE_A_MOVE)}"
        lines[off - 4 : off - 4] = in_section
    return "\n".join(lines)


def divided(text: str, target: str) -> tuple[str, str]:
    """The words of a program, and its comments."""
    pattern = r";.*" if target == "siemens-transmit" else r"\([^)]*\)"
    return re.sub(pattern, "", text), " ".join(re.findall(pattern, text))


def plain(text: str) -> str:
    return re.sub(r"[^A-Z0-9.,#-]", " ", text.upper())


def has_word(word: str, text: str) -> bool:
    return re.search(rf"(?<![A-Z0-9.,]){re.escape(word)}(?![0-9.]*[0-9])", plain(text)) is not None


def assert_words(blocks: tuple[str, ...], name: str, target: str, texts: str) -> None:
    for block in blocks:
        for word in block.split():
            is_axis = word[0] in "XZFRW" and "." in word
            assert is_axis or has_word(word, texts), f"{name} to {target}: {word} of {block} is lost"


@pytest.mark.nightly
@pytest.mark.one_in(18)
@pytest.mark.parametrize("name", NAMES)
def test_each_word_of_a_section_is_in_the_result(name: str) -> None:
    written_for = 0
    for target in NAMES[:: 1 if run.is_nightly else 6]:
        try:
            outcome = convert(program_of(name, IN_SECTION, ()), name, target, "1:radius=3,nose=0")
        except RefusedError as error:
            assert error.refusals  # noqa: PT017
            continue
        written_for += 1
        texts = f"{outcome.data.decode()} {' '.join(outcome.notes)}"
        assert_words((*IN_SECTION, *BESIDE_A_MOVE), name, target, texts)
        if target != name:
            comments = plain(divided(outcome.data.decode(), target)[1]).split()
            for decision in outcome.decisions:
                assert plain(decision.text).split()[0] in comments, f"{name} to {target}: {decision.text}"
    assert written_for or name in ("siemens-transmit", "fagor-8055t")


@pytest.mark.nightly
@pytest.mark.one_in(18)
@pytest.mark.parametrize("name", NAMES)
def test_what_a_macro_or_the_machine_takes_moves_nothing(name: str) -> None:
    behind = (*(block for block, _ in WHOLE), *BEHIND)
    for target in NAMES[:: 1 if run.is_nightly else 6]:
        if target == name:
            continue
        try:
            outcome = convert(program_of(name, (), behind), name, target, "1:radius=3,nose=0")
        except RefusedError as error:
            assert error.refusals  # noqa: PT017
            continue
        words, comments = divided(outcome.data.decode(), target)
        assert_words(behind, name, target, f"{words} {comments} {' '.join(outcome.notes)}")
        for block, number in WHOLE:
            assert number in comments, f"{name} to {target}: {block}"
            assert number not in words, f"{name} to {target}: {block}"


@pytest.mark.ci
@pytest.mark.one_in(9)
@pytest.mark.parametrize("name", NAMES)
def test_a_move_to_where_nobody_knows_is_a_reason_in_the_mode(name: str) -> None:
    for block in REFUSED:
        target = "takisawa" if name != "takisawa" else "okuma-osp"
        with pytest.raises(RefusedError) as error:
            convert(program_of(name, (block,), ()), name, target, "1:radius=3,nose=0")
        assert error.value.refusals


@pytest.mark.ci
@pytest.mark.one_in(9)
@pytest.mark.parametrize("name", NAMES)
def test_each_word_of_a_section_is_in_plain_moves(name: str) -> None:
    """And in a section again; ,R and ,C are corners that nobody has followed."""
    settings = OfPrograms(Options(machine=name, tools=("1:radius=3,nose=0",), use_config=False))("")
    options = Unrolling(chord_error=0.5, feed="per-minute")

    def rewritten_by(program: str, work: Callable[[Original], Outcome]) -> str | None:
        try:
            return rewritten("a.nc", program.encode(), settings, work).data.decode()
        except RefusedError as error:
            assert error.refusals  # noqa: PT017
            return None

    without_corners = program_of(name, IN_SECTION, BEHIND).replace(",R3.31 ,C2.27 ", "")
    blocks = (*IN_SECTION, *BEHIND, "M631", "E79")
    for program in (without_corners, *(program_of(name, (block,), ()) for block in (*REFUSED, "M8"))):
        text = rewritten_by(program, lambda original: unrolled(original, options))
        assert text is None or program == without_corners, f"{name}: {program}"
        if text is None:
            continue
        assert_words(blocks, name, name, text)
        again = rewritten_by(text, lambda original: rolled(original, Rolling()))
        if again is not None:
            assert_words(blocks, name, name, again)


@pytest.mark.nightly
def test_a_macro_of_the_builder_a_dwell_and_a_speed_before_its_start() -> None:
    """A macro that is not in the file is to be decided; G4 stays; P stands beside the start of the live tool."""
    head = "%\nO1\nG21 G98 G40\nT0606\nM76\nG97 S2500\nM70\nG0 X60. Z2. C0\nG12.1\nG1 X36. C10. F150\nG4 P1000\n"
    program = f"{head}C-10.\nX60. C0\nG13.1\nM72\nM75\nG65 P9001 A1. B2.\nU-2.\nM30\n%\n"
    for target, dwell in (("doosan", "G4 P1000"), ("haas-lathe", "G4 P1000"), ("okuma-osp", "G4 F1.")):
        text = convert(program, "takisawa", target).data.decode()
        assert f"\n{dwell}" in text
        assert "DECIDE: G65 P9001 A1. B2.: THE MACRO IS NOT IN THE FILE" in text
        assert "(DECIDE: U-2.: " in text
    assert "G97 S2500\nP2500 M133\n" in convert(program, "takisawa", "haas-lathe").data.decode()
