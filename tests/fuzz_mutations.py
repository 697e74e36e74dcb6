"""
Programs made worse: bytes turned, blocks dropped, doubled and swapped, numbers replaced by extreme ones, two programs
spliced, line ends changed. The same Random gives the same result.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from random import Random

#: What controls know, and what stands near it in real programs.
WORDS = (
    *("G12.1", "G13.1", "G112", "G113", "G41", "G42", "G40", "G0", "G1", "G2", "G3", "G4", "G18", "G17", "G20", "G21"),
    *("G28 U0", "G50 S2000", "G54", "G10 L2 P1 X1.", "G92 X0", "G68 X0 C0 R30.", "G69", "G71 U1. R1.", "G76", "G80"),
    *("G83 Z-5. R2.", "G43 H1", "G49", "G52 X1.", "G53", "G7.1 C20.", "G12.1 E8", "G12.1 E", "G50.2", "G107 C5."),
    *("M98 P2", "M98 P0002 L3", "M98 <A>", "M99", "M99 P10", "M97 P10", "G65 P2 A1. B#1", "G66 P2", "G67", "M30", "M2"),
    *("M0", "M1", "M3 S500", "M5", "M45", "M46", "T0101", "T0808", "T0", "T#1", "G98", "G99", "G94", "G95", "G96 S200"),
    *("X#1", "C[#1+#2]", "X-#3", "R[1/3]", "#1=#1+1", "#1=1", "#2=[1/0]", "#3=SQRT[-1]", "#4=POW[10,40]", "#500=#0"),
    *("#3000=1(STOP)", "#5041=0", "#2001=5.", "#0=1", "#1=ATAN[1]/[0]", "#2=SIN[30]*#1", "IF[#1LT5]GOTO10", "GOTO10"),
    *("WHILE[#1LT3]DO1", "END1", "DO1", "DO2", "IF[#1EQ#0]THEN#2=1", "N10", "N20", "O1", "O2", "O<A>", ":3", "GOTO#1"),
    *("(CUTTER 10. DIA)", "(3/4 DIA. CUTTER)", "(", ")", "%", "/", "/2", ";", "<", ">", "!", "=", "[", "]", ",", "\t"),
    *(",R2.", ",C1.", ",A45.", "I5.", "J-5.", "K1.", "R5.", "R-5.", "U1.", "H90.", "W-1.", "V1.", "E0.5", "F100", "F0"),
    *("X0", "C0", "X1.C0", "X40. C5.", "C-5.", "G1 X40. C10. F100", "G3 X0 C20. R20.", "G2 X40. C0 I-5. J5.", "Z-5."),
    *("G1 G41 X30. C3.", "G1 G40 X60.", "G1 G42 C-10.", "G0 X80. C0 Z2.", "DPRNT[X#1[53]]", "G5.1 Q1", "G8 P1", "G61"),
)
#: Numbers at the edges of what controls and floating-point numbers hold.
NUMBERS = (
    *("0", "-0", "0.", ".", "-.", "+5.", "--5", "5.5.5", "5-", "1", "0.001", "0.0005", ".0001", "0.000000001", "-1."),
    *("89.999999", "90.", "180.", "359.999", "360.", "999.999", "9999.9999", "99999999", "999999999", "-99999.999"),
    *("2147483647", "2147483648", "4294967296", "9223372036854775808", "1000000000000000", "12345678901234567"),
    *("9" * 15, "9" * 22, "9" * 40, "9" * 150, "9" * 310, "9" * 400, "1" + "0" * 155, "." + "0" * 330 + "1"),
    *("#1", "#0", "#100", "#500", "[1/3]", "[-1]", "[1/0]", "[POW[10,30]]", "[SQRT[-1]]", "#[#1]", "#3001", "\u0660"),
)
_NUMBER = re.compile(rb"[-+]?(?:\d+\.?\d*|\.\d+)")
_LETTERS = b"GMXYZCUVWHIJKRFSTNOPQLEABD"
_LINE_ENDS = (b"\n", b"\r\n", b"\n\r\r", b"\r\r\n", b"\r", b"\n\n", b";\n", b"", b"\x85", b"\x0b", b"\x00\n")
_HEADS = (b"\xef\xbb\xbf", b"\xff\xfe", b"\xfe\xff", b"%", b"%\n", b"\x00" * 20, b"\x1a", b"O1\n", b"\n" * 50, b"(")
_LONGEST = 40_000

Change = Callable[[bytes, Random, Sequence[bytes]], bytes]


def mutated(data: bytes, random: Random, others: Sequence[bytes]) -> bytes:
    """A program with one to six changes; others: programs to take blocks from. At most 40,000 bytes of it are kept."""
    for _ in range(random.choice((1, 1, 1, 2, 2, 3, 4, 6))):
        data = random.choice(_CHANGES)(data, random, others)
    return data[:_LONGEST]


def _span(length: int, random: Random) -> tuple[int, int]:
    start = random.randrange(length + 1)
    return start, min(length, start + random.choice((1, 1, 2, 3, 8, 30)))


def _bytes_turned(data: bytes, random: Random, others: Sequence[bytes]) -> bytes:
    found = bytearray(data or b"G1")
    for _ in range(random.choice((1, 1, 2, 8))):
        at = random.randrange(len(found))
        found[at] = random.choice((found[at] ^ (1 << random.randrange(8)), random.randrange(256), *b" .-(/;[]#=%,"))
    return bytes(found)


def _bytes_dropped(data: bytes, random: Random, others: Sequence[bytes]) -> bytes:
    start, end = _span(len(data), random)
    return data[:start] + data[end:]


def _cut_off(data: bytes, random: Random, others: Sequence[bytes]) -> bytes:
    start, _ = _span(len(data), random)
    return data[:start] if random.random() < 0.7 else data[start:]


def _blocks_changed(data: bytes, random: Random, others: Sequence[bytes]) -> bytes:
    """Dropped, doubled, moved elsewhere."""
    blocks = data.split(b"\n")
    start, end = _span(len(blocks), random)
    chosen, rest = blocks[start:end], blocks[:start] + blocks[end:]
    times = random.choice((0, 1, 1, 2, 2, 5))
    at = start if random.random() < 0.4 else random.randrange(len(rest) + 1)
    return b"\n".join([*rest[:at], *chosen * times, *rest[at:]])


def _block_repeated(data: bytes, random: Random, others: Sequence[bytes]) -> bytes:
    blocks = data.split(b"\n")
    start, end = _span(len(blocks) - 1, random)
    return b"\n".join([*blocks[:start], *blocks[start:end] * random.choice((10, 50, 200)), *blocks[end:]])


def _blocks_swapped(data: bytes, random: Random, others: Sequence[bytes]) -> bytes:
    blocks = data.split(b"\n")
    one, other = random.randrange(len(blocks)), random.randrange(len(blocks))
    blocks[one], blocks[other] = blocks[other], blocks[one]
    return b"\n".join(blocks)


def _number_replaced(data: bytes, random: Random, others: Sequence[bytes]) -> bytes:
    numbers = list(_NUMBER.finditer(data))
    if not numbers:
        return data
    found = random.choice(numbers)
    wanted = random.choice(NUMBERS).encode()
    if random.random() < 0.4:
        value = float(found[0]) if len(found[0]) < 30 else 1.0
        near = value + random.choice((-1, 1)) * random.choice((0.001, 0.01, 0.1, 1, 10, abs(value) or 1))
        wanted = random.choice((b"%.3f" % near, b"%.4f" % -value, b"%d" % round(value), b"%.9f" % (value * 1.0001)))
    return data[: found.start()] + wanted + data[found.end() :]


def _letter_replaced(data: bytes, random: Random, others: Sequence[bytes]) -> bytes:
    letters = [at for at, byte in enumerate(data) if byte in _LETTERS]
    if not letters:
        return data
    at = random.choice(letters)
    return data[:at] + bytes([random.choice(_LETTERS)]) + data[at + 1 :]


def _words_added(data: bytes, random: Random, others: Sequence[bytes]) -> bytes:
    """A word, beside others or as a block of its own."""
    at = random.randrange(len(data) + 1)
    if random.random() < 0.7:
        at = data.find(b"\n", at) + 1 or len(data)
    word = random.choice(WORDS).encode()
    return data[:at] + random.choice((word, word + b"\n", b"\n" + word + b"\n", b" " + word)) + data[at:]


def _spliced(data: bytes, random: Random, others: Sequence[bytes]) -> bytes:
    """The head of this program and the tail of another, or some blocks of the other put into this one."""
    other = random.choice(others) if others else data
    ours, theirs = data.split(b"\n"), other.split(b"\n")
    start, _ = _span(len(ours), random)
    first = random.randrange(len(theirs))
    if random.random() < 0.4:
        return b"\n".join([*ours[:start], *theirs[first:]])
    return b"\n".join([*ours[:start], *theirs[first : first + random.choice((1, 2, 5, 15))], *ours[start:]])


def _line_ends_changed(data: bytes, random: Random, others: Sequence[bytes]) -> bytes:
    if random.random() < 0.5:
        return data.replace(b"\n", random.choice(_LINE_ENDS))
    blocks = data.split(b"\n")
    at = random.randrange(len(blocks))
    return b"\n".join(blocks[: at + 1]) + random.choice(_LINE_ENDS) + b"\n".join(blocks[at + 1 :])


def _head_changed(data: bytes, random: Random, others: Sequence[bytes]) -> bytes:
    if random.random() < 0.2:
        return data.decode("latin-1").encode("utf-16")
    return random.choice(_HEADS) + data if random.random() < 0.7 else data + random.choice(_HEADS)


def _programs_called(data: bytes, random: Random, others: Sequence[bytes]) -> bytes:
    """The program becomes a called one, behind one that calls it."""
    call = random.choice((b"M98 P77", b"M98 P77 L2", b"G65 P77 A1. B2.", b"G66 P77", b"M98 P#1", b"M98 P0077"))
    ends = random.choice((b"\nM99\n", b"\nM99 P10\n", b"\n", b"\nM30\n"))
    return b"O1\nG21 G98\nT0101\nG0 X80. C0 Z2.\n" + call + b"\nX60.\nM30\nO77\n" + data + ends


_CHANGES: tuple[Change, ...] = (
    *(_bytes_turned, _bytes_dropped, _cut_off, _blocks_changed, _blocks_changed, _block_repeated, _blocks_swapped),
    *(_number_replaced, _number_replaced, _number_replaced, _letter_replaced, _words_added, _words_added, _words_added),
    *(_spliced, _spliced, _line_ends_changed, _head_changed, _programs_called),
)
