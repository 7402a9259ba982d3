"""Ground from a file.

- ``.csv``: rows of heights in metres, first row at the least y; a row may begin with ``#``. Empty
  cells and ``nan`` mark ground that must not be touched. The spacing is given beside the file.
- ``.npy``: the same as an array.
- ``.npz``: ``heights``, ``spacing`` and, if wanted, ``origin``.
"""

from __future__ import annotations

import csv
from pathlib import Path
from typing import Any

import numpy as np

from nullmotion.errors import InputError
from nullmotion.rover.terrain import HeightField

_KEY = "terrain.file"


def load_terrain(
    path: str | Path, spacing: float | None = None, origin: tuple[float, float] = (0.0, 0.0)
) -> HeightField:
    """Return the ground in a file.

    Args:
        path: The file: ``.csv``, ``.npy`` or ``.npz``.
        spacing: Distance between neighbours on the grid [m]; an ``.npz`` brings its own.
        origin: Where the first height is, (x, y) [m]; an ``.npz`` may bring its own.

    Raises:
        InputError: For a file that cannot be read, with the line that is wrong.
    """
    file = Path(path)
    if not file.is_file():
        raise InputError(_KEY, str(path), "an existing file")
    if file.suffix == ".npz":
        heights, spacing, origin = _archive(file, origin)
    elif file.suffix == ".npy":
        heights = _numpy(file)
    elif file.suffix == ".csv":
        heights = _csv(file)
    else:
        raise InputError(_KEY, str(path), "a .csv, .npy or .npz file")
    if spacing is None:
        raise InputError("terrain.spacing_m", None, f"a length above 0 beside {file.name}")
    return HeightField(heights, spacing, origin, str(path))


def save_terrain(field: HeightField, path: str | Path) -> None:
    """Write ground as ``.npz``, as `load_terrain` reads it."""
    np.savez_compressed(path, heights=field.heights, spacing=field.spacing, origin=field.origin)


def _numpy(file: Path) -> Any:
    try:
        found = np.load(file, allow_pickle=False)
    except (OSError, ValueError, EOFError) as error:
        raise InputError(_KEY, str(file), f"a NumPy file of numbers ({error})") from None
    return found if file.suffix == ".npz" else _numbers(file, found)


def _numbers(file: Path, found: Any, name: str = "") -> np.ndarray:
    if not (isinstance(found, np.ndarray) and found.dtype.kind in "iuf"):
        raise InputError(_KEY, str(file), f"real numbers{f' in {name!r}' if name else ''}")
    return found.astype(float)


def _archive(
    file: Path, origin: tuple[float, float]
) -> tuple[np.ndarray, float, tuple[float, float]]:
    found = _numpy(file)
    with found:
        lacking = {"heights", "spacing"} - set(found.files)
        if lacking:
            raise InputError(_KEY, str(file), f"an archive with {' and '.join(sorted(lacking))}")
        heights = _numbers(file, found["heights"], "heights")
        spacing = _numbers(file, found["spacing"], "spacing")
        if "origin" in found.files:
            x, y = _two(file, _numbers(file, found["origin"], "origin"))
            origin = (x, y)
    if spacing.size != 1:
        raise InputError(_KEY, str(file), "one number in 'spacing'")
    return heights, float(spacing.item()), origin


def _two(file: Path, values: np.ndarray) -> tuple[float, float]:
    if values.size != 2:
        raise InputError(_KEY, str(file), "two numbers in 'origin'")
    return float(values.flat[0]), float(values.flat[1])


def _csv(file: Path) -> np.ndarray:
    rows: list[list[float]] = []
    try:
        text = file.read_text(encoding="utf-8-sig")
    except (OSError, UnicodeDecodeError):
        raise InputError(_KEY, str(file), "a CSV file in UTF-8") from None
    for line, cells in enumerate(csv.reader(text.splitlines()), 1):
        if not cells or cells[0].lstrip().startswith("#"):
            continue
        row = [_cell(file, line, cell) for cell in cells]
        if rows and len(row) != len(rows[0]):
            allowed = f"{len(rows[0])} heights in every row"
            raise InputError(_KEY, len(row), allowed, f"{file}:{line}")
        rows.append(row)
    return np.array(rows) if rows else np.empty((0, 0))


def _cell(file: Path, line: int, cell: str) -> float:
    try:
        return float(cell) if cell.strip() else np.nan
    except ValueError:
        raise InputError(_KEY, cell, "a height [m]", f"{file}:{line}") from None
