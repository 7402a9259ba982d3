"""A momentum-rate run as a loop: what happens at each step, said once.

At step k (time t = k dt): the command is read; the run stops if a condition holds;
the law is sampled every ``period_steps`` and its limited rates queued; the rates that
are due act; the metrics are taken; the plant moves. The last pass (k = steps) only
takes the metrics of the final state.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from nullmotion import ops, tree
from nullmotion.array.model import CmgArray
from nullmotion.compile.loop import Loop, Stage
from nullmotion.law import Law, Observation
from nullmotion.metrics.base import Metric, Sample
from nullmotion.sim.integrators import INTEGRATORS
from nullmotion.sim.setup import Setup

TIME_UP = -1.0  # stop code of a run that lasted its full time; i + 1 is stop condition i


class RunState(NamedTuple):
    """What a run carries from step to step (floats or symbols)."""

    stop: Any
    taken: Any
    delta: Any
    impulse: Any
    wanted: Any
    hdot: Any
    asked: Any
    queue: tuple[Any, ...]
    rates: Any
    previous: Any
    law: Any
    sums: tuple[Any, ...]


class Parameters(NamedTuple):
    """Everything of a run that is a number; what varies in a batch becomes a kernel parameter."""

    array: CmgArray
    plant: CmgArray | None
    law: Law
    encoder_bias: Any
    delta: Any
    hdot: Any
    dt: Any
    thresholds: Any


class Record(NamedTuple):
    """What a history keeps of each step."""

    delta: Any
    rates: Any
    asked: Any
    hdot: Any
    impulse: Any
    wanted: Any


class Outcome(NamedTuple):
    """What is kept of the final state."""

    stop: Any
    taken: Any
    delta: Any
    rates: Any
    momentum: Any
    sums: tuple[Any, ...]


def parameters(setup: Setup) -> Parameters:
    """Return the numbers of a setup."""
    return Parameters(
        setup.array,
        setup.plant,
        setup.law,
        np.zeros(setup.array.n) if setup.encoder_bias is None else setup.encoder_bias,
        setup.delta,
        np.zeros(setup.array.m) if setup.scheduled else setup.hdot,
        setup.dt,
        np.array([s.threshold for s in setup.stop]),
    )


def reductions(metrics: tuple[Metric, ...]) -> list[tuple[Metric, str]]:
    """Return the (metric, reduction) pairs that a run sums up, in order."""
    return [(m, r) for m in metrics for r in m.reductions]


def loop(setup: Setup, varying: tuple[bool, ...] | None = None) -> Loop:
    """Return a setup's loop; ``varying`` marks leaves of `parameters` that differ between runs."""
    own = parameters(setup)
    flags = varying or (False,) * len(tree.flatten(own))
    run = _Run(setup)
    period = setup.period_steps
    late, lag = divmod(setup.delay_steps, period)[1], setup.delay_steps // period
    stages = (
        Stage(run.command, period),
        Stage(run.check),
        Stage(run.sample, period),
        Stage(lambda k, row, s, p: run.actuate(s, lag), period, late),
        Stage(run.measure),
        Stage(run.advance),
    )
    return Loop(
        start=lambda p: run.start(p, lag + 1),
        stages=stages,
        outputs=outcome,
        parameters=own,
        varying=flags,
        row=setup.array.m if setup.scheduled else 0,
        row_period=period,
        active=(lambda s: ops.equal(s.stop, 0.0)) if setup.stop else None,
        record=lambda s: Record(s.delta, s.rates, s.asked, s.hdot, s.impulse, s.wanted),
        recorded_after=5,
    )


def outcome(s: RunState, p: Parameters) -> Outcome:
    """Return what is kept of the final state."""
    plant = p.array if p.plant is None else p.plant
    return Outcome(s.stop, s.taken, s.delta, s.rates, plant.momentum(s.delta), s.sums)


class _Run:
    """The stages of one setup; holds structure only, numbers come as parameters."""

    def __init__(self, setup: Setup) -> None:
        self.setup = setup
        self.integrate = INTEGRATORS[setup.integrator]

    def start(self, p: Parameters, queue: int) -> RunState:
        n, m = self.setup.array.n, self.setup.array.m
        measured = p.delta + p.encoder_bias
        sums = tuple(_EMPTY[r] for _, r in reductions(self.setup.metrics))
        zero = np.zeros(n)
        plant = p.array if p.plant is None else p.plant
        return RunState(
            0.0,
            0.0,
            p.delta,
            np.zeros(m),
            plant.momentum(p.delta),
            np.zeros(m),
            zero,
            (zero,) * queue,
            zero,
            zero,
            p.law.init(p.array, measured),
            sums,
        )

    def command(self, k: Any, row: Any, s: RunState, p: Parameters) -> RunState:
        return s._replace(hdot=row if self.setup.scheduled else p.hdot)

    def check(self, k: Any, row: Any, s: RunState, p: Parameters) -> RunState:
        """Find out whether the run ends before this step."""
        stop = ops.where(ops.less(k, float(self.setup.steps)), 0.0, TIME_UP)
        sample = self._sample_at(k, s, p)
        for i, condition in reversed(list(enumerate(self.setup.stop))):
            value = condition.metric.of(sample)
            passed = (
                ops.less(value, p.thresholds[i])
                if condition.below
                else ops.less(p.thresholds[i], value)
            )
            stop = ops.where(passed, float(i + 1), stop)
        return s._replace(stop=ops.where(ops.equal(s.stop, 0.0), stop, s.stop))

    def sample(self, k: Any, row: Any, s: RunState, p: Parameters) -> RunState:
        """Ask the law and queue its limited rates."""
        observation = Observation(
            delta=s.delta + p.encoder_bias,
            hdot=s.hdot,
            t=k * p.dt,
            period=p.dt * float(self.setup.period_steps),
            delta_dot=s.rates,
        )
        asked, state = p.law.step(p.array, observation, s.law)
        return s._replace(asked=asked, law=state, queue=(p.array.limited(asked), *s.queue[:-1]))

    def actuate(self, s: RunState, lag: int) -> RunState:
        """Let the rates act that were asked ``lag`` samples ago."""
        return s._replace(rates=s.queue[lag])

    def measure(self, k: Any, row: Any, s: RunState, p: Parameters) -> RunState:
        """Take the metrics of every sample a run reaches, of rates only where a step follows."""
        s = s._replace(rates=self._moving(s, p))
        sample = self._sample_at(k, s, p)
        reached, going = ops.equal(s.taken, k), ops.equal(s.stop, 0.0)
        sums = []
        for (metric, reduction), old in zip(reductions(self.setup.metrics), s.sums, strict=True):
            new = _UPDATE[reduction](old, metric.of(sample))
            sums.append(
                ops.where(
                    going if metric.needs_rates or reduction in ("rms", "mean") else reached,
                    new,
                    old,
                )
            )
        return s._replace(sums=tuple(sums))

    def advance(self, k: Any, row: Any, s: RunState, p: Parameters) -> RunState:
        """Move the plant by one step unless the run has ended."""
        plant = p.array if p.plant is None else p.plant
        rates = s.rates
        delta, impulse = self.integrate(
            lambda d, _: (rates, plant.jacobian(d) @ rates), s.delta, s.impulse, p.dt
        )
        moved = (s.taken + 1.0, delta, impulse, s.wanted + p.dt * s.hdot, rates)
        stayed = (s.taken, s.delta, s.impulse, s.wanted, s.previous)
        going = ops.equal(s.stop, 0.0)
        taken, delta, impulse, wanted, previous = (
            ops.where(going, new, old) for new, old in zip(moved, stayed, strict=True)
        )
        return s._replace(
            taken=taken, delta=delta, impulse=impulse, wanted=wanted, previous=previous
        )

    def _moving(self, s: RunState, p: Parameters) -> Any:
        """Return the rates that the end stops let through."""
        plant = p.array if p.plant is None else p.plant
        if not plant.has_angle_limits:
            return s.rates
        return (plant.within_angle_limits(s.delta + p.dt * s.rates) - s.delta) / p.dt

    def _sample_at(self, k: Any, s: RunState, p: Parameters) -> Sample:
        first = ops.equal(s.taken, 0.0)
        return Sample(
            array=p.array if p.plant is None else p.plant,
            delta=s.delta,
            hdot=s.hdot,
            t=k * p.dt,
            rates=s.rates,
            previous_rates=ops.where(first, s.rates, s.previous),
            momentum_wanted=s.wanted,
            impulse=s.impulse,
        )


_EMPTY = {"min": np.inf, "max": -np.inf, "rms": 0.0, "mean": 0.0, "final": np.nan}
_UPDATE = {
    # the new value comes second: min and max return it when it is NaN
    "min": lambda old, new: ops.minimum(old, new),
    "max": lambda old, new: ops.maximum(old, new),
    "rms": lambda old, new: old + new * new,
    "mean": lambda old, new: old + new,
    "final": lambda old, new: new,
}
