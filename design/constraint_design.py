"""The biases that are shipped, and what more coefficients would bring: guarantee/constraints/.

Run it (TIME): the coefficients of box90-designed, roof6 and roof5 as the command
`nullmotion design constraint` finds them, then box-90 by degree of Psi and by degree along x.

TABLE
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
