"""What a designed bias is worth, beside the published ones."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from nullmotion.guarantee import create
from nullmotion.guarantee.constraint import Constraint
from nullmotion.guarantee.design.solve import Design
from nullmotion.guarantee.radius import Volume, guaranteed_radius, least_capabilities, volume
from nullmotion.guarantee.singular import nearest_singular

_POINTS = 2**18  # for a volume
_DIGITS = 8
_SIZES = (0.2, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95)  # of the extent

# Psi and its gradient chosen freely at every momentum bound the least TC of every smooth Psi
BOUNDS = {
    "box90": {0.4: 1.256, 0.8: 1.050, 1.0: 0.911, 1.2: 0.752, 1.4: 0.579, 1.6: 0.393, 1.8: 0.199}
}


@dataclass(frozen=True)
class Outcome:
    """What one constraint guarantees.

    Attributes:
        name: What it is called.
        radii: Radius for each torque capability; 0 for the envelope.
        volumes: Volume for each.
        singular: Least |h| at which a plane has no momentum to hold; None if there is none.
        least: Least TC at each size of momentum.
    """

    name: str
    radii: dict[float, float]
    volumes: dict[float, Volume]
    singular: float | None
    least: dict[float, float]


def rounded(design: Design) -> Constraint:
    """Return the constraint with coefficients of eight digits."""
    text = [f"{c:.{_DIGITS}g}" for c in design.coefficients]
    return design.family.make(design.degree, np.array(text, float))


def compare(design: Design) -> list[Outcome]:
    """Return what the design guarantees, then what it is compared with."""
    family = design.family
    others = {name: create(name) for name in family.published}
    if not others:
        others = {"start": family.make(design.degree, family.start(design.degree))}
    everything = {"designed": rounded(design), **others}
    sizes = tuple(BOUNDS.get(family.layout, [round(s * family.extent, 6) for s in _SIZES]))
    return [_outcome(name, c, tuple(family.levels), sizes) for name, c in everything.items()]


def advantage(constraint: Constraint, other: Constraint, first: float, last: float) -> float:
    """Return by how much the least TC is greater, at the worst |h| of a range, in steps of 0.01."""
    sizes = np.linspace(first, last, round((last - first) / 0.01) + 1)
    found = least_capabilities(constraint, sizes) - least_capabilities(other, sizes)
    return float(found.min())


def record(design: Design, outcomes: list[Outcome]) -> dict[str, Any]:
    """Return all of it as a mapping for JSON."""
    made = rounded(design)
    return {
        "format": "nullmotion constraint 1",
        "constraint": made.name,
        "parameters": {"terms": [list(term) for term in getattr(made, "terms")]},  # noqa: B009
        "objective": design.goal.name,
        "degree": design.degree,
        "interrupted": design.interrupted,
        "missed": design.missed,
        "units": {"torque_capability": "h0 x rate limit", "radius": "h0", "volume": "h0^3"},
        "outcomes": [_plain(outcome) for outcome in outcomes],
    }


def _outcome(
    name: str, constraint: Constraint, levels: tuple[float, ...], sizes: tuple[float, ...]
) -> Outcome:
    every = (0.0, *levels)
    point = nearest_singular(constraint)
    least = least_capabilities(constraint, np.array(sizes))
    return Outcome(
        name,
        {t: guaranteed_radius(constraint, t).value for t in every},
        {t: volume(constraint, t, points=_POINTS) for t in every},
        None if point is None else float(np.linalg.norm(point)),
        dict(zip(sizes, map(float, least), strict=True)),
    )


def _plain(outcome: Outcome) -> dict[str, Any]:
    return {
        "name": outcome.name,
        "radii": [{"torque_capability": t, "radius": r} for t, r in outcome.radii.items()],
        "volumes": [
            {"torque_capability": t, "volume": v.value, "standard_error": v.standard_error}
            for t, v in outcome.volumes.items()
        ],
        "nearest_singularity": outcome.singular,
        "least": [{"momentum": h, "torque_capability": t} for h, t in outcome.least.items()],
    }
