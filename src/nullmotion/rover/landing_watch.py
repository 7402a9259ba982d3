"""Watching a step on the ground: whether the rover has landed, or tipped."""

from __future__ import annotations

import numpy as np

from nullmotion.rover.chassis import Chassis
from nullmotion.rover.contact_record import Record
from nullmotion.rover.contact_reference import Reference
from nullmotion.rover.contact_signals import Signals
from nullmotion.rover.edge_frame import EdgeFrame
from nullmotion.rover.watch import Progress

_NEAR = 2e-3  # of the edge's length
TIPPED = float(np.radians(15.0))  # rad off the edge: no step any more


class LandingWatch:
    """Says when to end, and brakes the gimbal on landing.

    Attributes:
        leaving: Spikes that the step lifts.
        arriving: Spikes that it sets down.
        landed: When one of those had touched the ground and all were down to 0.2 % of the edge's
            length [s]; None: not yet. On ground that creeps the last may take seconds to touch.
        tipped: Whether the rover fell off its edge.
    """

    def __init__(
        self,
        chassis: Chassis,
        frame: EdgeFrame,
        reference: Reference,
        settle: float,
        patience: float,
        progress: Progress | None = None,
    ) -> None:
        """Take what is watched; times in seconds."""
        edge = set(frame.spikes)
        self.leaving = set(chassis.faces[frame.start_face]) - edge
        self.arriving = set(chassis.faces[frame.end_face]) - edge
        self.landed: float | None = None
        self.tipped = False
        self._reference, self._settle = reference, settle
        self._end = reference.duration + patience
        self._near, self._seen = _NEAR * frame.length, 0
        self._touched = False
        self._progress = progress

    def __call__(self, record: Record) -> float:
        """Return until when to go on [s]."""
        for change in record.changes[self._seen :]:
            self._touched |= change.carries and change.spike in self.arriving
        self._seen = len(record.changes)
        if self._touched and self.landed is None:
            sinkage = Signals.split(record.rows[-1]).sinkage[list(self.arriving)]
            if sinkage.min() > -self._near:
                self.landed = float(record.t[-1])
                self._reference.acts = False
                self._end = self.landed + self._settle
        if record.rows and Signals.split(record.rows[-1]).tilt > TIPPED:
            self.tipped = True
            self._end = min(self._end, record.t[-1])
        if self._progress and record.t:
            self._progress(min(record.t[-1] / self._reference.duration, 1.0))
        return self._end
