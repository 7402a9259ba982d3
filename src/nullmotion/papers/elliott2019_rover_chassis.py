"""Tables 8 and 9 of Elliott 2019: the platonic solids as chassis."""

from __future__ import annotations

import math

from nullmotion.papers.base import Cell
from nullmotion.rover.chassis_table import platonic_rows

# steepest slope [deg] and eta, as printed
SLOPES = {
    "tetrahedron": 54.7,
    "cube": 45.0,
    "octahedron": 35.3,
    "dodecahedron": 31.7,
    "icosahedron": 20.9,
}
RATIOS = {
    "tetrahedron": 0.71,
    "cube": 1.41,
    "octahedron": 1.0,
    "dodecahedron": 2.62,
    "icosahedron": 1.62,
}
_SLOPE_DIGIT, _RATIO_DIGIT = 0.05, 0.005


def cells() -> list[Cell]:
    """Return Tables 8 and 9."""
    rows = {row.name: row for row in platonic_rows(SLOPES)}
    slopes = [
        Cell("8", name, "max_slope_deg", printed, math.degrees(rows[name].slope), _SLOPE_DIGIT)
        for name, printed in SLOPES.items()
    ]
    ratios = [
        Cell("9", name, "eta", printed, rows[name].ratio, _RATIO_DIGIT)
        for name, printed in RATIOS.items()
    ]
    return slopes + ratios
