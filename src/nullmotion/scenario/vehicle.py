"""Spacecraft, servo, sensors, torques and faults from the sections of a scenario, in SI."""

from __future__ import annotations

from typing import Any

import numpy as np

from nullmotion.array import CmgArray
from nullmotion.scenario import attitude, objects, sections
from nullmotion.scenario.schema import ArraySection
from nullmotion.scenario.schema_spacecraft import (
    ControllerSection,
    DesaturationSection,
    DisturbanceSection,
    EventSection,
    ReactionWheelSection,
    SensorsSection,
    ServoSection,
    SpacecraftSection,
)
from nullmotion.spacecraft import (
    Controller,
    Desaturation,
    Disturbance,
    Event,
    Orbit,
    ReactionWheel,
    Sensors,
    Servo,
    Spacecraft,
    controllers,
)

_DEG = np.pi / 180
_SERVO = {  # key in files: field, factor to SI
    "time_constant_s": ("time_constant", 1.0),
    "rate_limit_deg_s": ("rate_limit", _DEG),
    "acceleration_limit_deg_s2": ("acceleration_limit", _DEG),
    "motor_torque_limit_Nm": ("torque_limit", 1.0),
    "friction_Nm": ("friction", 1.0),
    "gimbal_inertia_kg_m2": ("inertia", 1.0),
    "encoder_resolution_deg": ("encoder_resolution", _DEG),
}
_ORBIT = ("inclination", "ascending_node", "argument_of_latitude")


def spacecraft(section: SpacecraftSection) -> Spacecraft:
    """Return the body; raises InputError for an inertia that no body has."""
    own: dict[str, Any] = {}
    start = attitude.quaternion(section.q_BN, section.euler_321_deg)
    if start is not None:
        own["q_BN"] = start
    return Spacecraft(
        np.array(section.inertia_kg_m2, float),
        omega_BN_B=np.array(section.omega_BN_B, float),
        momentum_coupling=section.momentum_coupling,
        **own,
    )


def controller(section: ControllerSection) -> Controller:
    """Return the controller with its parameters; raises InputError for impossible ones."""
    cls = controllers.get(section.name)
    made: Controller = cls(**sections.parameters(section, cls))
    return made


def servo(section: ServoSection, array: ArraySection, n: int) -> Servo:
    """Return the servo of the n working CMGs; lists may have one value for each CMG of all."""
    own = {}
    for key, (field, factor) in _SERVO.items():
        value = getattr(section, key)
        if value is not None:
            each = objects.working(array, value, n) if isinstance(value, tuple) else value
            own[field] = np.asarray(each, float) * factor
    return Servo(**own)


def sensors(section: SensorsSection) -> Sensors:
    """Return the errors of gyro and star tracker."""
    return Sensors(
        section.gyro_noise_deg_s * _DEG,
        np.radians(section.gyro_bias_deg_s),
        section.attitude_noise_deg * _DEG,
        section.seed,
    )


def disturbance(section: DisturbanceSection) -> Disturbance:
    """Return the torque from outside."""
    orbit = None
    if section.altitude_km is not None:
        angles = {key: getattr(section, f"{key}_deg") * _DEG for key in _ORBIT}
        orbit = Orbit.at_altitude(section.altitude_km * 1000.0, **angles)
    return Disturbance(
        np.array(section.constant_Nm, float),
        np.array(section.amplitude_Nm or (0.0, 0.0, 0.0), float),
        section.frequency_Hz or 0.0,
        section.phase_deg * _DEG,
        orbit,
    )


def desaturation(section: DesaturationSection) -> Desaturation:
    """Return the torque that takes momentum off the array."""
    return Desaturation(section.torque_limit_Nm, section.gain_per_s, section.threshold_Nms)


def reaction_wheel(section: ReactionWheelSection, array: CmgArray) -> ReactionWheel:
    """Return the reaction wheel, normal to the array's torque plane unless it has an axis."""
    assert array.torque_axes is not None
    axis = np.cross(*array.torque_axes[:2]) if section.axis is None else np.array(section.axis)
    most = section.momentum_limit_Nms
    if section.wheel_inertia_kg_m2 is not None and section.speed_limit_rpm is not None:
        most = section.wheel_inertia_kg_m2 * section.speed_limit_rpm * objects.RPM
    torque, most = (np.inf if v is None else v for v in (section.torque_limit_Nm, most))
    return ReactionWheel(axis, torque, most, section.momentum_Nms)


def event(section: EventSection, array: ArraySection) -> Event:
    """Return a fault; its CMG is counted among the working ones."""
    failed = sum(i < section.cmg for i in set(array.failed_cmgs))
    own = {
        "rate_limit": None if section.rate_limit_deg_s is None else section.rate_limit_deg_s * _DEG,
        "time_constant": section.time_constant_s,
        "final_fraction": section.final_fraction,
    }
    return Event(
        section.kind,
        section.cmg - failed,
        section.at_s,
        section.detected_after_s,
        **{key: value for key, value in own.items() if value is not None},
    )
