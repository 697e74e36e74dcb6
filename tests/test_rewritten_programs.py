"""Programs of setters along the path of the tool center, with G41 again, and without the mode; what is refused."""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import partial
from typing import Any

import pytest
from cases import looped
from setter_programs import FAMILIES, drawn
from test_convert import END, HEAD, MILLED, SIEMENS, convert

from polarcheck.checking.settings import Settings
from polarcheck.files.settings.of_programs import OfPrograms, Options
from polarcheck.rewrite.compensate import centering, compensating
from polarcheck.rewrite.compensate.compensating import Compensating, centered, compensated
from polarcheck.rewrite.roll import rolling
from polarcheck.rewrite.roll.rolling import Rolling, rolled
from polarcheck.rewrite.unroll import unrolling
from polarcheck.rewrite.unroll.unrolling import Unrolling, unrolled
from polarcheck.rewrite.writing.original import Original
from polarcheck.rewrite.writing.outcome import Outcome, RefusedError
from polarcheck.rewrite.writing.rewritten_program import rewritten


def settings_of(machine: str, *tools: str) -> Settings:
    return OfPrograms(Options(machine=machine, tools=tools, use_config=False))("")


def outcome_of(program: str | bytes, settings: Settings, work: Callable[[Original], Outcome]) -> Outcome | None:
    """None where it is refused."""
    data = program.encode() if isinstance(program, str) else program
    try:
        return rewritten("a.nc", data, settings, work)
    except RefusedError as error:
        assert error.refusals  # noqa: PT017
        return None


def unroll(original: Original) -> Outcome:
    return unrolled(original, Unrolling(feed="per-minute"))


def compensate(original: Original) -> Outcome:
    return compensated(original, Compensating())


@pytest.mark.nightly
@pytest.mark.parametrize("start", range(8))
def test_programs_of_setters_are_rewritten(start: int) -> None:
    """Each is read back by its command: what is written is right; most are written."""
    counts = dict.fromkeys(("center", "contour", "plain", "rolled"), 0)
    for seed in range(5 * start + 1, 5 * start + 6):
        program = drawn(seed, "", FAMILIES[(17 * seed) % len(FAMILIES)])
        settings = settings_of(program.machine, *program.tools())
        center = outcome_of(program.text(), settings, centered)
        contour = outcome_of(program.text() if center is None else center.data, settings, compensate)
        plain = outcome_of(program.text(), settings, unroll)
        again = plain and outcome_of(
            plain.data, settings, lambda original: rolled(original, Rolling(feed="per-minute"))
        )
        for name, outcome in zip(counts, (center, contour, plain, again), strict=True):
            counts[name] += outcome is not None
    assert counts["center"] + counts["contour"] >= 5
    assert counts["plain"] >= 2


def refusal(program: str, work: Callable[[Original], Outcome], machine: str = "fanuc-30i", *tools: str) -> str:
    with pytest.raises(RefusedError) as error:
        rewritten("a.nc", program.encode(), settings_of(machine, *tools), work)
    return str(error.value)


IN_MODE = HEAD + "G0 X60. Z2. C0\nG12.1\n{}\nG13.1\nG0 Z50.\n" + END
CIRCLES = HEAD + "G0 X60. Z2. C0\nG12.1\nG1 X60. F200\nZ-1.\n"
CIRCLES += "X30. C10.\nX-30.\nC-10.\nX30.\nC10.\nX60.\nG13.1\nG0 Z50.\n" + END
CIRCLE = "G1 X40. C0 F200\nG3 X-40. C0 I-20. J0\nX40. C0 I20. J0\nG1 X60. C0"


@pytest.mark.ci
@looped(
    ("program", "expected"),
    [
        (IN_MODE.format("G1 X40. C5. F200").replace("G13.1\n", ""), "polar mode is never left"),
        (IN_MODE.format("G1 X40. C5. F200\nG12.1\nX30."), "the polar mode is switched on again within"),
        (IN_MODE.format("G1 X40. C5. F200").replace("X60. ", ""), "X is not known where the mode begins"),
        (IN_MODE.format("G1 X40. C5. F200").replace(" C0", ""), "C is not known where the mode begins"),
        (IN_MODE.format("G1 X40. C5. Z-1. F200").replace("X60. Z2.", "X60."), "Z moves beside X and C from a place"),
        (IN_MODE.format("#1=5\nG1 X40. C#1 F200").replace(END, f"G0 X#1\n{END}"), "a variable that the section sets"),
        (IN_MODE.format("G1 X40. C5."), "F is missing"),
        (HEAD + END, "there is no polar section in it"),
    ],
)
def test_why_a_section_is_not_unrolled(program: str, expected: str) -> None:
    assert expected in refusal(program, unroll)


@looped(
    ("program", "expected"),
    [
        (IN_MODE.format("G42 G1 X40. C0 F200\nC5.\nG40 X60."), "all polar sections have G41 or G42"),
        (IN_MODE.format("G1 Z-1. F200\nZ2."), "no polar section cuts"),
        (IN_MODE.format(CIRCLE).replace("T0101", "T0100"), "no tool offset is in force"),
        (IN_MODE.format(CIRCLE).replace("T0101", "T0202"), "R of T0202 is not known"),
        (IN_MODE.format(CIRCLE.replace("X-40. C0 I", "X-40. C0 T0303 I")), "another tool offset is called"),
    ],
)
def test_why_a_path_is_not_compensated(program: str, expected: str) -> None:
    assert expected in refusal(program, compensate, "fanuc-30i", "1:radius=4", "3:radius=5")


@pytest.mark.ci
@looped(
    ("program", "source", "target", "expected"),
    [
        (IN_MODE.format("G1 X[40.] C#1 F200"), "fanuc-30i", "haas-lathe", "is computed, and has to be another number"),
        (IN_MODE.format("G1 X40. C5. F200\nG91 Z[-1.]\nG90"), "mitsubishi-m700", "haas-lathe", "distances in a block"),
        (IN_MODE.format("G1 X40. C5. F200\nG0 Z[2.]"), "haas-lathe", "fanuc-30i", ""),
        (HEAD + "T0101\nG0 X60. Z2. C0\nM98 P7\n" + END, "fanuc-30i", "fagor-8055t", "writes that is not known"),
        (SIEMENS + "TRANS X5\nTRANSMIT\nG1 X20 Y5 F100\nTRAFOOF\nM30\n", "siemens-transmit", "okuma-osp", "by frames"),
        (SIEMENS + "S=R1 M3\nM30\n", "siemens-transmit", "okuma-osp", ""),
        (HEAD + "G4 P#1\n" + MILLED + END, "fanuc-30i", "okuma-osp", ""),
        (HEAD + "M76\nM70\n" + MILLED + END, "takisawa", "haas-lathe", "the speed of this spindle is not known"),
        ("$1\n" + HEAD + END + "$2\n" + HEAD + END, "citizen", "haas-lathe", "several channels"),
        (HEAD + "G0 X60. Z2. U5.\n" + END, "fanuc-30i", "mitsubishi-m700", ""),
        (HEAD + "G28 U0 W0\nG1 U2. Z1. F100\n" + END, "fanuc-30i", "mitsubishi-m700", ""),
        (HEAD + "N1 G0 W-1.\n#1=#1+1\nIF[#1 LT 3]GOTO 1\n" + END, "fanuc-30i", "siemens-transmit", "of a language"),
        (HEAD + "G76 P010060 Q100 R.1\nG76 X20. Z-20. P900 Q300 F1.\n" + END, "fanuc-30i", "haas-lathe", ""),
        (HEAD + "G65 P9010 A1. B2.\n" + END, "fanuc-30i", "haas-lathe", ""),
        (HEAD + "G90 X40. Z-5. F.2\nU-2.\nG0 X60.\n" + END, "fanuc-30i", "mitsubishi-m700", ""),
    ],
    one_in=4,
)
def test_what_converting_does_with_what_it_cannot_write(program: str, source: str, target: str, expected: str) -> None:
    """It is refused with the reason, or written with a decision where none is expected."""
    if expected:
        with pytest.raises(RefusedError, match=expected.replace("(", ".")):
            convert(program, source, target)
        return
    try:
        assert convert(program, source, target).data
    except RefusedError as error:
        assert error.refusals  # noqa: PT017


# ---- faults of the writers are found when the result is read back ----

SQUARE = IN_MODE.format("G1 X60. C10. F200 M8\nZ-1.\nX30. C10.\nX-30.\nC-10.\nX30.\nC10.\nX60.\nZ2.")
FAULTS = {
    "a block more outside": ("G0 Z50.", "G0 Z50.\nG0 X70."),
    "another place outside": ("G0 Z50.", "G0 Z51."),
    "an order less": (" M8", ""),
    "another speed": ("S500", "S600"),
    "another dwell": ("G4 P500", "G4 P900"),
    "Z elsewhere": ("Z-1.", "Z-1.1"),
    "a block less": ("G1 X30. C10.", ""),
}


def faulty(old: str, new: str, real: Callable[..., Any], *arguments: Any) -> tuple[bytes, list[int]]:
    data, origin = real(*arguments)
    return data.replace(old.encode(), new.encode(), 1), origin


@pytest.mark.ci
@pytest.mark.parametrize("fault", [*FAULTS, "X", "C", "F"])
@pytest.mark.parametrize("command", ["unroll", "center", "compensate", "roll"])
@pytest.mark.one_in(13)
def test_a_fault_of_a_writer_is_found(command: str, fault: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """A word of the result is changed before it is read back; what is the same or not there is passed over."""
    program = SQUARE.replace("T0101\n", "T0101\nG97 S500 M3\nG4 P500\n")
    settings = settings_of("fanuc-30i", "1:radius=4")
    if command == "center":
        program = rewritten("a.nc", program.encode(), settings, compensate).data.decode()
    if command == "roll":
        program = rewritten("a.nc", CIRCLES.encode(), settings, unroll).data.decode()
    module, work = {
        "unroll": (unrolling, unroll),
        "center": (centering, centered),
        "compensate": (compensating, compensate),
        "roll": (rolling, lambda original: rolled(original, Rolling(feed="per-minute"))),
    }[command]
    result = rewritten("a.nc", program.encode(), settings, work).data.decode()
    section = [line for line in result.splitlines() if fault in line and ("X" in line or "C" in line)]
    if fault in FAULTS:
        old, new = FAULTS[fault]
    else:
        line = section[len(section) // 2]
        number = re.search(rf"{fault}(-?[0-9.]+)", line)
        assert number
        old, new = line, line.replace(number[0], f"{fault}{float(number[1]) * 2 + 3:.3f}")
    if old not in result:
        pytest.skip("the word is not in this program")
    monkeypatch.setattr(module, "with_edits", partial(faulty, old, new, module.with_edits))
    outcome = outcome_of(program, settings, work)
    # F of sections is compared by unroll and roll; the others leave it as it is.
    assert outcome is None or (fault == "F" and command in ("center", "compensate")) or command == "roll"


# ---- words that only some programs have ----


@pytest.mark.ci
@looped(
    ("program", "source", "target", "expected"),
    [
        ("O1\nG90 G94\nT030203\nG0 X60. Z2. C0\n" + "M2\n", "okuma-osp", "fanuc-30i", "T0203"),
        ("O1\nG90 G94\nT130203\nG0 X60. Z2. C0\n" + "M2\n", "okuma-osp", "fanuc-30i", "T0203"),
        ("%\nO1\nG90 G94 G21\nT05.01 T00 M6\nG0 X60. Z2.\nM30\n%\n", "mazak-integrex", "fanuc-30i", "G0 X60. Z2."),
        (HEAD + "G20\nG0 X2.\nG99 G1 Z-1. F.01\n" + END, "fanuc-30i", "okuma-osp", "G0 X50.8"),
        (HEAD + "G0 X50000 Z2000\nG0 X60000\nZ3000\nX55000\n" + END, "fanuc-30i", "okuma-osp", "G0 X50 Z2\n"),
        (HEAD + "G0 X60. Z2. C0\nH45.\n" + END, "fanuc-30i", "siemens-transmit", "C-45\n"),
        (SIEMENS + "G0 X=IC(5) Z=AC(3)\nM30\n", "siemens-transmit", "haas-lathe", "Z3"),
        ("%\nO1 (A)\nG21 G98\nT0101\nG0 X60. Z2. (B)\n(C)\nM30\n%\n", "fanuc-30i", "siemens-transmit", "; C\n"),
        ("%\nO1\nG21 G98\nG0 X60. Z2.;G0 X50.;\nM30\n%\n", "fanuc-30i", "siemens-transmit", "G0 X60. Z2.\nG0 X50."),
        (HEAD + "G01 X60. F100\nG1 Z2.\n" + END, "fanuc-30i", "mitsubishi-m700", "G01 X30. F100\n"),
        (HEAD + "M3 S500\nM08\nG98\n" + END, "fanuc-30i", "mitsubishi-m700", "M08\nG94\n"),
        (HEAD + "M35\nG97 S900 M33\nG0 X60. Z2.\nM35\n" + END, "turning-center", "haas-lathe", "P900 M133\n"),
    ],
    one_in=4,
)  # fmt: skip
def test_words_that_few_programs_have(program: str, source: str, target: str, expected: str) -> None:
    assert expected in convert(program, source, target).data.decode()


MAZAK = "%\nO1\nG90 G94 G21\nT05.01 T00 M6\n"
MORE = [
    (IN_MODE.format("G1 X40. C5. F200\n#1=5.\nG3 X20. C-5. R[5.+#1]\nG1 X60. C0"), "fanuc-30i", "mazak-quick-turn"),
    (IN_MODE.format("G1 X40. C0 F200\n#1=20.\nG2 X-40. C0 I[0-#1] J0\nG1 X60. C0"), "fanuc-30i", "mazak-quick-turn"),
    (IN_MODE.format("G1 X40. C5. F200\nZ-1.\nG1 C[5.] Z-1. F[90.]\nG1 X60. C0"), "fanuc-30i", "haas-lathe"),
    (IN_MODE.format("G1 X40. C5. F200\nG1 X30. C2. Z-1.\nX60. C0"), "fanuc-30i", "turning-center"),
    (IN_MODE.format("G1 X40. C5. F200\nG3 X40.001 C5.001 R.5\nG1 X60. C0"), "fanuc-30i", "okuma-osp"),
    (IN_MODE.format("G1 X40. C5. F200\nG4 P500\nX30. M8\nM98 P7\nX60. C0") + "O7\nM9\nM99\n", "fanuc-30i", "doosan"),
    (IN_MODE.format("G1 X40. C5. F200\nX30. S900 M77\nX60. C0"), "fanuc-30i", "fanuc-16i"),
    (HEAD + "G83 Z-5. F80.\nG80\n" + END, "fanuc-30i", "siemens-iso"),
    (HEAD + "G92 U-1. Z-5. F1.\nG0 X60.\n" + END, "fanuc-30i", "mazak-eia"),
    (HEAD + "G20\nG83 Z-.5 F8.\nG80\n" + END, "fanuc-30i", "gsk-988"),
    (HEAD + "G28 W0\nG0 X60. W1.\n" + END, "fanuc-30i", "mazak-eia"),
    (HEAD + "GOTO 5\nG0 X1.\nG0 X2.\nN5 G0 X60.\n" + END, "fanuc-30i", "haas-lathe"),
    (HEAD + "T0101 G0 X60. #1=5\nG0 X#1\n" + END, "fanuc-30i", "haas-lathe"),
    (HEAD + "G0 X60. Z2.\nG43 H1 Z5.\nG49\n" + END, "fanuc-30i", "haas-lathe"),
    (HEAD + "G0 X60. Z2.\n,R5.\nG1 X50. ,R1. F100\n" + END, "fanuc-30i", "okuma-osp"),
    (HEAD + "G4 X[1.+1.]\nG99 G4 U2.\n" + END, "fanuc-30i", "siemens-transmit"),
    (HEAD + "#1=5\nG99 G1 F[.1]\nG20\nG1 Z-1. F[#1]\n" + END, "fanuc-30i", "okuma-osp"),
    (HEAD + "M98 P30007\nM30\nO7\nG0 X60.\nM99\n%\n", "fanuc-16i", "okuma-osp"),
    (SIEMENS + "L7 P2\nM30\n", "siemens-transmit", "haas-lathe"),
    (SIEMENS + 'T="MILL" D1\nM30\n', "siemens-transmit", "haas-lathe"),
    (SIEMENS + "IF R1==1 GOTOF A\nA: G0 X5\nM30\n", "siemens-transmit", "haas-lathe"),
    (SIEMENS + "G4 F=R1\nM30\n", "siemens-transmit", "haas-lathe"),
    (SIEMENS + "X=IC(5) Z=R1\nG91 X5 Z5\nG90\nM30\n", "siemens-transmit", "haas-lathe"),
    (SIEMENS + "G1 X55 Z1 F.1 G95\nG3 X50 Z-5 I=AC(40) K=AC(1)\nM30\n", "siemens-transmit", "haas-lathe"),
    (MAZAK + "G91 G28 X0 Z0\nG90 G0 X60. C0\nG91 C5.\nG90\nM30\n%\n", "mazak-eia", "fanuc-30i"),
    ("%\nO1\nG21 G98\nT101\nM154\nP#1 M133\nG0 X60.\nM135\nM155\nM30\n%\n", "haas-lathe", "okuma-osp"),
    ("O1\nG90 G94\nT030203\nT110203\nSB=VC1 M13\nG0 X60. Z2. C0\nCALL OABC\nM2\n", "okuma-osp", "haas-lathe"),
]  # fmt: skip


@pytest.mark.ci
@looped(("program", "source", "target"), MORE, one_in=9)
def test_any_program_is_converted_or_refused_with_its_line(program: str, source: str, target: str) -> None:
    """What is written is proven by reading it back; nothing else comes of it than a program or reasons."""
    try:
        assert convert(program, source, target).data
    except RefusedError as error:
        reasons = [refusal.text for refusal in error.refusals]
        if not all(reasons):
            pytest.fail(str(error))


LOOP = "#1=0\nWHILE[#1 LT 2]DO1\n#1=#1+1\nG1 Z[-#1] F100\nX40. C5. S[500+#1] M8\nX60. C0\nEND1"
PLAIN = [
    IN_MODE.format(LOOP),
    IN_MODE.format(LOOP.replace("S[500+#1] M8", "A[#1]")),
    IN_MODE.format("G91 G1 X-20. C5. F200\nG90 X60. C0").replace("G98", "G94"),
    IN_MODE.format("G1 X40. C5. F200\nIF[1 EQ 1]GOTO 9\nX30.").replace("G0 Z50.", "N9 G0 Z50."),
    HEAD + "G0 X60. Z2. C0\nM98 P7\nG1 X40. C5. F200\nG13.1\nM30\nO7\nG12.1\nM99\n%\n",
    IN_MODE.format("G1 X40. C5. F200\nW-1.\nX60. C0").replace(" Z2.", ""),
]


@pytest.mark.nightly
@looped("machine", ["fanuc-30i", "mitsubishi-m700"], one_in=5)
@looped("program", PLAIN)
def test_any_section_is_unrolled_or_refused_with_its_line(program: str, machine: str) -> None:
    settings = settings_of(machine, "1:radius=4")
    for work in (unroll, compensate, centered):
        outcome = outcome_of(program, settings, work)
        assert outcome is None or outcome.data


@pytest.mark.nightly
def test_elements_near_the_center_are_divided_for_the_limit_of_c() -> None:
    """An arc that passes 2 mm from the center: F of its parts keeps C at its limit."""
    program = IN_MODE.format("G1 X30. C0 F300\nG3 X-4. C0 R8.5\nG3 X30. C0 R8.5\nG1 X40. C3.\nX60. C0")
    plain = rewritten("a.nc", program.encode(), settings_of("fanuc-30i"), unroll).data
    slow = OfPrograms(Options(machine="fanuc-30i", changes=("limits.c_feed=1500",), use_config=False))("")
    outcome = rewritten("a.nc", plain, slow, lambda original: rolled(original, Rolling(feed="per-minute", keep_c=True)))
    assert any("C turns no faster than its limit allows" in note for note in outcome.notes)
