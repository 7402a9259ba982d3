"""The sections of a rover file as pydantic models; keys and units are those of the file."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BeforeValidator, Field

from nullmotion.rover.rover import MARS
from nullmotion.scenario.schema import NotNegative, Positive, Section, Three, sized
from nullmotion.scenario.schema_spacecraft import Inertia

_Slope = Annotated[float, Field(gt=-90, lt=90)]
_Share = Annotated[float, Field(gt=0, le=1)]
_Spread = Annotated[
    tuple[NotNegative, NotNegative, NotNegative],
    BeforeValidator(sized(3)),
]
_Nodes = Annotated[
    tuple[Annotated[int, Field(ge=10)], Annotated[int, Field(ge=10)]], BeforeValidator(sized(2))
]


class AboutSection(Section):
    """``[rover]``: what it is about."""

    title: str = ""
    description: str = ""
    name: str = ""


class ChassisSection(Section):
    """``[chassis]``: a platonic solid, or the spikes of another convex body."""

    shape: str | None = None
    edge_length_m: Positive | None = None
    vertices_m: Annotated[tuple[Three, ...], Field(min_length=4)] | None = None
    mass_kg: Positive
    inertia_kg_m2: Inertia | None = None
    friction: Positive | None = None


class CmgSection(Section):
    """``[cmg]``: the CMG, fixed in the chassis."""

    momentum_Nms: Positive
    rate_limit_rad_s: Positive
    acceleration_limit_rad_s2: Positive
    gimbal_axis: Three | None = None
    spin_axis: Three = (1.0, 0.0, 0.0)
    inertia_kg_m2: _Spread = (0.0, 0.0, 0.0)
    rotor_inertia_kg_m2: NotNegative = 0.0
    rotor_speed_rad_s: NotNegative = 0.0


class WheelsSection(Section):
    """``[wheels]``: three equal reaction wheels in place of a CMG."""

    inertia_kg_m2: Positive
    speed_limit_rad_s: Positive | None = None
    torque_limit_Nm: Positive | None = None


class SiteSection(Section):
    """``[site]``: where a step is made."""

    gravity_m_s2: Positive = MARS
    incline_deg: _Slope = 0.0
    heading_deg: float = 0.0


class StepSection(Section):
    """``[step]``: over which edge, and how."""

    edge: Annotated[int, Field(ge=1)] = 1
    face: Annotated[int, Field(ge=0)] | None = None
    motion: Literal["planned", "versine"] = "planned"
    versine_rate_rad_s: Positive = 2.0


class PlannerSection(Section):
    """``[planner]``: limits and how to solve; see `Settings`."""

    nodes: _Nodes = (60, 120)
    most_nodes: Annotated[int, Field(ge=10)] = 960
    dense: Annotated[int, Field(ge=1)] = 10
    drop: Positive = 0.02
    regularisation: Positive = 3e-3
    start_durations_s: Annotated[tuple[Positive, ...], Field(min_length=1)] = (2.5, 6.0)
    shortest_s: Positive = 0.5
    longest_s: Positive = 10.0
    acceleration_rad_s2: Positive = 5.0
    authority: Annotated[float, Field(gt=0, lt=1)] = 0.1
    body_rate_rad_s: Positive = 2.0


class ControlSection(Section):
    """``[control]``: gains of the tracking controller, 1/s^2, 1/s and 1/s."""

    kp: Positive = 25.0
    kd: Positive = 10.0
    gimbal: Positive = 200.0


class InitialSection(Section):
    """``[initial]``: a manoeuvre before the step, which brings the gimbal to its start."""

    gimbal_deg: float
    threshold_share: _Share = 0.5


class GroundSection(Section):
    """``[ground]``: a ground by name or file, or its numbers; what is left out is rock's."""

    file: str | None = None
    name: str | None = None
    stiffness_N_m: Positive | None = None
    damping_Ns_m: NotNegative | None = None
    drag_Ns_m: NotNegative | None = None
    friction: NotNegative | None = None


ROVER: dict[str, type[Section]] = {
    "rover": AboutSection,
    "chassis": ChassisSection,
    "cmg": CmgSection,
    "wheels": WheelsSection,
    "site": SiteSection,
    "step": StepSection,
    "planner": PlannerSection,
    "control": ControlSection,
    "initial": InitialSection,
    "ground": GroundSection,
}
"""Sections of a rover file."""
