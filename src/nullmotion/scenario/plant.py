"""How a real array differs from its drawing: drawn from a seed, the same everywhere."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from nullmotion.array import CmgArray
from nullmotion.scenario.schema import PlantSection


def drawn(
    section: PlantSection | None, array: CmgArray
) -> tuple[CmgArray | None, np.ndarray | None]:
    """Return the array as it is and what its encoders are off by; None where they are exact."""
    if section is None:
        return None, None
    generator = np.random.default_rng(section.seed)
    real = real_array(array, section, generator)
    bias = encoder_bias(array.n, section, generator)
    exact = section.gimbal_axis_error_deg == 0 and section.h0_error == 0
    return None if exact else real, bias if section.encoder_bias_deg else None


def real_array(array: CmgArray, plant: PlantSection, generator: np.random.Generator) -> CmgArray:
    """Return the array with gimbal axes turned and momenta off.

    Each gimbal's frame (g, s, t) turns by exactly ``gimbal_axis_error_deg`` about a
    direction perpendicular to its gimbal axis, uniform on that circle;
    h0_i becomes h0_i (1 + h0_error u_i) with u_i uniform in [-1, 1], and so does the
    inertia of a wheel whose speed may change: at a given speed its momentum is off as much.
    """
    around = generator.uniform(0.0, 2 * np.pi, array.n)
    off = generator.uniform(-1.0, 1.0, array.n)
    s, t = array.spin_axes, array.transverse_axes
    axis = np.cos(around)[:, None] * s + np.sin(around)[:, None] * t
    angle = np.radians(plant.gimbal_axis_error_deg)
    scale, wheels = 1 + plant.h0_error * off, array.wheels
    if wheels is not None:
        wheels = replace(wheels, inertia=wheels.inertia * scale)
    return CmgArray(
        _turned(array.gimbal_axes, axis, angle),
        _turned(s, axis, angle),
        array.h0 * scale,
        array.rate_limit,
        array.rate_limit_mode,
        array.angle_limits,
        array.momentum_bias,
        array.torque_axes,
        array.label,
        wheels,
    )


def _turned(vectors: np.ndarray, axis: np.ndarray, angle: float) -> np.ndarray:
    """Return vectors turned about unit axes, row by row (Rodrigues)."""
    along = np.sum(axis * vectors, axis=1, keepdims=True) * axis
    turned: np.ndarray = (
        np.cos(angle) * (vectors - along) + np.sin(angle) * np.cross(axis, vectors) + along
    )
    return turned


def encoder_bias(n: int, plant: PlantSection, generator: np.random.Generator) -> np.ndarray:
    """Return what the measured angles are off by [rad], uniform within the bound, (n,)."""
    bias: np.ndarray = generator.uniform(-1.0, 1.0, n) * np.radians(plant.encoder_bias_deg)
    return bias
