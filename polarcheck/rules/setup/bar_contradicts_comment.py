from __future__ import annotations

from polarcheck.checking.rule import WARNING, Bar, Mask, rule


@rule(
    WARNING,
    "the program turns {turned_diameter}, more than the bar that the comment in line {bar_comment} states",
    where="mode.enters",
)
def bar_contradicts_comment(bar: Bar) -> Mask:
    """
    Comment that states a smaller bar than the program turns.

    The program was written for another bar than its comment says: whoever loads the bar of the comment turns and mills
    in the air, or clamps a bar that does not hold the part. Only comments that say plainly what they mean are read, as
    (BAR DIA 28), (STOCK D50) or (HEX BAR 32).

    Source: programs of shops, which write the bar at the head of a program.

    Bad, tool 1:radius=4:

        O1000
        (BAR DIA 28)
        T0303
        G97 S1500 M3
        G99 G0 X42. Z2.
        G1 Z0 F0.2
        X-1.6
        G0 X40. Z1.
        G1 Z-30.          (expect: bar-contradicts-comment)
        X44.
        G0 X100. Z50. M5
        T0101
        G98 G0 X60. Z2. C0
        G12.1
        G1 Z-5. F500
        G42 X30. C0 F200
        G3 I-15.
        G1 G40 X60. F500
        Z2.
        G13.1
        G0 X100. Z50.
        M30

    Good, tool 1:radius=4:

        O1000
        (BAR DIA 42)
        T0303
        G97 S1500 M3
        G99 G0 X42. Z2.
        G1 Z0 F0.2
        X-1.6
        G0 X40. Z1.
        G1 Z-30.
        X44.
        G0 X100. Z50. M5
        T0101
        G98 G0 X60. Z2. C0
        G12.1
        G1 Z-5. F500
        G42 X30. C0 F200
        G3 I-15.
        G1 G40 X60. F500
        Z2.
        G13.1
        G0 X100. Z50.
        M30
    """
    return bar.contradicts_comment
