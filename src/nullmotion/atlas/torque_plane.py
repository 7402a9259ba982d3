"""A plane through momentum space, and a grid of momenta on it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from nullmotion.array.model import CmgArray
from nullmotion.atlas.envelope_rings import Rings, rings
from nullmotion.atlas.signs import checked_directions
from nullmotion.errors import InputError

LEAST, MOST = 3, 501
_MARGIN = 1.02  # of the grid around what is within reach
_TURNS = 2001  # planes that are tried to bound a section
_LEAST_SIDE = 0.01  # of a grid, over the longer one
_NONE = 1e-12  # over the mean momentum


@dataclass(frozen=True, eq=False)
class Plane:
    """A grid of momenta.

    Attributes:
        basis: Orthonormal rows, (2, m).
        origin: Its point closest to no momentum at all [N m s], (m,).
        x: Coordinates along the first row [N m s], (k,).
        y: Along the second, (k,).
        mirrored: Whether the grid is its own image in the array's bias.
    """

    basis: np.ndarray
    origin: np.ndarray
    x: np.ndarray
    y: np.ndarray
    mirrored: bool

    @property
    def momenta(self) -> np.ndarray:
        """The momenta [N m s], (len(y), len(x), m)."""
        along = self.x[:, None] * self.basis[0]
        found: np.ndarray = self.origin + along + (self.y[:, None] * self.basis[1])[:, None]
        return found


def plane(array: CmgArray, normal: Any, offset: Any, resolution: Any) -> Plane:
    """Return the plane normal . h = offset, with a grid over all that the array reaches on it.

    Raises:
        InputError: For one torque dimension, a normal with two, or one without length; a
            plane beyond what the array reaches; a resolution out of range.
    """
    if not isinstance(resolution, (int, np.integer)) or not LEAST <= resolution <= MOST:
        raise InputError("resolution", resolution, f"a whole number of points, {LEAST} to {MOST}")
    if array.m < 2:
        raise InputError("array", f"{array.m} torque dimension", "2 or 3 torque dimensions")
    assert array.torque_axes is not None
    bias, found = array.torque_axes @ array.momentum_bias, rings(array)
    basis, across = _frame(array, normal)
    far = _distance(array, normal, offset, across, found, bias)
    lean = (far - float(across @ bias)) / found.unit  # from the bias
    mirrored = abs(lean) <= _NONE
    ends = found.unit * np.array([_extent(found, e, across, lean) for e in basis])
    middle = basis @ bias + (0.0 if mirrored else ends @ [0.5, 0.5])
    half = 0.5 * (ends[:, 1] - ends[:, 0])
    half = _MARGIN * np.maximum(half, _LEAST_SIDE * half.max(initial=found.unit))
    x, y = (c + h * np.linspace(-1, 1, int(resolution)) for c, h in zip(middle, half, strict=True))
    return Plane(basis, far * across, x, y, mirrored)


def _frame(array: CmgArray, normal: Any) -> tuple[np.ndarray, np.ndarray]:
    """Return the basis (2, m) and the unit normal, 0 for m = 2: both turn like x, y and z."""
    if array.m == 2:
        if normal is not None:
            raise InputError("normal", normal, "None: there are two torque dimensions, one plane")
        return np.eye(2), np.zeros(2)
    across = checked_directions(array, [0, 0, 1] if normal is None else normal, "normal")
    if across.ndim != 1:
        raise InputError("normal", across.tolist(), "one vector of 3 components")
    first = np.eye(3)[(np.abs(across).argmax() + 1) % 3]
    first = first - (first @ across) * across
    first = first / np.linalg.norm(first)
    return np.stack([first, np.cross(across, first)]), across


def _distance(
    array: CmgArray, normal: Any, offset: Any, across: np.ndarray, found: Rings, bias: np.ndarray
) -> float:
    """Return the plane's distance from no momentum along its unit normal [N m s]."""
    length = 1.0 if normal is None else float(np.linalg.norm(np.asarray(normal, float)))
    deep = found.unit * float(found.support(across)) if across.any() else 0.0
    low, high = (length * (float(across @ bias) + s * deep) for s in (-1, 1))
    slack = _NONE * found.unit * length
    good = isinstance(offset, (int, float, np.number)) and low - slack <= offset <= high + slack
    if not good:
        what = "0: there is one plane" if array.m == 2 else "what the array reaches (N m s)"
        raise InputError("offset", offset, f"{low:.6g} to {high:.6g}, {what}")
    return float(offset) / length


def _extent(found: Rings, e: np.ndarray, across: np.ndarray, lean: float) -> tuple[float, float]:
    """Return bounds of h . e on a section of the reachable momenta, in their unit.

    By duality the greatest h . e with h . n = d in the convex hull of R is the least of
    S(e - t n) + t d over all t. Any t bounds it.
    """
    angle = np.linspace(-0.5 * np.pi, 0.5 * np.pi, _TURNS + 2)[1:-1, None]
    t = np.tan(angle) * across.any()
    bounds = [found.support(s * e - t * across) + t[:, 0] * lean for s in (1, -1)]
    return -float(bounds[1].min()), float(bounds[0].min())
