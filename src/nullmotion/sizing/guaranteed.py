"""The certified array beside a sampled design: its momentum, its proof, its flights."""

from __future__ import annotations

import numpy as np

from nullmotion.sizing import certified
from nullmotion.sizing.curve import Design
from nullmotion.sizing.geometry import Geometry
from nullmotion.sizing.polish import Polished, rounded_up
from nullmotion.sizing.requirement import Requirement
from nullmotion.sizing.result import Certified
from nullmotion.sizing.rows import degrees
from nullmotion.sizing.slews import failing, lattice
from nullmotion.sizing.trial import Trial

_LAW = "constraint"
_ANGLE = 0.25 * np.pi  # at which a roof's planes are at right angles: only there it has one
_TURN = 0.123


def guaranteed(found: Polished) -> Certified | str:
    """Return the certified array at a design's gimbal rate, or why there is none.

    A roof is turned to 45 deg, where it has a constraint function. With failures the constraint
    of what is left after each of them has to give the demand.
    """
    trial = found.trial
    r, geometry = trial.requirement, _with_constraint(trial.requirement, trial.geometry)
    if not geometry.held:
        left = " what is left after a failure" if r.failures else " this layout"
        return f"no constraint function holds{left}"
    known = {repr(held.constraint): held.constraint for held in geometry.held.values()}
    constraints = list(known.values())
    bound = certified.demand_bound(r, trial.profile)
    _, rate = r.held_back(1.0, found.design.rate)
    rates = np.array([rate])
    h0 = max(float(certified.momenta(c, bound, rates)[0]) for c in constraints)
    if not np.isfinite(h0):
        return f"the guarantee of {constraints[0].name} does not reach this demand"
    h0 = rounded_up(h0)
    wanted = certified.claims(bound, h0, rate)
    proofs = [proof for c in constraints for proof in certified.proofs(c, wanted)]
    size, limit = (float(v) for v in r.with_margins(h0, rate))
    made = Certified(
        h0_Nms=size,
        gimbal_rate_deg_s=round(float(np.degrees(limit)), 9),
        torque_Nm=size * limit,
        radius=wanted[-1].radius,
        torque_capability=wanted[-1].capability,
        constraint=" and ".join(c.name for c in constraints),
        certificates=proofs,
        proven=all(proof["proven"] for proof in proofs),
        skew_deg=degrees(geometry.skew),
    )
    held = Trial(trial.fleet, geometry, _LAW, trial.coast)
    if held.unsupported:
        held = Trial(trial.fleet, geometry, trial.law, trial.coast)
    slews = lattice(r, geometry.whole.n, _TURN)
    made.law, made.flights = held.law, len(slews)
    made.flown = len(failing(held, Design(size, limit), slews)) == 0
    return made


def _with_constraint(r: Requirement, geometry: Geometry) -> Geometry:
    """Return the array at an angle at which it has a constraint function, if the range has it."""
    low, high = r.skews
    if not geometry.held and geometry.skew is not None and low <= _ANGLE <= high:
        return geometry.at(_ANGLE)
    return geometry
