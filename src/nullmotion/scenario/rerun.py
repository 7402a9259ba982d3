"""Repeat a stored run and say whether it came out the same."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from nullmotion.errors import InputError
from nullmotion.scenario import dataset
from nullmotion.scenario.scenario import Scenario, checked
from nullmotion.scenario.source import Source
from nullmotion.scenario.store import TRAJECTORY
from nullmotion.scenario.variables import variables
from nullmotion.sim.trajectory import Trajectory


@dataclass(frozen=True)
class Stored:
    """What a folder says about the run in it.

    Attributes:
        attributes: Global attributes of ``trajectory.nc``.
        variables: Its arrays by name.
    """

    attributes: dict[str, str]
    variables: dict[str, np.ndarray]

    @property
    def law_file(self) -> str:
        """Text of the Python file that the law came from; empty for a law of nullmotion's own."""
        return self.attributes.get("law_file", "")

    def scenario(self) -> Scenario:
        """Return the scenario that was flown; a law from a file has to be registered before."""
        source = Source(
            self.attributes["scenario"],
            self.attributes["scenario_name"],
            files=json.loads(self.attributes["scenario_files"]),
        )
        return checked(source)


def read(directory: str | Path) -> Stored:
    """Return what ``trajectory.nc`` in a folder holds.

    Raises:
        InputError: If there is no such file, or not one of nullmotion's.
    """
    path = Path(directory)
    path = path / TRAJECTORY if path.is_dir() else path
    if not path.is_file():
        raise InputError(
            "DIR",
            str(directory),
            f"a folder with a {TRAJECTORY}, as `nullmotion run --out DIR` writes it",
        )
    import netCDF4

    try:
        with netCDF4.Dataset(path) as file:
            attributes = {name: str(file.getncattr(name)) for name in file.ncattrs()}
            file.set_auto_mask(False)
            variables = {name: np.asarray(v[...]) for name, v in file.variables.items()}
    except OSError:
        raise InputError("DIR", str(path), "a NetCDF file") from None
    if "scenario" not in attributes:
        raise InputError(
            "DIR", str(path), "a file that holds its scenario, written by `nullmotion run`"
        )
    return Stored(attributes, variables)


def verdict(stored: Stored, again: Trajectory) -> str:
    """Return in words whether a run came out the same, and if not, what may be the reason."""
    worst, where = 0.0, ""
    for variable in variables(again):
        old = stored.variables.get(variable.name)
        if old is None or old.shape != variable.values.shape:
            return f"differs: {variable.name} has another shape{_reasons(stored, again)}"
        if not np.array_equal(old, variable.values, equal_nan=True):
            gap = float(np.nanmax(np.abs(old - variable.values), initial=0.0))
            worst, where = max((worst, where), (gap, variable.name))
    if where:
        return f"differs by up to {worst:.3g} ({where}){_reasons(stored, again)}"
    return "identical, bit for bit"


def _reasons(stored: Stored, again: Trajectory) -> str:
    now = {f"{k}_version": v for k, v in dataset.versions().items()}
    now |= {"instruction_set": again.instruction_set, "backend": again.backend}
    then = stored.attributes
    other = [
        f"{key.removesuffix('_version')} {then.get(key)} -> {value}"
        for key, value in now.items()
        if then.get(key) != value
    ]
    return f"; {', '.join(other)}" if other else "; same versions and instruction set"
