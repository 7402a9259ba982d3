"""What a page says of a run whose wheel speeds change."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from nullmotion.plot.quantities import finite, turns_wheels, wheel_tolerance
from nullmotion.plot.view import Run
from nullmotion.report.tiles import Tile
from nullmotion.report.wording import number, percent
from nullmotion.scenario import vscmg_summary
from nullmotion.sim import wheel_summary

INCOMPLETE = "startup-incomplete"
_LIMITS = {
    "gimbal_rate": "gimbal rates at their limit",
    "gimbal_torque": "gimbal motors at their torque limit",
    "wheel_torque": "wheel motors at their torque limit",
    "wheel_power": "wheel motors at their power limit",
    "wheel_speed": "wheels at their speed limit",
    "torque": "torque cut",
}


def wheel_tiles(run: Run) -> list[Tile]:
    """Return the key numbers of the wheels; none where their speeds are constant."""
    if not turns_wheels(run):
        return []
    return [tile for tile in (_settling(run), _torque(run)) if tile is not None]


def _settling(run: Run) -> Tile | None:
    allowed, at = wheel_tolerance(run), run.metrics.get("wheel_settling_s")
    if allowed is None or at is None:
        return None
    note = f"within {percent(allowed)} % of design for good"
    if not np.isfinite(at):
        return Tile("Wheels at speed", "not reached", "", note)
    return Tile("Wheels at speed", number(at), "s", note)


def _torque(run: Run) -> Tile | None:
    if not np.isfinite(run.wheel_motor_torque).any():
        return None
    largest = float(np.nanmax(np.abs(run.wheel_motor_torque)))
    limits = finite(run.setup.array.flywheels.torque_limit)
    note = f"{percent(largest / limits[0])} % of the limit" if limits else "no limit set"
    return Tile("Peak wheel motor torque", number(largest, 3), "N m", note)


def wheel_findings(run: Run, told: Mapping[str, Any] | None = None) -> Iterator[str]:
    """Yield sentences on what was limited, on the momentum budget and on Lyapunov's function.

    Args:
        run: A run with variable wheel speeds.
        told: What `nullmotion.scenario.vscmg_summary.summary` returns; only with it the
            budget is known.
    """
    limits = [_limit(name, when) for name, when in wheel_summary.limits(run).items()]
    yield f"Limited: {'; '.join(limits)}" if limits else "Nothing was limited"
    budget = (told or {}).get("momentum_budget")
    if budget and budget["needed_Nms"] > 0:
        needed, held = number(budget["needed_Nms"], 3), number(budget["available_Nms"], 3)
        yield (
            f"Momentum to hold at the end: {needed} N m s, of at most {held} N m s that the array "
            f"holds in that direction at its design speeds"
        )
    monitor = vscmg_summary.monitored(run)  # type: ignore[arg-type]
    if monitor is not None:
        yield monitor.words().rstrip(".")


def _limit(name: str, when: Mapping[str, Any]) -> str:
    first, last, share = number(when["first_s"]), number(when["last_s"]), percent(when["share"])
    time = f"at {first} s" if first == last else f"{first} to {last} s"
    which = [str(i + 1) for i in when.get("cmgs", ())]
    of = f" (CMG {', '.join(which)})" if which else ""
    return f"{_LIMITS[name]}{of} {time}, {share} % of the run"


def incomplete(run: Run) -> str:
    """Return what is missing of a startup, in words; empty if nothing is.

    Wheels that begin off their speeds and never come there count as one, whatever it is called.
    """
    if not turns_wheels(run):
        return ""
    told = INCOMPLETE in run.status
    late = np.isnan(run.metrics.get("wheel_settling_s", 0.0))
    if not told and not (late and _off(run, 0) > (wheel_tolerance(run) or np.inf)):
        return ""
    head = "Startup incomplete: wheels" if told else "Wheels not at speed:"
    return f"{head} off by up to {percent(_off(run, -1))} %"


def _off(run: Run, row: int) -> float:
    """Return the largest relative error of a wheel's speed in a row."""
    aim = np.asarray(run.setup.array.design_speed, float)
    off = np.abs(run.wheel_speed[row] - aim) / np.where(aim > 0, aim, np.inf)
    return float(np.max(off))


def at_speed(run: Run) -> str:
    """Return since when the wheels are at their speeds, in words; empty where always or never."""
    at = run.metrics.get("wheel_settling_s", 0.0) if turns_wheels(run) else 0.0
    return f"wheels at speed in {number(at)} s" if np.isfinite(at) and at > 0 else ""
