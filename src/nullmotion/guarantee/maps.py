"""Torque capability over momentum space: on a slice, and least and greatest over direction."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from nullmotion.errors import InputError
from nullmotion.guarantee.constraint import Constraint

if TYPE_CHECKING:
    import xarray as xr

_AXES = "xyz"
_GOLDEN = np.pi * (3 - np.sqrt(5.0))


def slice_map(
    constraint: Constraint,
    across: str = "z",
    at: float = 0.0,
    *,
    points: int = 401,
    reach: float | None = None,
) -> xr.DataArray:
    """Return TC on a plane of momenta, with the momentum's components as coordinates.

    Args:
        constraint: The constraint function.
        across: Axis that is constant, ``x``, ``y`` or ``z``; ignored with two components.
        at: Momentum along it, in units of one CMG's.
        points: Points along each side.
        reach: Half the side, in units of one CMG's momentum; by default to the envelope's corner.

    Raises:
        InputError: For an axis that is none.
    """
    import xarray as xr

    if constraint.m == 3 and across not in tuple(_AXES):
        raise InputError("across", across, "x, y or z")
    names = [c for c in _AXES[: constraint.m] if constraint.m == 2 or c != across]
    side = np.linspace(-1, 1, points) * (constraint.reach if reach is None else reach)
    first, second = np.meshgrid(side, side, indexing="ij")
    h = np.full((points, points, constraint.m), float(at))
    h[..., _AXES.index(names[0])], h[..., _AXES.index(names[1])] = first, second
    return xr.DataArray(
        constraint.torque_capability(h),
        dims=[f"h_{c}" for c in names],
        coords={f"h_{c}": (f"h_{c}", side, {"units": "h0"}) for c in names},
        name="torque_capability",
        attrs={"units": "h0 rate_limit", "constraint": constraint.name},
    )


def band(constraint: Constraint, radii: Any, *, directions: int = 4096) -> tuple[Any, Any]:
    """Return the least and the greatest TC over directions of momentum at given |h|.

    From a spiral of directions: the least is seen to about 1e-3, `radius.least_capability`
    polishes it.

    Args:
        constraint: The constraint function.
        radii: Sizes of the momentum, (k,).
        directions: Number of directions.
    """
    sizes = np.asarray(radii, float)
    h = sizes[:, None, None] * spread_directions(constraint.m, directions)
    found = constraint.torque_capability(h)
    return found.min(axis=1), found.max(axis=1)


def spread_directions(m: int, count: int) -> np.ndarray:
    """Return unit vectors spread evenly over the circle or the sphere, (count, m)."""
    k = np.arange(count)
    if m == 2:
        angle = 2 * np.pi * k / count
        return np.stack([np.cos(angle), np.sin(angle)], axis=1)
    z = 1 - (2 * k + 1) / count
    ring = np.sqrt(1 - z * z)
    return np.stack([ring * np.cos(_GOLDEN * k), ring * np.sin(_GOLDEN * k), z], axis=1)
