"""A chart without a renderer: what is drawn, in which unit, over which axis.

`nullmotion.report` makes these into pages, `nullmotion.plot.draw` into figures.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal, Protocol

import numpy as np


class Run(Protocol):
    """What a picture reads of a trajectory (`nullmotion.sim.Trajectory` is one).

    From ``q_BN`` on only runs that turn a spacecraft have it (`quantities.of_attitude`), from
    ``wheel_speed`` on only runs whose wheel speeds change (`quantities.turns_wheels`).
    """

    t: np.ndarray
    delta: np.ndarray
    rates: np.ndarray
    hdot: np.ndarray
    torque: np.ndarray
    momentum: np.ndarray
    measures: Mapping[str, np.ndarray]
    eram: Any
    metrics: Mapping[str, float]
    stopped_at_s: float | None
    stop_reason: str
    status: Sequence[str]
    backend: str
    setup: Any
    q_BN: Any
    omega_BN_B: Any
    reference: Any
    pointing_error: Any
    inertial_momentum: Any
    motor_torque: Any
    wheel_speed: Any
    wheel_acceleration: Any
    wheel_motor_torque: Any
    limited: Any
    estimates: Any


class Case(Protocol):
    """What a picture reads of one case of a comparison."""

    label: str
    law: str
    information: Sequence[str]
    trajectory: Any
    metrics: Mapping[str, float]


@dataclass(frozen=True)
class Curve:
    """One line of a chart.

    Args:
        label: Name in the legend.
        x: Abscissa, (k,).
        y: Ordinate, (k,); not a number where there is a gap.
        colour: Hex colour.
        dash: One of `palette.DASHES`.
        width: Line width [px].
        marker: Whether its points are drawn as well.
    """

    label: str
    x: np.ndarray
    y: np.ndarray
    colour: str
    dash: str = "solid"
    width: float = 1.6
    marker: bool = False


@dataclass(frozen=True)
class Level:
    """A horizontal line with a name, such as a limit.

    Args:
        value: Ordinate.
        label: Its name; empty for none.
        dash: One of `palette.DASHES`.
    """

    value: float
    label: str
    dash: str = "dot"


@dataclass(frozen=True)
class Mark:
    """A vertical line with a name above it, such as a fault.

    Args:
        at: Abscissa.
        label: Its name; empty where a neighbour's name is for both.
        side: To which side of the line the name runs.
    """

    at: float
    label: str
    side: Literal["left", "right"] = "right"


@dataclass(frozen=True)
class Panel:
    """One chart.

    Args:
        key: Short name, unique on a page.
        title: What it shows.
        y_title: Quantity and unit of the ordinate.
        curves: Its lines.
        levels: Limits and thresholds.
        note: A sentence a reader needs beside the title.
        x_title: Quantity and unit of the abscissa.
        ticks: Names of the abscissas 0, 1, 2, ... where these are no numbers.
        log: Whether the ordinate is logarithmic.
        marks: Instants.
        spans: Stretches of the abscissa that are shaded, from and to.
    """

    key: str
    title: str
    y_title: str
    curves: tuple[Curve, ...]
    levels: tuple[Level, ...] = ()
    note: str = ""
    x_title: str = "Time [s]"
    ticks: tuple[str, ...] = ()
    log: bool = False
    marks: tuple[Mark, ...] = ()
    spans: tuple[tuple[float, float], ...] = ()
