"""Singular surfaces: the sheets of all sign patterns, meshed for pictures and searches.

    h(u) = bias + sum_i epsilon_i h0_i p_i / |p_i|,    p_i = u - (u . g_i) g_i

What depends on u alone is worked out once; each of the 2^(n - 1) sheets is then a sum with signs.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from nullmotion.array.model import CmgArray
from nullmotion.atlas.curvature import determinant, radii_terms
from nullmotion.atlas.grid import Grid, grid
from nullmotion.atlas.kind import KINDS, Kind, codes
from nullmotion.atlas.signs import checked_signs, patterns
from nullmotion.atlas.surfaces_points import SingularPoints, singular_points

__all__ = ["SingularPoints", "Surface", "singular_points", "surfaces"]

RESOLUTION = 4000


@dataclass(frozen=True, eq=False)
class Surface:
    """The sheet of one sign pattern over all directions.

    Attributes:
        signs: epsilon, (n,).
        u: Unit singular directions along the torque axes, (P, m); the same for all sheets.
        cells: Triangles (T, 3) that turn anticlockwise around u for m = 3, edges (T, 2) for
            m = 2: indices of points. The rim of the hole at each gimbal axis is left open.
        delta: Gimbal angles in (-pi, pi] [rad], (P, n).
        momentum: h(delta) with the array's bias [N m s], (P, m).
        kind: Types as places in `KINDS`, (P,).
        curvature: Gaussian (m = 2: the line's) curvature [1/(N m s)^(m - 1)], (P,).
        rim: Points with u along a gimbal axis, whose CMG is free, (P,).
    """

    signs: np.ndarray
    u: np.ndarray
    cells: np.ndarray
    delta: np.ndarray
    momentum: np.ndarray
    kind: np.ndarray
    curvature: np.ndarray
    rim: np.ndarray

    @property
    def passable(self) -> np.ndarray:
        """Where null motion leaves the singular set, (P,)."""
        there: np.ndarray = self.kind == KINDS.index(Kind.HYPERBOLIC)
        return there


def surfaces(
    array: CmgArray, resolution: int = RESOLUTION, signs: Any = None
) -> tuple[Surface, ...]:
    """Return the singular surfaces of an array, the outer one (all signs +1) first.

    Args:
        array: The array; any number of CMGs, failed ones and momentum bias included.
        resolution: About how many directions on the sphere (m = 2: on the circle).
        signs: Sign patterns (k, n); by default all 2^(n - 1).

    Raises:
        InputError: For signs other than 1 and -1, a resolution out of range, more than 16 CMGs.
    """
    chosen = patterns(array) if signs is None else np.atleast_2d(checked_signs(array, signs))
    directions = _directions(array, grid(array, resolution))
    return tuple(directions.sheet(sign) for sign in chosen)


@dataclass(frozen=True, eq=False)
class _Directions:
    """What the sheets share: singular angles, momenta and curvatures with all signs +1."""

    array: CmgArray
    grid: Grid
    delta: np.ndarray
    opposite: np.ndarray
    momenta: np.ndarray
    bias: np.ndarray
    radii: np.ndarray
    rounding: np.ndarray
    free: np.ndarray

    def sheet(self, signs: np.ndarray) -> Surface:
        """Return the sheet of one sign pattern."""
        radii = np.einsum("n,npk->pk", signs, self.radii)
        with np.errstate(divide="ignore"):
            curvature = np.where(self.grid.rim, 0.0, 1.0 / determinant(radii, self.array.m))
        return Surface(
            signs=signs,
            u=self.grid.u,
            cells=self.grid.cells,
            delta=np.where(signs > 0, self.delta, self.opposite),
            momentum=self.bias + np.einsum("n,npm->pm", signs, self.momenta),
            kind=codes(self.array, signs, radii, self.rounding, self.free),
            curvature=curvature,
            rim=self.grid.rim,
        )


def _directions(array: CmgArray, mesh: Grid) -> _Directions:
    assert array.torque_axes is not None
    base = singular_points(array, mesh.u, np.ones(array.n), mesh.towards)
    radii = np.moveaxis(radii_terms(array, mesh.u, base.delta, base.across), 1, 0)
    return _Directions(
        array=array,
        grid=mesh,
        delta=base.delta,
        opposite=np.where(base.delta > 0, base.delta - np.pi, base.delta + np.pi),
        momenta=np.moveaxis(array.rotor_momenta(base.delta), 1, 0),
        bias=array.torque_axes @ array.momentum_bias,
        radii=np.ascontiguousarray(radii),
        rounding=np.abs(radii).sum(axis=(0, 2)),
        free=base.free,
    )
