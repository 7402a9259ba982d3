"""The records of a run: what it carries, what is put in, what is kept."""

from __future__ import annotations

import dataclasses
from typing import Any, NamedTuple

import numpy as np

from nullmotion.array.model import CmgArray
from nullmotion.law import Law
from nullmotion.sim.setup import Setup
from nullmotion.spacecraft import (
    Controller,
    Desaturation,
    Disturbance,
    Event,
    ReactionWheel,
    Sensors,
    Servo,
    Spacecraft,
)
from nullmotion.vscmg.hardware import Units


class RunState(NamedTuple):
    """What a run carries from step to step (floats or symbols); () where there is no such thing.

    ``due`` is the rate command in force, ``rates`` the mean rate of the step, ``speed`` the
    rate at its start, ``reading`` the encoder a step before, ``motor`` the motor torque,
    ``wheel`` the reaction wheel's momentum and ``wheel_rate`` its derivative. Of variable-speed
    CMGs (`sim.flywheels`): ``spin`` the wheel speeds, ``spin_rate`` their derivatives over the
    step, ``spin_torque`` the wheel motors', ``cut`` the samples whose torque a limit cut,
    ``limited`` whether the last one was, ``rest`` the inertia without units, ``moved`` the
    state at the step's end, ``work`` of the motors so far, ``torque_matrix`` what a controller
    estimates for the law.
    """

    stop: Any
    taken: Any
    delta: Any
    impulse: Any
    wanted: Any
    hdot: Any
    asked: Any
    queue: tuple[Any, ...]
    due: Any
    rates: Any
    previous: Any
    law: Any
    sums: tuple[Any, ...]
    q: Any
    omega: Any
    reference: Any
    controller: Any
    noise: Any
    speed: Any
    acceleration: Any
    reading: Any
    motor: Any
    wheel: Any
    wheel_rate: Any
    preview: Any
    spin: Any
    spin_rate: Any
    spin_torque: Any
    cut: Any
    limited: Any
    rest: Any
    moved: Any
    work: Any
    torque_matrix: Any


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
    momentum_target: Any
    spacecraft: Spacecraft | None
    controller: Controller | None
    target: Any
    servo: Servo | None
    sensors: Sensors | None
    noise: Any
    disturbance: Disturbance | None
    desaturation: Desaturation | None
    events: tuple[Event, ...]
    reaction_wheel: ReactionWheel | None
    units: Units | None
    wheel_speed: Any

    @property
    def true_array(self) -> CmgArray:
        """The array that really turns, before any event."""
        return self.array if self.plant is None else self.plant


class Record(NamedTuple):
    """What a history keeps of each step."""

    delta: Any
    rates: Any
    asked: Any
    hdot: Any
    impulse: Any
    wanted: Any
    q_BN: Any
    omega_BN_B: Any
    reference: Any
    speed: Any
    motor_torque: Any
    wheel_momentum: Any
    wheel_torque: Any
    spin: Any
    spin_rate: Any
    spin_torque: Any
    limited: Any
    work: Any
    estimates: Any


class Outcome(NamedTuple):
    """What is kept of the final state; ``law`` is the state of a law that runs in Python."""

    stop: Any
    taken: Any
    delta: Any
    rates: Any
    momentum: Any
    sums: tuple[Any, ...]
    q_BN: Any
    omega_BN_B: Any
    law: Any
    spin: Any = ()
    cut: Any = ()


def parameters(setup: Setup) -> Parameters:
    """Return the numbers of a setup."""
    zero = np.zeros(setup.array.m)
    quiet = setup.sensors and dataclasses.replace(setup.sensors, seed=0)
    return Parameters(
        setup.array,
        setup.plant,
        setup.law,
        np.zeros(setup.array.n) if setup.encoder_bias is None else setup.encoder_bias,
        setup.delta,
        zero if setup.hdot.ndim == 2 else setup.hdot,
        setup.dt,
        np.array([s.threshold for s in setup.stop]),
        setup.momentum_target,
        setup.spacecraft,
        setup.controller,
        setup.target,
        setup.servo,
        quiet,
        _noise(setup),
        setup.disturbance,
        setup.desaturation,
        setup.events,
        setup.reaction_wheel,
        setup.units,
        setup.wheel_speed if setup.variable_speed else None,
    )


def _noise(setup: Setup) -> np.ndarray | None:
    """Return the start of the run's random numbers; None where none are drawn."""
    if setup.sensors is None or not setup.sensors.noisy:
        return None
    from nullmotion.spacecraft.random import seeded

    return seeded(setup.sensors.seed)
