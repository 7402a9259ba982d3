"""What a constraint guarantees, in rows: found by search, then proven."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from nullmotion.errors import InputError
from nullmotion.guarantee import radius as search
from nullmotion.guarantee.certificate import Certificate, certify
from nullmotion.guarantee.constraint import Constraint

LEVELS = (0.25, 0.5, 0.75, 1.0, 1.25, 1.5, 2.0, 3.0)
_STEPS = (0.001, 0.003, 0.01, 0.03)  # shares that a proof may stay below the search


class Guarantee(NamedTuple):
    """One row: within a radius, a torque capability in every direction.

    Attributes:
        torque_capability: TC, divided by one CMG's momentum and rate limit; 0 for the envelope.
        radius: Largest |h| up to which it holds, by search, in units of one CMG's momentum.
        momentum: Where it is lost just beyond.
        certificate: Proof for a radius slightly below; None where there is none.
    """

    torque_capability: float
    radius: float
    momentum: tuple[float, ...]
    certificate: Certificate | None


def table(
    constraint: Constraint,
    levels: Sequence[float] = LEVELS,
    progress: Callable[[float], None] | None = None,
) -> list[Guarantee]:
    """Return the envelope and the radius for each torque capability, with certificates.

    Levels above the torque capability at no momentum are left out.
    """
    home = constraint.torque_capability(np.zeros(constraint.m))
    wanted = [t for t in sorted(levels) if t < home * (1 - 1e-6)]
    rows = [_row(constraint, 0.0, None)]
    for i, t in enumerate(wanted):
        report = None if progress is None else _part(progress, i, len(wanted))
        rows.append(_row(constraint, t, report))
    return rows


def largest_radius(constraint: Constraint, torque_capability: float) -> search.Radius:
    """Return the radius of the largest ball in which TC holds, by search.

    Raises:
        InputError: For a TC that there is not even without momentum.
    """
    home = float(constraint.torque_capability(np.zeros(constraint.m)))
    if not 0 < torque_capability < home:
        allowed = f"above 0 and below {home:.6g}, what there is without momentum"
        raise InputError("torque_capability", torque_capability, allowed)
    return search.guaranteed_radius(constraint, torque_capability)


def prove_radius(
    constraint: Constraint, torque_capability: float, found: float,
    progress: Callable[[float], None] | None = None,
) -> Certificate:  # fmt: skip
    """Return a certificate for a radius just below the one that search found."""
    for share in _STEPS:
        size = _down(found * (1 - share))
        certificate = certify(constraint, size, torque_capability, progress)
        if certificate.proven or certificate.reason == "interrupted":
            break
    return certificate


def prove_capability(
    constraint: Constraint, radius: float, progress: Callable[[float], None] | None = None
) -> Certificate:
    """Return a certificate for the greatest TC that search finds to hold inside a radius.

    Raises:
        InputError: For a radius that is not inside the envelope.
    """
    envelope = search.guaranteed_radius(constraint, 0.0).value
    if not 0 < radius < envelope:
        allowed = f"above 0 and below {envelope:.6g}, the radius of the envelope"
        raise InputError("radius", radius, allowed)
    sizes = np.linspace(0, radius, 33)[1:]
    least = min(search.least_capability(constraint, float(r)) for r in sizes)
    for share in _STEPS:
        certificate = certify(constraint, radius, _down(least * (1 - share)), progress)
        if certificate.proven or certificate.reason == "interrupted":
            break
    return certificate


def _row(
    constraint: Constraint, level: float, progress: Callable[[float], None] | None
) -> Guarantee:
    found = search.guaranteed_radius(constraint, level)
    proof = prove_radius(constraint, level, found.value, progress) if level else None
    return Guarantee(level, found.value, tuple(map(float, found.momentum)), proof)


def _down(value: float) -> float:
    """Return a value rounded down to four digits behind the point."""
    return float(np.floor(value * 1e4) / 1e4)


def _part(progress: Callable[[float], None], i: int, count: int) -> Callable[[float], None]:
    return lambda share: progress((i + share) / count)
