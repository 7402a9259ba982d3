"""Whether designs fly: one choice of layout, angle, law and coast, any momentum and rate."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from nullmotion import laws
from nullmotion.law import Law
from nullmotion.sizing.axes import frames
from nullmotion.sizing.cases import NONE_FAILED, Cases
from nullmotion.sizing.flight import Flights
from nullmotion.sizing.geometry import Geometry
from nullmotion.sizing.held import InLayout
from nullmotion.sizing.profile import RateProfile
from nullmotion.sizing.requirement import Requirement

_MOST = 60_000  # flights in one call
_FIRST = 24  # slews that are flown before the others


class Fleet:
    """Compiled flights of one requirement, made when first asked for.

    Args:
        requirement: What is flown.
    """

    def __init__(self, requirement: Requirement) -> None:
        """Start with none."""
        self.requirement = requirement
        self._made: dict[tuple[object, ...], Flights] = {}

    def flights(self, geometry: Geometry, law: Law, failed: int, substeps: int) -> Flights:
        """Return the flights of a law with what is left of an array after a failure."""
        array = geometry.arrays[failed]
        own = (geometry.layout, geometry.skew, failed) if law.knows_axes else ()
        key = (repr(law), array.n, substeps, *own)
        if key not in self._made:
            flown = InLayout(law, array) if law.knows_axes else law
            self._made[key] = Flights(self.requirement, array, flown, substeps)
        return self._made[key]

    @property
    def flown(self) -> int:
        """Number of flights so far."""
        return sum(flights.flown for flights in self._made.values())


@dataclass(frozen=True)
class Trial:
    """A choice whose momentum and gimbal rate are sought.

    Attributes:
        fleet: Where flights are compiled.
        geometry: Layout and angle.
        law: Name of the law.
        coast: Share of the slew at constant rate.
    """

    fleet: Fleet
    geometry: Geometry
    law: str
    coast: float
    _law: Law = field(init=False)

    def __post_init__(self) -> None:
        """Make the law; one that keeps to a constraint starts on it."""
        object.__setattr__(self, "_law", laws.create(self.law))
        if self._law.knows_axes and self.geometry.held:
            object.__setattr__(self, "geometry", self.geometry.at(start="constraint"))

    @property
    def unsupported(self) -> str:
        """Why the law cannot steer the array, or what a failure leaves of it."""
        reasons = (self._law.supports(array) for array in self.geometry.arrays.values())
        return next(filter(None, reasons), "")

    @property
    def requirement(self) -> Requirement:
        """What is flown."""
        return self.fleet.requirement

    @property
    def profile(self) -> RateProfile:
        """Rate about each axis."""
        r = self.requirement
        return RateProfile(r.angle, r.profile_time, self.coast, r.slew.smoothing)

    def settled(self, cases: Cases, h0: np.ndarray, rate: np.ndarray, fine: int = 1) -> np.ndarray:
        """Return when each slew has settled [s], (designs, slews); infinite if it has not.

        Args:
            cases: The slews.
            h0: Momentum of each design's CMGs [N m s], (designs,).
            rate: Largest gimbal rate [rad/s], (designs,).
            fine: Integration steps in a period of the law.
        """
        if not len(cases):
            return np.empty((len(h0), 0))
        size = max(1, _MOST // len(cases))
        parts = [
            self._settled(cases, h0[i : i + size], rate[i : i + size], fine)
            for i in range(0, len(h0), size)
        ]
        return np.concatenate(parts)

    def _settled(self, cases: Cases, h0: np.ndarray, rate: np.ndarray, fine: int) -> np.ndarray:
        late = np.empty((len(h0), len(cases)))
        for rows in self._together(cases):
            part = cases.picked(rows)
            many = part.picked(np.tile(np.arange(len(rows)), len(h0)))
            size, limit = (np.repeat(v, len(rows)) for v in self.requirement.held_back(h0, rate))
            delta, able = self.geometry.starts(many, size)
            flights = self.fleet.flights(self.geometry, self._law, int(part.failed[0]), fine)
            columns = (*self.geometry.axes(many), size, limit, delta)
            found = flights.fly(self.profile, frames(many.axis), columns)
            late[:, rows] = np.where(able, found, np.inf).reshape(len(h0), -1)
        return late

    def _together(self, cases: Cases) -> list[np.ndarray]:
        """Return the slews that one kernel flies: as many CMGs, and the same if a law asks."""
        own = self._law.knows_axes
        kinds = cases.failed if own else np.where(cases.failed == NONE_FAILED, NONE_FAILED, 0)
        return [np.flatnonzero(kinds == kind) for kind in np.unique(kinds)]

    def flies(self, cases: Cases, h0: np.ndarray, rate: np.ndarray) -> np.ndarray:
        """Return whether each design settles in time in every slew, (designs,)."""
        cut = len(cases) - max(_FIRST, len(cases) // 4)  # the hard ones stand last
        good = np.ones(len(h0), bool)
        for part in (np.arange(max(cut, 0), len(cases)), np.arange(cut)):
            which = np.flatnonzero(good)
            if len(part) and len(which):
                late = self.settled(cases.picked(part), h0[which], rate[which])
                good[which] = (late < self.requirement.time).all(axis=1)
        return good
