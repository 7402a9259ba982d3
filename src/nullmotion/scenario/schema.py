"""The sections of a scenario file as pydantic models.

Keys and units are those of the file. What depends on a name (the parameters of a
layout, a law or a controller, the metrics to stop at) is added by
`nullmotion.scenario.sections`. The spacecraft's sections are in `schema_spacecraft`.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Annotated, Any, Literal

from pydantic import BaseModel, BeforeValidator, ConfigDict, Discriminator, Field, Tag
from pydantic_core import PydanticCustomError

Positive = Annotated[float, Field(gt=0)]
NotNegative = Annotated[float, Field(ge=0)]


def _is_list(value: Any) -> str:
    return "list" if isinstance(value, tuple) else "number"


def _is_rows(value: Any) -> str:
    return "rows" if isinstance(value, tuple) and value and isinstance(value[0], tuple) else "list"


def sized(count: int) -> Callable[[Any], Any]:
    """Return a check that a list has so many numbers."""

    def check(value: Any) -> Any:
        if isinstance(value, tuple) and len(value) != count:
            given = {"count": count, "given": len(value)}
            raise PydanticCustomError("size", "{count} numbers (this has {given})", given)
        return value

    return check


def one_or_each(number: Any) -> Any:
    """Return the type of one number or a list with one for each CMG."""
    listed = Annotated[tuple[number, ...], Field(min_length=1), Tag("list")]
    return Annotated[Annotated[number, Tag("number")] | listed, Discriminator(_is_list)]


Pair = tuple[float, float]
Vector = tuple[float, float, float]
Three = Annotated[Vector, BeforeValidator(sized(3))]
Four = Annotated[tuple[float, float, float, float], BeforeValidator(sized(4))]
Some = Annotated[tuple[float, ...], Field(min_length=1)]
Limits = Annotated[
    Annotated[Pair, Tag("list")] | Annotated[tuple[Pair, ...], Tag("rows")], Discriminator(_is_rows)
]


class Section(BaseModel):
    """Base of all sections: nothing unknown, no NaN, no silent conversion."""

    model_config = ConfigDict(extra="forbid", frozen=True, strict=True, allow_inf_nan=False)

    def given(self, key: str) -> bool:
        """Return whether the file gives a value for a key."""
        return key in self.model_fields_set


class About(Section):
    """``[scenario]``: what it is about."""

    title: str = ""
    description: str = ""


class ArraySection(Section):
    """``[array]``: a layout by name with its parameters, momenta, limits, failures."""

    layout: str
    h0_Nms: one_or_each(NotNegative) = 1.0  # type: ignore[valid-type]
    wheel_inertia_kg_m2: one_or_each(Positive) | None = None  # type: ignore[valid-type]
    wheel_speed_rpm: one_or_each(NotNegative) | None = None  # type: ignore[valid-type]
    wheel_speed_rad_s: one_or_each(NotNegative) | None = None  # type: ignore[valid-type]
    wheel_torque_limit_Nm: one_or_each(NotNegative) | None = None  # type: ignore[valid-type]
    wheel_speed_limit_rpm: one_or_each(Positive) | None = None  # type: ignore[valid-type]
    wheel_power_limit_W: one_or_each(Positive) | None = None  # type: ignore[valid-type]
    rate_limit_deg_s: one_or_each(Positive) | None = None  # type: ignore[valid-type]
    rate_limit_mode: Literal["scale", "clip"] = "scale"
    angle_limits_deg: Limits | None = None
    momentum_bias_Nms: Three | None = None
    failed_cmgs: tuple[Annotated[int, Field(ge=0)], ...] = ()
    frozen_at_deg: one_or_each(float) | None = None  # type: ignore[valid-type]


class CustomArraySection(ArraySection):
    """``[array]`` with ``layout = "custom"``: the axes themselves, in body frame B."""

    gimbal_axes: Annotated[tuple[Vector, ...], Field(min_length=1)]
    spin_axes: Annotated[tuple[Vector, ...], Field(min_length=1)]


class PlantSection(Section):
    """``[plant]``: how the real array differs from the one the law is given."""

    gimbal_axis_error_deg: Annotated[float, Field(ge=0, lt=90)] = 0.0
    h0_error: Annotated[float, Field(ge=0, lt=1)] = 0.0
    encoder_bias_deg: NotNegative = 0.0
    seed: Annotated[int, Field(ge=0)] = 0


class InitialSection(Section):
    """``[initial]``: the state at the start; the layout's home unless given."""

    gimbal_deg: Some | None = None
    momentum_Nms: Some | None = None
    wheel_speed_rad_s: one_or_each(float) | None = None  # type: ignore[valid-type]


class NamedLaw(Section):
    """A law by name; its parameters are fields of the models made from this one."""

    name: str


class LawSection(NamedLaw):
    """``[law]``: the law that steers, and when it is called."""

    period_s: Positive | None = None
    delay_s: NotNegative = 0.0


class CaseSection(NamedLaw):
    """``[[compare.case]]``: a law that ``compare`` runs beside ``[law]``."""

    label: str = ""


class MissionSection(Section):
    """``[mission]``: what is asked: a rate of momentum, a momentum, an attitude, a startup."""

    kind: Literal["momentum-rate", "momentum", "attitude", "startup"] = "momentum-rate"
    hdot_Nm: Some | None = None
    momentum_Nms: Some | None = None
    target_q_BN: Four | None = None
    target_euler_321_deg: Three | None = None
    profile: str | None = None
    profile_hold: bool = False
    slew_time_s: Positive | None = None
    settle_tolerance_deg: Annotated[float, Field(gt=0, le=180)] = 0.1
    wheel_tolerance: Annotated[float, Field(gt=0, lt=1)] = 0.02

    @property
    def turns_body(self) -> bool:
        """Whether it asks for an attitude, which takes a spacecraft."""
        return self.kind in ("attitude", "startup")


class StopSection(Section):
    """``[simulation.stop]``: thresholds at which the run ends."""


class RequirementsSection(Section):
    """``[requirements]``: limits that numbers of the summary have to keep."""


class SimulationSection(Section):
    """``[simulation]``: time grid and integrator of the plant."""

    dt_s: Positive = 0.01
    duration_s: Positive
    integrator: Literal["euler", "rk4", "semi-implicit-euler", "dop853"] = "rk4"
