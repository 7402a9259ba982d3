"""Singular surfaces as triangles of one type each, and where a plane meets them."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

from nullmotion.atlas import Surface


class Pieces(NamedTuple):
    """Triangles in momentum space.

    Attributes:
        corner: Their corners [N m s], (T, 3, 3).
        normal: Unit normals: the singular directions in their middles, (T, 3).
        kind: Types as places in `nullmotion.atlas.KINDS`, (T,).
    """

    corner: np.ndarray
    normal: np.ndarray
    kind: np.ndarray


class Cut(NamedTuple):
    """Pieces of the lines in which a plane meets triangles.

    Attributes:
        ends: Both ends of each piece [N m s], (k, 2, 3).
        kind: Types as places in `nullmotion.atlas.KINDS`, (k,).
    """

    ends: np.ndarray
    kind: np.ndarray


def own_places(sheet: Surface) -> np.ndarray:
    """Return for each point the point of the sheet whose type a picture gives it, (P,).

    The rim of a hole belongs to two sheets, and its type is that of both together; a picture
    takes the type of the nearest ring of the sheet itself, or the rim would be drawn in teeth.
    """
    place, rim = np.arange(len(sheet.u)), sheet.rim
    columns = sheet.cells.shape[1]
    for a in range(columns):
        for b in range(columns):
            inner, outer = sheet.cells[:, a], sheet.cells[:, b]
            there = rim[inner] & ~rim[outer]
            place[inner[there]] = outer[there]
    return place


def pieces(sheets: Iterable[Surface]) -> Pieces:
    """Return the triangles of sheets; where types part, triangles are cut along the edge.

    An edge between types is where 1/K passes through zero.
    """
    parts = [part for sheet in sheets for part in _parts(sheet)]
    corner, u, kind = (np.concatenate(column) for column in zip(*parts, strict=True))
    normal = u.sum(axis=1)
    size = np.linalg.norm(normal, axis=1, keepdims=True)
    return Pieces(corner, normal / np.where(size > 0, size, 1.0), kind)


def cut(made: Pieces, normal: np.ndarray, offset: float = 0.0) -> Cut:
    """Return where the plane normal . h = offset meets triangles.

    Args:
        made: Triangles.
        normal: Unit vector along the torque axes, (3,).
        offset: Distance of the plane from the origin [N m s].
    """
    side = made.corner @ normal - offset
    above = side > 0
    met = above.any(axis=1) & ~above.all(axis=1)
    corner, side, above = made.corner[met], side[met], above[met]
    alone = np.where(above.sum(axis=1) == 1, above.argmax(axis=1), above.argmin(axis=1))
    (h, hq, hr), (d, dq, dr) = _from(corner, alone), _from(side, alone)
    ends = [h + (d / (d - e))[:, None] * (there - h) for there, e in ((hq, dq), (hr, dr))]
    return Cut(np.stack(ends, axis=1), made.kind[met])


def _parts(sheet: Surface) -> list[tuple[np.ndarray, np.ndarray, np.ndarray]]:
    """Return corners, directions at the corners and types: whole triangles, then cut ones."""
    own = own_places(sheet)
    kind = sheet.kind[own][sheet.cells]
    mixed = np.ptp(kind, axis=1) > 0
    whole, split = sheet.cells[~mixed], sheet.cells[mixed]
    parts = [(sheet.momentum[whole], sheet.u[whole], kind[~mixed, 0])]
    curvature = sheet.curvature[own]
    return parts + _halves(sheet, curvature, split, kind[mixed]) if mixed.any() else parts


def _halves(
    sheet: Surface, curvature: np.ndarray, cells: np.ndarray, kind: np.ndarray
) -> list[tuple[np.ndarray, np.ndarray, np.ndarray]]:
    """Return the parts of triangles with two types: one beside the odd corner, two beyond."""
    a, b, c = kind.T
    alone = np.where(b == c, 0, np.where(c == a, 1, 2))
    p, q, r = _from(cells, alone)
    own, other = kind[np.arange(len(kind)), alone], _from(kind, alone)[1]
    with np.errstate(divide="ignore"):
        margin = 1.0 / curvature
    table = np.concatenate([sheet.momentum, sheet.u], axis=1)
    pq, pr = (_edge(table, margin, p, there) for there in (q, r))
    made = []
    for corners, of in (
        ((table[p], pq, pr), own),
        ((pq, table[q], table[r]), other),
        ((pq, table[r], pr), other),
    ):
        both = np.stack(corners, axis=1)
        made.append((both[..., :3], both[..., 3:], of))
    return made


def _edge(table: np.ndarray, margin: np.ndarray, p: np.ndarray, q: np.ndarray) -> np.ndarray:
    """Return where the type changes between two points: halfway if 1/K does not tell."""
    with np.errstate(invalid="ignore"):
        share = margin[p] / (margin[p] - margin[q])
    share = np.where(np.isfinite(share) & (share >= 0) & (share <= 1), share, 0.5)[:, None]
    found: np.ndarray = table[p] + share * (table[q] - table[p])
    return found


def _from(table: np.ndarray, first: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the three columns of a table (T, 3, ...), each row turned to begin with one."""
    rows = np.arange(len(table))
    return table[rows, first], table[rows, (first + 1) % 3], table[rows, (first + 2) % 3]
