"""Colors that the color-blind distinguish, and that differ in black and white."""

from __future__ import annotations

from bisect import bisect_right

#: Shares of the limit of C at which a new color begins, and the colors: viridis from light to dark.
BOUNDS = (0.01, 0.03, 0.1, 0.3, 0.6)
SHADES = ("#7ad151", "#22a884", "#2a788e", "#355f8d", "#414487", "#440154")
ABOVE, PLAIN, UNKNOWN, INK = "#d55e00", "#1b3a5c", "#767676", "#1a1a1a"
LEFT = "#0072b2"
PART, PART_EDGE, BAR, CENTER = "#dde6ee", "#9db0c2", "#f0e8da", "#595959"
#: The color of a label by the severity of its finding.
SEVERITIES = {"error": "#a8321a", "warning": "#8a5a00", "note": "#4f4f4f", "overcut": ABOVE, "left standing": LEFT}
#: The limit itself is not above it.
_ROUNDING = 1e-9


def color_of_share(share: float | None, is_positioning: bool) -> str:
    """Return the color of a move with this share of the limit of C; unknown is plain."""
    if share is not None and share > 1 + _ROUNDING:
        return ABOVE
    if share is None or is_positioning:
        return PLAIN
    return SHADES[bisect_right(BOUNDS, share)]
