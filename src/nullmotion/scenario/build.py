"""From a checked scenario to what the simulation takes."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from nullmotion import metrics
from nullmotion.array import CmgArray
from nullmotion.errors import InputError
from nullmotion.metrics.base import Metric
from nullmotion.scenario import (
    attitude,
    metric_keys,
    objects,
    plant,
    profile,
    start,
    vehicle,
    vscmg_units,
)
from nullmotion.scenario.checks import WHOLE
from nullmotion.scenario.scenario import Scenario
from nullmotion.scenario.schema import StopSection
from nullmotion.sim.setup import Setup, Stop


def setup(scenario: Scenario, metric_names: tuple[str, ...] | None = None) -> Setup:
    """Return the run of a scenario, in SI and radians.

    Args:
        scenario: A checked scenario.
        metric_names: What is measured; by default all registered metrics, those of an
            attitude only with a spacecraft.

    Raises:
        UnsupportedArrayError: When the law cannot steer the array.
        InputError: For a metric of an attitude when there is no spacecraft.
    """
    array = objects.array(scenario.array)
    dt = scenario.simulation.dt_s
    period = _steps(scenario.law.period_s or dt, dt)
    steps = step_count(scenario)
    real, bias = plant.drawn(scenario.plant, array)
    return Setup(
        array=array,
        law=objects.law(scenario.law),
        delta=start.angles(scenario.array, scenario.initial, array),
        hdot=_command(scenario, array, steps, period),
        plant=real,
        encoder_bias=bias,
        dt=dt,
        steps=steps,
        period_steps=period,
        delay_steps=_steps(scenario.law.delay_s, dt),
        integrator=scenario.simulation.integrator,
        stop=stops(scenario.stop),
        metrics=_metrics(scenario, metric_names),
        **_surroundings(scenario, array, np.arange(0, steps + 1, period) * dt),
    )


def metric(name: str, **parameters: Any) -> Metric:
    """Return a registered metric; parameters that are not given keep their defaults."""
    made: Metric = metrics.get(name)(**parameters)
    return made


def _metrics(scenario: Scenario, names: tuple[str, ...] | None) -> tuple[Metric, ...]:
    """Return what is measured, the tolerance of settling as the mission has it."""
    body, wheels = scenario.mission.turns_body, scenario.variable_speed
    settling = {
        "settling_time_s": math.radians(scenario.mission.settle_tolerance_deg),
        "momentum_settling_s": scenario.mission.wheel_tolerance,
        "wheel_settling_s": scenario.mission.wheel_tolerance,
    }
    chosen = names or metrics.applicable(body, wheels)
    for name in chosen:
        if metrics.get(name).needs_body and not body:
            raise InputError("metrics", name, 'one that needs no mission.kind = "attitude"')
        if metrics.get(name).needs_wheels and not wheels:
            raise InputError("metrics", name, "one that needs no variable wheel speeds")
    tolerances = {n: {"tolerance": settling[n]} if n in settling else {} for n in chosen}
    return tuple(metric(n, **own) for n, own in tolerances.items())


def step_count(scenario: Scenario) -> int:
    """Return the number of steps: the last one reaches the duration."""
    times = scenario.simulation
    return max(1, math.ceil(times.duration_s / times.dt_s * (1 - WHOLE)))


def _steps(time: float, dt: float) -> int:
    return round(time / dt)


def stops(section: StopSection) -> tuple[Stop, ...]:
    """Return the stop conditions, by the metric's name."""
    return tuple(
        Stop(metric_keys.metric(key)(), value, key.endswith("_below"))
        for key, value in metric_keys.limits(section).items()
    )


def _command(scenario: Scenario, array: CmgArray, steps: int, period: int) -> np.ndarray:
    mission: Any = scenario.mission
    if mission.kind != "momentum-rate":
        return np.zeros(array.m)
    if mission.profile is None:
        return np.array(mission.hdot_Nm, float)
    table = profile.load(scenario.source, mission.profile, array.m)
    return table.at(np.arange(0, steps, period) * scenario.simulation.dt_s)


def _surroundings(scenario: Scenario, array: CmgArray, times: np.ndarray) -> dict[str, Any]:
    """Return what is around the array: servo and faults, target, spacecraft and the rest."""
    found: dict[str, Any] = {
        "events": tuple(vehicle.event(event, scenario.array) for event in scenario.events)
    }
    if scenario.servo is not None:
        found["servo"] = vehicle.servo(scenario.servo, scenario.array, array.n)
    if scenario.mission.kind == "momentum":
        found["momentum_target"] = np.array(scenario.mission.momentum_Nms, float)
    for name in ("spacecraft", "controller", "sensors", "disturbance", "desaturation"):
        section = getattr(scenario, name)
        if section is not None:
            found[name] = getattr(vehicle, name)(section)
    if scenario.reaction_wheel is not None:
        found["reaction_wheel"] = vehicle.reaction_wheel(scenario.reaction_wheel, array)
    if scenario.vscmg is not None:
        found["units"] = vscmg_units.made(scenario.vscmg, scenario.array, array.n)
    if scenario.variable_speed and array.wheels is not None:
        found["wheel_speed"] = vscmg_units.wheel_speed(scenario, array)
    if scenario.mission.turns_body:
        found["target"] = attitude.target(scenario)
        found["reference"] = attitude.reference(scenario, found["spacecraft"].q_BN, times)
    return found
