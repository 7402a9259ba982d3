"""What sizing found: a row for each layout, and which figure rests on what."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass, field
from typing import Any, Literal

import numpy as np

from nullmotion.sizing.requirement import Requirement

Basis = Literal["certified", "sampled"]
_DIGITS = 10


@dataclass
class Certified:
    """An array whose torque is proven for the demand in every direction of the cone.

    Attributes:
        h0_Nms: Momentum of each CMG.
        gimbal_rate_deg_s: Largest gimbal rate: that of the sampled design.
        torque_Nm: Momentum times rate.
        radius: Greatest momentum asked, over one CMG's.
        torque_capability: Torque capability needed within this radius, over momentum times rate.
        constraint: Constraint function.
        certificates: What was proven, ball in ball: radius, torque capability, boxes, seconds.
        proven: Whether all of it was.
        flown: Whether it flew the slews of a check.
        flights: Number of these flights.
        law: Law that flew them: the one that keeps to the constraint, where it knows the array.
        skew_deg: Roof angle; None for a layout without.
        basis: ``certified``.
    """

    h0_Nms: float
    gimbal_rate_deg_s: float
    torque_Nm: float
    radius: float
    torque_capability: float
    constraint: str
    certificates: list[dict[str, Any]]
    proven: bool
    flown: bool = False
    flights: int = 0
    law: str = ""
    skew_deg: float | None = None
    basis: Basis = "certified"


@dataclass
class Row:
    """The smallest array of one layout that meets the requirement when flown.

    Attributes:
        layout: Name of the layout.
        cmgs: Number of CMGs, the one that may fail among them.
        status: ``sized`` or ``cannot``; `reason` then says why.
        law: Law that flies it.
        h0_Nms: Momentum of each CMG, margins included.
        gimbal_rate_deg_s: Largest gimbal rate, margins included.
        skew_deg: Skew or roof angle; None for a layout without.
        torque_Nm: Momentum times rate, what one CMG gives.
        coast_fraction: Share of the slew at constant rate.
        binds: What the array is at the limit of: ``momentum``, ``gimbal rate``.
        flown: Whether it meets the requirement in every flight: search, check, finer steps.
        smaller_by_5_percent: Whether it does with h0, gimbal_rate or both 5 % smaller.
        flights: Number of flights that were flown for this row.
        axes: Number of different axes in the last check, those of the search included.
        check: Its number of slews, and integration steps in a law period.
        start: Where slews begin: the layout's ``home``, or the angles of its ``constraint``.
        start_gimbal_deg: Gimbal angles that the worst slew begins with.
        worst: Slew that the smaller arrays do not fly: axis, failed CMG, momentum held, settling
            time; and those of the smaller arrays, None for never.
        peak_momentum_Nms: Greatest momentum that the slews ask for.
        peak_torque_Nm: Greatest torque that they ask for.
        certified: The certified array, or None; `certified_reason` then says why.
        curve: Least momentum that flies over the gimbal rate.
        tried: Every law, coast and angle that was compared, with its h0^w rate.
        basis: ``sampled``.
    """

    layout: str
    cmgs: int
    status: Literal["sized", "cannot"] = "sized"
    reason: str = ""
    law: str = ""
    h0_Nms: float = np.nan
    gimbal_rate_deg_s: float = np.nan
    skew_deg: float | None = None
    torque_Nm: float = np.nan
    coast_fraction: float = np.nan
    binds: list[str] = field(default_factory=list)
    flown: bool = False
    smaller_by_5_percent: dict[str, bool] = field(default_factory=dict)
    flights: int = 0
    axes: int = 0
    check: dict[str, int] = field(default_factory=dict)
    start: str = ""
    start_gimbal_deg: list[float] = field(default_factory=list)
    worst: dict[str, Any] = field(default_factory=dict)
    peak_momentum_Nms: float = np.nan
    peak_torque_Nm: float = np.nan
    certified: Certified | None = None
    certified_reason: str = ""
    curve: dict[str, list[float]] = field(default_factory=dict)
    tried: list[dict[str, Any]] = field(default_factory=list)
    basis: Basis = "sampled"


@dataclass
class Sizing:
    """The result of sizing.

    Attributes:
        requirement: What was asked for.
        rows: One for each layout, in the order of the requirement.
        complete: False if it was interrupted: layouts are missing.
        seconds: Time it took.
        files: Text of files that fly a row, by layout: scenario and profile.
    """

    requirement: Requirement
    rows: list[Row]
    complete: bool
    seconds: float
    files: dict[str, dict[str, str]] = field(default_factory=dict)

    def __getitem__(self, layout: str) -> Row:
        """Return the row of a layout."""
        return next(row for row in self.rows if row.layout == layout)

    def to_dict(self) -> dict[str, Any]:
        """Return everything as plain records; what is not a number is None."""
        from nullmotion import __version__

        r = self.requirement
        record = {
            "requirement": {"title": r.title, "name": r.name, **_plain(r.source.data)},
            "layouts": [asdict(row) for row in self.rows],
            "complete": self.complete,
            "seconds": round(self.seconds, 3),
            "version": __version__,
        }
        plain: dict[str, Any] = _plain(record)
        return plain

    def to_json(self) -> str:
        """Return everything as JSON."""
        return json.dumps(self.to_dict(), indent=2, allow_nan=False) + "\n"


def _plain(value: Any) -> Any:
    """Return a record of lists, texts and numbers of ten digits; None for what is none."""
    if isinstance(value, dict):
        return {str(k): _plain(v) for k, v in value.items()}
    if isinstance(value, (list, tuple, np.ndarray)):
        return [_plain(v) for v in value]
    if isinstance(value, (bool, np.bool_)):
        return bool(value)
    if isinstance(value, (float, np.floating)):
        return float(f"{value:.{_DIGITS}g}") if np.isfinite(value) else None
    return int(value) if isinstance(value, np.integer) else value
