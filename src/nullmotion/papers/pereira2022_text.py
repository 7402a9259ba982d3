"""What Pereira 2022 prints: the Jacobians of Eqs 23 and 24, and what it says of Figs 11-16."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from nullmotion import singular_lines
from nullmotion.array import layouts
from nullmotion.papers.base import Cell
from nullmotion.papers.pereira2022_cases import Flight

HOME = (0.0, 0.0, 0.0)
SINGULAR = (0.0, 2 * np.pi / 3, -2 * np.pi / 3)  # Fig 6
_PRINTED = {  # Eqs 23 and 24, over h0
    "Eq 23": (HOME, ((-0.5, 1.0, -0.5), (0.866, 0.0, -0.866)), (1.225, 1.225)),
    "Eq 24": (SINGULAR, ((-0.5, -0.5, -0.5), (0.866, 0.866, 0.866)), (None, 0.0)),
}
_SINGULAR_DIRECTION = (-0.866, -0.5)
_HALF_DIGIT = 5e-5, 5e-4  # of what is printed: matrices, singular values

SIGNIFICANT = 0.3  # [N m] of mismatch, a third of the peak command
MATCHED = 1e-3  # [N m]
_NEAR_MINIMAL = 1.5  # energy over the least energy
_SATURATED = 0.999  # share of a limit
_OURS = "the inferred parameters let the rates saturate as well"


def cells(flights: Mapping[str, Flight]) -> list[Cell]:
    """Return every printed value and word with ours."""
    return [*_geometry(), *_results(flights), *_table(flights)]


def _geometry() -> list[Cell]:
    """Jacobians, singular values and the singular direction."""
    array, found = layouts.create("triangle", h0=1.0), []
    for row, (delta, printed, sigma) in _PRINTED.items():
        J = array.jacobian(np.array(delta))
        for (i, j), value in np.ndenumerate(np.array(printed)):
            name = f"J_{i + 1}{j + 1}"
            found.append(Cell("text", row, name, float(value), float(J[i, j]), _HALF_DIGIT[0]))
        values = np.linalg.svd(J, compute_uv=False)
        for j, (given, ours) in enumerate(zip(sigma, values, strict=True)):
            if given is not None:
                found.append(
                    Cell("text", row, f"sigma_{j + 1}", given, float(ours), _HALF_DIGIT[1])
                )
    u = np.linalg.svd(array.jacobian(np.array(SINGULAR)))[0][:, 1]
    u = u * np.sign(u @ np.array(_SINGULAR_DIRECTION))
    for j, printed_u in enumerate(_SINGULAR_DIRECTION):
        found.append(Cell("text", "Eq 24", f"u_{j + 1}", printed_u, float(u[j]), _HALF_DIGIT[0]))
    kind = singular_lines.nearest(array, SINGULAR)
    on_it = kind.distance < 1e-9
    ours = f"{kind.momentum:.0f}h" if on_it else "regular"
    return [*found, Cell("text", "Fig 6", "kind", "3h", ours)]


def _results(flights: Mapping[str, Flight]) -> list[Cell]:
    """What the text says of the flights, as yes or no."""
    alone, term, far = (flights[n] for n in ("N = 1, no term", "N = 1, term", "N = 5, term"))
    setup, law = alone.run.setup, alone.run.setup.law
    limit = float(setup.array.rate_limit[0]) * _SATURATED
    accelerated = getattr(law, "acceleration_limit_rad_s2", np.inf) * _SATURATED
    at = float(alone.t[np.argmax(alone.mismatch)])
    effort = far.energy / far.least_energy
    minimal = f"{effort:.2f} times that of the least rates at the same angles"
    said = [
        (alone, "significant_mismatch", "Y", alone.mismatch.max() > SIGNIFICANT, ""),
        (alone, "rates_saturate", "N", alone.peak_rate >= limit, _OURS),
        (alone, "accelerations_saturate", "Y", alone.peak_acceleration >= accelerated, ""),
        (term, "smaller_mismatch", "Y", term.mismatch.max() < 0.3 * alone.mismatch.max(), ""),
        (term, "less_energy", "Y", term.energy < alone.energy, ""),
        (far, "torque_matched", "Y", far.mismatch.max() < MATCHED, ""),
        (far, "energy_near_minimal", "Y", effort < _NEAR_MINIMAL, minimal),
        (far, "singularities_avoided", "Y", far.distance.min() > 0.49, ""),
    ]
    names = {id(flight): name for name, flight in flights.items()}
    time = Cell(
        *("text", "N = 1, no term", "singularity_time_s", 30.0, at, 2.0, "inferred"),
        '"t = 30 s or so": the slew begins at 30 s',
    )
    return [
        time,
        *(
            Cell("text", names[id(f)], column, printed, "Y" if ours else "N", 0.0, "inferred", note)
            for f, column, printed, ours, note in said
        ),
    ]


def _table(flights: Mapping[str, Flight]) -> list[Cell]:
    """The numbers behind the curves of Figs 11-18."""
    columns = ("peak_torque_mismatch_Nm", "least_distance_rad", "peak_rate_rad_s")
    found = []
    for name, flight in flights.items():
        row = flight.row(name)
        for column in columns:
            cell = Cell("figures 11-18", name, column, None, row[column], 0.0, "inferred")
            found.append(cell)
    return found
