"""How lathes are programmed: the words around the mode, as their profiles and facts pages have them."""

from __future__ import annotations

from typing import NamedTuple


class Dialect(NamedTuple):
    """
    The words of a control.

    machine: its profile. system: A (U, W, H) or B (G90, G91). virtual, virtual_step: addresses of the virtual axis.
    diameter_outside, diameter_inside: X words are diameters outside of the mode, in it. line, cw, ccw: motion codes in
    the mode. radius_word: of arcs. centers: I and J may be written. before, on, behind, off: blocks around the mode.
    engage, release: the C axis. reference: of the C axis. spindle, spindle_off: of the live tool. per_minute,
    per_revolution: feed modes. head: the first blocks. calls: M98 and macro statements are written. index: C positioned
    before G12.1 turns the contour. remark: what a comment stands between. cycles: turning cycles of system A.
    starts_in_inch: where a program selects no unit. read_ahead: blocks that the compensation
    knows in advance. outward: 1 where Z grows away from the part, -1 where it grows into it.
    """

    machine: str
    system: str = "A"
    virtual: str = "C"
    virtual_step: str = "H"
    diameter_outside: bool = True
    diameter_inside: bool = True
    line: str = "G1"
    cw: str = "G2"
    ccw: str = "G3"
    radius_word: str = "R"
    centers: bool = True
    before: tuple[str, ...] = ()
    on: str = "G12.1"
    behind: tuple[str, ...] = ()
    off: str = "G13.1"
    engage: str = ""
    release: str = ""
    reference: str = "G28 H0"
    spindle: str = "G97 S3000 M13"
    spindle_off: str = ""
    per_minute: str = "G98"
    per_revolution: str = "G99"
    head: tuple[str, ...] = ("G40",)
    calls: bool = True
    index: bool = True
    remark: tuple[str, str] = ("(", ")")
    cycles: bool = True
    inch: str = "G20"
    metric: str = "G21"
    units: tuple[str, ...] = ("mm", "inch")
    starts_in_inch: bool = False
    read_ahead: int = 3
    outward: int = 1


_B = Dialect("", system="B", per_minute="G94", per_revolution="G95", cycles=False, reference="G28 C0")

DIALECTS = {
    dialect.machine: dialect
    for dialect in (
        Dialect("fanuc"),
        Dialect("fanuc-16i"),
        Dialect("fanuc-30i", spindle="G97 S2500 M3"),
        Dialect("gsk-988", units=("mm",)),
        Dialect("doosan", engage="M35", release="M34", spindle="G97 S3000 M33"),
        Dialect("takisawa", engage="M76", release="M75", spindle="G97 S3000 M70", spindle_off="M72"),
        Dialect("colchester", engage="M109", release="M110"),
        Dialect(
            "mazak-quick-turn", engage="M200", release="M202", spindle="G97 S3000 M203",
            spindle_off="M205", before=("G17 XC",),
        ),
        Dialect(
            "turning-center", engage="M35", spindle="G97 S2000 M33", spindle_off="M35", head=("G18", "G40"),
            units=("inch",), starts_in_inch=True,
        ),
        Dialect(
            "haas-lathe", virtual="Y", virtual_step="V", diameter_inside=False, before=("G17",), on="G112", off="G113",
            behind=(), engage="M154", release="M155", spindle="G97 P2500 M133", spindle_off="M135",
            starts_in_inch=True,
        ),
        Dialect(
            "okuma-osp", system="B", virtual="Y", virtual_step="V", diameter_inside=False, line="G101", cw="G102",
            ccw="G103", radius_word="L", centers=False, on="G137 C0", behind=("G17",), off="G136", engage="M110",
            release="M109", reference="", spindle="G97 SB=3000 M13", spindle_off="M12", per_minute="G94",
            per_revolution="G95", calls=False, index=False, cycles=False, inch="", metric="", units=("mm",),
            read_ahead=10,
        ),
        _B._replace(machine="siemens-iso", head=("G90", "G40"), calls=False),
        Dialect(
            "siemens-transmit", system="B", virtual="Y", virtual_step="V", diameter_inside=False, radius_word="CR=",
            before=("DIAMOF",), on="TRANSMIT", off="TRAFOOF", reference="", spindle="SETMS(2) S2=3000 M2=3",
            per_minute="G94", per_revolution="G95", head=("G90", "G40", "DIAMON"), calls=False, index=False,
            remark=("; ", ""), cycles=False, inch="G70", metric="G71", units=("mm",),
        ),
        Dialect(
            "citizen", virtual="Y", virtual_step="V", diameter_inside=False, on="G12.1 D0 E=C", behind=("G17",),
            spindle="G97 S3000 M13", cycles=False, calls=False, outward=-1,
        ),
        _B._replace(
            machine="mazak-eia", engage="M200", release="M202", before=("G17 XC",), head=("G90", "G40"),
            spindle="G97 S3000 M203",
        ),
        _B._replace(machine="mitsubishi-m700", diameter_outside=False, diameter_inside=False, head=("G90", "G40")),
        Dialect(
            "lsis", diameter_outside=False, diameter_inside=False, on="G112", off="G113", calls=False, cycles=False,
            units=("mm",),
        ),
    )
}  # fmt: skip
