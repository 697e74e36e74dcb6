"""
A lathe that runs the programs of many controls: what the tool does, step by step. It shares no module with the package.

It runs programs without faults, as posts write them: no alarm, no overcut. Cutter compensation is a side, not a path,
since controls go round corners otherwise; where the tool stands is where the program says.
"""

from __future__ import annotations

import cmath
import math
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from string import ascii_uppercase
from typing import Any

INCH = 25.4
_NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)"
_WORD = re.compile(
    rf"(?P<name>TRANSMIT|TRAFOOF|DIAMOF|DIAMON|SETMS\(\d+\)|RTS\b|CALL\s*O(?P<called>\d+))"
    rf"|(?P<address>(?:SB|CR|[SMC]\d?|T)=|[A-Z])\s*"
    rf"(?P<value>\"[^\"]*\"|(?:DC|AC|IC)\({_NUMBER}\)|{_NUMBER}|-?(?:\[[^\]]*\]|\#\d+))"
)
_ABSENT = math.nan
#: Shorter moves are rounding [mm].
_SHORT = 0.003


@dataclass(frozen=True)
class Control:
    """
    What the words of a control mean.

    system: of its G codes: A, B, C or S, Siemens. on, off: of the mode. virtual: address of the virtual axis.
    x, x_in_mode: X words count twice the radius (2) or once (1), in the mode as before it (0). lies: the plane lies
    where C stands at the switch ("switch"), where C0 is ("c0"), or where the word C beside the switch points ("word").
    sense: of C against the angle of the plane. increments: a length without a point counts 0.001 mm. in_space: F is
    along the way with Z. codes: G codes with other numbers. orders: M code -> state and value; also: what else it does.
    live_speed: the address of its speed. dwells: address -> seconds, or None: a length. comments: what begins and ends
    one. words: of its own -> what they are here.
    """

    system: str = "A"
    on: tuple[str, ...] = ("G12.1", "G112")
    off: tuple[str, ...] = ("G13.1", "G113")
    virtual: str = "C"
    x: int = 2
    x_in_mode: int = 2
    lies: str = "switch"
    sense: int = 1
    increments: bool = False
    in_space: bool = False
    inch: bool = False
    codes: dict[str, str] = field(default_factory=dict)
    orders: dict[str, tuple[str, str]] = field(default_factory=dict)
    also: dict[str, tuple[str, str]] = field(default_factory=dict)
    live_speed: str = "S"
    radius: str = "R"
    dwells: dict[str, float | None] = field(default_factory=lambda: {"X": None, "U": None, "P": 0.001})
    comments: str = r"\([^)\n]*\)?|;.*"
    words: tuple[tuple[str, str], ...] = ()


_MAIN = {"M3": ("main", "cw"), "M4": ("main", "ccw"), "M5": ("main", "off")}


def _orders(engage: str = "", release: str = "", live: str = "", stop: str = "", **further: str) -> dict[str, Any]:
    """M codes by what they do: C on, C off, live tool forwards and backwards, live tool off; clamp and unclamp."""
    orders = {"M8": ("coolant", "on"), "M7": ("coolant", "on"), "M9": ("coolant", "off"), **_MAIN}
    for code, order in ((engage, ("c_axis", "on")), (release, ("c_axis", "off")), (stop, ("live", "off"))):
        orders.update({code: order} if code else {})
    orders.update(zip(live.split(), (("live", "cw"), ("live", "ccw")), strict=False))
    return orders | {code: ("clamp", what) for what, code in further.items()}


_FANUC = Control(orders=_orders(), increments=True)
_MAZAK = Control("B", ("G12.1",), ("G13.1",), orders=_orders("M200", "M202", clamp="M210", unclamp="M212"), words=(
    (r"G17\s*(XC|UH|X\s*C)", "G17"), (r"G10\.9\s*X0", "DIAMOF"), (r"G10\.9\s*X1", "DIAMON")),
    increments=True, x_in_mode=0)  # fmt: skip
_INTEGREX = {**_orders("M200", "M202", "M3 M4", "M5", clamp="M210", unclamp="M212"), "M203": ("main", "cw"),
             "M204": ("main", "ccw"), "M205": ("main", "off")}  # fmt: skip
CONTROLS = {
    "fanuc": _FANUC,
    "fanuc-16i": _FANUC,
    "fanuc-30i": _FANUC,
    "gsk-988": Control(orders=_orders()),
    "lsis": Control(on=("G112",), off=("G113",), x=1, x_in_mode=1, orders=_orders(), comments=r"\([^)\n]*\)?|%.*"),
    "takisawa": Control(
        orders=_orders("M76", "M75", "M70 M71", "M72", clamp="M73", unclamp="M74"), increments=True
    ),
    "colchester": Control(orders=_orders("M109", "M110", clamp="M89", unclamp="M90"), increments=True),
    "doosan": Control(orders=_orders("M35", "M34", clamp="M89", unclamp="M90"), increments=True),
    "turning-center": Control(
        orders=_orders("M35", "M34", "M33"), also=dict.fromkeys(("M35", "M5"), ("live", "off")), increments=True,
        inch=True,
    ),
    "haas-lathe": Control(
        on=("G112",), off=("G113",), virtual="Y", x_in_mode=1, in_space=True, inch=True, live_speed="P",
        orders=_orders("M154", "M155", "M133 M134", "M135"), dwells={"P": 0.001},
    ),
    "okuma-osp": Control(
        "B", ("G137",), ("G136",), "Y", x_in_mode=1, lies="word", in_space=True, live_speed="SB=", radius="L",
        codes={"G101": "G1", "G102": "G2", "G103": "G3", "G138": "DIAMOF", "G180": "G80"}, dwells={"F": 1.0},
        orders=_orders("M110", "M109", "M13 M14", "M12", clamp="M147", unclamp="M146"),
    ),
    "siemens-iso": Control("B", orders=_orders(), increments=True, dwells={"X": None, "P": 0.001}),
    "siemens-transmit": Control(
        "S", ("TRANSMIT",), ("TRAFOOF",), "Y", x=1, x_in_mode=0, lies="c0", sense=-1, in_space=True, live_speed="S3=",
        radius="CR=", dwells={"F": 1.0}, comments=";.*", orders=_orders(), words=(
            (r"C\s*=\s*DC\(([^)]*)\)", r"C\1"), (r"SPOS\s*=\s*", "C"), (r"\bM1=", "M"), (r"\bS1=", "S"),
            (r"\bM17\b", "RTS"), (r"\bT\s*=\s*(\d+)\b", r"T\1")),
    ),
    "mazak-eia": _MAZAK,
    "mazak-quick-turn": Control(
        on=("G12.1",), off=("G13.1",), words=_MAZAK.words[:1], increments=True, orders=_orders(
            "M200", "M202", "M203 M204", "M205", clamp="M210", unclamp="M212"),
    ),
    "mazak-integrex": Control(
        "B", ("G12.1",), ("G13.1",), orders=_INTEGREX, words=_MAZAK.words, increments=True, x_in_mode=0
    ),
    "citizen": Control(
        on=("G12.1",), off=("G13.1",), virtual="Y", x_in_mode=1, live_speed="S3=", increments=True, words=(
            (r"(G12\.1)\s*D0\s*E\s*=\s*C", r"\1"),), orders=_orders("M18", "M20", "M80 M81", "M82"),
    ),
    "mitsubishi-m700": Control("B", x=1, x_in_mode=1, orders=_orders(), increments=True),
    "hurco": Control(
        "B", ("G101",), ("G109",), "Y", x_in_mode=0, lies="c0", in_space=True, codes={"G7": "DIAMOF", "G8": "DIAMON"},
        orders=_orders("", "", "M33 M34", "M35", clamp="M132", unclamp="M134"), dwells={"U": 1.0, "X": 1.0, "P": 0.001},
    ),
    "fagor-8055t": Control(
        "C", ("G1699",), ("G18",), lies="c0", x_in_mode=1, in_space=True, dwells={"K": 0.01}, words=(
            (r"G16\s*XC", "G1699"),), codes={"G15": "M1500"}, orders={
                **_orders("M1500", "", "M45 M51", "M50"), "M51": ("live", "cw")},
    ),
}  # fmt: skip

_OF_ALL = {
    **{f"G{number}": f"motion {number}" for number in range(4)}, "G4": "dwell", "G40": "side 40", "G41": "side 41",
    "G42": "side 42", "G28": "reference", "G53": "machine", "G10": "data", "G96": "css on", "G97": "css off",
    "G17": "", "G18": "", "G19": "", "G80": "motion -1", "G30": "reference", "G65": "call", "G43": "", "G49": "",
}  # fmt: skip
_OF_ALL |= {f"G{number}": "origin" for number in range(54, 60)} | {f"G{number}": "cycle" for number in range(70, 77)}
_OF_ALL |= {f"G{number}": f"motion {number}" for number in range(81, 90)}
_OF_SYSTEM = {
    "A": {"G20": "unit inch", "G21": "unit mm", "G98": "feed minute", "G99": "feed turn", "G50": "set",
          "G90": "motion 90", "G92": "motion 92", "G94": "motion 94", "G32": "motion 32", "G390": "absolute",
          "G391": "steps"},
    "B": {"G20": "unit inch", "G21": "unit mm", "G94": "feed minute", "G95": "feed turn", "G90": "absolute",
          "G91": "steps", "G92": "set", "G77": "motion 90", "G78": "motion 92", "G79": "motion 94", "G33": "motion 32"},
    "C": {"G70": "unit inch", "G71": "unit mm", "G94": "feed minute", "G95": "feed turn", "G90": "absolute",
          "G91": "steps", "G92": "set", "G33": "motion 32"},
    "S": {"G70": "unit inch", "G71": "unit mm", "G700": "unit INCH", "G710": "unit MM", "G94": "feed minute",
          "G95": "feed turn", "G90": "absolute", "G91": "steps", "G450": "", "G451": "", "G33": "motion 32",
          "G74": "reference", "G500": "origin"},
}  # fmt: skip
#: States that orders change; each step has them, so that an order that is missing is seen at the next step.
_STATES = ("main", "live", "c_axis", "clamp", "coolant", "css", "main_speed", "live_speed", "origin", "side", "turn")


@dataclass
class Step:
    """
    What the lathe does.

    what: rapid, line, arc, tool, dwell, reference, or the code of a cycle. line: in the program, from 1.
    values: name -> value and the line that has set it. In the mode a move has its end on the part (`re`, `im`), else x
    and c; x is a radius [mm], c [deg]; an arc has its center and `sweep` [deg]. feed is along the plane [mm/min, mm].
    """

    what: str
    line: int
    values: dict[str, tuple[float | str, int]]
    in_mode: bool = False


def steps(text: str, machine: str, lines: Sequence[int] = ()) -> list[Step]:
    """
    Run a program, and return what the lathe does: moves of no length left out, arcs about one center as one.

    lines: the number of each line in the steps, as in the program from which it was converted; else they count from 1.
    """
    return _joined(_Lathe(CONTROLS[machine], text, lines).run())


class _Lathe:
    def __init__(self, control: Control, text: str, numbers: Sequence[int]) -> None:
        self.control = control
        self.codes = {**_OF_ALL, **_OF_SYSTEM[control.system]}
        self.lines = [self._plain(line) for line in text.upper().replace("\r", "").split("\n")]
        self.numbers = numbers or range(1, len(self.lines) + 1)
        self.known: dict[str, tuple[float | str, int]] = dict.fromkeys(_STATES, ("off", 0))
        self.known |= {"side": ("40", 0), "origin": ("G54", 0)}
        self.known |= {"x": (_ABSENT, 0), "z": (_ABSENT, 0), "c": (_ABSENT, 0), "feed": (_ABSENT, 0)}
        self.inch = self.feed_inch = control.inch
        self.absolute, self.per_turn, self.motion = True, False, 0
        self.scale = control.x
        self.in_mode, self.plane, self.turned = False, complex(_ABSENT, _ABSENT), 0.0
        self.speed = {"main": (_ABSENT, 0), "live": (_ABSENT, 0)}
        self.number, self.macro = 0, dict[int, float]()
        self.tool: Any = 0
        self.done: list[Step] = []

    def _plain(self, line: str) -> str:
        line = re.sub(self.control.comments, " ", line)
        for pattern, text in self.control.words:
            line = re.sub(pattern, text, line)
        return line.strip()

    # ---- flow ----

    def run(self) -> list[Step]:
        starts = [index for index, line in enumerate(self.lines) if re.match(r"[O:]\d|%_N_\w+_MPF", line)]
        self._run(starts[0] + 1 if starts else 0, 0)
        if not any(state == "live" for state, _ in self.control.orders.values()):
            # M3 is for the live tool where it runs in the mode.
            milling = {step.values["main"] for step in self.done if step.in_mode and step.values["main"][0] != "off"}
            for step in self.done:
                if (runs := step.values["main"]) in milling:
                    step.values |= {"live": runs, "live_speed": step.values["main_speed"]}
                    step.values |= {"main": ("off", runs[1]), "main_speed": (0.0, runs[1])}
        return self.done

    def _run(self, index: int, depth: int) -> None:
        """Run the blocks from a line on, up to the end of the program or the return to who called."""
        while index < len(self.lines) and depth < 8 and len(self.done) < 20000:
            line, self.number = self.lines[index], self.numbers[index]
            if re.match(r"[O:]\d|%_N_\w+_[MS]PF", line) and depth:
                return
            if (jump := self._statement(line, index)) is not None:
                index = jump
                continue
            words = list(self._words(re.sub(r"^/?\s*N\d+", "", line)))
            names = [f"{address}{_text(value)}" for address, value, _ in words if address in "GM"]
            named = [value for address, value, _ in words if address == "name"]
            if call := self._called(words, names):
                for _ in range(call[1]):
                    self._run(call[0], depth + 1)
            elif "M99" in names or "RTS" in named:
                return
            else:
                self._block(words)
                if {"M2", "M30"} & set(names):
                    return
            index += 1

    def _called(self, words: list[Any], names: list[str]) -> tuple[int, int] | None:
        """The line where a subprogram begins, and how often it runs."""
        value = {address: number for address, number, _ in words}
        times = int(value.get("L", value.get("Q", 1)))
        for name in (str(number) for address, number, _ in words if address == "name"):
            if match := re.match(r"CALL\s*O(\d+)", name):
                return self._line_of(rf"O0*{int(match[1])}\b"), times
        if "M98" in names and "P" in value:
            return self._line_of(rf"[O:]0*{int(value['P'])}\b"), times
        if "M97" in names:
            return self._line_of(rf"N0*{int(value['P'])}\b") - 1, times
        if self.control.system == "S" and "L" in value and len(words) - ("P" in value) == 1:
            return self._line_of(rf"%_N_L0*{int(value['L'])}_SPF"), int(value.get("P", 1))
        return None

    def _line_of(self, pattern: str) -> int:
        return next((index + 1 for index, line in enumerate(self.lines) if re.match(pattern, line)), len(self.lines))

    def _statement(self, line: str, index: int) -> int | None:
        """Run a statement of a macro, and return the index of the next line; None for any other block."""
        line = re.sub(r"^N\d+\s*", "", line)
        if match := re.match(r"#(\d+)\s*=(.+)", line):
            self.macro[int(match[1])] = self._evaluated(match[2])
            return index + 1
        if match := re.match(r"WHILE\s*\[(.+)\]\s*DO\s*(\d)", line):
            if self._evaluated(match[1]):
                return index + 1
            return self._line_of_end(match[2], index)
        if match := re.match(r"END\s*(\d)", line):
            return max(i for i in range(index) if re.search(rf"WHILE.*DO\s*{match[1]}", self.lines[i]))
        if match := re.match(r"IF\s*\[(.+)\]\s*GOTO\s*(\d+)", line):
            return self._line_of(rf"N0*{match[2]}\b") - 1 if self._evaluated(match[1]) else index + 1
        return None

    def _line_of_end(self, number: str, index: int) -> int:
        return next(
            i + 1 for i in range(index, len(self.lines)) if re.match(rf"(N\d+\s*)?END\s*{number}", self.lines[i])
        )

    def _evaluated(self, text: str) -> float:
        text = re.sub(r"#(\d+)", lambda match: f"({self.macro.get(int(match[1]), 0.0)})", text)
        for word, sign in (("GE", ">="), ("GT", ">"), ("LE", "<="), ("LT", "<"), ("EQ", "=="), ("NE", "!=")):
            text = re.sub(word, sign, text)
        text = text.replace("[", "(").replace("]", ")")
        assert re.fullmatch(r"[-+*/().\d\s<>=!e]*", text), text
        return float(eval(text))  # noqa: S307

    # ---- words ----

    def _words(self, line: str) -> Iterator[tuple[str, Any, str]]:
        """Address, value and text of each word of a line; a name of the control's own has the address `name`."""
        for match in _WORD.finditer(line):
            if match["name"]:
                yield "name", match["name"], match["name"]
                continue
            address, text = match["address"], match["value"]
            if text[0] == '"':
                yield address, text, text
            elif "#" in text or "[" in text:
                yield address, self._evaluated(text), "."
            else:
                number = re.search(_NUMBER, text)
                yield address, float(number[0] if number else 0), text

    def _block(self, words: list[tuple[str, Any, str]]) -> None:
        values = {address: self._valued(address, number, text) for address, number, text in words}
        texts = {address: text for address, _, text in words}
        what = named = ""
        codes = [f"{address}{_text(number)}" for address, number, _ in words if address in ("G", "M")]
        codes += [str(number) for address, number, _ in words if address == "name"]
        codes += [f"{address}{_text(number)}" for address, number, _ in words if re.fullmatch(r"M\d=", address)]
        values = {address: value for address, value in values.items() if address not in "GMON"}
        codes = [self.control.codes.get(code, code) for code in codes]
        for code in sorted(codes, key=lambda code: code[:1] == "M"):
            if code in self.control.on or code in self.control.off:
                self._switch(code in self.control.on, values)
                values.pop("C", None)
                continue
            meaning, _, value = self.codes.get(code, f"? {code}").partition(" ")
            what = self._code(code, meaning, value, values) or what
            named = code if what == "cycle" == meaning else named
        if what != "set":
            self._tool(values, texts)
        if "F" in values and what not in ("dwell", "cycle"):
            self._set("feed", values.pop("F") * (INCH if self.feed_inch else 1))
        axes = {address: value for address, value in values.items() if address in "XYZCUVWH"}
        if what in ("dwell", "reference", "machine", "data", "set", "cycle", "call"):
            self._without_move(f"{what} {named}".strip(), values, texts)
        elif axes:
            self._move(axes, values)
        if {"M0", "M1", "M2", "M30"} & set(codes):
            self._add("stop" if {"M0", "M1"} & set(codes) else "end", {})

    def _valued(self, address: str, number: Any, text: str) -> Any:
        if self.control.increments and address in "XYZUVWIJKR" + "CH" and "." not in text:
            return number * (0.0001 if self.inch and address not in "CH" else 0.001)
        return number

    def _code(self, code: str, meaning: str, value: str, values: dict[str, Any]) -> str:
        """Do what a code does at once, and return what it makes of its block."""
        if meaning == "motion":
            self.motion = int(value)
        elif meaning == "unit":
            self.inch = value.lower() == "inch"
            self.feed_inch = self.feed_inch if self.control.system == "S" and value.islower() else self.inch
        elif meaning == "feed":
            self.per_turn = value == "turn"
        elif meaning in ("absolute", "steps"):
            self.absolute = meaning == "absolute"
        elif meaning in ("side", "css"):
            self._set(meaning, value)
        elif meaning == "origin":
            self._set("origin", "G54" if code == "G500" else code)
        elif code in ("DIAMOF", "DIAMON"):
            self.scale = 1 if code == "DIAMOF" else 2
        elif code[0] == "M":
            self._order(code, values)
        elif meaning in ("dwell", "reference", "machine", "data", "set", "cycle", "call"):
            return meaning
        elif meaning == "?" and not code.startswith("SETMS"):
            self._add(code, {})
        return ""

    def _order(self, code: str, values: dict[str, Any]) -> None:
        if code in ("M0", "M1", "M2", "M30", "M6", "M98", "M99"):
            return
        state, value = self.control.orders.get(code, ("", ""))
        if code.startswith("M3=") and self.control.system == "S":
            state, value = "live", {"3": "cw", "4": "ccw"}.get(code[3:], "off")
        self._set(*self.control.also.get(code, (state or "main", self.known[state or "main"][0])))
        if not state:
            self._add(code, {})
            return
        if state == "live" and value != "off" and self.control.live_speed == "P" and "P" in values:
            self.speed["live"] = values.pop("P"), self.number
        self._set(state, value)

    def _tool(self, values: dict[str, Any], texts: dict[str, str]) -> None:
        for address in [address for address in values if re.fullmatch(r"S|SB=|S\d=", address)]:
            speed = values.pop(address) * (0.3048 if self.inch and self.known["css"][0] == "on" else 1)
            of_live = address == self.control.live_speed or (address == "S" and self.control.live_speed == "P")
            for spindle in (*(("main",) if address == "S" else ()), *(("live",) if of_live else ())):
                self.speed[spindle] = speed, self.number
        number, edge = values.pop("T", values.pop("T=", 0)), values.pop("D", None)
        if not number and edge is None and not {"T", "T="} & set(texts):
            return
        offset: Any = edge
        if self.control.system not in "SC":
            number, offset = divmod(int(number) % 10000, 100) if number % 1 == 0 else (int(number), int(number))
        elif edge in (None, 1):
            offset = number or self.tool
        self.tool = number or self.tool
        self._add("tool", {"number": self.tool, "offset": offset})

    # ---- what becomes of a block ----

    def _set(self, name: str, value: float | str) -> None:
        if self.known[name][0] != value:
            self.known[name] = value, self.number

    def _add(self, what: str, own: dict[str, Any], in_mode: bool = False) -> None:
        values = {name: self.known[name] for name in _STATES}
        for spindle in ("main", "live"):
            runs = self.known[spindle][0] in ("cw", "ccw")
            values[f"{spindle}_speed"] = self.speed[spindle] if runs else (0.0, self.known[spindle][1])
            values[f"{spindle}_word"] = self.speed[spindle]
        values |= {name: value if isinstance(value, tuple) else (value, self.number) for name, value in own.items()}
        values.pop("turn")
        self.done.append(Step(what, self.number, values, in_mode))

    def _without_move(self, what: str, values: dict[str, Any], texts: dict[str, str]) -> None:
        """A block whose words are no end of a move: its numbers are compared as they stand."""
        length = INCH if self.inch else 1.0
        if what == "dwell":
            for address, unit in self.control.dwells.items():
                if address in values:
                    seconds = values[address] if unit is None else float(texts[address]) * unit
                    seconds = float(texts[address]) if address == "P" and "." in texts[address] else seconds
                    self._add("dwell", {"seconds": seconds})
            return
        if what == "set" and not set(values) & set("XZUWC"):
            self._add("limit", {"speed": values.get("S", 0.0)})
            return
        own = {address: value * (length if address in "XZUWIKRQYV" else 1) for address, value in values.items()}
        own |= {address: own[address] / self.scale for address in "XU" if address in own}
        places = {}
        for axis, absolute, step in (("x", "X", "U"), ("z", "Z", "W"), ("c", "C", "H")):
            if what in ("reference", "machine", "set") and {absolute, step} & set(own):
                by_step = step in own or not self.absolute
                number = own.pop(absolute, None) if absolute in own else own.pop(step)
                places[axis] = number + (float(self.known[axis][0]) if by_step and what == "reference" else 0.0)
        self._add(what, {**own, **places})
        for axis, place in places.items():
            of_c = 0.0 if axis == "c" and what == "reference" else _ABSENT
            self.known[axis] = (place if what == "set" else of_c), self.number

    def _switch(self, on: bool, values: dict[str, Any]) -> None:
        x, c = self.known["x"], self.known["c"]
        if on == self.in_mode:
            return
        self.in_mode = on
        if on:
            angle = 0.0 if math.isnan(float(c[0])) else float(c[0])
            if self.control.lies == "word":
                angle = values.get("C", 0.0)
            turned = cmath.rect(1.0, math.radians(angle))
            self.turned = 1 + 0j if self.control.lies == "c0" else turned
            self.plane = float(x[0]) * (turned if self.control.lies == "c0" else 1)
            self.scale = self.control.x_in_mode or self.scale
            return
        part = self.plane * self.turned
        self.scale = self.control.x if self.control.x_in_mode else self.scale
        if not cmath.isnan(part):
            self._set("x", abs(part))
            self._set("c", math.degrees(cmath.phase(part)) if part else _ABSENT)

    def _move(self, axes: dict[str, float], values: dict[str, Any]) -> None:
        length = INCH if self.inch else 1.0
        old = {axis: float(self.known[axis][0]) for axis in "xzc"}
        new, plane = dict(old), self.plane
        steps_letters = {"U": "X", "V": "Y", "W": "Z", "H": "C"} if self.control.system == "A" else {}
        for address, number in axes.items():
            axis = steps_letters.get(address, address)
            step = address in steps_letters or not self.absolute
            in_plane = self.in_mode and axis == self.control.virtual
            value = number * (1.0 if axis == "C" and not in_plane else length) / (self.scale if axis == "X" else 1)
            if in_plane:
                plane = complex(plane.real, value + (plane.imag if step else 0))
            elif self.in_mode and axis == "X":
                plane = complex(value + (plane.real if step else 0), plane.imag)
            else:
                if axis == "C":
                    value *= self.control.sense
                new[axis.lower()] = value + (old.get(axis.lower(), _ABSENT) if step else 0)
        named = {steps_letters.get(address, address).lower() for address in axes}
        moved_z = new["z"] - old["z"] if "z" in named else 0.0
        self.known |= {
            axis: (new[axis], self.number) for axis in (named & {"z"} if self.in_mode else named & set("xzc"))
        }
        if self.motion >= 4 or self.motion < 0:
            own = {address: values[address] * length for address in "RQIK" if address in values}
            places = {"x": self.known["x"], "z": self.known["z"], "c": self._angle()}
            self._add(f"cycle {self.motion}", {**own, **places, "feed": self.known["feed"], "turn": str(self.per_turn)})
            # A cycle ends where it has begun; holes are drilled along Z.
            self.known |= {axis: (old[axis], self.number) for axis in named & set("z" if self.motion < 90 else "xz")}
            return
        what = ("rapid", "line", "arc", "arc")[self.motion]
        own = {"z": self.known["z"]}
        if self.in_mode:
            start, self.plane = self.plane, plane
            if abs(plane - start) < _SHORT and abs(moved_z) < _SHORT:
                return
            end = plane * self.turned
            own |= {"re": end.real, "im": end.imag}
            path = abs(plane - start)
        else:
            start, plane = complex(old["z"], old["x"]), complex(new["z"], new["x"])
            if abs(plane - start) < _SHORT and old["c"] == new["c"] and what != "arc":
                return
            own |= {"x": self.known["x"], "c": self._angle()}
            path = 0.0
        if what == "arc":
            center = self._center(start, plane, values, length)
            sweep = cmath.phase((plane - center) / (start - center)) if start != center else 0.0
            sweep += (
                2
                * math.pi
                * ((self.motion == 3) - (self.motion == 2))
                * ((sweep <= 1e-9) if self.motion == 3 else (sweep >= -1e-9))
            )
            path = abs(sweep) * abs(start - center)
            center = center * self.turned if self.in_mode else center
            own |= {"center_re": center.real, "center_im": center.imag, "sweep": math.degrees(sweep)}
        if what != "rapid":
            feed, line = self.known["feed"]
            if self.in_mode and self.control.in_space and path and moved_z == moved_z:
                feed = float(feed) * path / math.hypot(path, moved_z)
            own |= {"feed": (feed, line), "turn": str(self.per_turn)}
        self._add(what, own, self.in_mode)

    def _angle(self) -> tuple[float, int]:
        angle, line = self.known["c"]
        return float(angle) % 360, line

    def _center(self, start: complex, end: complex, values: dict[str, Any], length: float) -> complex:
        """The center of an arc, by its words: in the plane of X and the virtual axis, or of Z and X."""
        letters = "IJ" if self.in_mode else "KI"
        if self.control.radius in values:
            radius, chord = values[self.control.radius] * length, end - start
            height = math.sqrt(max(0.0, radius**2 - abs(chord) ** 2 / 4))
            turn = 1j if (self.motion == 3) == (radius > 0) else -1j
            return start + chord / 2 + turn * height * chord / abs(chord)
        return start + complex(*(values.get(letter, 0.0) * length for letter in letters))


def _text(number: float | str) -> str:
    return number if isinstance(number, str) else f"{number:g}"


def _joined(done: list[Step]) -> list[Step]:
    """Arcs about one center that go on where the one before ends become one; a live tool by M3 is one."""
    result: list[Step] = []
    for step in done:
        last = result[-1] if result else None
        if last and step.what == last.what == "arc" and _go_on(last, step):
            sweep = float(last.values["sweep"][0]) + float(step.values["sweep"][0])
            step.values["sweep"] = sweep, last.line
            step.values["center_re"], step.values["center_im"] = last.values["center_re"], last.values["center_im"]
            result[-1] = Step("arc", last.line, step.values, step.in_mode)
        else:
            result.append(step)
    return result


def _go_on(last: Step, step: Step) -> bool:
    ours = {name: value for name, (value, _) in last.values.items()}
    theirs = {name: value for name, (value, _) in step.values.items()}
    same = all(_is_near(ours.get(name), theirs.get(name), 0.03) for name in ("center_re", "center_im"))
    same &= ours["sweep"] * theirs["sweep"] > 0 and abs(ours["sweep"] + theirs["sweep"]) < 361  # type: ignore[operator]
    skipped = ("re", "im", "x", "z", "c", "center_re", "center_im", "sweep")
    names = [name for name in ours if name not in skipped]
    return same and all(_is_near(ours[name], theirs.get(name), _tolerance(name, theirs.get(name))) for name in names)


# ---- comparing ----

_NOTHING: Mapping[int, str] = {}
_AXES = "XUZWCHYV"
#: The addresses of the words that set a value or make a step; all for those that are not here.
_SET_BY = {
    **dict.fromkeys(("main", "live", "c_axis", "clamp", "coolant", "stop", "end"), "M"),
    **dict.fromkeys(("css", "origin", "side", "turn", "reference", "machine", "data", "set", "call", "dwell"), "G"),
    **dict.fromkeys(("rapid", "line", "arc", "cycle"), _AXES), **dict.fromkeys(("tool", "number", "offset"), "TD"),
    "main_speed": "MS", "live_speed": "MSP", "main_word": "S", "live_word": "SP", "limit": "GS", "seconds": "GXUPF",
    "feed": "GF", "x": "XU", "z": "ZW", "c": "CH", "re": "XUCHYV", "im": "XUCHYV",
}  # fmt: skip


def _tolerance(name: str, value: object) -> float:
    if name in ("feed", "main_speed", "live_speed", "main_word", "live_word", "speed") and isinstance(value, float):
        return 0.006 * max(1.0, abs(value))
    return {"center_re": 0.03, "center_im": 0.03, "sweep": 0.2, "seconds": 0.0015}.get(name, 0.003)


def _is_near(ours: object, theirs: object, tolerance: float) -> bool:
    if isinstance(ours, str) or isinstance(theirs, str) or ours is None or theirs is None:
        return ours == theirs
    if math.isnan(ours) or math.isnan(theirs):  # type: ignore[arg-type]
        return math.isnan(ours) and math.isnan(theirs)  # type: ignore[arg-type]
    return abs(ours - theirs) <= tolerance  # type: ignore[operator]


def differences(ours: list[Step], theirs: list[Step], told: Mapping[int, str] = _NOTHING) -> tuple[list[str], int]:
    """
    Return what two programs do otherwise, and how many of their differences come from words that were told.

    told: lines about which a comment or a note says that something is other there, with the addresses of the words
    that it names.
    """
    result: list[str] = []
    excused = i = j = 0
    while i < len(ours) or j < len(theirs):
        first = ours[i] if i < len(ours) else None
        second = theirs[j] if j < len(theirs) else None
        is_one = False
        if first and second and _same_kind(first, second):
            is_one = first.line == second.line
            names = _different(first, second)
            open_names = [name for name in names if not _is_told(name, first, second, told)]
            if not names or (not open_names and (is_one or not _names(told, first.line, first.what))):
                excused += len(names)
                i, j = i + 1, j + 1
                continue
        if first and not is_one and _names(told, first.line, first.what):
            excused, i = excused + 1, i + 1
        elif second and not is_one and _names(told, second.line, second.what):
            excused, j = excused + 1, j + 1
        elif first and second and _same_kind(first, second):
            text = ", ".join(f"{n} {_shown(first, n)} -> {_shown(second, n)}" for n in open_names)
            result.append(f"{first.line} -> {second.line}: {first.what}: {text}")
            i, j = i + 1, j + 1
        else:
            result.append(f"{first and (first.line, first.what)} -> {second and (second.line, second.what)}")
            i, j = (i + 1, j) if len(ours) - i > len(theirs) - j else (i, j + 1)
    return result, excused


def _same_kind(first: Step, second: Step) -> bool:
    as_line = first.what == "rapid" and second.what == "line" and first.in_mode and second.in_mode
    feed = second.values.get("feed", (0.0, 0))[0]
    return first.what == second.what or (as_line and not isinstance(feed, str) and feed >= 999)


def _different(first: Step, second: Step) -> list[str]:
    names = dict.fromkeys((*first.values, *second.values))
    if first.what != second.what:
        names = dict.fromkeys(name for name in names if name not in ("feed", "turn"))
    for spindle in ("main", "live"):
        # Where the order to one of the two is decided, the word of its speed is there all the same.
        if (first.values[spindle][0] == "off") == (second.values[spindle][0] == "off"):
            names.pop(f"{spindle}_word")
    values = {name: (first.values.get(name, ("", 0))[0], second.values.get(name, ("", 0))[0]) for name in names}
    is_near = {name: _is_near(ours, theirs, _tolerance(name, ours)) for name, (ours, theirs) in values.items()}
    if "c" in values:
        is_near["c"] = _near_angle(*values["c"], abs(float(first.values.get("x", (_ABSENT, 0))[0])))
    return [name for name in names if not is_near[name]]


def _near_angle(ours: object, theirs: object, radius: float) -> bool:
    """The same angle of C, up to 0.001 mm at the radius: behind the mode C is that of a rounded point."""
    if isinstance(ours, float) and isinstance(theirs, float) and not math.isnan(ours - theirs):
        apart = abs(math.remainder(ours - theirs, 360))
        return apart <= 0.003 or math.radians(apart) * radius <= 0.001
    return _is_near(ours, theirs, 0.003)


def _is_told(name: str, first: Step, second: Step, told: Mapping[int, str]) -> bool:
    ours, theirs = first.values.get(name, ("", first.line)), second.values.get(name, ("", second.line))
    return _names(told, ours[1], name) or _names(told, theirs[1], name)


def _names(told: Mapping[int, str], line: int, name: str) -> bool:
    """What is told about a line names a word that sets this value, or makes this step."""
    by = "M" if re.fullmatch(r"M\d+", name) else _SET_BY.get(name.partition(" ")[0], ascii_uppercase)
    return not set(by).isdisjoint(told.get(line, ""))


def _shown(step: Step, name: str) -> str:
    value = step.values.get(name, ("nothing", 0))[0]
    return f"{value:.4f}" if isinstance(value, float) else str(value)
