"""Generated ground: a random field with a power-law spectrum, the same for the same seed.

    z = sum over wave vectors k of a_k cos(k . x + phase_k),  a_k ~ |k|^-(hurst + 1)

for wavelengths from `shortest` to twice the field's size, scaled to the wanted root mean square
slope; then an even incline is added. Slopes hence vary over the field as on natural ground,
where long hills carry short ones.
"""

from __future__ import annotations

import math

import numpy as np

from nullmotion.errors import InputError
from nullmotion.rover.terrain import HeightField

_MOST = 4_000_000  # heights: a field of 500 m at 0.25 m


def generated(
    size: float | tuple[float, float] = 20.0,
    *,
    seed: int = 0,
    rms_slope: float = math.radians(12.0),
    shortest: float = 4.0,
    hurst: float = 0.8,
    incline: float = 0.0,
    heading: float = 0.0,
    spacing: float = 0.25,
) -> HeightField:
    """Return generated ground.

    Args:
        size: Extent along x and y [m]; one number for a square.
        seed: Of the random numbers.
        rms_slope: Root mean square of the slope without the incline [rad]; 0 for a plane.
        shortest: Shortest wavelength [m].
        hurst: From 0 (rough) to 1 (smooth): how much the long waves outweigh the short ones.
        incline: Even slope that is added [rad].
        heading: Direction in which that rises, from +x towards +y [rad].
        spacing: Of the grid [m].

    Raises:
        InputError: For what no ground can have.
    """
    wide, deep = size if isinstance(size, tuple) else (size, size)
    _check(
        spacing_m=(spacing, 1e-3, 1e3),
        size_m=(min(wide, deep), spacing, 1e6),
        rms_slope_deg=(math.degrees(rms_slope), 0.0, 60.0),
        shortest_m=(shortest, 2 * spacing, math.inf),
        hurst=(hurst, 0.0, 1.0),
        incline_deg=(math.degrees(incline), -80.0, 80.0),
        heading_deg=(math.degrees(heading), -1e6, 1e6),
        seed=(seed, 0, math.inf),
    )
    if (wide / spacing + 1) * (deep / spacing + 1) > _MOST:
        raise InputError("terrain.spacing_m", spacing, f"a grid of at most {_MOST} heights")
    columns, rows = (max(2, round(s / spacing) + 1) for s in (wide, deep))
    z = _waves(rows, columns, seed, shortest / spacing, hurst)
    rms = math.sqrt(float(np.mean(np.tan(HeightField(z, spacing).slopes()) ** 2)))
    z *= math.tan(rms_slope) / rms if rms else 0.0
    x, y = np.meshgrid(spacing * np.arange(columns), spacing * np.arange(rows))
    z += math.tan(incline) * (math.cos(heading) * x + math.sin(heading) * y)
    return HeightField(z, spacing, source=f"generated, seed {seed}")


def _waves(rows: int, columns: int, seed: int, shortest: float, hurst: float) -> np.ndarray:
    """Return the random field, unscaled; lengths in steps of the grid."""
    # twice the size, of which a quarter is kept: opposite sides of a whole period are alike
    shape = (2 * rows, 2 * columns)
    random = np.random.default_rng(seed)
    noise = np.fft.rfft2(random.normal(size=shape))
    k = np.hypot(np.fft.fftfreq(shape[0])[:, None], np.fft.rfftfreq(shape[1])[None, :])
    kept = (k > 0) & (k <= 1 / shortest)
    amplitude = np.where(kept, np.where(k > 0, k, 1.0) ** -(hurst + 1), 0.0)
    return np.fft.irfft2(noise * amplitude, s=shape)[:rows, :columns]


def _check(**bounded: tuple[float, float, float]) -> None:
    """Refuse a value that is not between its bounds."""
    for key, (value, low, high) in bounded.items():
        if not low <= value <= high:
            raise InputError(f"terrain.{key}", value, f"from {low:g} to {high:g}")
