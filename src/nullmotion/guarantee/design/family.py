"""Biases that can be designed: the planes, and the polynomial that biases them."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product

import numpy as np

from nullmotion.errors import InputError
from nullmotion.guarantee import create
from nullmotion.guarantee._bias import Term
from nullmotion.guarantee.constraint import Constraint

Powers = tuple[int, int, int]  # of X (of x for unequal planes), Y, Z
MOST = 6  # degree


@dataclass(frozen=True)
class Family:
    """Psi = sum c X^i Y^j Z^k up to a degree, X = (h_x/extent)^2 and so on.

    Powers of X alone go on to an axial degree: along the common axis of the planes the bias
    has to follow more than a parabola (Eq 51 adds a polynomial there, too).

    Equal planes have one coefficient for Y^j Z^k and Y^k Z^j. Then

        TC(h_x, h_y, h_z) = TC(-h_x, h_y, h_z) = TC(h_x, h_z, h_y)

    and an octant of momentum space tells all. Unequal planes have powers of x = h_x/extent
    in place of those of X, each for half a degree, and two octants.

    Attributes:
        layout: Layout it is for.
        constraint: Name of the constraint that takes the terms.
        counts: CMGs in each plane.
        extent: Greatest |h_x| inside.
        b: Bias at no momentum of the start.
        envelope: Radius to be kept free of singularity by what is shipped.
        levels: Torque capabilities, and what a unit of the radius of each counts.
        published: Constraints to compare with.
        axial: Axial degree.
        tilt: What the start adds for unequal planes.
    """

    layout: str
    constraint: str
    counts: tuple[int, int]
    extent: float
    b: float
    envelope: float
    levels: dict[float, float]
    published: tuple[str, ...] = ()
    axial: int = 4
    tilt: float = 0.0

    @property
    def equal(self) -> bool:
        """Whether the planes have equally many CMGs."""
        return self.counts[0] == self.counts[1]

    def orbits(self, degree: int) -> list[tuple[Powers, ...]]:
        """Return the powers that share a coefficient, by rising degree.

        Raises:
            InputError: For a degree below 2 (nothing to design) or above `MOST`.
        """
        for key, value, least in (("degree", degree, 2), ("axial degree", self.axial, 0)):
            if not least <= value <= MOST:
                raise InputError(key, value, f"a whole number from {least} to {MOST}")
        half = 1 if self.equal else 2
        ranges = range(half * degree + 1), range(degree + 1), range(degree + 1)
        powers = [p for p in product(*ranges) if p[0] / half + p[1] + p[2] <= degree]
        powers += [(i, 0, 0) for i in range(half * degree + 1, half * self.axial + 1)]
        powers.sort(key=lambda p: (p[0] / half + p[1] + p[2], p[::-1]))
        if not self.equal:
            return [(p,) for p in powers]
        kept = [p for p in powers if p[1] >= p[2]]
        return [((i, j, k),) if j == k else ((i, j, k), (i, k, j)) for i, j, k in kept]

    def start(self, degree: int) -> np.ndarray:
        """Return the coefficients of b (1 - X)(1 - Y)(1 - Z) + extent X + tilt x, without XYZ."""
        b, x = self.b, 1 if self.equal else 2
        known = {(0, 0, 0): b, (x, 0, 0): self.extent - b, (0, 1, 0): -b, (0, 0, 1): -b}
        known |= {(x, 1, 0): b, (x, 0, 1): b, (0, 1, 1): b}
        if not self.equal:
            known[1, 0, 0] = self.tilt
        return np.array([known.get(orbit[0], 0.0) for orbit in self.orbits(degree)])

    def powers(self, degree: int, h: np.ndarray) -> np.ndarray:
        """Return what multiplies each coefficient in Psi and its gradient, (N, 4, n).

        Args:
            degree: Degree of the polynomial.
            h: Momenta, (N, 3).
        """
        base, slope = (h / self.extent) ** 2, 2.0 * h / self.extent**2
        if not self.equal:
            base[:, 0], slope[:, 0] = h[:, 0] / self.extent, 1.0 / self.extent
        orbits = self.orbits(degree)
        found = np.zeros((len(h), 4, len(orbits)))
        for n, orbit in enumerate(orbits):
            for p in orbit:
                factors = [base[:, a] ** p[a] for a in range(3)]
                found[:, 0, n] += factors[0] * factors[1] * factors[2]
                for a in range(3):
                    if p[a]:
                        lowered = p[a] * base[:, a] ** (p[a] - 1) * slope[:, a]
                        found[:, 1 + a, n] += lowered * factors[a - 2] * factors[a - 1]
        return found

    def terms(self, degree: int, coefficients: np.ndarray) -> tuple[Term, ...]:
        """Return rows (i, j, k, c) of coefficients."""
        pairs = zip(self.orbits(degree), coefficients, strict=True)
        return tuple((*p, float(c)) for orbit, c in pairs for p in orbit)

    def make(self, degree: int, coefficients: np.ndarray) -> Constraint:
        """Return the constraint with coefficients."""
        return create(self.constraint, terms=self.terms(degree, coefficients))


BOX90 = Family(
    layout="box90",
    constraint="box90-designed",
    counts=(2, 2),
    extent=2.0,
    b=float(4 * np.sqrt(6.0) / 3),
    envelope=1.905,
    levels={0.5: 1.0, 1.0: 1.0},
    published=("box90-cubic", "box90-spherical"),
)
ROOF6 = Family("roof6", "roof6", (3, 3), 3.0, 4.735, 2.9, {0.5: 1.0, 1.0: 1.0, 1.5: 1.0})
_LEVELS5 = {0.5: 1.0, 1.0: 1.0, 1.25: 0.5}
ROOF5 = Family("roof5", "roof5", (3, 2), 2.0, 3.65, 1.9, _LEVELS5, tilt=-0.76)
_FAMILIES = {family.layout: family for family in (BOX90, ROOF6, ROOF5)}


def family_of(layout: str) -> Family:
    """Return the family for a layout.

    Raises:
        InputError: For a layout without one.
    """
    if layout not in _FAMILIES:
        raise InputError("layout", layout, " or ".join(_FAMILIES))
    return _FAMILIES[layout]
