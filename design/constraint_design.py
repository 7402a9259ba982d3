"""The biases that are shipped, and what more coefficients would bring: guarantee/constraints/.

Run it (five minutes on one core): the coefficients of box90-designed, roof6 and roof5 as the
command `nullmotion design constraint` finds them (another machine's linear algebra may end in
the optimum beside it), then box-90 by degree of Psi and by degree along x alone. Radii and
volumes of the envelope, TC >= 0.5 and TC >= 1; by how much the least TC is above that of the
cubic and of the spherical bias at the worst |h| from 0.1 to 1.8:

    degree, coefficients   radii                   volumes              above
    cubic                  1.7904 1.3913 0.7438    49.99  40.03   3.13
    spherical              1.8347 1.4157 0.8047    33.44  21.54   6.12
    2 2  7                 1.9174 1.4698 0.7974    55.50  35.73   7.72  +0.0114 -0.0042
    2 3  8                 1.9312 1.4745 0.8058    55.87  43.41   6.06  +0.0130 +0.0002
    2 4  9                 1.9277 1.4763 0.8213    56.13  42.24   6.55  +0.0234 +0.0045
    3 3 13                 1.9257 1.4745 0.8059    54.02  43.47   5.25  +0.0134 +0.0003
    3 4 14                 1.9167 1.4765 0.8158    54.62  44.28   7.93  +0.0101 +0.0020
    4 4 22                 1.9177 1.4763 0.8160    55.13  44.09   8.12  +0.0160 +0.0035

What counts is the degree along x: X^3 and X^4 beside an even quadratic beat both published
biases everywhere, in radius, in volume and at every |h|; an even quadratic alone falls behind
the spherical one near |h| = 0.9. More coefficients move along the same front. The bounds for
any smooth Psi are 2, 1.487 and 0.876.
"""

from __future__ import annotations

import time
from dataclasses import replace

from nullmotion import guarantee
from nullmotion.guarantee.constraint import Constraint
from nullmotion.guarantee.design import Design, design, family_of, goal_of
from nullmotion.guarantee.design.outcome import advantage, rounded
from nullmotion.guarantee.radius import guaranteed_radius, volume

SHIPPED = ("box90", "roof6", "roof5")
DEGREES = ((2, 2), (2, 3), (2, 4), (3, 3), (3, 4), (4, 4))


def numbers(made: Constraint, levels: tuple[float, ...]) -> str:
    """Return radii and volumes for the envelope and each torque capability."""
    every = (0.0, *levels)
    radii = " ".join(f"{guaranteed_radius(made, t).value:6.4f}" for t in every)
    return radii + "   " + " ".join(f"{volume(made, t).value:6.2f}" for t in every)


def above(made: Constraint, names: tuple[str, ...]) -> str:
    """Return by how much the least TC is above that of others at |h| = 0.1 ... 1.8."""
    found = [advantage(made, guarantee.create(name), 0.1, 1.8) for name in names]
    return " ".join(f"{value:+.4f}" for value in found)


def shipped(layout: str) -> Design:
    """Return the design with the command's defaults."""
    family = family_of(layout)
    return design(family, goal_of(family))


def main() -> None:
    """Print coefficients and the table."""
    for layout in SHIPPED:
        begin = time.perf_counter()
        found = shipped(layout)
        made, known = rounded(found), guarantee.create(found.family.constraint)
        print(f"{known.name}, {time.perf_counter() - begin:.0f} s, as shipped: {made == known}")
        for row in getattr(made, "terms"):  # noqa: B009
            print("   ", row)
        print("   ", numbers(made, tuple(found.family.levels)), flush=True)
    family = family_of("box90")
    for name in family.published:
        print(f"{name:24s} {numbers(guarantee.create(name), (0.5, 1.0))}")
    for degree, axial in DEGREES:
        other = replace(family, axial=axial)
        made = rounded(design(other, goal_of(other), degree, starts=2))
        count = f"{degree} {axial} {len(other.orbits(degree)):2d}"
        row = f"{count:24s} {numbers(made, (0.5, 1.0))}   {above(made, family.published)}"
        print(row, flush=True)


if __name__ == "__main__":
    main()
