"""From the knee of a curve to the design: as small as flies, in momentum and in rate.

The design flies every slew that was looked at. Slews that it does not fly, about axes of ever
new lattices and near the axes that fail first, are taken into the search until none is found.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from nullmotion.sizing import boundary
from nullmotion.sizing.cases import Cases
from nullmotion.sizing.curve import Curve, Design
from nullmotion.sizing.slews import failing, lattice, nearby
from nullmotion.sizing.trial import Trial

SMALLER = 0.95
LARGER = ((1.04, 1.0), (1.0, 1.04), (1.08, 1.08))
REDUCTIONS = {"h0": (SMALLER, 1.0), "gimbal_rate": (1.0, SMALLER), "both": (SMALLER, SMALLER)}
FINE = 4  # integration steps in a law period of the last check
_TOLERANCE = 0.003
_SETTLED = 0.004  # change of momentum or rate below which both are least
_ROUNDS, _TURNS, _STEP = 16, 4, 1.03
_HARDER = 0.985  # share of a design at which the slews that fail first show
_WORST, _NEAR = 12, 25  # slews whose neighbours are flown, and how many neighbours each
_BEYOND = 1.12  # where the search goes on if a design was lucky
_GOLDEN = 0.6180339887


@dataclass
class Polished:
    """A design and what was flown for it.

    Attributes:
        trial: Layout, angle, law, coast.
        design: Momentum and rate.
        slews: Those of the search, the hard ones among them.
        checked: Slews of the last check, about other axes.
        flown: Whether the design flies all of both, with finer steps too.
        smaller: Whether it flies them with h0, gimbal rate or both 5 % smaller.
        worst: The slew that most of the smaller designs do not fly.
    """

    trial: Trial
    design: Design
    slews: Cases
    checked: Cases
    flown: bool = False
    smaller: dict[str, bool] = field(default_factory=dict)
    worst: Cases | None = None


def polished(curve: Curve, step: Callable[[float], None]) -> Polished:
    """Return the design at the knee of a curve.

    Args:
        curve: Momenta over rates.
        step: Called with the finished share.
    """
    trial, generator = curve.trial, np.random.default_rng(0)
    found = Polished(trial, curve.knee, curve.cases, curve.cases)
    for i in range(_ROUNDS):
        found.flown, found.design = False, _least(found)
        if not np.isfinite(found.design.h0):
            break
        bad = _counterexamples(found, i, generator)
        step(1.0 - 1.0 / (i + 2))
        if len(bad):
            found.slews = found.slews.joined(bad)
            continue
        other = _lucky(found) or _reduced(found)
        if other is None:
            found.flown = True
            break
        found.design = other
    return found


def _least(found: Polished) -> Design:
    """Return the least momentum at the design's rate, then the least rate at it, and so on."""
    trial, (h0, rate) = found.trial, found.design
    lowest = trial.requirement.gimbal_rates[0]

    def of_momentum(values: np.ndarray, _: np.ndarray) -> np.ndarray:
        return trial.flies(found.slews, values, np.full(len(values), rate))

    def of_rate(values: np.ndarray, _: np.ndarray) -> np.ndarray:
        return trial.flies(found.slews, np.full(len(values), h0), values)

    for _ in range(_TURNS):
        before = h0, rate
        h0 = float(boundary.least(of_momentum, np.array([h0]), _STEP, _TOLERANCE)[0])
        if np.isfinite(h0) and rate > lowest:
            rate = float(boundary.least(of_rate, np.array([rate]), _STEP, _TOLERANCE, lowest)[0])
        if max(before[0] / h0, before[1] / rate) < 1.0 + _SETTLED:
            break
    if not np.isfinite(h0):
        return Design(h0, rate)
    return Design(rounded_up(h0), float(np.radians(rounded_up(float(np.degrees(rate))))))


def rounded_up(value: float) -> float:
    """Return a number of four digits that is not smaller, rounding apart."""
    unit = 10.0 ** (np.floor(np.log10(value)) - 3)
    return float(f"{np.ceil(value / unit - 1e-6) * unit:.4g}")


def _counterexamples(found: Polished, i: int, generator: np.random.Generator) -> Cases:
    """Return slews that the design does not fly: of a new lattice, and near the hardest."""
    trial, design = found.trial, found.design
    r, n = trial.requirement, trial.geometry.whole.n
    smaller = Design(_HARDER * design.h0, _HARDER * design.rate)
    hardest = failing(trial, smaller, found.slews)
    hardest = hardest.picked(generator.permutation(len(hardest))[:_WORST])
    bad = failing(trial, design, nearby(r, hardest, _NEAR, generator))
    fresh = lattice(r, n, (0.37 + _GOLDEN * i) % 1.0)
    bad = bad.joined(failing(trial, design, fresh))
    if len(bad):
        return bad
    found.checked = lattice(r, n, (0.71 + _GOLDEN * i) % 1.0)
    return failing(trial, design, found.checked.joined(found.slews), FINE)


def _lucky(found: Polished) -> Design | None:
    """Return a larger design to go on from if the design flies where larger ones do not."""
    trial, (h0, rate) = found.trial, found.design
    factors = np.array(LARGER)
    good = trial.flies(found.slews, h0 * factors[:, 0], rate * factors[:, 1])
    return None if good.all() else Design(_BEYOND * h0, _BEYOND * rate)


def _reduced(found: Polished) -> Design | None:
    """Fly the smaller designs; return one that flies though none should, if there is one."""
    trial, (h0, rate) = found.trial, found.design
    slews = found.slews.joined(found.checked)
    factors = np.array(list(REDUCTIONS.values()))
    late = trial.settled(slews, h0 * factors[:, 0], rate * factors[:, 1])
    bad = late > trial.requirement.time  # by a sample at least: not settled at that time
    flies = [not row.any() for row in bad]
    found.smaller = dict(zip(REDUCTIONS, flies, strict=True))
    found.worst = slews.picked(np.array([int(np.argmax(bad.sum(axis=0)))]))
    bound = rate <= trial.requirement.gimbal_rates[0] * (1.0 + _TOLERANCE)
    for good, (a, b) in zip(flies, factors.tolist(), strict=True):
        if good and not (bound and b < 1.0):
            return Design(a * h0, b * rate)
    return None
