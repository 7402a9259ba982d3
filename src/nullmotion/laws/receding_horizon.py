"""Receding horizon: null motion planned ahead along the momentum that is about to be asked."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar, NamedTuple

import numpy as np

from nullmotion import qp
from nullmotion.array.model import CmgArray
from nullmotion.errors import InputError
from nullmotion.law import Claim, Law, Observation, check_parameters
from nullmotion.lookahead import path
from nullmotion.lookahead.planner import Planner, Task, Weights, planner
from nullmotion.lookahead.search import Plan, Search, planned, shifted, within

_ASKED = 1e-9  # rad; a command that turns the gimbals less in a sample is none
_FULL = 0.995  # share of the torque below which it is beyond authority, not rounded off
_LONGEST = 10.0  # rad; rate limits of a step count up to here
_COUNTED = ("unsolved-program", "fall-back", "beyond-rate-authority")


class Carried(NamedTuple):
    """What is carried from sample to sample.

    Attributes:
        plan: The last plan; None without one.
        queue: Rates that are on their way, the oldest first.
        tally: Counts so far, in the order of `_COUNTED`.
    """

    plan: Plan | None = None
    queue: tuple[Any, ...] = ()
    tally: tuple[int, ...] = (0, 0, 0)


@dataclass(frozen=True)
class RecedingHorizon(Law):
    """Rates of the first step of a plan that keeps sigma_min up along the path ahead.

    The path is the momentum that the command will ask for: N knots at geometrically growing
    distances up to ``horizon``, for torque held as it is or previewed, no further than the
    momentum envelope. A plan is a configuration for each knot. Two SQP iterations a
    sample improve the plan of the sample before (`nullmotion.lookahead.program`):

        minimise  sum_k  w/2 |x_k|^2 / d_k  +  rho/2 d_k max(sigma_ref - sigma_min,k, 0)^2

    over the null motion at the knots, within the rate limits; x_k is a move and d_k its
    distance in momentum. The first knot is one sample ahead and met exactly: the momentum
    changes by period x hdot over the sample. New plans, with null motion to either side,
    are looked for where sigma_min of the plan is low, for a plan does not change side.

    What goes wrong is counted: a program that is not solved within its iterations (the
    plan is followed as it is; without one, the pseudo-inverse), and torque beyond rate
    authority, which is given in its direction as far as the rates go (from
    rmax h0 / |hdot| about 2 up there is none).

    Args:
        horizon: Momentum to look ahead, in mean momenta.
        steps: Number of knots N.
        sigma_ref: Singular value above which nothing is gained.
        rho: Price of sigma_min below it.
        effort: Price w of moving.
        iterations: SQP iterations a sample.
        renew_below: Least sigma_min of a plan below which others are looked for.
        renew_every: Samples between two such searches.
        samples: Samples of ``preview`` to read; 0: torque is held as it is.
        lead_s: Time until rates act, which the law allows for [s].
        solver: Name of the solver.
        iteration_limit: Most iterations of the solver.
    """

    name: ClassVar[str] = "receding-horizon"
    full_name: ClassVar[str] = "Receding-horizon null motion"
    aliases: ClassVar[tuple[str, ...]] = ("rhc", "look-ahead")
    citation: ClassVar[str] = "Pereira et al. (2022), Sec. 5.3, carried over to any array"
    claims: ClassVar[frozenset[Claim]] = frozenset({Claim.FINITE, Claim.BOUNDED, Claim.TIMELESS})
    information: ClassVar[tuple[str, ...]] = ("preview",)
    traceable: ClassVar[bool] = False

    horizon: float = 1.8
    steps: int = 15
    sigma_ref: float = 0.6
    rho: float = 60.0
    effort: float = 1.0
    iterations: int = 2
    renew_below: float = 0.3
    renew_every: int = 5
    samples: int = 0
    lead_s: float = 0.0
    solver: str = "daqp"
    iteration_limit: int = 500

    def __post_init__(self) -> None:
        """Check the parameters."""
        positive = ("horizon", "sigma_ref", "rho", "effort")
        check_parameters(self, positive, ("renew_below", "lead_s"))
        for key, least in (
            ("steps", 3), ("iterations", 1), ("renew_every", 1), ("samples", 0),
            ("iteration_limit", 1),
        ):  # fmt: skip
            value = getattr(self, key)
            if not isinstance(value, int) or isinstance(value, bool) or value < least:
                raise InputError(f"law.{key}", value, f"a whole number from {least}")

    @property
    def information_used(self) -> tuple[str, ...]:
        """The preview, where it reads any of it."""
        return self.information if self.samples else ()

    @property
    def preview_samples(self) -> int:
        """How many samples of the command it looks at."""
        return self.samples

    def supports(self, array: CmgArray) -> str:
        """Ask for null motion."""
        if array.n > array.m:
            return ""
        return f"{array.n} CMGs leave no null motion beside {array.m} torque dimensions"

    def init(self, array: CmgArray, delta: Any) -> Carried:
        """Return a state without a plan."""
        return Carried()

    def counts(self, state: Carried) -> Mapping[str, int]:
        """Return what went wrong, in samples (programs for the first)."""
        return dict(zip(_COUNTED, state.tally, strict=True))

    def step(self, array: CmgArray, obs: Observation, state: Carried) -> tuple[Any, Carried]:
        """Return the rates of the plan's first step."""
        own, period = planner(array, self.steps), float(obs.period)
        rate = np.asarray(obs.hdot, float) / own.mean
        ahead = self._path(own, rate, obs, period)
        start = np.asarray(obs.delta, float)
        if state.queue:
            start = start + period * sum(state.queue)
        if ahead is None:
            return self._sent(np.zeros(array.n), state.plan, state, period)
        momentum = own.momentum(start)
        target = own.envelope.held(momentum, momentum + ahead.target)
        limit = np.minimum(np.outer(own.rate_limit, ahead.seconds), _LONGEST)
        weights = Weights(self.effort, self.rho, self.sigma_ref)
        task = Task(start, ahead._replace(target=target), limit, weights)
        plan: Plan | None = planned(own, task, state.plan, self._search())
        assert plan is not None
        unsolved, fallen = plan.unsolved, plan.solution is None
        if fallen:
            plan = state.plan
        point = start if plan is None else plan.points[0]
        if fallen and plan is not None:
            point = shifted(plan, ahead.place)[0]
        point = own.exact(point, target[0])
        point, share = within(own, start, point, target[0] - momentum, limit[:, 0])
        happened = (unsolved, int(fallen), int(share < _FULL))
        return self._sent((point - start) / period, plan, state, period, happened)

    def _path(self, own: Planner, rate: Any, obs: Observation, period: float) -> path.Path | None:
        """Return the path ahead; None where nothing is asked."""
        if self.samples and obs.preview is not None:
            rates = np.asarray(obs.preview, float)[: self.samples] / own.mean
            if np.abs(rates).max() * period > _ASKED:
                least = float(own.rate_limit.min())
                return path.previewed(rates, period, self.horizon, self.steps, least)
        elif np.abs(rate).max() * period > _ASKED:
            return path.held(rate, period, self.horizon, self.steps)
        return None

    def _search(self) -> Search:
        solver = qp.create(self.solver, iteration_limit=self.iteration_limit)
        return Search(solver, self.iterations, self.renew_below, self.renew_every)

    def _sent(
        self,
        rates: np.ndarray,
        plan: Plan | None,
        state: Carried,
        period: float,
        happened: tuple[int, int, int] = (0, 0, 0),
    ) -> tuple[np.ndarray, Carried]:
        """Return the rates and the next state."""
        waiting = round(self.lead_s / period)
        queue = (*state.queue, rates)[-waiting:] if waiting else ()
        tally = tuple(a + b for a, b in zip(state.tally, happened, strict=True))
        return rates, Carried(plan, queue, tally)
