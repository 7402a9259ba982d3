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
_VARIED = (
    ("time to stop [s]", "stopped_at_s", screen.number),
    ("off-axis torque, peak [%]", "max_off_axis_torque_fraction", screen.percent),
    ("least sigma_min", "min_sigma_min", screen.number),
)
_MOST_VALUES = 12  # of a varied key in a table on the screen


def tables(comparison: Comparison) -> list[Any]:
    """Return the tables of a comparison: one, or one a metric over the varied values."""
    if comparison.varied is None:
        return [_single(comparison)]
    return [_varied(comparison, *column) for column in _VARIED]


def _single(comparison: Comparison) -> Any:
    head = (
        "Case",
        "Parameters",
        "Result",
        *(title for title, _, _ in _COLUMNS),
        "Information used",
    )
    rows = [_row(case) for case in comparison.cases]
    made = screen.table(comparison.title, head, rows, numeric=range(3, 3 + len(_COLUMNS)))
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
    return " ".join([f"{stops}sigma_min is that of A over the mean momentum.", *refused])


def _row(case: Case) -> Sequence[str]:
    numbers = [written(case.metrics.get(key)) for _, key, written in _COLUMNS]
    return (
        case.label,
        case.parameters_kind,
        result(case),
        *numbers,
        ", ".join(case.information) or "-",
    )


def result(case: Case) -> str:
    """Return in a few words how a case went."""
    run = case.trajectory
    if run is None:
        return "could not run"
    from nullmotion.plot.quantities import stuck_since

    since = stuck_since(run)  # type: ignore[arg-type]
    if "non-finite" in run.status:
        return "not finite"
    if since is not None:
        return f"stuck from {since:.3g} s"
    return (
        f"ran {run.t[-1]:.4g} s"
        if run.stopped_at_s is None
        else f"stopped {run.stopped_at_s:.4g} s"
    )


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
