"""A run as a loop: what happens at each step, said once.

At step k (time t = k dt): the command is read or made by the controller; the run stops if a
condition holds; the law is sampled every ``period_steps`` and its limited rates queued; the
rates that are due act on the gimbals' servos; the metrics are taken; the plant moves. The last
pass (k = steps) only takes the metrics of the final state.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from nullmotion import ops, rotation, tree
from nullmotion.compile.loop import Loop, Stage
from nullmotion.law import Observation
from nullmotion.metrics.base import Metric, Sample
from nullmotion.sim import command, flywheels, plant
from nullmotion.sim.setup import Setup
from nullmotion.sim.state import Outcome, Parameters, Record, RunState, parameters
from nullmotion.spacecraft import faults, motion

TIME_UP = -1.0  # stop code of a run that lasted its full time; i + 1 is stop condition i


def reductions(metrics: tuple[Metric, ...]) -> list[tuple[Metric, str]]:
    """Return the (metric, reduction) pairs that a run sums up, in order."""
    return [(m, r) for m in metrics for r in m.reductions]


def passes(setup: Setup, recording: bool) -> int:
    """Return how often a run's loop goes round: the last pass looks at the final state."""
    return setup.steps + (recording or bool(setup.stop or setup.metrics))


def loop(setup: Setup, varying: tuple[bool, ...] | None = None, *, recording: bool = False) -> Loop:
    """Return a setup's loop.

    Args:
        setup: What to run.
        varying: Marks the leaves of `parameters` that differ between runs; none by default.
        recording: Whether a history is kept.
    """
    own = parameters(setup)
    flags = varying or (False,) * len(tree.flatten(own))
    run = _Run(setup, always=passes(setup, recording) == setup.steps)
    period = setup.period_steps
    late, lag = divmod(setup.delay_steps, period)[1], setup.delay_steps // period
    stages = (
        Stage(run.command, period),
        Stage(run.check),
        Stage(run.sample, period),
        Stage(lambda k, row, s, p: s._replace(due=s.queue[lag]), period, late),
        Stage(run.drive),
        Stage(run.measure),
        Stage(run.advance),
    )
    return Loop(
        start=lambda p: run.start(p, lag + 1),
        stages=stages,
        outputs=outcome,
        parameters=own,
        varying=flags,
        row=setup.table.shape[1] if setup.scheduled else 0,
        row_period=period,
        active=(lambda s: ops.equal(s.stop, 0.0)) if setup.stop else None,
        record=record,
        recorded_after=6,
    )


def record(s: RunState) -> Record:
    """Return what a history keeps of a step."""
    return Record(
        s.delta,
        s.rates,
        s.asked,
        s.hdot,
        s.impulse,
        s.wanted,
        s.q,
        s.omega,
        s.reference,
        s.speed,
        s.motor,
        s.wheel if isinstance(s.wheel, tuple) else np.array([s.wheel]),
        s.wheel_rate if isinstance(s.wheel_rate, tuple) else np.array([s.wheel_rate]),
        s.spin,
        s.spin_rate,
        s.spin_torque,
        np.array([s.limited]) if flywheels.turning(s) else (),
        np.array([s.work]) if flywheels.turning(s) else (),
        np.array(tree.flatten(s.controller)) if flywheels.turning(s) else (),
    )


def outcome(s: RunState, p: Parameters) -> Outcome:
    """Return what is kept of the final state."""
    array = flywheels.spun(faults.as_it_is(p.true_array, p.events, s.taken * p.dt), s)
    momentum = array.momentum(s.delta)
    law = () if p.law.traceable else s.law
    return Outcome(
        s.stop, s.taken, s.delta, s.rates, momentum, s.sums, s.q, s.omega, law, s.spin, s.cut
    )


class _Run:
    """The stages of one setup; holds structure only, numbers come as parameters."""

    def __init__(self, setup: Setup, always: bool) -> None:
        self.setup, self.always = setup, always  # always: every pass is a step

    def start(self, p: Parameters, queue: int) -> RunState:
        n, m = self.setup.array.n, self.setup.array.m
        zero, craft, nothing = np.zeros(n), p.spacecraft, ()
        reading: Any = nothing
        if p.servo is not None and p.servo.has("encoder_resolution"):
            reading = motion.quantised(p.delta, p.servo.encoder_resolution)
        command_zero = np.zeros(2 * n) if self.setup.variable_speed else zero
        reference = np.array([1.0, 0.0, 0.0, 0.0]) if p.target is None else p.target
        return RunState(
            stop=0.0,
            taken=0.0,
            delta=p.delta,
            impulse=np.zeros(m),
            wanted=self._momentum(p),
            hdot=np.zeros(m),
            asked=zero,
            queue=(command_zero,) * queue,
            due=command_zero,
            rates=zero,
            previous=zero,
            law=p.law.init(p.array, p.delta + p.encoder_bias),
            sums=tuple(_EMPTY[r] for _, r in reductions(self.setup.metrics)),
            q=craft.q_BN if craft else nothing,
            omega=craft.omega_BN_B if craft else nothing,
            reference=reference if craft else nothing,
            controller=p.controller.init(p.array) if p.controller else nothing,
            noise=nothing if p.noise is None else p.noise,
            speed=zero,
            acceleration=zero if p.servo else nothing,
            reading=reading,
            motor=zero,
            wheel=p.reaction_wheel.momentum if p.reaction_wheel else nothing,
            wheel_rate=0.0 if p.reaction_wheel else nothing,
            preview=nothing,
            limited=0.0,
            work=0.0,
            **flywheels.started(self.setup, p),
        )

    def _momentum(self, p: Parameters) -> Any:
        array = p.true_array
        if p.wheel_speed is not None:
            array = array.altered(h0=array.flywheels.inertia * p.wheel_speed)
        return array.momentum(p.delta)

    def command(self, k: Any, row: Any, s: RunState, p: Parameters) -> RunState:
        return command.command(self.setup, k, row, s, p)

    def check(self, k: Any, row: Any, s: RunState, p: Parameters) -> RunState:
        """Find out whether the run ends before this step."""
        if self.always:
            return s._replace(stop=TIME_UP)
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
        t = k * p.dt
        array = command.known_array(t, s, p)
        observation = Observation(
            delta=command.measured_angles(s, p),
            hdot=s.hdot,
            t=t,
            period=p.dt * float(self.setup.period_steps),
            delta_dot=s.rates,
            omega_BN_B=None if isinstance(s.omega, tuple) else s.omega,
            preview=None if isinstance(s.preview, tuple) else s.preview,
            wheel_speed=s.spin if flywheels.turning(s) else None,
            torque_matrix=None if isinstance(s.torque_matrix, tuple) else s.torque_matrix,
        )
        asked, state = p.law.step(array, observation, s.law)
        if flywheels.turning(s):
            return flywheels.asked(s._replace(law=state), p, array, observation, asked)
        return s._replace(asked=asked, law=state, queue=(array.limited(asked), *s.queue[:-1]))

    def drive(self, k: Any, row: Any, s: RunState, p: Parameters) -> RunState:
        return plant.drive(self.setup, k, s, p)

    def measure(self, k: Any, row: Any, s: RunState, p: Parameters) -> RunState:
        """Take the metrics of every sample a run reaches, of rates only where a step follows."""
        if not self.setup.metrics:
            return s
        sample = self._sample_at(k, s, p)
        reached, going = ops.equal(s.taken, k), ops.equal(s.stop, 0.0)
        sums = []
        for (metric, reduction), old in zip(reductions(self.setup.metrics), s.sums, strict=True):
            new = _UPDATE[reduction](old, metric.of(sample))
            steps_only = metric.needs_rates or reduction in _OVER_STEPS
            sums.append(ops.where(going if steps_only else reached, new, old))
        return s._replace(sums=tuple(sums))

    def advance(self, k: Any, row: Any, s: RunState, p: Parameters) -> RunState:
        """Move the plant by one step unless the run has ended."""
        moved = plant.advanced(self.setup, k, s, p)
        moved |= {"taken": s.taken + 1.0, "wanted": s.wanted + p.dt * s.hdot}
        if self.always:
            return s._replace(**moved)
        going = ops.equal(s.stop, 0.0)
        return s._replace(
            **{key: ops.where(going, new, getattr(s, key)) for key, new in moved.items()}
        )

    def _sample_at(self, k: Any, s: RunState, p: Parameters) -> Sample:
        first = ops.equal(s.taken, 0.0)
        body: dict[str, Any] = {}
        if flywheels.turning(s):
            body |= {"wheel_speed": s.spin, "wheel_acceleration": s.spin_rate}
            body["turning"] = faults.as_working(p.true_array, p.events, k * p.dt)
        elif faults.of_kind(p.events, "stuck"):
            body["turning"] = faults.as_working(p.true_array, p.events, k * p.dt)
        if not isinstance(s.q, tuple):
            body |= {"q_BN": s.q, "omega_BN_B": s.omega, "q_BR": _error(s)}
        return Sample(
            array=flywheels.spun(faults.as_it_is(p.true_array, p.events, k * p.dt), s),
            delta=s.delta,
            hdot=s.hdot,
            t=k * p.dt,
            rates=s.rates,
            previous_rates=ops.where(first, s.rates, s.previous),
            momentum_wanted=s.wanted,
            impulse=s.impulse,
            asked=s.asked,
            motor_torque=s.motor,
            speed=s.speed,
            dt=p.dt,
            **body,
        )


def _error(s: RunState) -> Any:
    return rotation.shortest(rotation.multiply(rotation.conjugate(s.reference), s.q))


_EMPTY = {
    "min": np.inf,
    "max": -np.inf,
    "latest": -np.inf,
    "rms": 0.0,
    "mean": 0.0,
    "total": 0.0,
    "final": np.nan,
}
_OVER_STEPS = ("rms", "mean", "total")
_UPDATE = {
    # the new value comes second: min and max return it when it is NaN
    "min": lambda old, new: ops.minimum(old, new),
    "max": lambda old, new: ops.maximum(old, new),
    "latest": lambda old, new: ops.maximum(old, new),
    "rms": lambda old, new: old + new * new,
    "mean": lambda old, new: old + new,
    "total": lambda old, new: old + new,
    "final": lambda old, new: new,
}
