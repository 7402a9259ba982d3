"""From a checked scenario to what the simulation takes."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from nullmotion import metrics
from nullmotion.array import CmgArray
from nullmotion.metrics.base import Metric
from nullmotion.scenario import objects, plant, profile
from nullmotion.scenario.checks import WHOLE
from nullmotion.scenario.scenario import Scenario
from nullmotion.scenario.schema import StopSection
from nullmotion.sim.setup import Setup, Stop


def setup(scenario: Scenario, metric_names: tuple[str, ...] | None = None) -> Setup:
    """Return the run of a scenario, in SI and radians.

    Args:
        scenario: A checked scenario.
        metric_names: What is measured; all registered metrics by default.

    Raises:
        UnsupportedArrayError: When the law cannot steer the array.
    """
    array = objects.array(scenario.array)
    dt = scenario.simulation.dt_s
    period = _steps(scenario.law.period_s or dt, dt)
    steps = step_count(scenario)
    real, bias = _plant(scenario, array)
    return Setup(
        array=array,
        law=objects.law(scenario.law),
        delta=objects.start(scenario.array, scenario.initial.gimbal_deg, array.n),
        hdot=_command(scenario, array, steps, period),
        plant=real,
        encoder_bias=bias,
        dt=dt,
        steps=steps,
        period_steps=period,
        delay_steps=_steps(scenario.law.delay_s, dt),
        integrator=scenario.simulation.integrator,
        stop=stops(scenario.stop),
        metrics=tuple(metric(name) for name in metric_names or metrics.names()),
    )


def metric(name: str) -> Metric:
    """Return a registered metric with its defaults."""
    made: Metric = metrics.get(name)()
    return made


def step_count(scenario: Scenario) -> int:
    """Return the number of steps: the last one reaches the duration."""
    times = scenario.simulation
    return max(1, math.ceil(times.duration_s / times.dt_s * (1 - WHOLE)))


def _steps(time: float, dt: float) -> int:
    return round(time / dt)


def stops(section: StopSection) -> tuple[Stop, ...]:
    """Return the stop conditions, by the metric's name."""
    return tuple(
        Stop(metric(key.rpartition("_")[0]), value, key.endswith("_below"))
        for key, value in section.model_dump(exclude_unset=True).items()
        if value is not None
    )


def _plant(scenario: Scenario, array: CmgArray) -> tuple[CmgArray | None, np.ndarray | None]:
    section = scenario.plant
    if section is None:
        return None, None
    generator = np.random.default_rng(section.seed)
    real = plant.real_array(array, section, generator)
    bias = plant.encoder_bias(array.n, section, generator)
    exact = section.gimbal_axis_error_deg == 0 and section.h0_error == 0
    return None if exact else real, bias if section.encoder_bias_deg else None


def _command(scenario: Scenario, array: CmgArray, steps: int, period: int) -> np.ndarray:
    mission: Any = scenario.mission
    if mission.profile is None:
        return np.array(mission.hdot_Nm, float)
    table = profile.load(scenario.source, mission.profile, array.m)
    return table.at(np.arange(0, steps, period) * scenario.simulation.dt_s)
