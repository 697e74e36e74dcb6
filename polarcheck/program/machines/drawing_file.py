"""
Reads the curves of a drawing (DXF), with which a part is compared. ezdxf reads the file, and is imported late.

The origin is the spindle axis; x points to C0 and is a radius.
"""

from __future__ import annotations

import itertools
from collections import Counter
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import msgspec

from polarcheck.foundation import bounded
from polarcheck.foundation.errors import JobError, first_of
from polarcheck.program.machines.chains import joined
from polarcheck.program.machines.drawn_curves import (
    MOST_POINTS,
    NoDrawingError,
    drop_frame,
    fineness_of,
    is_flat,
    points_of,
)
from polarcheck.program.machines.part_keys import DrawnPart, Part

#: A drawing of one part has some kB [bytes].
_LARGEST = 16_000_000
#: Limits: lines and arcs, places of blocks, blocks inside each other. No drawing has more.
_MOST_ENTITIES, _MOST_BLOCKS, _DEEPEST = 50_000, 2000, 16
_BINARY = b"AutoCAD Binary DXF\r\n\x1a\0"
_LISTED = 4
_HINT = 'pip install "polarcheck[drawing]"'


class Drawing(msgspec.Struct, frozen=True):
    """
    The curves of a drawing.

    curves: the points of each, x + 1j*c in units of the drawing; one that ends where it begins is closed.
    scale: mm per unit; NaN where the drawing does not say.
    passed_over: curves that could not be read, with their count; empty for none.
    """

    curves: tuple[tuple[complex, ...], ...]
    scale: float
    passed_over: str = ""


def part_of(path: Path, title: str, part: Part | None = None) -> DrawnPart:
    """The part of a drawing, with the other values of its entry. Raises JobError as read_drawing does."""
    drawing = read_drawing(path, title, () if part is None else part.layers)
    values: dict[str, Any] = {} if part is None else {name: getattr(part, name) for name in Part.__struct_fields__}
    values["drawing"] = str(path)
    return DrawnPart(**values, curves=drawing.curves, scale=drawing.scale, passed_over=drawing.passed_over)


def read_drawing(path: Path, title: str, layers: Sequence[str] = ()) -> Drawing:
    """
    The lines and curves of the model space of a DXF file, of R12 or later, as text or binary.

    Blocks are resolved. Ignored are text, dimensions, points, hatches, layers that are off or frozen, DEFPOINTS, and
    broken lines such as center lines. Where layers are named only these count, also if they are off. Raises JobError,
    one line that begins with the title, for a file that cannot be read, shows no curve or has no such layer.
    """
    try:
        data = bounded.read_file(path, _LARGEST, "no drawing of a part is")
    except OSError as error:
        raise JobError(f"{title}: {error.strerror}") from None
    try:
        _load_reader()
    except ImportError:
        raise JobError(f"{title}: reading a drawing needs ezdxf, which is not installed: {_HINT}") from None
    try:
        # ezdxf assumes meters where a file does not say.
        return _drawing(_document(data), layers, says_units=b"$INSUNITS" in data)
    except NoDrawingError as error:
        raise JobError(f"{title}: {error}") from None
    except Exception as error:
        # A broken file can make ezdxf raise anything.
        said = " ".join(str(error).split())[:80]
        raise JobError(f"{title}: is no DXF file that can be read{f': {said}' if said else ''}") from None


def _load_reader() -> None:
    """
    Import ezdxf without its search of all fonts, which would write a cache into the home folder; only lines are needed.
    """
    import os
    import sys
    import tempfile

    if sys.modules.get("ezdxf") is not None:
        return
    before = os.environ.get(_CACHE)
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "ezdxf").mkdir()
        (Path(folder) / "ezdxf" / "font_manager_cache.json").write_text(_NO_FONTS, "utf-8")
        os.environ[_CACHE] = folder
        try:
            import ezdxf  # noqa: F401
        finally:
            os.environ.pop(_CACHE)
            if before is not None:
                os.environ[_CACHE] = before


#: The environment variable with the folder of the cache of ezdxf.
_CACHE = "XDG_CACHE_HOME"
#: A cache without fonts, for any version.
_NO_FONTS = '{"version": 2, "font-faces": []}'


def _document(data: bytes) -> Any:
    import io
    import logging

    from ezdxf.document import Drawing as Document
    from ezdxf.filemanagement import dxf_stream_info
    from ezdxf.lldxf.tagger import binary_tags_loader

    logging.getLogger("ezdxf").setLevel(logging.CRITICAL)  # its warnings are not part of the report
    if data.startswith(_BINARY):
        return Document.load(binary_tags_loader(data))
    text = data.decode("utf-8", "ignore")
    if not text.lstrip("\ufeff \t").startswith(("0", "999")):
        raise NoDrawingError("is no DXF file; save the drawing as DXF")
    encoding = dxf_stream_info(io.StringIO(text, None)).encoding
    return Document.read(io.StringIO(data.decode(encoding, "surrogateescape").lstrip("\ufeff"), None))


def _drawing(document: Any, layers: Sequence[str], *, says_units: bool) -> Drawing:
    fineness = fineness_of(int(document.header.get("$INSUNITS", 0)) if says_units else 0)
    ignored, passed_over, curves, points = Counter[str](), Counter[str](), [], 0
    for entity in _shown(document, _Layers(document, layers), ignored):
        if is_flat(entity, fineness):
            passed_over[f"{entity.dxftype()} with an axis of no length"] += 1
            continue
        curve = tuple(itertools.islice(points_of(entity, fineness), MOST_POINTS))
        points += len(curve)
        if points >= MOST_POINTS:
            raise NoDrawingError(f"has curves of more than {MOST_POINTS} points: no drawing of a part has")
        if len(curve) > 1:
            curves.append(curve)
        else:
            ignored[f"{entity.dxftype()} without length"] += 1
    if not curves:
        ignored += passed_over
        why = f"; ignored: {_listed_counts(ignored)}" if ignored else ""
        why = why or ("" if len(document.modelspace()) else ": its model space is empty")
        raise NoDrawingError(f"shows no line, arc or curve of a part{why}{fineness.of_units}")
    return Drawing(joined(curves, fineness.gap), fineness.scale, _listed_counts(passed_over))


def _listed_counts(counts: Counter[str]) -> str:
    """`3 TEXT, 1 HATCH`: the most frequent first."""
    return ", ".join(f"{count} {what}" for what, count in counts.most_common(_LISTED))


#: Entities that are curves, and those that are resolved into curves.
_CURVES = ("LINE", "ARC", "CIRCLE", "ELLIPSE", "SPLINE")
_POLYLINES = ("LWPOLYLINE", "POLYLINE")


def _shown(document: Any, layers: _Layers, ignored: Counter[str]) -> Iterator[Any]:
    """The curves of the model space, with blocks and polylines resolved."""
    # What lies on layer 0 of a block is on the layer on which the block is inserted.
    waiting: list[tuple[Iterator[Any], str]] = [(iter(document.modelspace()), "0")]
    count = blocks = 0
    while waiting:
        entities, outer = waiting[-1]
        entity = next(entities, None)
        if entity is None:
            waiting.pop()
            continue
        count += 1
        if count > _MOST_ENTITIES:
            raise NoDrawingError(f"has more than {_MOST_ENTITIES} lines and arcs: no drawing of a part has")
        kind, layer = entity.dxftype(), str(entity.dxf.get("layer", "0"))
        layer = outer if layer == "0" else layer
        reason = layers.reason(entity, kind, layer)
        if reason:
            ignored[reason] += 1
        elif kind in _CURVES:
            yield entity
        elif kind != "INSERT":
            drop_frame(entity)
            waiting.append((iter(entity.virtual_entities()), layer))
        else:
            blocks += max(int(entity.dxf.row_count * entity.dxf.column_count), 1)
            if blocks > _MOST_BLOCKS or len(waiting) > _DEEPEST:
                raise NoDrawingError(
                    f"has blocks at more than {_MOST_BLOCKS} places, or more than {_DEEPEST} in each other"
                )
            inserted = entity.multi_insert() if entity.mcount > 1 else iter(entity.virtual_entities())
            waiting.append((inserted, layer))


#: How much of the name of a kind of entity a message shows [characters].
_LONGEST = 20


class _Layers:
    """The layers of a drawing, and those that are named; capitals make no difference."""

    def __init__(self, document: Any, named: Sequence[str]) -> None:
        layers = {layer.dxf.name.lower(): layer for layer in document.layers}
        self._spelled = {name: str(layer.dxf.name) for name, layer in layers.items()}
        self._named = {name.lower() for name in named}
        hidden = {name for name, layer in layers.items() if layer.is_off() or layer.is_frozen()}
        broken = {name for name, layer in layers.items() if _is_broken(layer.dxf.get("linetype", "CONTINUOUS"))}
        self._hidden = (hidden | {"defpoints"}) - self._named
        self._broken = broken - self._named
        self._check(document, named)

    def _check(self, document: Any, named: Sequence[str]) -> None:
        """Raises NoDrawingError for a layer that is not there. The table need not list the layers of all entities."""
        if self._named <= self._spelled.keys():
            return
        for entity in itertools.chain(*document.blocks):
            layer = str(entity.dxf.get("layer", "0"))
            self._spelled.setdefault(layer.lower(), layer)
        missing = [name for name in named if name.lower() not in self._spelled]
        if missing:
            names = sorted((name for name in self._spelled.values() if name.lower() != "defpoints"), key=str.lower)
            listed = first_of([name[:_LONGEST_NAME] for name in names], _MOST_NAMES)
            raise NoDrawingError(f"has no layer {missing[0][:_LONGEST_NAME]}; its layers are {listed}")

    def reason(self, entity: Any, kind: str, layer: str) -> str:
        """Why an entity on a layer is ignored, for the message; empty if it is not."""
        name, line = layer.lower(), str(entity.dxf.get("linetype", "BYLAYER")).upper()
        if name in self._hidden or entity.dxf.get("invisible", 0):
            return "on layers that are off, frozen or DEFPOINTS"
        if kind == "INSERT":
            return ""
        if kind not in (*_CURVES, *_POLYLINES):
            return str(kind[:_LONGEST])
        if self._named and name not in self._named:
            return f"on layer {self._spelled.get(name, layer)[:_LONGEST_NAME]}"
        return "with a broken line" if (name in self._broken if line == "BYLAYER" else _is_broken(line)) else ""


#: How many names of layers a message shows, and how much of each [characters].
_MOST_NAMES, _LONGEST_NAME = 12, 40


def _is_broken(linetype: str) -> bool:
    """True for the line type of centers and hidden edges."""
    return linetype.upper() not in ("CONTINUOUS", "BYLAYER", "BYBLOCK")
