"""
The picture of a program for a document, as PNG or SVG: the face of each section and a list of the findings below it.

It is as wide as the text on a page of A4. The same program gives the same bytes. matplotlib draws it, without a screen,
a network or the user's own style.
"""

from __future__ import annotations

import io
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import matplotlib
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.figure import Figure

from polarcheck.foundation.finding import radius_origin
from polarcheck.program.reading.excerpt import visible
from polarcheck.view.picture_data import Picture, SectionPicture
from polarcheck.view.stills.face import Window, draw_face, legend
from polarcheck.view.stills.numbering import Entry, entries, outside
from polarcheck.view.stills.palette import ABOVE, CENTER, INK, SEVERITIES, Coloring, coloring

if TYPE_CHECKING:
    from collections.abc import Callable
from collections.abc import Iterator
from functools import cache
from typing import TYPE_CHECKING

from matplotlib.font_manager import FontProperties, findfont, get_font
from matplotlib.ft2font import LoadFlags

if TYPE_CHECKING:
    from matplotlib.ft2font import FT2Font

#: The font comes with matplotlib.
FONT = "DejaVu Sans"
#: Stands for a character that the font lacks.
_LACKING = "\ufffd"
#: The size at which characters are measured [points].
_SIZE = 100.0
#: Points in a millimeter.
_POINTS = 72 / 25.4


def printable(text: str) -> str:
    """Return text without control characters and without characters that the font lacks."""
    glyphs = _glyphs()
    return "".join(sign if ord(sign) in glyphs else _LACKING for sign in visible(text.replace("\t", " ")))


@cache
def _font(bold: bool) -> FT2Font:
    return get_font(findfont(FontProperties(family=FONT, weight="bold" if bold else "normal")))


@cache
def _glyphs() -> dict[int, int]:
    """Return the glyph of each character."""
    return dict(_font(False).get_charmap())


@cache
def _advance(sign: str, bold: bool) -> float:
    """Return the width of a character of a font of one point [points]."""
    font = _font(bold)
    font.set_size(_SIZE, 72)
    return float(font.load_char(ord(sign), LoadFlags.NO_HINTING).linearHoriAdvance) / 65536 / _SIZE


def wrapped(text: str, width: float, size: float, most: int = 4, *, bold: bool = False) -> list[str]:
    """
    Break a text into lines.

    width: of a line [mm].
    size: of the font [points].
    most: the number of lines; what does not fit is cut, with dots.
    """
    room = width * _POINTS / size
    lines: list[str] = []
    line, used = "", 0.0
    for word in _words(printable(text), room, bold):
        wide = sum(_advance(sign, bold) for sign in word)
        blank = _advance(" ", bold)
        if not line or used + blank + wide <= room:
            line, used = (f"{line} {word}", used + blank + wide) if line else (word, wide)
            continue
        lines.append(line)
        line, used = word, wide
        if len(lines) == most:
            return [*lines[:-1], f"{lines[-1]} ..."]
    return [*lines, line] if line else lines


def _words(text: str, room: float, bold: bool) -> Iterator[str]:
    """Yield the words; one that is wider than a line is broken."""
    for word in text.split():
        begin, used = 0, 0.0
        for index, sign in enumerate(word):
            used += _advance(sign, bold)
            if used > room:
                yield word[begin:index]
                begin, used = index, _advance(sign, bold)
        yield word[begin:]


#: The width of the picture and its margin [mm], and the dots of a PNG per inch.
WIDTH, _MARGIN, _DPI = 160.0, 3.0, 200
#: The room left and right of a face for labels and colors, above for its title, and below for labels and legend [mm].
_LEFT, _RIGHT, _BELOW = 13.0, 17.0, 9.0
#: The least and the greatest height of a face, and the size of a detail [mm].
_LEAST, _GREATEST, _DETAIL = 55.0, 135.0, 43.0
#: At most so many details stand below a face; a fault smaller than this share of the face has one.
_DETAILS, _SMALL = 3, 0.2
#: The height of a line of text of one point [mm].
_LINE = 0.45
_MM = 1 / 25.4
#: The most sections of a picture.
MOST = 12
_STYLE: Any = {
    "font.family": FONT,
    "text.parse_math": False,
    "svg.fonttype": "path",
    "svg.hashsalt": "polarcheck",
    "hatch.linewidth": 0.6,
    "axes.unicode_minus": True,
}


def still(picture: Picture, form: str, chosen: Sequence[int] = ()) -> bytes:
    """
    Return the picture of a program.

    form: png or svg.
    chosen: the numbers of the sections that are drawn, from 1; without any the first sections are.
    """
    with matplotlib.rc_context():
        matplotlib.rcdefaults()
        matplotlib.rcParams.update(_STYLE)
        sheet = _Sheet()
        _add_head(sheet, picture)
        numbers = list(chosen) or list(range(1, min(len(picture.sections), MOST) + 1))
        for number in numbers:
            _add_section(sheet, picture, number)
        _add_rest(sheet, picture, numbers)
        figure = sheet.figure()
        data = io.BytesIO()
        canvas: Any = FigureCanvasSVG(figure) if form == "svg" else FigureCanvasAgg(figure)
        if form == "svg":
            title = f"polarcheck: {visible(picture.path)}"
            canvas.print_svg(data, metadata={"Title": title, "Creator": "polarcheck", "Date": None})
        else:
            canvas.print_png(data, metadata={"Software": "polarcheck"})
    return data.getvalue()


class _Sheet:
    """Things one below the other, on a figure that is as high as they are together."""

    def __init__(self) -> None:
        self._things: list[tuple[float, Callable[[Figure, float, float], None]]] = []

    def add(self, height: float, draw: Callable[[Figure, float, float], None]) -> None:
        """Add a thing of this height [mm]. draw: takes the figure, its top from below and the height of all [mm]."""
        self._things.append((height, draw))

    def space(self, height: float) -> None:
        """Add room [mm]."""
        self.add(height, lambda figure, top, total: None)

    def text(
        self, text: str, size: float = 8, *, bold: bool = False, color: str = INK, indent: float = 0, most: int = 4
    ) -> None:
        """
        Add text over the whole width.

        size: of the font [points].
        indent: room on the left [mm].
        most: the number of lines.
        """
        lines = wrapped(text, WIDTH - 2 * _MARGIN - indent, size, most, bold=bold)
        height = size * _LINE

        def draw(figure: Figure, top: float, total: float) -> None:
            for index, line in enumerate(lines):
                figure.text(
                    (_MARGIN + indent) / WIDTH, (top - index * height) / total, line, size=size, color=color,
                    weight="bold" if bold else "normal", va="top", ha="left",
                )  # fmt: skip

        self.add(len(lines) * height + 0.4, draw)

    def figure(self) -> Figure:
        """Return the figure with everything drawn."""
        total = sum(height for height, _ in self._things) + 2 * _MARGIN
        figure = Figure(figsize=(WIDTH * _MM, total * _MM), dpi=_DPI, facecolor="white")
        top = total - _MARGIN
        for height, draw in self._things:
            draw(figure, top, total)
            top -= height
        return figure


# ---- words ----


def _add_head(sheet: _Sheet, picture: Picture) -> None:
    sheet.text(picture.path, 11, bold=True, most=2)
    facts = [text for label, text in picture.head if label in ("program", "machine")]
    if facts:
        sheet.text(", ".join(reversed(facts)), 8)
    color = SEVERITIES["error"] if picture.verdict.startswith("fail") else INK
    sheet.text(f"{picture.verdict}: {picture.summary}", 8, bold=True, color=color)
    sheet.space(1)


def _add_rest(sheet: _Sheet, picture: Picture, numbers: Sequence[int]) -> None:
    """Add what no section shows."""
    outside_findings, more = outside(picture.findings)
    if outside_findings:
        sheet.text("Outside the polar sections", 8, bold=True)
        for entry in outside_findings:
            _add_entry(sheet, entry, "")
        _add_more(sheet, more)
    for reason in picture.not_evaluated[:5]:
        sheet.text(f"not evaluated: {reason}", 7, most=2)
    for label, text in picture.head:
        if label == "not drawn":
            sheet.text(f"not drawn: {text}", 7, most=2)
    if not picture.sections:
        sheet.text("No polar section is drawn.", 8)
    elif len(numbers) < len(picture.sections):
        numbers_drawn = ", ".join(map(str, numbers))
        sheet.text(f"Drawn: section {numbers_drawn} of {len(picture.sections)}.", 7)


def _add_more(sheet: _Sheet, more: int) -> None:
    if more:
        sheet.text(f"and {more} more", 7, indent=5.5)


def _add_entry(sheet: _Sheet, entry: Entry, label: str) -> None:
    color = SEVERITIES.get(entry.kind, INK)
    if label:
        sheet.add(0, lambda figure, top, total: _draw_number(figure, label, color, top, total))
    sheet.text(f"{entry.kind}, {entry.text}" if entry.kind else entry.text, 7.5, indent=5.5)


def _draw_number(figure: Figure, label: str, color: str, top: float, total: float) -> None:
    figure.text(
        (_MARGIN + 2) / WIDTH, (top - 1.5) / total, label, size=7, color="white", weight="bold",
        ha="center", va="center",
        bbox={"boxstyle": "round,pad=0.2,rounding_size=0.5", "facecolor": color, "edgecolor": "none"},
    )  # fmt: skip


def _facts(section: SectionPicture) -> str:
    """Return one line on what the picture of a section depends on."""
    length = f"{{:.{4 if section.units == 'inch' else 3}f}} {section.units}"
    facts = []
    if section.radius is not None:
        facts.append(
            f"cutter R {length.format(section.radius / section.scale)} ({radius_origin(section.radius_source)})"
        )
    if section.stock is not None:
        facts.append(f"stock {length.format(section.stock / section.scale)} across")
    if section.c_limit is not None:
        facts.append(f"limit of C {section.c_limit:.0f} deg/min")
    if section.time is not None:
        facts.append(f"{section.time:.1f} s")
    if section.parts and section.parts[-1].z is not None:
        facts.append(f"finished part at Z{length.format(section.parts[-1].z / section.scale)}")
    return ", ".join(facts)


# ---- a section ----


class _Frame(NamedTuple):
    """A face on the sheet: what it shows, and its height [mm]."""

    window: Window
    height: float


def _add_section(sheet: _Sheet, picture: Picture, number: int) -> None:
    section = picture.sections[number - 1]
    listed, more = entries(section, [finding for finding in picture.findings if finding.section == number - 1])
    title = section.title if len(picture.sections) == 1 else f"{number}. {section.title}"
    sheet.text(title + (f", channel {section.channel}" if section.channel else ""), 9, bold=True, most=2)
    if facts := _facts(section):
        sheet.text(facts, 7)
    for text in [section.needs_radius] if section.needs_radius else []:
        sheet.text(text, 8, bold=True, color=SEVERITIES["warning"])
    for text in (section.makes or [part.text for part in section.parts])[:4]:
        sheet.text(text, 7, most=2)
    frame = _framed(section)
    sheet.add(
        frame.height + _BELOW + 1.5,
        lambda figure, top, total: _draw_section(figure, section, frame, listed, top, total),
    )
    samples = legend(section)
    rows = -(-len(samples) // 4)
    sheet.add(rows * 4 + 1, lambda figure, top, total: _draw_legend(figure, samples, top, total))
    _add_details(sheet, section, frame, listed)
    for entry in listed:
        _add_entry(sheet, entry, str(entry.number))
    _add_more(sheet, more)
    sheet.space(3)


def _framed(section: SectionPicture) -> _Frame:
    """Return the part of the plane that holds all that is drawn, in the shape of the room on the sheet."""
    x0, c0, x1, c1 = section.frame
    across = WIDTH - 2 * _MARGIN - _LEFT - _RIGHT
    width, height = 1.08 * max(x1 - x0, 1e-3), 1.08 * max(c1 - c0, 1e-3)
    scale = max(width / across, height / _GREATEST)
    tall = min(max(height / scale, _LEAST), _GREATEST)
    return _Frame(_window(((x0 + x1) / 2, (c0 + c1) / 2), across, tall, scale), tall)


def _window(middle: tuple[float, float], across: float, tall: float, scale: float) -> Window:
    (x, c), half, high = middle, across * scale / 2, tall * scale / 2
    return Window(x - half, c - high, x + half, c + high, scale)


def _draw_section(
    figure: Figure, section: SectionPicture, frame: _Frame, listed: Sequence[Entry], top: float, total: float
) -> None:
    from_left, across = _MARGIN + _LEFT, WIDTH - 2 * _MARGIN - _LEFT - _RIGHT
    area = (from_left / WIDTH, (top - 1.5 - frame.height) / total, across / WIDTH, frame.height / total)
    draw_face(figure.add_axes(area), section, frame.window, listed, small=False)
    key = coloring(section)
    if key.bounds:
        _draw_colors(figure, key, ((from_left + across + 2.5) / WIDTH, area[1], 2.5 / WIDTH, area[3]))


def _draw_colors(figure: Figure, key: Coloring, area: tuple[float, float, float, float]) -> None:
    """Draw the key of the colors of the path."""
    axes = figure.add_axes(area)
    colors = [*key.shades, *([ABOVE] if key.has_limit else [])]
    axes.set_xlim(0, 1)
    axes.set_ylim(0, len(colors))
    for number, color in enumerate(colors):
        axes.axhspan(number, number + 1, color=color, linewidth=0)
    axes.set_yticks(range(1, len(key.bounds) + 1), [f"{bound:.4g}" for bound in key.bounds], fontsize=7)
    axes.yaxis.tick_right()
    axes.tick_params(length=2, width=0.5, pad=1)
    axes.set_xticks([])
    axes.set_ylabel(key.title, fontsize=7, labelpad=2)
    axes.yaxis.set_label_position("right")
    for spine in axes.spines.values():
        spine.set_linewidth(0.5)


def _draw_legend(figure: Figure, samples: Sequence[object], top: float, total: float) -> None:
    if samples:
        figure.legend(
            handles=samples, loc="upper left", bbox_to_anchor=((_MARGIN + _LEFT - 2) / WIDTH, top / total), ncols=4,
            fontsize=7, frameon=False, borderpad=0, borderaxespad=0, handlelength=2.4, columnspacing=1.4,
            handletextpad=0.5, labelspacing=0.45,
        )  # fmt: skip


# ---- details ----


def _add_details(sheet: _Sheet, section: SectionPicture, frame: _Frame, listed: Sequence[Entry]) -> None:
    """Add views from near by of the gravest findings that the face shows too small."""
    window = frame.window
    small = _SMALL * (window.c1 - window.c0)
    details: list[tuple[str, Window]] = []
    rules: set[str] = set()
    for entry in listed:
        if entry.span is None or not 0 < entry.span < small or not entry.places or len(details) == _DETAILS:
            continue
        if entry.rule and entry.rule in rules:
            continue  # others of the rule look alike
        near = _window(entry.places[0], _DETAIL, _DETAIL, entry.span / _DETAIL)
        if any(abs(near.x0 - detail.x0) + abs(near.c0 - detail.c0) < near.x1 - near.x0 for _, detail in details):
            continue
        rules.add(entry.rule)
        details.append((f"{entry.number}, enlarged {window.scale / near.scale:.3g} times", near))
    if details:
        sheet.add(_DETAIL + 9, lambda figure, top, total: _draw_details(figure, section, listed, details, top, total))


def _draw_details(
    figure: Figure, section: SectionPicture, listed: Sequence[Entry], details: Sequence[tuple[str, Window]],
    top: float, total: float,
) -> None:  # fmt: skip
    for index, (title, window) in enumerate(details):
        from_left = _MARGIN + 8 + index * (_DETAIL + 8)
        axes = figure.add_axes((from_left / WIDTH, (top - 4 - _DETAIL) / total, _DETAIL / WIDTH, _DETAIL / total))
        draw_face(axes, section, window, listed, small=True)
        axes.set_title(title, fontsize=7.5, pad=2, color=CENTER)
