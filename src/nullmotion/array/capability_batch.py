"""Torque capability over batches of gimbal angles: sources, and how they are run."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import lru_cache
from math import comb
from typing import Any

import numpy as np

from nullmotion import ops
from nullmotion.array.minors import climb, columns, least_rates
from nullmotion.array.model import CmgArray
from nullmotion.array.torque_set import inradius, least_rates_capability, reach
from nullmotion.compile import CompiledFunction, compile_function

_KERNEL_FROM = 20_000  # configurations from which compiling a kernel pays
_KERNEL_MINORS = 1_000  # minors up to which it does
_KERNEL_ANGLE = 1e5  # rad; kernels promise no sines beyond it
_CHUNK = 2048  # configurations at once: intermediate values stay in the cache


def scaled_limits(array: CmgArray) -> tuple[np.ndarray, float]:
    """Return rate limits over the least one, (n,), and that [rad/s]; ones where there is none."""
    least = float(np.min(array.rate_limit))
    return (array.rate_limit / least, least) if np.isfinite(least) else (np.ones(array.n), 1.0)


def _pseudo_inverse(array: CmgArray, delta: Any, *null_motion: Any) -> Any:
    limits, unit = scaled_limits(array)
    found = least_rates(columns(array.unit_jacobian(delta)))
    for nu in null_motion:
        limits = limits - ops.absolute(nu) * (1.0 / unit)
    return least_rates_capability(found, limits)


def _local_gradient(array: CmgArray, delta: Any, k: Any) -> Any:
    limits, unit = scaled_limits(array)
    a = columns(array.unit_jacobian(delta))
    h = array.rotor_momenta(delta) / array.mean_momentum
    found = least_rates(a)
    nu = k * climb(found, a, columns(np.swapaxes(h, -1, -2)))
    return least_rates_capability(found, limits - np.moveaxis(ops.absolute(nu), 0, -1) / unit)


def _optimal(array: CmgArray, delta: Any) -> Any:
    return inradius(array.unit_jacobian(delta), scaled_limits(array)[0])


def _direction(array: CmgArray, delta: Any, u: Any) -> Any:
    return reach(array.unit_jacobian(delta), u, scaled_limits(array)[0])


_SOURCES: dict[str, tuple[Callable[..., Any], int]] = {  # with the last axes of the second input
    "pseudo-inverse": (_pseudo_inverse, 1),
    "local-gradient": (_local_gradient, 0),
    "optimal": (_optimal, 0),
    "direction": (_direction, 1),
}


def evaluated(array: CmgArray, name: str, delta: np.ndarray, *more: np.ndarray) -> Any:
    """Return a source's values over broadcast leading axes: a float, or an array.

    Args:
        array: The array.
        name: ``pseudo-inverse`` (and null motion), ``local-gradient`` (and k), ``optimal`` or
            ``direction`` (and unit vectors).
        delta: Gimbal angles [rad], (..., n).
        *more: The second input, if there is one.
    """
    source, axes = _SOURCES[name]
    tails = [x.shape[x.ndim - axes :] for x in more]
    shape = np.broadcast_shapes(delta.shape[:-1], *[x.shape[: x.ndim - axes] for x in more])
    if array.n < array.m:
        return np.zeros(shape)[()]
    pairs = zip([delta, *more], [(array.n,), *tails], strict=True)
    inputs = [np.broadcast_to(x, shape + tail).reshape(-1, *tail) for x, tail in pairs]
    count = len(inputs[0])
    small = array.n * comb(array.n, array.m - 1) <= _KERNEL_MINORS
    if count >= _KERNEL_FROM and small and np.abs(delta).max() <= _KERNEL_ANGLE:
        values = _kernel(_geometry(array), name, bool(more))(*inputs)
    else:
        parts = [slice(i, i + _CHUNK) for i in range(0, count, _CHUNK)]
        values = [source(array, *[x[part] for x in inputs]) for part in parts]
        values = np.concatenate([np.zeros(0), *values])
    return np.reshape(values, shape)[()]


@dataclass(frozen=True)
class _Geometry:
    """An array that equals any other with the same numbers in it, as a cache needs it."""

    numbers: bytes
    array: CmgArray = field(compare=False)


def _geometry(array: CmgArray) -> _Geometry:
    parts = [array.gimbal_axes, array.spin_axes, array.h0, array.rate_limit, array.torque_axes]
    return _Geometry(b"|".join(np.asarray(x, float).tobytes() for x in parts), array)


@lru_cache(maxsize=32)
def _kernel(geometry: _Geometry, name: str, second: bool) -> CompiledFunction:
    array, (source, axes) = geometry.array, _SOURCES[name]
    size = array.m if name == "direction" else array.n
    example = [np.zeros(size) if axes else 0.0] if second else []
    return compile_function(
        lambda delta, *more: source(array, delta, *more), np.zeros(array.n), *example
    )
