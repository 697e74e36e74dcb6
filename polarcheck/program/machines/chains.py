"""Curves that are drawn one by one, put together where the end of one is that of another."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

Curve = tuple[complex, ...]


def joined(curves: Iterable[Sequence[complex]], gap: float) -> tuple[Curve, ...]:
    """
    The curves as chains, each as long as it can be; one whose ends are no farther apart than the gap ends where it
    begins.

    Where more than two ends meet, the chain goes on as straight as it can. What is drawn twice counts once.
    """
    curves_left = _each_once([tuple(curve) for curve in curves if len(curve) > 1], gap)
    ends = _Ends(curves_left, gap)
    chains = []
    for number, curve in enumerate(curves_left):
        if number in ends.used:
            continue
        ends.used.add(number)
        chain = list(curve)
        for _ in range(2):
            while not _is_closed(chain, gap) and (following := ends.following(chain)):
                chain += following[1:]
            chain.reverse()
        if _is_closed(chain, gap):
            chain[-1] = chain[0]
        chains.append(tuple(chain))
    return tuple(chains)


def chord_count(sweep: float, radius: float, sagitta: float) -> int:
    """How many chords an arc of this sweep [rad] needs to lie no farther off it than the sagitta."""
    return math.ceil(sweep / 2 / math.acos(1 - min(sagitta / radius, 0.25)))


def _is_closed(chain: Sequence[complex], gap: float) -> bool:
    return len(chain) > 2 and abs(chain[-1] - chain[0]) <= gap


def _each_once(curves: Sequence[Curve], gap: float) -> list[Curve]:
    by_ends: dict[tuple[complex, ...], Curve] = {}
    for curve in curves:
        middle = curve[len(curve) // 2] if len(curve) % 2 else (curve[len(curve) // 2 - 1] + curve[len(curve) // 2]) / 2
        cells = [_cell(point, gap) for point in (curve[0], curve[-1], middle)]
        first, last = sorted(cells[:2], key=lambda cell: (cell.real, cell.imag))
        by_ends.setdefault((first, last, cells[2], complex(len(curve))), curve)
    return list(by_ends.values())


def _cell(point: complex, gap: float) -> complex:
    return complex(round(point.real / gap), round(point.imag / gap))


class _Ends:
    """The ends of curves, by the cell of a grid in which each lies; used: the curves that are part of a chain."""

    def __init__(self, curves: Sequence[Curve], gap: float) -> None:
        self._curves, self._gap = curves, gap
        self.used: set[int] = set()
        self._at: dict[complex, list[tuple[int, bool]]] = {}
        for number, curve in enumerate(curves):
            for is_end in (False, True):
                self._at.setdefault(_cell(curve[-is_end], gap), []).append((number, is_end))

    def following(self, chain: Sequence[complex]) -> Sequence[complex]:
        """The curve that goes on where a chain ends, from there on; empty where none does."""
        here, cell = chain[-1], _cell(chain[-1], self._gap)
        best: tuple[float, int, bool] | None = None
        for step in _AROUND:
            near = [end for end in self._at.get(cell + step, ()) if end[0] not in self.used]
            if len(near) < len(self._at.get(cell + step, ())):
                self._at[cell + step] = near
            for number, is_end in near:
                curve = self._curves[number]
                if abs(curve[-is_end] - here) > self._gap:
                    continue
                direction = curve[-2] - curve[-1] if is_end else curve[1] - curve[0]
                turn = abs(_turn(here - chain[-2], direction))
                if best is None or turn < best[0]:
                    best = turn, number, is_end
        if best is None:
            return ()
        self.used.add(best[1])
        curve = self._curves[best[1]]
        return curve[::-1] if best[2] else curve


_AROUND = [complex(x, c) for x in (-1, 0, 1) for c in (-1, 0, 1)]


def _turn(before: complex, after: complex) -> float:
    turned = before.conjugate() * after
    return math.atan2(turned.imag, turned.real)
