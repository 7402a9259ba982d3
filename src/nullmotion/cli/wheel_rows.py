"""What the screen says of a run whose wheel speeds change."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from nullmotion.cli import screen

if TYPE_CHECKING:
    from nullmotion.scenario import Scenario
    from nullmotion.sim import Trajectory

WORDS = {
    "gimbal_rate": "gimbal rate",
    "gimbal_torque": "gimbal torque",
    "wheel_torque": "wheel torque",
    "wheel_power": "wheel power",
    "wheel_speed": "wheel speed",
    "torque": "torque cut",
}


def rows(trajectory: Trajectory, scenario: Scenario) -> list[tuple[str, str]]:
    """Return wheel speeds, what was limited and when, and the momentum budget."""
    from nullmotion.scenario import vscmg_summary

    found = vscmg_summary.summary(trajectory, scenario)
    settled = screen.settling(_number(found["wheels"]["wheel_settling_s"]))
    speeds = screen.vector(found["wheels"]["final_speed_rad_s"])
    made = [
        ("Wheels settled", settled if settled == screen.NOT_SETTLED else f"{settled} s"),
        ("Final wheel speeds", f"{speeds} rad/s"),
        ("Peak wheel motor torque", _peak(trajectory)),
        ("Limited", "; ".join(_limited(found["limited"])) or "nothing"),
    ]
    if "momentum_budget" in found:
        made.append(("Momentum budget", _budget(found["momentum_budget"])))
    return made


def _number(value: float | None) -> float:
    return float("nan") if value is None else value


def _peak(trajectory: Trajectory) -> str:
    import numpy as np

    torque = trajectory.wheel_motor_torque
    assert torque is not None
    known = np.abs(torque[np.isfinite(torque)])
    return screen.number(float(known.max()) if known.size else None) + " N m"


def _limited(found: dict[str, Any]) -> Iterator[str]:
    for name, when in found.items():
        first, last = screen.number(when["first_s"]), screen.number(when["last_s"])
        time = f"at {first} s" if first == last else f"{first} to {last} s"
        yield f"{WORDS[name]} {time} ({screen.percent(when['share'])} %)"


def _budget(found: dict[str, Any]) -> str:
    needed, available = (screen.number(found[k]) for k in ("needed_Nms", "available_Nms"))
    return f"{needed} of at most {available} N m s at design speeds"
