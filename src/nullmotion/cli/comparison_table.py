"""Comparisons as tables on the screen."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from nullmotion.cli import screen

if TYPE_CHECKING:
    from nullmotion.campaign import Case, Comparison

_COLUMNS = (
    ("Off-axis torque peak [%]", "max_off_axis_torque_fraction", screen.percent),
    ("Along-axis error RMS [%]", "rms_along_axis_torque_fraction", screen.percent),
    ("Rate step [rad/s]", "max_rate_step_rad_s", screen.number),
    ("Least sigma_min", "min_sigma_min", screen.number),
    ("Reserve [N m s]", "final_momentum_reserve_Nms", screen.number),
)
_ATTITUDE = (
    ("Settling time [s]", "settling_time_s", screen.number),
    ("Final pointing error [deg]", "final_pointing_error_deg", screen.number),
    ("Peak motor torque [N m]", "max_motor_torque_Nm", screen.number),
    ("Rates saturated [s]", "rate_saturated_s", screen.number),
    ("Least sigma_min", "min_sigma_min", screen.number),
    ("Gimbal travel [rad]", "gimbal_travel_rad", screen.number),
)
_STARTUP = (
    *_ATTITUDE[:2],
    ("Wheels settled [s]", "wheel_settling_s", screen.number),
    ("Wheel error [%]", "final_wheel_speed_error", screen.percent),
)
_VARIED = (
    ("time to stop [s]", "stopped_at_s", screen.number),
    ("off-axis torque, peak [%]", "max_off_axis_torque_fraction", screen.percent),
    ("least sigma_min", "min_sigma_min", screen.number),
)
_VARIED_ATTITUDE = (
    ("settling time [s]", "settling_time_s", screen.settling),
    ("final pointing error [deg]", "final_pointing_error_deg", screen.number),
    ("least sigma_min", "min_sigma_min", screen.number),
)
_VARIED_STARTUP = (
    *_VARIED_ATTITUDE[:2],
    ("wheels settled [s]", "wheel_settling_s", screen.settling),
    ("final wheel speed error [%]", "final_wheel_speed_error", screen.percent),
    *_VARIED_ATTITUDE[2:],
)
_MOST_VALUES = 12  # of a varied key in a table on the screen


def tables(comparison: Comparison) -> list[Any]:
    """Return the tables of a comparison: one, or one a metric over the varied values."""
    if comparison.varied is None:
        return [_single(comparison)]
    chosen = _by_kind(comparison, _VARIED, _VARIED_ATTITUDE, _VARIED_STARTUP)
    return [_varied(comparison, *column) for column in chosen]


def _by_kind(comparison: Comparison, momentum: Any, attitude: Any, startup: Any) -> Any:
    kinds = {"attitude": attitude, "startup": startup}
    return kinds.get(comparison.scenario.mission.kind, momentum)


def _single(comparison: Comparison) -> Any:
    columns = _by_kind(comparison, _COLUMNS, _ATTITUDE, _STARTUP)
    required = comparison.scenario.requirements is not None
    head = ["Case", "Parameters", "Result", *(title for title, _, _ in columns)]
    rows = [_row(case, columns) for case in comparison.cases]
    if required:
        head.append("Required")
        rows = [[*row, _passed(case)] for row, case in zip(rows, comparison.cases, strict=True)]
    numeric = range(3, len(head))
    head.append("Information used")
    rows = [
        [*row, ", ".join(case.information) or "-"]
        for row, case in zip(rows, comparison.cases, strict=True)
    ]
    made = screen.table(comparison.title, head, rows, numeric=numeric)
    for column in made.columns[:3]:
        column.no_wrap = True
    made.caption, made.caption_justify = _caption(comparison), "left"
    return made


def _caption(comparison: Comparison) -> str:
    reasons = {
        c.trajectory.stop_reason
        for c in comparison.cases
        if c.trajectory and c.trajectory.stopped_at_s is not None
    }
    stops = f"Stopped: {' or '.join(sorted(reasons))}. " if reasons else ""
    refused = [
        f"{c.label} could not run: {c.reason}." for c in comparison.cases if c.trajectory is None
    ]
    stuck = any(event.kind == "stuck" for event in comparison.scenario.events)
    counted = " A stuck CMG does not count." if stuck else ""
    measure = f"sigma_min is that of A over the mean momentum.{counted}"
    if comparison.scenario.mission.kind == "startup":
        measure = "Wheel error: how far a wheel's speed is from that of the design, at the end."
    return " ".join([f"{stops}{measure}", *refused])


def _row(case: Case, columns: Sequence[Any]) -> list[str]:
    numbers = [written(case.metrics.get(key)) for _, key, written in columns]
    return [case.label, case.parameters_kind, result(case), *numbers]


def _passed(case: Case) -> str:
    results = case.summary.get("requirements", ())
    return f"{sum(r['passed'] for r in results)}/{len(results)}" if results else "-"


def result(case: Case) -> str:
    """Return in a few words how a case went."""
    run = case.trajectory
    if run is None:
        return "could not run"
    from nullmotion.plot.quantities import stuck_since

    if "non-finite" in run.status:
        return "not finite"
    if run.q_BN is not None and run.stopped_at_s is None:
        return _settled(case)
    since = None if run.q_BN is not None else stuck_since(run)  # type: ignore[arg-type]
    if since is not None:
        return f"stuck from {since:.3g} s"
    return (
        f"ran {run.t[-1]:.4g} s"
        if run.stopped_at_s is None
        else f"stopped {run.stopped_at_s:.4g} s"
    )


def _settled(case: Case) -> str:
    """Return whether an attitude settled, and in a startup the wheels."""
    attitude = case.metrics.get("settling_time_s")
    if attitude != attitude:
        return screen.NOT_SETTLED
    wheels = case.metrics.get("wheel_settling_s")
    return "wheels off speed" if wheels != wheels else "settled"


def _varied(comparison: Comparison, title: str, key: str, written: Any) -> Any:
    labels = list(dict.fromkeys(case.label for case in comparison.cases))
    step = -(-len(comparison.values) // _MOST_VALUES)
    shown = [comparison.values[i] for i in range(0, len(comparison.values), step)]
    cells = {(c.label, str(c.value)): written(c.metrics.get(key)) for c in comparison.cases}
    rows = [(label, *(cells.get((label, str(v)), "-") for v in shown)) for label in labels]
    more = f" (1 of {step} values shown, all in compare.json)" if step > 1 else ""
    head = (comparison.varied or "", *(str(v) for v in shown))
    return screen.table(
        f"{comparison.title}: {title}{more}", head, rows, numeric=range(1, 1 + len(shown))
    )
