"""The sections of a requirement file as pydantic models; keys and units are those of the file."""

from __future__ import annotations

from functools import cache
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Discriminator, Field, Tag, create_model

from nullmotion.array import layouts
from nullmotion.scenario.schema import NotNegative, Pair, Positive, Section, Three, sized
from nullmotion.scenario.schema_spacecraft import Inertia

NOT_SIZED = ("planar", "triangle")  # torque in two dimensions only
DEFAULT_LAYOUTS = ("box90", "roof", "roof6", "pyramid")


def _is_list(value: Any) -> str:
    return "list" if isinstance(value, tuple) else "one"


_Angle = Annotated[float, Field(gt=0, lt=90)]
_Two = BeforeValidator(sized(2))
_Bias = Annotated[
    Annotated[NotNegative, Tag("one")] | Annotated[Three, Tag("list")], Discriminator(_is_list)
]
_Range = Annotated[
    Annotated[Positive, Tag("one")] | Annotated[Pair, _Two, Tag("list")], Discriminator(_is_list)
]
_Angles = Annotated[
    Annotated[_Angle, Tag("one")] | Annotated[tuple[_Angle, _Angle], _Two, Tag("list")],
    Discriminator(_is_list),
]
_Names = Annotated[
    Annotated[str, Tag("one")]
    | Annotated[Annotated[tuple[str, ...], Field(min_length=1)], Tag("list")],
    Discriminator(_is_list),
]
_Share = Annotated[float, Field(ge=0, le=1)]


class AboutSection(Section):
    """``[requirement]``: what it is about."""

    title: str = ""
    description: str = ""


class BodySection(Section):
    """``[spacecraft]``: what is turned; the inertia holds everything on board."""

    inertia_kg_m2: Inertia


class SlewSection(Section):
    """``[slew]``: from rest to rest about any axis of a cone in body frame B."""

    angle_deg: Annotated[float, Field(gt=0, le=180)]
    time_s: Positive
    axis: Three = (0.0, 0.0, 1.0)
    cone_half_angle_deg: Annotated[float, Field(ge=0, le=180)] = 180.0
    coast_fraction: Annotated[float, Field(ge=0, le=0.9)] | None = None
    smoothing: _Share = 0.5


class SettlingSection(Section):
    """``[settling]``: what counts as settled, and the time for it beside the slew's."""

    pointing_error_deg: Positive = 0.1
    body_rate_deg_s: Positive = 0.2
    time_s: NotNegative = 0.0


class DisturbanceSection(Section):
    """``[disturbance]``: momentum that the array holds beside the slew, torque from outside."""

    momentum_Nms: _Bias = 0.0
    torque_Nm: Three | None = None


class FailureSection(Section):
    """``[failure]``: how many CMGs may have failed, whichever it is."""

    failed_cmgs: Literal[0, 1] = 0


class MarginSection(Section):
    """``[margin]``: shares of the demand that the array has beyond what it needs."""

    momentum: NotNegative = 0.0
    torque: NotNegative = 0.0


class ArraysSection(Section):
    """``[array]``: what may be chosen."""

    layouts: Annotated[tuple[str, ...], Field(min_length=1)] = DEFAULT_LAYOUTS
    gimbal_rate_deg_s: _Range = (10.0, 120.0)
    skew_deg: _Angles = (20.0, 70.0)
    momentum_weight: Positive = 2.0


class LawsSection(Section):
    """``[law]``: laws to fly, by layout; and their sampling period."""

    period_s: Positive | None = None


class FeedbackSection(Section):
    """``[controller]``: the `tracking` controller's response."""

    natural_frequency_rad_s: Positive | None = None
    damping: Positive = 1.0


class SamplingSection(Section):
    """``[sampling]``: slew axes that are flown in the search and in the check."""

    axes: Annotated[int, Field(ge=6, le=100_000)] = 300
    check_axes: Annotated[int, Field(ge=6, le=1_000_000)] = 3000


def layout_names() -> list[str]:
    """Return the layouts that can be sized: those with torque in three dimensions."""
    return [name for name in layouts.names() if name not in NOT_SIZED]


@cache
def laws_model() -> type[LawsSection]:
    """Return the model of ``[law]``: a key for each layout."""
    fields: Any = dict.fromkeys(layout_names(), (_Names | None, None))
    made: type[LawsSection] = create_model("LawsSection", __base__=LawsSection, **fields)
    return made


@cache
def models() -> dict[str, type[Section]]:
    """Return the model of each section by name."""
    return {
        "requirement": AboutSection,
        "spacecraft": BodySection,
        "slew": SlewSection,
        "settling": SettlingSection,
        "disturbance": DisturbanceSection,
        "failure": FailureSection,
        "margin": MarginSection,
        "array": ArraysSection,
        "law": laws_model(),
        "controller": FeedbackSection,
        "sampling": SamplingSection,
    }
