"""Rules that report a cause from which findings of many other rules follow, by what is wrong."""

#: X or the second axis is another than the one that the section was written for, or there is none.
SECTION_READ_OTHERWISE = (
    "wrong-axis-address-in-polar",
    "diameter-radius-mixed",
    "second-axis-never-programmed",
    "linear-axis-never-programmed",
)
#: The polar sections, or the words themselves, are others than were meant: what else would be found is not known.
READ_OTHERWISE = (
    *SECTION_READ_OTHERWISE,
    "polar-never-left",
    "polar-never-entered",
    "polar-code-of-another-control",
    "comment-not-closed",
    "other-dialect",
)
#: An arc whose end may be what is wrong, and then what begins there is, too.
END_IN_DOUBT = (
    "arc-center-on-path",
    "arc-end-off-circle",
    "arc-radius-too-small",
    "arc-without-center",
)
#: What is written for C may be what is wrong, so that an arc that begins there has another start.
C_IN_DOUBT = (*END_IN_DOUBT, "degrees-in-polar")
#: An arc that there is not, so that nobody knows the way to its end.
NO_SUCH_ARC = (
    *END_IN_DOUBT,
    "arc-word-of-other-plane",
    "arc-off-polar-plane",
)
#: What stands in a block of its own in the mode and cannot: without it there would be fewer blocks without movement.
OUT_OF_PLACE = (
    "plane-selected-in-polar",
    "origin-shifted-in-polar",
    "offset-changed-in-polar",
    "code-not-allowed-in-polar",
    "spindle-code-in-polar",
    "tool-length-offset-in-polar",
    "polar-entered-twice",
    "incremental-word-of-other-code-system",
    "unknown-code",
    "rapid-in-polar",
)
#: G41 or G42 in offset mode: another side of the contour, or another ramp.
SIDE_WRITTEN_AGAIN = ("side-changed-in-offset-mode", "side-repeated-in-offset-mode")
