"""The design of one layout: the knee of the best candidate, polished."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from nullmotion.sizing.cases import NONE_FAILED
from nullmotion.sizing.choose import Choice
from nullmotion.sizing.curve import Curve, rates
from nullmotion.sizing.polish import Polished, polished
from nullmotion.sizing.slews import failing, searched
from nullmotion.sizing.trial import Trial

_RATES, _TOLERANCE = 14, 0.01
_ATTEMPTS = 4
_CLOSE = 1.02  # worth over that of another candidate up to which a design is kept
_HUGE = 10.0  # momentum over a usual design's, to see why no array flies


@dataclass(frozen=True)
class Designed:
    """A design and the curve on which it lies."""

    polished: Polished
    curve: Curve

    @property
    def worth(self) -> float:
        """h0^weight times rate."""
        design = self.polished.design
        weight = self.curve.trial.requirement.array.momentum_weight
        return float(design.h0**weight * design.rate)


def designed(choice: Choice, step: Callable[[float], None]) -> Designed | None:
    """Return the design of least worth that flies; None if there is none.

    Args:
        choice: Candidates with their coarse curves.
        step: Called with the finished share.
    """
    waiting, done = list(choice.tried), list[Designed]()
    for _ in range(_ATTEMPTS):
        coarse = min(waiting, key=lambda curve: curve.best)
        if not np.isfinite(coarse.best):
            break
        waiting.remove(coarse)
        found = _designed(coarse, step)
        if found.polished.flown:
            done.append(found)
        left = min((curve.best for curve in waiting), default=np.inf)
        if done and min(d.worth for d in done) <= _CLOSE * left:
            break
    return min(done, key=lambda d: d.worth) if done else None


def why_not(choice: Choice) -> str:
    """Return why no array of a layout flies."""
    first = choice.tried[0]
    trial: Trial = first.trial
    if trial.geometry.reason or trial.unsupported:
        return trial.geometry.reason or trial.unsupported
    known = first.h0[np.isfinite(first.h0)]
    h0 = float(known.max()) if len(known) else _HUGE * first.guess().max()
    bad = failing(trial, first.knee._replace(h0=h0, rate=float(first.rates[-1])), first.cases)
    if not len(bad):
        return "no design was found whose larger arrays fly as well"
    axis = ", ".join(f"{v:.2f}" for v in bad.axis[0])
    lost = "" if bad.failed[0] == NONE_FAILED else f" without CMG {int(bad.failed[0]) + 1}"
    return (
        f"{len(bad)} of {len(first.cases)} slews do not settle in time even with {h0:.4g} N m s "
        f"at {np.degrees(first.rates[-1]):.4g} deg/s, such as about ({axis}){lost}"
    )


def _designed(coarse: Curve, step: Callable[[float], None]) -> Designed:
    trial = coarse.trial
    r = trial.requirement
    curve = Curve(trial, searched(r, trial.geometry), rates(r.gimbal_rates, _RATES), _TOLERANCE)
    curve.harden(coarse.cases)
    step(0.4)
    return Designed(polished(curve, lambda share: step(0.4 + 0.6 * share)), curve)
