"""Which law, coast and angle make the smallest array of a layout."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from nullmotion import laws
from nullmotion.array import layouts
from nullmotion.sizing.curve import Curve, rates
from nullmotion.sizing.geometry import Geometry
from nullmotion.sizing.requirement import Requirement
from nullmotion.sizing.slews import failing, lattice, searched
from nullmotion.sizing.trial import Fleet, Trial

LAWS = ("sr", "local-gradient")  # that fly the smallest arrays: docs/sizing.md
COASTS = (0.4, 0.2, 0.0)
_RATES, _SHARE = 6, 3
_TOLERANCE, _CLOSER = 0.04, 0.01  # of momenta: between laws and coasts, between angles
_ANGLES, _CUTS = 6, 3
_GOLDEN = 0.5 * (3.0 - np.sqrt(5.0))
_PROBES = 12  # for each candidate, on the average
_TURN = 0.011  # between the lattices of two probes

Step = Callable[[float], None]


@dataclass(frozen=True)
class Choice:
    """The best candidate of a layout, and what was tried.

    Attributes:
        curve: The best.
        tried: Every candidate.
    """

    curve: Curve
    tried: tuple[Curve, ...]


def chosen(requirement: Requirement, layout: str, fleet: Fleet, step: Step) -> Choice:
    """Return the best candidate of a layout.

    A first law is flown over the range of the angle, then all laws and coasts at the best
    angle, then the best of them at angles nearby. At last the best is flown about more axes
    until it stays the best.

    Args:
        requirement: What has to be flown.
        layout: Name of the layout.
        fleet: Where flights are compiled.
        step: Called with the finished share.
    """
    names, given = law_names(requirement, layout), requirement.slew.coast_fraction
    pairs = [(law, coast) for law in names for coast in (COASTS if given is None else (given,))]
    geometry = Geometry(layout, _usual(requirement, layout), bool(requirement.failures))
    curves = [_curve(Trial(fleet, geometry, *pairs[0]), _TOLERANCE)]
    turning = geometry.skew is not None and requirement.skews[0] < requirement.skews[1]
    if geometry.held:
        turned = Trial(fleet, geometry.at(start="constraint"), *pairs[0])
        curves.append(_curve(turned, _TOLERANCE))
    if turning:
        curves += [_at(curves[0], skew, _TOLERANCE) for skew in _scan(requirement)]
    best = _best(curves).trial
    for i, (law, coast) in enumerate(pairs[1:]):
        curves.append(_curve(Trial(fleet, best.geometry, law, coast), _TOLERANCE))
        step(0.3 + 0.5 * i / len(pairs))
    if turning:
        curves += list(_cuts(_best(curves), requirement))
    step(0.9)
    _probe(curves, requirement)
    return Choice(_best(curves), tuple(curves))


def law_names(requirement: Requirement, layout: str) -> tuple[str, ...]:
    """Return the laws that are tried on a layout."""
    given = getattr(requirement.law, layout)
    names = LAWS if given is None else (given,) if isinstance(given, str) else given
    return tuple(laws.get(name).name for name in names)


def _usual(requirement: Requirement, layout: str) -> float | None:
    """Return the angle [rad] at which a layout is tried first; None if it has none."""
    default = getattr(layouts.get(layout)(), "skew", None)
    low, high = requirement.skews
    return None if default is None else float(np.clip(default, low, high))


def _best(curves: list[Curve]) -> Curve:
    return min(curves, key=lambda curve: curve.best)


def _curve(trial: Trial, tolerance: float) -> Curve:
    r = trial.requirement
    slews = searched(r, trial.geometry, _SHARE)
    return Curve(trial, slews, rates(r.gimbal_rates, _RATES), tolerance)


def _at(curve: Curve, skew: float, tolerance: float) -> Curve:
    """Return the same law and coast at another angle."""
    trial = curve.trial
    geometry = trial.geometry.at(skew)
    return _curve(Trial(trial.fleet, geometry, trial.law, trial.coast), tolerance)


def _scan(requirement: Requirement) -> list[float]:
    """Return angles in the middle of equal parts of the range."""
    low, high = requirement.skews
    return [low + (high - low) * (i + 0.5) / _ANGLES for i in range(_ANGLES)]


def _cuts(best: Curve, requirement: Requirement) -> Iterator[Curve]:
    """Yield curves at angles that close in on the best."""
    low, high = requirement.skews
    half = 0.5 * (high - low) / _ANGLES
    middle = float(best.trial.geometry.skew or 0.0)
    worth: dict[float, float] = {}
    for skew in (middle - half, middle, middle + half):
        if low <= skew <= high:
            curve = _at(best, skew, _CLOSER)
            worth[skew] = curve.best
            yield curve
    for _ in range(_CUTS):
        skew = _cut(worth)
        curve = _at(best, skew, _CLOSER)
        worth[skew] = curve.best
        yield curve


def _cut(worth: dict[float, float]) -> float:
    """Return an angle in the wider of the intervals beside the best."""
    angles = sorted(worth)
    i = min(range(len(angles)), key=lambda k: worth[angles[k]])
    sides = [angles[k] for k in (i - 1, i + 1) if 0 <= k < len(angles)]
    far = max(sides, key=lambda angle: abs(angle - angles[i]))
    return float(angles[i] + _GOLDEN * (far - angles[i]))


def _probe(curves: list[Curve], requirement: Requirement) -> None:
    """Fly the best at its knee about other axes, until the best one flies them all."""
    for i in range(_PROBES * len(curves)):
        best = _best(curves)
        if not np.isfinite(best.best):
            return
        slews = lattice(requirement, best.trial.geometry.whole.n, 0.2 + _TURN * i, _SHARE)
        bad = failing(best.trial, best.knee, slews)
        if not len(bad):
            return
        best.harden(bad)
