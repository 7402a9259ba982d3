"""Colours and dashes of every picture, on paper and on screen.

After Okabe and Ito's palette for all kinds of colour vision, without its yellow
and with orange, sky blue, green and purple darkened to a contrast of at least 3 : 1
on white.
Colour never speaks alone: each slot has a dash as well, and 7 colours times 5
dashes, walked together, tell 35 curves apart.
"""

from __future__ import annotations

INK = "#1b1f24"
QUIET = "#5b6570"
GRID = "#e3e6ea"
ALERT = "#a3230a"
SHADE = "#f6d9c9"

COLOURS = ("#0072b2", "#d55e00", "#008a65", "#b0508a", "#b87800", "#1b1f24", "#3b9bd8")
DASHES = ("solid", "dash", "dot", "dashdot", "longdash")


def colour(slot: int) -> str:
    """Return the colour of the slot-th curve of a chart, counted from 0."""
    return COLOURS[slot % len(COLOURS)]


def dash(slot: int) -> str:
    """Return the dash of the slot-th curve of a chart, counted from 0."""
    return DASHES[slot % len(DASHES)]
