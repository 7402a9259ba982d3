"""The numbers of an analysis in words: rows of tables, on screen and on the page."""

from __future__ import annotations

from nullmotion.atlas.analysis import Analysis
from nullmotion.atlas.sizes import Radii
from nullmotion.plot import palette
from nullmotion.plot.atlas_view import Ball
from nullmotion.report.atlas_numbers import Number

OUTER = "Outer surface, least momentum"
OMNI = "Omnidirectional momentum"
IMPASSABLE = "Nearest impassable singularity"
_UNIT = "N m s"
_NOTES = {
    OUTER: "Sheet of all plus signs alone; it has holes, and is not the envelope",
    OMNI: "Largest ball of reachable momenta: up to it every |h| in every direction",
    IMPASSABLE: "Elliptic: no null motion, and no law can go on along u; the pseudo-inverse sticks",
}


def number_rows(found: Analysis) -> list[Number]:
    """Return the numbers of an array without failures."""
    unit = float(found.array.mean_momentum)
    most = found.max_momentum
    rows = [
        *radius_rows(found.radii, unit),
        Number("Largest momentum", most.lower, most.upper, _UNIT, unit, "In the best direction"),
    ]
    if found.volume is not None:
        size, m = found.volume, found.array.m
        what = {3: "Volume", 2: "Area", 1: "Length"}[m]
        note = f"Of all reachable momenta; about {size.value:.4g}"
        power = "" if m == 1 else ("²" if m == 2 else "³")
        row = Number(
            f"{what} of reachable momenta", size.lower, size.upper, f"(N m s){power}", unit**m, note
        )
        rows.append(row)
    return rows


def radius_rows(radii: Radii, unit: float) -> list[Number]:
    """Return the four radii as rows; a guarantee for each torque."""
    ball, nearest, outer = radii.omnidirectional, radii.nearest_impassable, radii.outer_surface
    rows = [
        Number(OMNI, ball.lower, ball.upper, _UNIT, unit, f"{_NOTES[OMNI]} ({ball.basis})"),
        Number(OUTER, outer.radius, outer.radius, _UNIT, unit, _NOTES[OUTER]),
    ]
    if nearest is None:
        none = "No internal singularity is impassable"
        rows.append(Number(IMPASSABLE, None, None, _UNIT, unit, none))
    else:
        note = f"{_NOTES[IMPASSABLE]} ({nearest.basis.partition(',')[0]})"
        rows.append(Number(IMPASSABLE, nearest.lower, nearest.radius, _UNIT, unit, note))
    for row in radii.guaranteed:
        level = f"{row.torque_capability:g} h0 x rate limit"
        finite = row.torque_Nm < float("inf")
        name = f"Guaranteed at {row.torque_Nm:.4g} N m" if finite else f"Guaranteed at {level}"
        note = f"By the constraint {row.constraint}: {level} in every direction, proven"
        rows.append(Number(name, row.proven_radius, row.radius, _UNIT, unit, note))
    if radii.no_guarantee:
        rows.append(Number("Guaranteed", None, None, _UNIT, unit, radii.no_guarantee))
    return rows


def failure_rows(found: Analysis) -> tuple[tuple[str, ...], list[tuple[str, ...]]]:
    """Return head and rows of what is left when a CMG fails; CMGs count from 1."""
    head = ("Failed CMG", "Omnidirectional", "Outer surface", "Impassable from", "Guaranteed")
    rows: list[tuple[str, ...]] = []
    for first in sorted({one.like for one in found.failures}):
        alike = [one for one in found.failures if one.like == first]
        left = alike[0].radii
        nearest, held = left.nearest_impassable, left.guaranteed
        rows.append(
            (
                ", ".join(str(one.cmg + 1) for one in alike),
                f"{left.omnidirectional.lower:.4f} to {left.omnidirectional.upper:.4f}",
                f"{left.outer_surface.radius:.4f}",
                "–" if nearest is None else f"{nearest.radius:.4f}",
                "–" if not held else f"{held[0].proven_radius or 0.0:.4f}",
            )
        )
    return head, rows


def balls(found: Analysis) -> list[Ball]:
    """Return the radii as a picture shows them."""
    radii = found.radii
    nearest = radii.nearest_impassable
    made = [
        Ball("outer", OUTER, radii.outer_surface.radius, palette.COLOURS[0], "dot", False),
        Ball("omnidirectional", OMNI, radii.omnidirectional.lower, palette.COLOURS[2], "solid"),
    ]
    if nearest is not None:
        made.append(Ball("impassable", IMPASSABLE, nearest.radius, palette.ALERT, "dash"))
    for i, row in enumerate(radii.guaranteed):
        size = row.proven_radius
        if size:
            name = f"Guaranteed at {row.torque_capability:g} h0 x rate limit"
            made.append(Ball(f"guaranteed-{i}", name, size, palette.COLOURS[3], "dashdot"))
    return [ball for ball in made if ball.radius > 0]
