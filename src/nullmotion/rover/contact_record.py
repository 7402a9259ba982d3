"""What a contact simulation leaves: its nodes in time, and which spikes carried."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from nullmotion.rover.contact_signals import Signals
from nullmotion.rover.contact_step import NODES, WEIGHTS, Step


class Change(NamedTuple):
    """A spike that begins (`carries`) or ends to carry, and the state then."""

    t: float
    spike: int
    carries: bool
    x: np.ndarray


@dataclass
class Record:
    """What happened, at the nodes of all steps in order.

    Attributes:
        t: Times [s].
        x: States, (15,) each.
        rows: Signals, see `Signals.split`.
        weight: What a node counts in an integral over time [s].
        carrying: Which spikes carried, (V,) each.
        changes: Spikes that began or ended to carry.
        steps: Number of the solver's steps.
        failure: What the solver said when it could not go on.
    """

    t: list[float] = field(default_factory=list)
    x: list[np.ndarray] = field(default_factory=list)
    rows: list[np.ndarray] = field(default_factory=list)
    weight: list[float] = field(default_factory=list)
    carrying: list[np.ndarray] = field(default_factory=list)
    changes: list[Change] = field(default_factory=list)
    steps: int = 0
    failure: str = ""

    def signals(self) -> Signals:
        """Return the signals over time."""
        return Signals.split(np.array(self.rows))

    def integral(self, power: np.ndarray) -> float:
        """Return the integral over time of a signal."""
        return float(np.array(self.weight) @ power)

    def note(self, step: Step) -> None:
        """Keep the nodes of a step."""
        self.t.extend(step.t)
        self.x.extend(step.x)
        self.rows.extend(step.rows)
        self.weight.extend(step.length * WEIGHTS)
        self.carrying.extend([step.carrying] * len(NODES))
        self.steps += 1
