"""The sections of a scenario file that say what carries the array and what happens to it."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import AfterValidator, BeforeValidator, Discriminator, Field, Tag
from pydantic_core import PydanticCustomError

from nullmotion.scenario.schema import (
    Four,
    NotNegative,
    Positive,
    Section,
    Three,
    Vector,
    one_or_each,
)

_Share = Annotated[float, Field(ge=0, le=1)]
_Seed = Annotated[int, Field(ge=0)]


def _is_matrix(value: Any) -> str:
    rows = isinstance(value, tuple) and any(isinstance(row, tuple) for row in value)
    return "matrix" if rows else "diagonal"


def _nine(value: Any) -> Any:
    if (
        isinstance(value, tuple)
        and [len(row) for row in value if isinstance(row, tuple)] != [3] * 3
    ):
        raise PydanticCustomError("matrix", "3 numbers, or 3 rows of 3 numbers")
    return value


Inertia = Annotated[
    Annotated[Three, Tag("diagonal")]
    | Annotated[tuple[Vector, Vector, Vector], BeforeValidator(_nine), Tag("matrix")],
    Discriminator(_is_matrix),
]


class SpacecraftSection(Section):
    """``[spacecraft]``: the body that carries the array, and its state at the start."""

    inertia_kg_m2: Inertia
    q_BN: Four | None = None
    euler_321_deg: Three | None = None
    omega_BN_B: Three = (0.0, 0.0, 0.0)
    momentum_coupling: bool = True


class ControllerSection(Section):
    """``[controller]``: a controller by name; its parameters are added to this model."""

    name: str


class ServoSection(Section):
    """``[servo]``: how gimbals follow what they are commanded; at once and exactly without it."""

    time_constant_s: one_or_each(NotNegative) = 0.0  # type: ignore[valid-type]
    rate_limit_deg_s: one_or_each(Positive) | None = None  # type: ignore[valid-type]
    acceleration_limit_deg_s2: one_or_each(Positive) | None = None  # type: ignore[valid-type]
    motor_torque_limit_Nm: one_or_each(Positive) | None = None  # type: ignore[valid-type]
    friction_Nm: one_or_each(NotNegative) = 0.0  # type: ignore[valid-type]
    gimbal_inertia_kg_m2: one_or_each(Positive) | None = None  # type: ignore[valid-type]
    encoder_resolution_deg: one_or_each(NotNegative) = 0.0  # type: ignore[valid-type]


class SensorsSection(Section):
    """``[sensors]``: errors of the measured body rate and attitude; none without it."""

    gyro_noise_deg_s: NotNegative = 0.0
    gyro_bias_deg_s: Three = (0.0, 0.0, 0.0)
    attitude_noise_deg: NotNegative = 0.0
    seed: _Seed = 0


class DisturbanceSection(Section):
    """``[disturbance]``: torque from outside; with an altitude, the gravity gradient too."""

    constant_Nm: Three = (0.0, 0.0, 0.0)
    amplitude_Nm: Three | None = None
    frequency_Hz: Positive | None = None
    phase_deg: float = 0.0
    altitude_km: Positive | None = None
    inclination_deg: float = 0.0
    ascending_node_deg: float = 0.0
    argument_of_latitude_deg: float = 0.0


class DesaturationSection(Section):
    """``[desaturation]``: limited torque from outside that takes momentum off the array."""

    torque_limit_Nm: Positive
    gain_per_s: Positive = 0.1
    threshold_Nms: NotNegative = 0.0


class ReactionWheelSection(Section):
    """``[reaction_wheel]``: gives the third torque dimension beside a planar array."""

    axis: Three | None = None
    torque_limit_Nm: Positive | None = None
    momentum_limit_Nms: Positive | None = None
    wheel_inertia_kg_m2: Positive | None = None
    speed_limit_rpm: Positive | None = None
    momentum_Nms: float = 0.0


class EventSection(Section):
    """``[[event]]``: a fault of one CMG (counted from 0, failed ones included) from a time on."""

    kind: Literal["stuck", "slow", "spin-down", "wheel-dead"]
    cmg: Annotated[int, Field(ge=0)]
    at_s: NotNegative
    detected_after_s: Annotated[float, Field(ge=0, allow_inf_nan=True)] = 0.0
    rate_limit_deg_s: Positive | None = None
    time_constant_s: Positive | None = None
    final_fraction: _Share | None = None


def _odd(value: int) -> int:
    if value < 3 or value % 2 == 0:
        raise PydanticCustomError(
            "odd", "an odd number from 3 (negative, zero and positive null motion)"
        )
    return value


class PlanSection(Section):
    """``[plan]``: how the null motion of a whole manoeuvre is searched, and what it is to gain."""

    cost: str = "papakonstantinou"
    weights: Four | None = None
    k_max: Positive = 0.7
    depth: Annotated[int, Field(ge=1)] = 10
    levels: Annotated[int, AfterValidator(_odd)] = 3
    lag: bool = False
    duration_s: Positive | None = None
    manipulability_threshold: Positive = 0.5
    rate_threshold_deg_s: Positive | None = None
    index: Literal["sqrt-det", "det"] = "sqrt-det"
