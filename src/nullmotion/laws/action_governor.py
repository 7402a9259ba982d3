"""Action governor: the pseudo-inverse's rates, changed as little as keeps off singularities."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from nullmotion import qp
from nullmotion.allocation import checks
from nullmotion.allocation.blocks import Blocks
from nullmotion.allocation.exclusion import exclusion
from nullmotion.allocation.fallback import Memory, fall_back, least, solver
from nullmotion.allocation.limits import Limits
from nullmotion.allocation.problem import Weights, problem
from nullmotion.array.model import CmgArray
from nullmotion.law import Claim, Law, Observation, check_parameters


@dataclass(frozen=True)
class ActionGovernor(Law):
    """The rates nearest to the pseudo-inverse's that give the torque and keep away.

        minimise  1/2 |x - x_0|_S^2 + 1/2 rho max(eta, 0)^2,      x_0 = A^+ hdot
        subject to A x = hdot,  |x_i| <= rate limit,  |x_i - x_i before| <= T acceleration limit,
                   angles in theirs,  eta = kappa (kappa - n . (gamma + T x - gamma_s))

    gamma_s is the singular configuration nearest now, n the direction away from it: exact for
    arrays with parallel gimbal axes, searched on any other. Where no rates within the limits
    give the torque, it is the pseudo-inverse within the limits, by the array's
    ``rate_limit_mode`` (the paper's Eq 35 is "scale"); this is counted.

    Args:
        S: Weight of the change [s^2], one or one for each CMG.
        rho: Weight of what the distance lacks [rad^-4].
        kappa: Distance to singularity that is asked for [rad]; the triangle's is below 1.28.
        acceleration_limit_rad_s2: Largest gimbal acceleration [rad/s^2]; None for no limit.
        solver: Name of the QP solver.
        time_limit_s: Time for a solution [s]; None for no limit.
    """

    name: ClassVar[str] = "action-governor"
    full_name: ClassVar[str] = "Action governor"
    citation: ClassVar[str] = "Pereira (2022), Eqs 30-40"
    claims: ClassVar[frozenset[Claim]] = frozenset({Claim.FINITE, Claim.SCALING, Claim.TIMELESS})
    information: ClassVar[tuple[str, ...]] = ("delta_dot",)
    traceable: ClassVar[bool] = False

    S: float | tuple[float, ...] = 1.0
    rho: float = 1000.0
    kappa: float = 0.5
    acceleration_limit_rad_s2: float | None = None
    solver: str = "daqp"
    time_limit_s: float | None = None

    def __post_init__(self) -> None:
        """Check the parameters."""
        limits = ("acceleration_limit_rad_s2", "time_limit_s")
        check_parameters(self, ("S", "rho", "kappa", *limits))
        checks.solver(self.solver)

    def supports(self, array: CmgArray) -> str:
        """Ask for a null space, and for weights of the array's size."""
        return checks.refusal(array, {"S": array.n}, self)

    def init(self, array: CmgArray, delta: Any) -> Memory:
        """Return the memory before the first sample."""
        return Memory.empty(array.n, 1)

    def counts(self, state: Memory) -> Mapping[str, int]:
        """Return how often each fall-back was taken."""
        return state.counts()

    def step(self, array: CmgArray, obs: Observation, state: Any) -> tuple[Any, Any]:
        """Return the governed rates."""
        before = state.rates if obs.delta_dot is None else obs.delta_dot
        limits = Limits.of(array, self.acceleration_limit_rad_s2, obs.period)
        keep_off = exclusion(array, obs.delta, state.normal)
        n, S = array.n, np.resize(self.S, array.n)
        pull = Blocks(np.diag(S)[None], np.zeros((1, n, n)), -(S * least(array, obs))[None])
        weights = Weights(0.0, 0.0, self.rho, self.kappa)
        rest = before, np.asarray(obs.delta, float), obs.period
        soft = problem(pull, weights, limits, keep_off, *rest)
        found = solver(self.solver, self.time_limit_s).solve(_exact(soft, array, obs))
        if not found.solved:
            return fall_back(array, obs, state, before, limits, keep_off.normal)
        return found.x[:n], state.solved(found.x[None, :n], keep_off.normal)


def _exact(soft: qp.Problem, array: CmgArray, obs: Observation) -> qp.Problem:
    """Return the program with A x = hdot."""
    A = np.zeros((array.m, soft.variables))
    A[:, : array.n] = array.unit_jacobian(obs.delta)
    hdot = obs.hdot / array.mean_momentum
    lower, upper = (np.concatenate([bound, hdot]) for bound in (soft.lower, soft.upper))
    rows = np.concatenate([soft.A, A])
    return qp.Problem(soft.H, soft.g, rows, lower, upper, soft.x_lower, soft.x_upper)
