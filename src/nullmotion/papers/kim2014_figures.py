"""Figures 2 to 13 of Kim et al. 2012, Lyapunov's function, and startups within limits."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from nullmotion.papers import kim2014_panels as shown
from nullmotion.papers.kim2014_beyond import Variant
from nullmotion.papers.kim2014_cases import Startup
from nullmotion.plot import palette
from nullmotion.plot.view import Curve, Panel

_TITLES = {"case1": "case 1", "case2": "case 2"}
_UNITS = tuple(f"unit {i + 1}" for i in range(4))
_TEN = tuple(f"element {i + 1}" for i in range(10))
_COMMON = {"common_legend": True}
_OPTIONS: dict[int, dict[str, Any]] = {8: {"columns": 3}} | dict.fromkeys(
    (3, 4, 7, 10, 11), _COMMON
)


def _error(run: Startup) -> list[Panel]:
    return [shown.early(shown.quaternion_error(run)), shown.whole(shown.error_size(run))]


def _inputs(run: Startup) -> list[Panel]:
    rates, accelerations = shown.gimbal_rates(run), shown.wheel_accelerations(run)
    return [
        panel
        for part in (shown.at_once, shown.early, shown.later)
        for panel in (shown.within_limit(part(rates), run), part(accelerations))
    ]


def _speeds(run: Startup) -> list[Panel]:
    panel = shown.wheel_speeds(run)
    return [shown.early(panel), shown.whole(panel)]


def _measures(run: Startup) -> list[Panel]:
    return _both(run, shown.objective, shown.null_weights)


def _null(run: Startup) -> list[Panel]:
    error = [shown.whole(shown.momentum_error(run)), shown.whole(shown.momentum_decay(run))]
    return [*_both(run, shown.null_motion), *error]


def _both(run: Startup, *panels: Callable[[Startup], Panel]) -> list[Panel]:
    return [part(panel(run)) for panel in panels for part in (shown.early, shown.later)]


def _parameters(run: Startup) -> list[Panel]:
    return [
        shown.whole(shown.estimates(run, "theta_1", "Elements of θ₁", slice(0, 10), _TEN)),
        shown.whole(shown.estimates(run, "theta_2", "Elements of θ₂", slice(10, 18), _TEN[:8])),
    ]


def _theta_1(run: Startup) -> list[Panel]:
    lines = (
        ("moments", "Moments of inertia", slice(0, 3), ("xx", "yy", "zz")),
        ("products", "Products", slice(3, 6), ("xy", "xz", "yz")),
        ("units", "J_s - J_t", slice(6, 10), _UNITS),
    )
    return [shown.early(shown.estimates(run, *line)) for line in lines]


def _theta_2(run: Startup) -> list[Panel]:
    lines = (
        ("gimbals", "J_g", slice(10, 14), _UNITS),
        ("units", "J_s - J_t", slice(14, 18), _UNITS),
    )
    return [shown.early(shown.estimates(run, *line)) for line in lines]


FIGURES: dict[int, tuple[str, str, Callable[[Startup], list[Panel]]]] = {
    2: ("case1", "quaternion error", _error),
    3: ("case1", "control input", _inputs),
    4: ("case1", "wheel speeds", _speeds),
    5: ("case1", "singularity measure and null-motion weights", _measures),
    6: ("case1", "null motion and momentum tracking error", _null),
    7: ("case1", "parameter estimates", _parameters),
    8: ("case1", "θ₁ in windows", _theta_1),
    9: ("case1", "θ₂ in windows", _theta_2),
    10: ("case2", "control input", _inputs),
    11: ("case2", "wheel speeds", _speeds),
    12: ("case2", "singularity measure and null-motion weights", _measures),
    13: ("case2", "null motion and momentum tracking error", _null),
}
COUNT = len(FIGURES) + 2


def draw(
    folder: Path, flights: Mapping[str, Startup], others: Mapping[Variant, Startup]
) -> Iterator[Path]:
    """Draw all figures, one after another.

    Args:
        folder: Where they go.
        flights: The paper's cases.
        others: The same on other plants.
    """
    from nullmotion.plot.draw import save

    folder.mkdir(parents=True, exist_ok=True)
    for number, (case, title, panels) in FIGURES.items():
        name = f"Figure {number}: {title}, {_TITLES[case]}"
        path, options = folder / f"figure_{number:02d}.png", _OPTIONS.get(number, {})
        yield save(panels(flights[case]), path, title=name, **options)
    name = "Lyapunov's function and its bound"
    yield save(_lyapunov(flights), folder / "figure_lyapunov.png", title=name, **_COMMON)
    name = "The full plant, torque-driven, within 5 rad/s and 5 mN m"
    yield save(_limits(others), folder / "figure_limits.png", title=name, **_COMMON)


def _lyapunov(flights: Mapping[str, Startup]) -> list[Panel]:
    found = []
    for case, run in flights.items():
        cut = "gimbals saturate" if run.saturated.any() else "no limit acts"
        title = f"{_TITLES[case].capitalize()}, {cut}"
        found.append(shown.early(shown.lyapunov(title, run.lyapunov)))
    return found


def _limits(others: Mapping[Variant, Startup]) -> list[Panel]:
    """|e_v| and |mu| of limited startups, with the paper's control and with ours."""
    kinds = {"clipped, the paper's gains": False, "direction kept, softer gains": True}
    found = []
    for case, title in _TITLES.items():
        runs = {
            label: others[Variant(case, "all positive", "full", "torque", True, kept)]
            for label, kept in kinds.items()
        }
        for key, what, axis in (
            ("error", "attitude error", "|e_v| [-]"),
            ("share", "momentum error", "|µ| / |µ(0)| [-]"),
        ):
            curves = tuple(
                Curve(label, run.run.t, getattr(run, key), palette.colour(i), palette.dash(i))
                for i, (label, run) in enumerate(runs.items())
            )
            panel = Panel(f"{case}_{key}", f"{title}: {what}".capitalize(), axis, curves, log=True)
            found.append(shown.between(panel, 0.0, 300.0 if key == "error" else np.inf))
    return found
