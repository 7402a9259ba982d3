"""What a search gives back."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass, field
from typing import Any

import numpy as np

Knots = tuple[float, ...]


@dataclass
class Found:
    """What a method finds.

    Attributes:
        knots: The course, in units of k_max.
        value: Its value.
        proven: Whether no course of the levels searched is better.
        rollouts: Whole runs simulated, parts of runs added up.
        ties: Other courses of the same value, to one part in 1e9.
        ties_complete: Whether these are all.
        certificate: What proves it, as counts and bounds.
        remarks: What has to be said.
        delta: Start angles [rad] where the method chooses them.
    """

    knots: Knots
    value: float
    proven: bool
    rollouts: float
    ties: list[Knots] = field(default_factory=list)
    ties_complete: bool = True
    certificate: dict[str, Any] = field(default_factory=dict)
    remarks: list[str] = field(default_factory=list)
    delta: np.ndarray | None = None


@dataclass
class PlanResult(Found):
    """A plan: what was found, beside what it was found for.

    Attributes:
        method: How it was searched.
        baseline_value: Value without null motion.
        depth: Number of knots.
        levels: Values of a knot; None where it is continuous.
        k_max: Unit of the knots [rad/s].
        duration_s: Time from the first knot to the last [s].
        lag: Whether the null vector is that of the sample before.
        law: Law under the null motion.
        cost: Name of the cost.
        cost_parameters: Its parameters.
        parts: What the value is made of.
        baseline_parts: And without null motion.
        seconds: Time of the search.
        compile_seconds: Time to compile the manoeuvre before it.
    """

    method: str = ""
    baseline_value: float = float("nan")
    depth: int = 0
    levels: int | None = None
    k_max: float = float("nan")
    duration_s: float = float("nan")
    lag: bool = False
    law: str = ""
    cost: str = ""
    cost_parameters: dict[str, Any] = field(default_factory=dict)
    parts: dict[str, float] = field(default_factory=dict)
    baseline_parts: dict[str, float] = field(default_factory=dict)
    seconds: float = 0.0
    compile_seconds: float = 0.0

    @property
    def gain(self) -> float:
        """Gain in value over no null motion, as a fraction of its size; NaN if that is 0."""
        base = self.baseline_value
        return (self.value - base) / abs(base) if base and np.isfinite(base) else float("nan")

    def to_dict(self) -> dict[str, Any]:
        """Return the plan as ``plan.json`` holds it; what is not finite is None."""
        record = asdict(self) | {"gain": self.gain}
        delta = record.pop("delta")
        if delta is not None:
            record["gimbal_deg"] = np.degrees(delta).tolist()
        plain: dict[str, Any] = _plain(record)
        return plain

    def to_json(self) -> str:
        """Return the text of ``plan.json``."""
        return json.dumps(self.to_dict(), indent=2, allow_nan=False) + "\n"


def _plain(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _plain(v) for key, v in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(v) for v in value]
    if isinstance(value, (float, np.floating)):
        return float(value) if np.isfinite(value) else None
    return value.item() if isinstance(value, np.generic) else value
