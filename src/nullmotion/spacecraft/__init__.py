"""The spacecraft around an array: body, servo, sensors, torques from outside, faults."""

from __future__ import annotations

from nullmotion.spacecraft.body import Spacecraft
from nullmotion.spacecraft.controller import AttitudeObservation, Controller
from nullmotion.spacecraft.disturbance import Desaturation, Disturbance, Orbit
from nullmotion.spacecraft.events import Event
from nullmotion.spacecraft.reaction_wheel import ReactionWheel
from nullmotion.spacecraft.sensors import Sensors
from nullmotion.spacecraft.servo import Servo

__all__ = [
    "AttitudeObservation",
    "Controller",
    "Desaturation",
    "Disturbance",
    "Event",
    "Orbit",
    "ReactionWheel",
    "Sensors",
    "Servo",
    "Spacecraft",
]
