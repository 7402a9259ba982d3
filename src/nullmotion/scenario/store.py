"""Results of a run on disk: ``trajectory.nc``, ``summary.json``, ``trajectory.csv``."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

import numpy as np

from nullmotion.scenario import dataset, requirements, vscmg_summary
from nullmotion.scenario.files import replacing
from nullmotion.scenario.scenario import Scenario
from nullmotion.scenario.variables import LABELS, UNITS, variables
from nullmotion.scenario.variables_vscmg import labels
from nullmotion.sim.trajectory import Trajectory

TRAJECTORY, SUMMARY, TABLE, REPORT = (
    "trajectory.nc",
    "summary.json",
    "trajectory.csv",
    "report.html",
)


def write(
    trajectory: Trajectory,
    scenario: Scenario,
    directory: str | Path,
    *,
    csv: bool = False,
    law_file: str = "",
    report: Callable[[Path], Any] | None = None,
) -> Path:
    """Write a run's files into a folder, all of them or none; other files there stay.

    Args:
        trajectory: The run.
        scenario: What was flown.
        directory: Folder, made if need be.
        csv: Whether ``trajectory.csv`` is written too.
        law_file: Text of the Python file that the law came from.
        report: Writes ``report.html`` to the path it is given.
    """
    target = Path(directory)
    owned = (TRAJECTORY, SUMMARY, TABLE, REPORT) if (target / TRAJECTORY).is_file() else ()
    with replacing(target, owned) as new:
        write_netcdf(
            trajectory, new / TRAJECTORY, dataset.attributes(trajectory, scenario, law_file)
        )
        (new / SUMMARY).write_text(
            json.dumps(summary(trajectory, scenario), indent=2) + "\n", encoding="utf-8"
        )
        if csv:
            write_csv(trajectory, new / TABLE)
        if report:
            report(new / REPORT)
    return target


def summary(trajectory: Trajectory, scenario: Scenario) -> dict[str, Any]:
    """Return what ``summary.json`` holds; what is not finite is null."""
    found = {"scenario": scenario.name, "title": scenario.title, **trajectory.summary()}
    found |= vscmg_summary.summary(trajectory, scenario)
    found["parameters"] = dataset.resolved(trajectory, scenario)["law"]
    found["seed"] = scenario.plant.seed if scenario.plant else None
    found["requirements"] = requirements.evaluate(scenario, found)
    found["requirements_passed"] = requirements.passed(found["requirements"])
    result: dict[str, Any] = dataset.plain(found | {"versions": dataset.versions()})
    return result


def write_netcdf(trajectory: Trajectory, path: Path, attributes: dict[str, str]) -> None:
    """Write a run as NetCDF-4."""
    import netCDF4  # alone it imports four times as fast as through xarray

    with netCDF4.Dataset(path, "w", format="NETCDF4") as file:
        file.setncatts(attributes)
        for dimension, names in labels(trajectory).items():
            file.createDimension(dimension, len(names))
            told = file.createVariable(dimension, str, (dimension,))
            told[:] = np.array(names, dtype=object)
        for variable in variables(trajectory):
            for name, size in zip(variable.dims, variable.values.shape, strict=True):
                if name not in file.dimensions:
                    file.createDimension(name, size)
            packed = variable.values.size > 1000
            stored = file.createVariable(
                variable.name, "f8", variable.dims, zlib=packed, complevel=1
            )
            stored.setncatts({"units": variable.units, "long_name": variable.long_name})
            stored[...] = variable.values


def write_csv(trajectory: Trajectory, path: Path) -> None:
    """Write the histories as a table, one row a step, units in the column names."""
    columns: dict[str, np.ndarray] = {}
    known: dict[str, Iterable[object]] = {**LABELS, **labels(trajectory)}
    known["torque_axis"] = _axis_labels(trajectory)
    for variable in variables(trajectory):
        if variable.dims[0] != "time":
            continue
        unit = UNITS[variable.units]
        if variable.values.ndim == 1:
            columns["t_s" if variable.name == "time" else variable.name + unit] = variable.values
            continue
        names = known.get(variable.dims[1], range(variable.values.shape[1]))
        for label, column in zip(names, variable.values.T, strict=True):
            columns[f"{variable.name}_{label}{unit}"] = column
    table = np.stack(list(columns.values()), axis=1)
    np.savetxt(path, table, fmt="%.17g", delimiter=",", header=",".join(columns), comments="")


def _axis_labels(trajectory: Trajectory) -> list[str]:
    basis = np.asarray(trajectory.setup.array.torque_axes)
    body = [int(np.argmax(row)) for row in basis]
    exact = np.array_equal(basis, np.eye(3)[body])
    return ["xyz"[i] for i in body] if exact else [f"e{i + 1}" for i in range(len(basis))]


def to_xarray(trajectory: Trajectory, scenario: Scenario | None = None) -> Any:
    """Return a run as an `xarray.Dataset` with units and conventions."""
    import xarray

    found = variables(trajectory)
    data = {v.name: (v.dims, v.values, {"units": v.units, "long_name": v.long_name}) for v in found}
    named = {dimension: list(names) for dimension, names in labels(trajectory).items()}
    made = xarray.Dataset(data, coords=named, attrs=dataset.attributes(trajectory, scenario))
    return made.set_coords(["torque_axes"])
