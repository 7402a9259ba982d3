"""Named columns with units over the same times, and how they are written."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np

_SUFFIX = {
    "1": "",
    "s": "_s",
    "m": "_m",
    "N": "_N",
    "J": "_J",
    "W": "_W",
    "N m": "_Nm",
    "rad": "_rad",
    "m s-1": "_m_s",
    "rad s-1": "_rad_s",
    "rad s-2": "_rad_s2",
}
_LABELS = {"axis": "frp", "body_axis": "xyz", "quaternion": "0123"}


class Column(NamedTuple):
    """A quantity over time.

    Attributes:
        name: Its name.
        unit: Its unit.
        meaning: What it is.
        values: Its values, times first.
        dims: What the other axes of the values are.
    """

    name: str
    unit: str
    meaning: str
    values: np.ndarray
    dims: tuple[str, ...] = ()


class Table(NamedTuple):
    """Columns over the same times; the first is the time."""

    name: str
    columns: list[Column]

    def flat(self) -> Iterator[tuple[str, np.ndarray]]:
        """Yield columns of single numbers, unit in the name."""
        for column in self.columns:
            for place in np.ndindex(column.values.shape[1:]):
                labels = [_label(d, i) for d, i in zip(column.dims, place, strict=True)]
                name = "_".join([column.name, *labels]) + _SUFFIX[column.unit]
                yield name, column.values[(slice(None), *place)]

    def write_csv(self, path: Path) -> None:
        """Write the table, one row a time."""
        heads, values = zip(*self.flat(), strict=True)
        rows, names = np.column_stack(values), ",".join(heads)
        np.savetxt(path, rows, fmt="%.17g", delimiter=",", header=names, comments="")


def _label(dim: str, index: int) -> str:
    return _LABELS[dim][index] if dim in _LABELS else str(index)


def write_netcdf(found: Iterable[Table], path: Path, attributes: dict[str, str]) -> None:
    """Write histories as NetCDF-4; the times of each are its dimension."""
    import netCDF4

    with netCDF4.Dataset(path, "w", format="NETCDF4") as file:
        file.setncatts(attributes)
        for table in found:
            times = f"{table.name}_t"
            for column in table.columns:
                dims = (times, *column.dims)
                for name, size in zip(dims, column.values.shape, strict=True):
                    if name not in file.dimensions:
                        file.createDimension(name, size)
                stored = file.createVariable(
                    f"{table.name}_{column.name}", "f8", dims, zlib=True, complevel=1
                )
                stored.setncatts({"units": column.unit, "long_name": column.meaning})
                stored[...] = column.values
