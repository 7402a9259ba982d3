"""What `nullmotion rover plan` and `run` leave on disk, all files of a result or none."""

from __future__ import annotations

import json
import platform
from collections.abc import Callable
from pathlib import Path
from typing import Any

from nullmotion.rover import rover_run_summary as summary
from nullmotion.rover import rover_run_tables as tables
from nullmotion.rover.files import StepFile
from nullmotion.rover.rover_run import StepResult, WheelPlan
from nullmotion.rover.rover_run_columns import Table, write_netcdf
from nullmotion.rover.step_plan import StepPlan
from nullmotion.rover.versine import Verdict
from nullmotion.scenario.dataset import plain
from nullmotion.scenario.files import replacing

PLAN, RUN, HISTORY, REPORT = "plan.json", "run.json", "trajectory.nc", "report.html"
CONVENTIONS = (
    "SI units and radians. f, r, p: forward on the ground, along the edge, up, from the middle of "
    "the edge; the step turns positively about r. B: body axes of the chassis. Quaternions are "
    "scalar first, q_BN turns N = (f, r, p) into B. delta is the gimbal angle, theta the angle "
    "turned about the edge. Each history has its own times."
)
_TABLES = ("plan", "versine", "initialise", "closed_loop", "landing")
_CSV = tuple(f"{name}.csv" for name in _TABLES)
Report = Callable[[Path], Any]


def write_plan(
    file: StepFile,
    plan: StepPlan | WheelPlan,
    verdict: Verdict | None,
    directory: str | Path,
    report: Report | None = None,
) -> Path:
    """Write ``plan.json`` and the plan's history as CSV.

    Args:
        file: What was asked for.
        plan: The plan.
        verdict: How a versine comes out.
        directory: Folder, made if need be.
        report: Writes ``report.html`` to the path it is given.
    """
    if isinstance(plan, WheelPlan):
        found, history = summary.of_wheels(plan), tables.wheel_table(plan.versine)
    else:
        found, history = summary.of_plan(plan, verdict), tables.plan_table(plan)
    record = {**summary.of_file(file), **found, **dict(history.flat()), **_origin(file.source)}
    target = Path(directory)
    with replacing(target, _owned(target, PLAN)) as new:
        write_json(record, new / PLAN)
        history.write_csv(new / f"{history.name}.csv")
        if report:
            report(new / REPORT)
    return target


def write_run(
    result: StepResult, directory: str | Path, csv: bool = False, report: Report | None = None
) -> Path:
    """Write ``run.json`` and ``trajectory.nc``.

    Args:
        result: The step from plan to landing.
        directory: Folder, made if need be.
        csv: Whether each history is written as CSV, too.
        report: Writes ``report.html`` to the path it is given.
    """
    target, found = Path(directory), histories(result)
    with replacing(target, _owned(target, RUN)) as new:
        write_json(run_record(result), new / RUN)
        write_netcdf(found, new / HISTORY, _attributes(result))
        for history in found if csv else ():
            history.write_csv(new / f"{history.name}.csv")
        if report:
            report(new / REPORT)
    return target


def histories(result: StepResult) -> list[Table]:
    """Return the histories of a step."""
    way = result.initialisation
    return [
        tables.plan_table(result.plan),
        *([] if way is None else [tables.initialisation_table(way)]),
        tables.run_table(result.run),
        tables.landing_table(result.landing),
    ]


def run_record(result: StepResult) -> dict[str, Any]:
    """Return what ``run.json`` holds."""
    way = result.initialisation
    return {
        **summary.of_file(result.file),
        "outcome": result.landing.outcome,
        "plan": summary.of_plan(result.plan, result.verdict),
        "initialisation": None if way is None else summary.of_initialisation(way),
        "closed_loop": summary.of_run(result.run),
        "landing": summary.of_landing(result.landing),
        "seconds": result.seconds,
        **_origin(result.file.source),
    }


def write_json(record: dict[str, Any], path: Path) -> None:
    """Write a record; what is not finite is null."""
    path.write_text(json.dumps(plain(record), indent=1) + "\n", encoding="utf-8")


def _attributes(result: StepResult) -> dict[str, str]:
    found = {f"{name}_version": text for name, text in summary.versions().items()}
    return {
        "title": result.file.title,
        "source": f"nullmotion {found['nullmotion_version']}",
        "conventions": CONVENTIONS,
        "outcome": result.landing.outcome,
        "rover": result.file.source.effective_text(),
        "rover_name": result.file.source.name,
        **found,
        "platform": platform.platform(),
    }


def _origin(source: Any) -> dict[str, Any]:
    return {
        "file": source.name,
        "document": source.effective_text(),
        "versions": summary.versions(),
    }


def _owned(target: Path, name: str) -> tuple[str, ...]:
    """Return the files of an earlier result that go away with it."""
    return (name, HISTORY, REPORT, *_CSV) if (target / name).is_file() else ()
