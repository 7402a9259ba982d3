"""Beyond Papakonstantinou et al. 2021: the proven optimum, and plants that keep omega x h."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from nullmotion.papers.papakonstantinou2021_cases import NONE, Manoeuvre
from nullmotion.papers.papakonstantinou2021_tables import percent
from nullmotion.plan import Found
from nullmotion.plan import enumerate as everything
from nullmotion.plan.best import TIE

NOTE = """\
Every case on the paper's plant and on others: with the term omega x h that the paper's body does
without, and with RK4 at 0.01 s in place of semi-implicit Euler at 0.1 s. There the law is sampled
at 0.01 s too and the null vector has no lag; the kinematic command (h_c - h)/dt is ten times as
large. The knots stand over the same 7 s, and the cost counts time in steps of 0.1 s everywhere.

`rank` is the place among all 59,049 courses, by enumeration; `rollouts` counts whole runs, parts
of runs added up; `ties` are other courses as good. The optimum is proven by branch and bound, with
the certificate in `beyond.json`. Errors are in rad, of the kinematic case in N m s."""


def rows(run: Manoeuvre) -> list[dict[str, Any]]:
    """Return what one manoeuvre is worth without null motion, and under three courses of it."""
    values = everything.all_values(run.rollouts, run.section.levels)
    courses: Mapping[str, tuple[Any, Found | None]] = {
        "SRI alone": (NONE, None),
        "the paper's L": (run.case.course, None),
        "the paper's search": (run.heuristic_course, run.heuristic),
        "exact optimum": (run.optimum.knots, run.optimum),
    }
    return [_row(run, values, name, *found) for name, found in courses.items()]


def _row(
    run: Manoeuvre, values: np.ndarray, name: str, knots: tuple[float, ...], found: Found | None
) -> dict[str, Any]:
    value, parts = run.value(knots), run.parts(knots)
    row = {
        "case": run.case.name,
        "plant": run.plant.name,
        "course": name,
        "cost": value,
        "gain_percent": percent(run.value(NONE), value),
        "rank": 1 + int(np.count_nonzero(values > value + TIE * abs(value))),
        "mean_manipulability": parts["mean_manipulability"],
        "time_low_manipulability_s": parts["samples_of_low_manipulability"] * run.setup.dt,
        "greatest_error": parts["greatest_error"],
        "time_rate_excess_s": parts["samples_of_rate_excess"] * run.setup.dt,
        "knots": [int(k) for k in knots],
        "rollouts": None if found is None else found.rollouts,
        "ties": len(found.ties) if found is not None and found.proven else None,
        "proven": None if found is None else found.proven,
    }
    return row if found is None or not found.proven else row | {"certificate": certificate(found)}


def certificate(found: Found) -> dict[str, Any]:
    """Return what proves an optimum, and whether it does."""
    proof = dict(found.certificate)
    every = proof["leaves_evaluated"] + proof["pruned_sequences"] == proof["sequences"]
    bound = proof["largest_pruned_bound"] <= proof["optimum"] + proof["tolerance"]
    return proof | {"holds": bool(every and bound and found.proven)}
