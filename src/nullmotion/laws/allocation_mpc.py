"""Convex allocation over a horizon: torque, effort, smoothness and distance to singularity."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from nullmotion import qp
from nullmotion.allocation import checks
from nullmotion.allocation.compiled import evaluate
from nullmotion.allocation.exclusion import Exclusion, exclusion
from nullmotion.allocation.fallback import Memory, fall_back, solver
from nullmotion.allocation.limits import Limits
from nullmotion.allocation.problem import Weights, problem
from nullmotion.array.model import CmgArray
from nullmotion.law import Claim, Law, Observation, check_parameters


@dataclass(frozen=True)
class AllocationMpc(Law):
    """One convex quadratic program a sample over N_p moves; the first is made.

        minimise  sum_tau 1/2 |hdot_tau - hdot_c,tau|_H^2 + 1/2 |x_tau|_U^2
                  + 1/2 |x_tau - x_tau-1|_M^2 + 1/2 rho max(eta_tau+1, 0)^2
        hdot_tau = J x_tau + A (gamma_tau - gamma_phi,tau),   gamma_tau+1 = gamma_tau + T x_tau
        |x_i| <= rate limit,  |x_i,tau - x_i,tau-1| <= T acceleration limit,  angles in theirs
        eta_tau+1 = kappa (kappa - n . (gamma_tau+1 - gamma_s))

    x_tau are the gimbal rates of a move. J and A are taken along the moves planned at the
    sample before, the plane (kappa, n, gamma_s) is that of the singular configuration nearest
    now; each sample is thus one Gauss-Newton step. hdot is divided by the mean momentum, so
    that H does not depend on the array's size. The nearest singular configuration is exact
    for arrays with parallel gimbal axes and searched on any other, where one fixed plane is a
    poor picture of a curved set: `receding-horizon` is meant for those.

    Without a solution in time the moves planned before are made, and when they are used up
    the pseudo-inverse's within the limits; both are counted.

    Args:
        N_p: Number of moves. The paper's sum from k to k + N_p would be one more.
        H: Weight of the torque error over the mean momentum [s^2], one or one for each dimension.
        U: Weight of the rates [s^2], one or one for each CMG.
        M: Weight of their changes [s^2], likewise.
        rho: Weight of what the distance lacks [rad^-4]; 0 leaves the term out.
        kappa: Distance to singularity that is asked for [rad]; the triangle's is below 1.28.
        acceleration_limit_rad_s2: Largest gimbal acceleration [rad/s^2]; None for no limit.
        midpoint: Linearise at the middle of each move: the mean torque of the sample is then
            matched, not the torque at its start.
        solver: Name of the QP solver.
        time_limit_s: Time for a solution [s]; None for no limit.
    """

    name: ClassVar[str] = "allocation-mpc"
    full_name: ClassVar[str] = "Convex allocation over a horizon"
    citation: ClassVar[str] = "Pereira (2022), Eqs 42-44"
    claims: ClassVar[frozenset[Claim]] = frozenset({Claim.FINITE, Claim.SCALING, Claim.TIMELESS})
    information: ClassVar[tuple[str, ...]] = ("delta_dot", "preview")
    traceable: ClassVar[bool] = False

    N_p: int = 5
    H: float | tuple[float, ...] = 100.0
    U: float | tuple[float, ...] = 1e-3
    M: float | tuple[float, ...] = 1e-3
    rho: float = 1000.0
    kappa: float = 0.5
    acceleration_limit_rad_s2: float | None = None
    midpoint: bool = False
    solver: str = "daqp"
    time_limit_s: float | None = None

    def __post_init__(self) -> None:
        """Check the parameters."""
        limits = ("acceleration_limit_rad_s2", "time_limit_s")
        check_parameters(self, ("H", "U", "kappa", *limits), ("M", "rho"))
        checks.whole("N_p", self.N_p)
        checks.solver(self.solver)

    def supports(self, array: CmgArray) -> str:
        """Ask for a null space, and for weights of the array's size."""
        return checks.refusal(array, {"H": array.m, "U": array.n, "M": array.n}, self)

    @property
    def preview_samples(self) -> int:
        """How many samples of hdot it looks at."""
        return self.N_p

    def init(self, array: CmgArray, delta: Any) -> Memory:
        """Return the memory before the first sample."""
        return Memory.empty(array.n, self.N_p)

    def counts(self, state: Memory) -> Mapping[str, int]:
        """Return how often each fall-back was taken."""
        return state.counts()

    @property
    def _weights(self) -> Weights:
        return Weights(self.U, self.M, self.rho, self.kappa)

    def program(
        self, array: CmgArray, obs: Observation, state: Memory
    ) -> tuple[qp.Problem, Exclusion, Limits, Any]:
        """Return the sample's program, the exclusion, the limits and the rates until now."""
        before = state.rates if obs.delta_dot is None else obs.delta_dot
        wanted = checks.wanted(obs, self.N_p)
        torque, line = evaluate(
            array, obs.delta, state.plan, wanted, self.H, obs.period, self.midpoint
        )
        keep_off = Exclusion(np.inf, state.normal)
        if self.rho > 0:
            keep_off = exclusion(array, obs.delta, state.normal, line)
        limits = Limits.of(array, self.acceleration_limit_rad_s2, obs.period)
        rest = before, np.asarray(obs.delta, float), obs.period
        made = problem(torque, self._weights, limits, keep_off if self.rho > 0 else None, *rest)
        return made, keep_off, limits, before

    def step(self, array: CmgArray, obs: Observation, state: Any) -> tuple[Any, Any]:
        """Return the first of the moves that solve the program."""
        made, keep_off, limits, before = self.program(array, obs, state)
        found = solver(self.solver, self.time_limit_s).solve(made)
        if not found.solved:
            return fall_back(array, obs, state, before, limits, keep_off.normal)
        moves = found.x[: self.N_p * array.n].reshape(self.N_p, array.n)
        return moves[0], state.solved(moves, keep_off.normal)
