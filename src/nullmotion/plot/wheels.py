"""The charts that a run has when its wheel speeds change."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from nullmotion.plot import palette
from nullmotion.plot.parts import bundle, limited
from nullmotion.plot.quantities import cmg_names, finite, turns_wheels, wheel_tolerance
from nullmotion.plot.view import Curve, Level, Panel, Run
from nullmotion.scenario import vscmg_summary
from nullmotion.scenario.estimates import estimates
from nullmotion.sim.wheel_summary import spans

_NEAR = 0.004  # share of the run below which two shaded spans are drawn as one
_MOST = 200  # shaded spans in a chart
_CLOSE = 1.15  # speed limit over design speed below which both lines have one name
_LEAST = 1e-7  # relative speed errors below are nobody's and would only stretch the axis
_SUPERSCRIPTS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
_SHADED = "Shaded: a limit cut the torque that was asked for."
_SHOWN = ("torque", "wheel_torques", "wheel_speeds", "rates", "pointing_error")
_ESTIMATED = {
    "inertia": ("Estimated inertia", "Entries of the constant part; Js-Jt of each unit."),
    "unit_inertia": ("Estimated unit inertias", "As they act through the gimbal rates."),
    "outside_torque": ("Estimated outside torque", "In B, from zero."),
}


def wheel_speeds(run: Run) -> Panel:
    """Wheel speeds with those that the array was designed for."""
    curves = bundle(run.t, run.wheel_speed, cmg_names(run))
    array, words = run.setup.array, "rad/s"
    aims, most = finite(array.design_speed), finite(array.flywheels.speed_limit)
    levels = tuple(Level(aim, f"design {aim:.4g} {words}", "dash") for aim in aims)
    panel = Panel("wheel_speeds", "Wheel speeds", f"Speed [{words}]", curves, levels)
    if len(aims) == len(most) == 1 and most[0] < _CLOSE * aims[0]:  # names would overlap
        name = f"limit {most[0]:.4g}, design {aims[0]:.4g} {words}"
        return replace(panel, levels=(Level(aims[0], "", "dash"), Level(most[0], name)))
    return limited(panel, most, words)


def wheel_errors(run: Run) -> Panel:
    """How far the wheels are from their speeds, as shares."""
    curves = bundle(run.t, _errors(run), cmg_names(run))
    allowed = wheel_tolerance(run)
    levels = () if allowed is None else (Level(100 * allowed, f"tolerance {100 * allowed:.3g} %"),)
    title, y_title = "Wheel speed errors", "Share of design speed [%]"
    return Panel("wheel_errors", title, y_title, curves, levels, log=True)


def largest_wheel_error(run: Run) -> np.ndarray:
    """Return the largest of the wheels' relative speed errors [%], (k,); none without wheels."""
    if not turns_wheels(run):
        return np.full(len(run.t), np.nan)
    largest: np.ndarray = np.nanmax(_errors(run), axis=1)
    return largest


def _errors(run: Run) -> np.ndarray:
    """Return the wheels' relative speed errors for a logarithmic axis [%], (k, n)."""
    aim = np.asarray(run.setup.array.design_speed, float)
    share = np.abs(run.wheel_speed / np.where(aim > 0, aim, np.nan) - 1.0)
    found: np.ndarray = 100.0 * np.maximum(share, _LEAST)
    return found


def wheel_torques(run: Run) -> Panel:
    """Torques of the wheel motors with their limits."""
    curves = bundle(run.t, run.wheel_motor_torque, cmg_names(run))
    panel = Panel("wheel_torques", "Wheel motor torques", "Torque [N m]", curves)
    return limited(panel, finite(run.setup.array.flywheels.torque_limit), "N m")


def lyapunov(run: Run) -> Panel:
    """Lyapunov's function of the adaptive controller with its bound; no curves of another.

    From its value at the start on: most of that is what is not known yet, and stays.
    """
    title, y_title = "Lyapunov's function", "V − V(0) [N m]"
    found: Any = vscmg_summary.monitored(run)  # type: ignore[arg-type]
    if found is None:
        return Panel("lyapunov", title, y_title, ())
    start = found.V[0]
    curves = (
        Curve("V", found.t, found.V - start, palette.colour(0)),
        Curve("bound", found.t, found.bound - start, palette.colour(1), "dash"),
    )
    note = f"V(0) is {start:.3g} N m. V stays below its bound while the theorem's assumptions hold."
    return Panel("lyapunov", title, y_title, curves, note=note)


def learned(run: Run) -> list[Panel]:
    """Estimates of the controller, one chart a kind."""
    made = []
    for kind, (names, unit, values) in estimates(run).items():  # type: ignore[arg-type]
        title, note = _ESTIMATED.get(kind, ("State of the controller", ""))
        power = _power(values)
        scale = f"10{str(power).translate(_SUPERSCRIPTS)} " if power else ""
        y_title = f"Estimate [{scale}{'-' if unit == '1' else unit.replace('m2', 'm²')}]"
        curves = bundle(run.t, values / 10.0**power, [_counted(name) for name in names])
        made.append(Panel(f"estimated_{kind}", title, y_title, curves, note=note))
    return made


def _power(values: np.ndarray) -> int:
    """Return the power of a thousand that makes the largest value readable."""
    largest = float(np.max(np.abs(values), initial=0.0, where=np.isfinite(values)))
    return 0 if largest == 0 or largest >= 0.1 else 3 * int(np.floor(np.log10(largest) / 3))


def shaded(panels: Sequence[Panel], run: Run) -> list[Panel]:
    """Return charts over time with the spans in which torque was cut."""
    if not turns_wheels(run) or not np.any(run.limited > 0):
        return list(panels)
    found = _joined(spans(run.t, run.limited[:-1] > 0), float(run.t[-1]))
    return [
        replace(panel, spans=found, note=" ".join(filter(None, [panel.note, _SHADED])))
        if panel.key in _SHOWN
        else panel
        for panel in panels
    ]


def _joined(found: Sequence[tuple[float, float]], end: float) -> tuple[tuple[float, float], ...]:
    """Return spans of which those near each other are one."""
    near, joined = _NEAR * end, list(found)
    while True:
        merged = joined[:1]
        for start, stop in joined[1:]:
            if start - merged[-1][1] < near:
                merged[-1] = (merged[-1][0], stop)
            else:
                merged.append((start, stop))
        if len(merged) <= _MOST:
            return tuple(merged)
        near, joined = 2.0 * near, merged


def _counted(name: str) -> str:
    """Return a name with its CMG counted from 1, as charts do."""
    head, underscore, index = name.rpartition("_")
    return f"{head} {int(index) + 1}" if underscore and index.isdigit() else name.replace("_", " ")
