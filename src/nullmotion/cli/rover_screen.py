"""Steps and trips of a rover as tables on the screen."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import typer

from nullmotion.cli import screen

if TYPE_CHECKING:
    from nullmotion.rover.files import StepFile
    from nullmotion.rover.mission_run import MissionResult
    from nullmotion.rover.rover_run import StepResult, WheelPlan
    from nullmotion.rover.step_plan import StepPlan
    from nullmotion.rover.versine import Verdict

_PLAN = (
    ("Duration [s]", "duration_s"),
    ("Least margin [N m]", "least_margin_Nm"),
    ("Energy [J]", "energy_J"),
    ("Cost of travel [J/(kg m)]", "cost_of_travel_J_kg_m"),
    ("Sign of o.r", "branch"),
    ("Gimbal at the start [deg]", "start_gimbal_deg"),
    ("Greatest gimbal rate [rad/s]", "max_gimbal_rate_rad_s"),
    ("Greatest body rate [rad/s]", "max_body_rate_rad_s"),
    ("Planned in [s]", "seconds"),
)
_RUN = (
    ("Outcome", "outcome"),
    ("Duration [s]", "duration_s"),
    ("Least margin [N m]", "least_margin_Nm"),
    ("Largest angle error [rad]", "max_angle_error_rad"),
    ("Energy [J]", "energy_J"),
    ("Cost of travel [J/(kg m)]", "cost_of_travel_J_kg_m"),
    ("Energy balance, relative error", "energy_balance"),
    ("Slip [mm]", "slip_mm"),
    ("Off-axis tilt [deg]", "tilt_deg"),
)
_WHEELS = (
    ("Outcome", "outcome"),
    ("Energy [J]", "energy_J"),
    ("Cost of travel [J/(kg m)]", "cost_of_travel_J_kg_m"),
    ("Fastest wheel [rad/s]", "wheel_speed_rad_s"),
    ("Duration [s]", "duration_s"),
)
_TRIP = (
    ("Steps", "steps"),
    ("Way [m]", "distance_m"),
    ("As the crow flies [m]", "straight_m"),
    ("From the goal at the end [m]", "miss_m"),
    ("Duration without spin-up [s]", "duration_s"),
    ("Energy of the steps [J]", "step_energy_J"),
    ("Drag on the rotor [J]", "drag_energy_J"),
    ("Spin-up [J]", "spin_up_energy_J"),
    ("Least margin [N m]", "least_margin_Nm"),
    ("Steepest climb [deg]", "steepest_climb_deg"),
    ("Steepest descent [deg]", "steepest_descent_deg"),
    ("Searches of the path", "searches"),
)


def show_plan(file: StepFile, plan: StepPlan | WheelPlan, verdict: Verdict | None) -> None:
    """Print a plan's key numbers."""
    from nullmotion.rover import rover_run_summary as summary
    from nullmotion.rover.rover_run import WheelPlan

    if isinstance(plan, WheelPlan):
        found = summary.of_wheels(plan)
        heads = ("Quantity", "Impulsive", "Versine")
        _print(_title(file), heads, _side_by_side(_WHEELS, found.values()))
        _remark(plan.versine.verdict)
        return
    found = summary.of_plan(plan, verdict)
    rows = [(words, screen.number(found[key])) for words, key in _PLAN if found[key] != 0.0]
    _print(_title(file), ("Quantity", "Value"), rows)
    _remark(verdict)


def show_run(result: StepResult) -> None:
    """Print plan, closed loop and landing side by side, and what happened."""
    from nullmotion.rover import rover_run_summary as summary

    ground = summary.of_landing(result.landing)
    found = (
        summary.of_plan(result.plan, result.verdict),
        summary.of_run(result.run),
        {**ground, "duration_s": ground["landed_at_s"]},
    )
    name = result.landing.ground.name
    heads = ("Quantity", "Plan", "Closed loop", f"On the ground ({name})")
    _print(_title(result.file), heads, _side_by_side(_RUN, found))
    if result.initialisation is not None:
        way = summary.of_initialisation(result.initialisation)
        typer.echo(
            f"Gimbal brought from {way['from_deg']:.4g} to {way['to_deg']:.4g} deg in "
            f"{way['duration_s']:.3g} s; {way['least_spare_Nm']:.3g} N m to spare of the static "
            f"threshold of {way['static_threshold_Nm']:.3g} N m"
        )
    rows = [
        (f"{e.t:.4f}", e.kind, "-" if e.spike is None else str(e.spike), f"{e.size:.3g} {e.unit}")
        for e in result.landing.events
    ]
    _print("On the ground", ("Time [s]", "Event", "Spike", "Size"), rows)
    _remark(result.verdict)


def show_mission(result: MissionResult) -> None:
    """Print a trip, and what it costs beside rovers with wheels."""
    found = result.travel.summary()
    rows = [(words, screen.number(found[key])) for words, key in _TRIP]
    _print(result.file.title, ("Quantity", "Value"), rows)
    if result.trips is None:
        typer.echo("No step was needed.")
        return
    name, made = result.file.rover.name, result.travel
    costs = [
        (f"{name}, steps alone", made.step_cost, None),
        (f"{name}, this trip with rotor upkeep and spin-up", made.cost_of_travel, None),
        *((f"{name}, {D:,.0f} m", cost, None) for D, cost in result.costs().items()),
        *((_wheels(t), t.cost_of_travel, t.break_even) for t in result.wheels),
    ]
    cells = [(words, *map(screen.number, values)) for words, *values in costs]
    heads = ("Rover", "Cost of travel [J/(kg m)]", f"{name} costs less from [m]")
    _print("Cost of travel on the same slopes", heads, cells)


def _wheels(trip: Any) -> str:
    left_out = f", {100 * trip.refused:.3g} % of the steps too steep for it" if trip.refused else ""
    return f"{trip.rover}, impulsive steps{left_out}"


def _title(file: StepFile) -> str:
    from math import degrees

    place = f"{degrees(file.site.incline):.4g} deg, {file.site.gravity:.4g} m/s^2"
    return f"{file.title}: edge {file.edge}, {place}"


def _side_by_side(
    wanted: Iterable[tuple[str, str]], found: Iterable[Mapping[str, Any]]
) -> list[tuple[str, ...]]:
    records = list(found)
    rows = [(words, *(screen.number(r.get(key)) for r in records)) for words, key in wanted]
    return [row for row in rows if set(row[1:]) != {"-"}]


def _remark(verdict: Verdict | None) -> None:
    """Say how a versine comes out."""
    if verdict is not None:
        why = f" at {verdict.time:.3g} s: {verdict.reason}" if verdict.reason else ""
        typer.echo(f"The versine {verdict.outcome}{why}")


def _print(title: str, heads: Sequence[str], rows: Sequence[Sequence[str]]) -> None:
    numeric = range(1, len(heads))
    screen.console().print(screen.table(title, heads, rows, tuple(numeric)))
