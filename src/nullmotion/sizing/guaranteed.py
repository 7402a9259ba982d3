"""The certified array beside a sampled design: its momentum, its proof, its flights."""

from __future__ import annotations

import numpy as np

from nullmotion.errors import NullmotionError
from nullmotion.sizing import certified
from nullmotion.sizing.curve import Design
from nullmotion.sizing.held import Held
from nullmotion.sizing.polish import Polished, rounded_up
from nullmotion.sizing.result import Certified
from nullmotion.sizing.rows import degrees
from nullmotion.sizing.slews import failing, lattice
from nullmotion.sizing.trial import Trial

_LAW = "constraint"
_ANGLE = 0.25 * np.pi  # at which a roof's planes are at right angles: only there it has one
_TURN = 0.123


def guaranteed(found: Polished) -> Certified | str:
    """Return the certified array at a design's gimbal rate, or why there is none.

    A roof is turned to 45 deg, where it has a constraint function.
    """
    trial = found.trial
    r, geometry = trial.requirement, trial.geometry
    if r.failures:
        return "no constraint function holds what is left after a failure"
    if geometry.held is None and geometry.skew is not None:
        low, high = r.skews
        if low <= _ANGLE <= high:
            geometry = geometry.at(_ANGLE)
    function = geometry.held
    if not isinstance(function, Held):
        return "no constraint function holds this layout"
    constraint, bound = function.constraint, certified.demand_bound(r, trial.profile)
    _, rate = r.held_back(1.0, found.design.rate)
    h0 = float(certified.momenta(constraint, bound, np.array([rate]))[0])
    if not np.isfinite(h0):
        return f"the guarantee of {constraint.name} does not reach this demand at any momentum"
    h0 = rounded_up(h0)
    wanted = certified.claims(bound, h0, rate)
    certificates = certified.proofs(constraint, wanted)
    size, limit = (float(v) for v in r.with_margins(h0, rate))
    made = Certified(
        h0_Nms=size,
        gimbal_rate_deg_s=round(float(np.degrees(limit)), 9),
        torque_Nm=size * limit,
        radius=wanted[-1].radius,
        torque_capability=min(claim.capability for claim in wanted),
        constraint=constraint.name,
        certificates=certificates,
        proven=all(record["proven"] for record in certificates),
        skew_deg=degrees(geometry.skew),
    )
    _fly(
        made,
        Trial(trial.fleet, geometry.at(start="constraint"), _LAW, trial.coast),
        Design(size, limit),
    )
    return made


def _fly(made: Certified, trial: Trial, design: Design) -> None:
    """Fly the certified array under the law that keeps to the constraint."""
    r = trial.requirement
    slews = lattice(r, trial.geometry.whole.n, _TURN)
    try:
        made.flown = len(failing(trial, design, slews)) == 0
        made.flights = len(slews)
    except NullmotionError:
        made.flown = False
