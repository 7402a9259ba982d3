"""Sections 4.2, 4.3 and 7.3 of Elliott 2019: what the box-90's constraints promise."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cached_property

import numpy as np

from nullmotion.guarantee.constraints.box90_cubic import Box90Cubic
from nullmotion.guarantee.constraints.box90_spherical import Box90Spherical
from nullmotion.papers.base import Cell
from nullmotion.papers.elliott2019_spheres import Band, Box90, band, radius

_EDGES = ((1.780, 1.800), (1.990, 2.005), (2.935, 2.965))  # where TC falls steeply
SIZES = np.unique(
    np.concatenate([np.linspace(0.0, 3.0, 301), *(np.linspace(*e, 31) for e in _EDGES)])
)  # |H|, past the farthest point of the envelopes
NOTHING = 1e-4  # TC that counts as none
_RESTRICTED = 2.0

_TIGHT = "holds as printed, but it holds up to the computed radius as well"
_SATURATED = "where a plane is saturated"
_PLANE = "where a plane has no momentum: J_t is singular there, before the envelope ends"
_FARTHEST = "the farthest momentum: no sphere of that size is inside"
_INSIDE = "a plane has no momentum on a curve inside the envelope: h = ({:.3f}, 0, {:.3f}) is on it"
_SHARE = "at {:.0f} % of the sizes up to 1.83"


class Guarantees:
    """Both published constraints, and their extremes over momenta of one size."""

    def __init__(self) -> None:
        """Compile."""
        self.cubic = Box90(Box90Cubic())
        self.spherical = Box90(Box90Spherical())

    @cached_property
    def band(self) -> Band:
        """TC of the cubic constraint."""
        return band(self.cubic.capability, SIZES)

    @cached_property
    def determinant(self) -> Band:
        """|det J_t| of the cubic constraint."""
        return band(self.cubic.determinant, SIZES)

    @cached_property
    def spherical_band(self) -> Band:
        """TC of the spherical constraint."""
        return band(self.spherical.capability, SIZES)

    def cells(self) -> Iterator[Cell]:
        """Return the numbers that the text says of Figures 20 to 24 and 41."""
        yield from self._radii()
        yield from self._reach()
        yield from self._shape()
        yield self._regular()

    def _radii(self) -> Iterator[Cell]:
        for row, level, value in (
            ("constrained envelope", NOTHING, 1.79),
            ("TC at least 0.5", 0.5, 1.39),
            ("TC at least 1", 1.0, 0.73),
        ):
            found, note = radius(self.cubic.capability, level), _TIGHT if level == 1.0 else ""
            yield Cell("text", row, "radius", value, found, 0.005, note=note)
        saturated = radius(self.spherical.room, 0.0)
        singular = radius(self.spherical.capability, NOTHING)
        row = "spherical constraint, {}"
        farthest = float(SIZES[self.spherical_band.high > NOTHING].max())
        for what, found, note in (
            ("farthest", farthest, _FARTHEST),
            ("envelope", saturated, _SATURATED),
            ("TC above 0", singular, _PLANE),
        ):
            yield Cell("text", row.format(what), "radius", 2.0, found, 0.005, note=note)

    def _reach(self) -> Iterator[Cell]:
        from scipy.optimize import brentq

        for axis, direction in zip("xyz", np.eye(3), strict=True):

            def room(t: float, direction: np.ndarray = direction) -> float:
                return float(self.cubic.room(t * direction[None])[0])

            found = float(brentq(room, 1.0, 2.5, xtol=1e-12))
            row = f"constrained envelope, along {axis}"
            yield Cell("text", row, "reach", _RESTRICTED, found, 1e-6)

    def _shape(self) -> Iterator[Cell]:
        high, far = self.band.high, self.band.sizes > 1.6
        top = float(self.band.sizes[int(np.argmax(np.where(far, high, 0.0)))])
        yield Cell("text", "clusters with TC of at least 1", "momentum", 2.0, top, 0.1)
        spherical, cubic = self.spherical_band.low, self.band.low
        both = (spherical > NOTHING) & (self.band.sizes > 0)
        share = float((spherical > cubic)[both].mean())
        column, found = "least_TC_greater_at_most_magnitudes", "yes" if share > 0.5 else "no"
        note = _SHARE.format(100 * share)
        yield Cell("text", "spherical constraint", column, "yes", found, note=note)

    def _regular(self) -> Cell:
        """Look along H_x = Psi(H_x, 0, H_z), where the first plane has no momentum."""
        from scipy.optimize import brentq

        def first(x: float, z: float) -> float:
            return x - float(self.cubic.constraint.bias(np.array([x, 0.0, z]))[0])

        z = 1.92
        x = float(brentq(first, 0.0, 2.0, args=(z,)))
        inside = float(self.cubic.room(np.array([[x, 0.0, z]]))[0]) > 0
        column, note = "non-singular_inside", _INSIDE.format(x, z) if inside else ""
        return Cell(
            "text", "constrained envelope", column, "yes", "no" if inside else "yes", note=note
        )
