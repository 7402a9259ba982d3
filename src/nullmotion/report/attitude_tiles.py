"""The key numbers of a run that turns a spacecraft."""

from __future__ import annotations

import numpy as np

from nullmotion.plot.quantities import (
    final_error_deg,
    motor_limits,
    tolerance_deg,
    turns_wheels,
)
from nullmotion.plot.view import Run
from nullmotion.report.tiles import Tile, least_sigma
from nullmotion.report.wheels import wheel_tiles
from nullmotion.report.wording import number, percent, quantity


def attitude_tiles(run: Run) -> list[Tile]:
    """Return the key numbers of an attitude run."""
    made = [
        _settling(run),
        _error(run),
        *wheel_tiles(run),
        _body_rate(run),
        _motor(run),
        _saturated(run),
        least_sigma(run),
        _travel(run),
    ]
    return [tile for tile in made if tile is not None]


def _settling(run: Run) -> Tile | None:
    key, allowed = "settling_time_s", tolerance_deg(run)
    if allowed is None or key not in run.metrics:
        return None
    value, unit = quantity(run.metrics[key], "s", key)
    return Tile("Settling time", value, unit, f"within {number(allowed)} deg for good")


def _error(run: Run) -> Tile:
    error = final_error_deg(run)
    at = f"at {number(run.t[-1])} s"
    note = f"{number(3600 * error, 3)} arcsec {at}" if error < 0.1 else at
    return Tile("Final pointing error", number(error, 3), "deg", note)


def _body_rate(run: Run) -> Tile:
    rate = np.degrees(np.linalg.norm(run.omega_BN_B, axis=1))
    largest = run.metrics.get("max_body_rate_deg_s", np.nanmax(rate, initial=0.0))
    at = f"at {number(run.t[int(np.nanargmax(rate))])} s" if np.isfinite(rate).any() else ""
    return Tile("Peak body rate", number(largest), "deg/s", at)


def _motor(run: Run) -> Tile | None:
    largest = run.metrics.get("max_motor_torque_Nm")
    if largest is None:
        return None
    limits = motor_limits(run)
    note = f"{percent(largest / limits[0])} % of the limit" if limits else "no limit set"
    name = "Peak gimbal motor torque" if turns_wheels(run) else "Peak motor torque"
    return Tile(name, number(largest, 3), "N m", note)


def _saturated(run: Run) -> Tile | None:
    beyond = run.metrics.get("rate_saturated_s")
    if beyond is None:
        return None
    note = f"{percent(beyond / run.t[-1])} % of {number(run.t[-1])} s"
    return Tile("Rate-saturated", number(beyond), "s", note)


def _travel(run: Run) -> Tile | None:
    travel = run.metrics.get("gimbal_travel_rad")
    if travel is None:
        return None
    return Tile("Gimbal travel", number(travel), "rad", f"{number(np.degrees(travel))} deg, all")
