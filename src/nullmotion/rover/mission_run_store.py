"""What `nullmotion rover mission` leaves on disk, all files of a result or none."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np

from nullmotion.rover.mission_run import MissionResult
from nullmotion.rover.path_travel import Travel
from nullmotion.rover.rover_run_store import REPORT, Report, write_json
from nullmotion.rover.rover_run_summary import versions
from nullmotion.scenario.files import replacing

MISSION, STEPS = "mission.json", "steps.csv"


def write_mission(
    result: MissionResult, directory: str | Path, csv: bool = False, report: Report | None = None
) -> Path:
    """Write ``mission.json``.

    Args:
        result: The mission.
        directory: Folder, made if need be.
        csv: Whether the steps are written as ``steps.csv``, too.
        report: Writes ``report.html`` to the path it is given.
    """
    target = Path(directory)
    owned = (MISSION, STEPS, REPORT) if (target / MISSION).is_file() else ()
    with replacing(target, owned) as new:
        write_json(mission_record(result), new / MISSION)
        if csv:
            _write_steps(result.travel, new / STEPS)
        if report:
            report(new / REPORT)
    return target


def mission_record(result: MissionResult) -> dict[str, Any]:
    """Return what ``mission.json`` holds."""
    file, made = result.file, result.travel
    left, right, low, high = file.terrain.bounds
    return {
        "title": file.title,
        "rover": file.rover.name,
        "gravity_m_s2": file.gravity,
        "start_m": list(file.start),
        "goal_m": list(file.goal),
        "terrain": {
            "source": file.terrain.source,
            "x_m": [left, right],
            "y_m": [low, high],
            "spacing_m": file.terrain.spacing,
        },
        **made.summary(),
        "comparison": comparison(result),
        "path": {
            "footprints_m": made.corners,
            "spikes": made.feet,
            **{key: values for key, values in columns(made).items() if key != "step"},
        },
        "seconds": result.seconds,
        "file": file.source.name,
        "document": file.source.effective_text(),
        "versions": versions(),
    }


def comparison(result: MissionResult) -> dict[str, Any]:
    """Return the CMG rover beside those with wheels; distances are keys, in metres."""
    care = result.travel.upkeep
    return {
        "cmg_J_kg_m": {
            "this trip": result.travel.cost_of_travel,
            "steps alone": result.travel.step_cost,
            **{f"{D:g} m": cost for D, cost in result.costs().items()},
            "without end": math.nan if result.trips is None else result.trips.running_cost,
        },
        "wheels": [
            {
                "rover": trip.rover,
                "impulsive_J_kg_m": trip.cost_of_travel,
                "refused_steps_fraction": trip.refused,
                "break_even_m": trip.break_even,
            }
            for trip in result.wheels
        ],
        "upkeep": {
            "power_W": care.power,
            "pause_s": care.pause,
            "spin_up_time_s": care.spin_up_time,
            "rotor_energy_J": care.rotor_energy,
        },
    }


def columns(made: Travel) -> dict[str, np.ndarray]:
    """Return one number a step, by name with unit."""
    x, y, z = made.middles[1:].T
    a, b = made.edges.T
    return {
        "step": np.arange(1, made.steps + 1),
        "x_m": x,
        "y_m": y,
        "z_m": z,
        "spike_a": a,
        "spike_b": b,
        "turn_deg": np.degrees(made.turn),
        "pitch_deg": np.degrees(made.pitch),
        "cross_deg": np.degrees(made.cross),
        "energy_J": made.energy,
        "time_s": made.time,
        "margin_Nm": made.margin,
    }


def _write_steps(made: Travel, path: Path) -> None:
    found = columns(made)
    table = np.column_stack(list(found.values()))
    np.savetxt(path, table, fmt="%.10g", delimiter=",", header=",".join(found), comments="")
