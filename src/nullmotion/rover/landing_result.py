"""What came of a step on the ground."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nullmotion.rover.contact_events import SLIP, TILT, Event, contact_events, slips, spike_paths
from nullmotion.rover.contact_record import Record
from nullmotion.rover.contact_signals import Signals
from nullmotion.rover.dense import interpolated
from nullmotion.rover.ground import Ground
from nullmotion.rover.landing_watch import LandingWatch
from nullmotion.rover.step_plan import StepPlan


@dataclass(frozen=True, eq=False)
class Landing:
    """A step on the ground; arrays over time, (k, ...).

    Attributes:
        plan: What was tracked.
        ground: The ground.
        t: Times [s].
        state: Position of the mass centre in f, r, p from the middle of the edge as it stood at
            first [m], q_BN, velocity [m/s], omega_B [rad/s], delta [rad], delta' [rad/s], (k, 15).
        signals: Angles, powers, sinkage and forces; see `Signals`.
        events: What happened, in order of time.
        outcome: ``landed``, ``tipped`` or ``turned away`` (by 15 deg, over or on the ground),
            ``fell back``, ``did not land``, or why the simulation ended early.
        landed_at: When it landed [s]; NaN if it did not. See `LandingWatch.landed`.
        slip: How far the edge's spikes got along the ground [m].
        tilt: Greatest angle by which the rover turned other than about the edge [rad].
        energy: Energy of gimbal and rotor motor until landing, Eq 88 [J].
        work: Work of both motors, signed, until the end [J].
        dissipated: Energy lost in the ground until the end [J].
        energy_change: Change of kinetic, potential and spring energy until the end [J].
        steps: Number of the solver's steps.
    """

    plan: StepPlan
    ground: Ground
    t: np.ndarray
    state: np.ndarray
    signals: Signals
    events: tuple[Event, ...]
    outcome: str
    landed_at: float
    slip: float
    tilt: float
    energy: float
    work: float
    dissipated: float
    energy_change: float
    steps: int

    @property
    def as_planned(self) -> bool:
        """Whether it landed with a slip below 10 mm and less than 1 deg off the edge."""
        return self.outcome == "landed" and self.slip < SLIP and self.tilt < TILT

    @property
    def spikes(self) -> np.ndarray:
        """Tips of the spikes in f, r, p, from where `state` counts [m], (k, V, 3)."""
        return spike_paths(self.state, self.plan.rover.chassis.vertices)[0]

    @property
    def energy_balance(self) -> float:
        """|work - losses - change of energy| over the energy used, or turned over if more."""
        rest = self.work - self.dissipated - self.energy_change
        return abs(rest) / max(self.energy, abs(self.work), abs(self.energy_change), 1e-12)

    @property
    def max_angle_error(self) -> float:
        """Greatest |planned less true angle| until landing [rad]."""
        until = self.t <= (self.landed_at if np.isfinite(self.landed_at) else np.inf)
        planned = interpolated(self.plan.x, self.plan.duration, self.t)[0]
        return float(np.abs(planned - self.signals.theta)[until].max())

    @property
    def cost_of_travel(self) -> float:
        """Energy per mass and distance [J/(kg m)], as in Table 4."""
        return self.energy / (self.plan.rover.mass * self.plan.frame.distance)


def landing_of(plan: StepPlan, ground: Ground, record: Record, watch: LandingWatch) -> Landing:
    """Return what came of a simulation."""
    t, x, signals = np.array(record.t), np.array(record.x), record.signals()
    spikes = plan.rover.chassis.vertices
    landed = np.nan if watch.landed is None else watch.landed
    events = contact_events(record, spikes, plan.frame.spikes, watch.leaving)
    if watch.landed is not None:
        down = (e.size for e in events if e.spike in watch.arriving and e.kind == "touchdown")
        events.append(Event(landed, "landing", next(down), "m/s"))
    total = signals.energy + signals.stored
    slip = slips(spike_paths(x, spikes)[0], plan.frame.spikes)
    return Landing(
        plan=plan,
        ground=ground,
        t=t,
        state=x,
        signals=signals,
        events=tuple(sorted(events, key=lambda event: event.t)),
        outcome=_outcome(plan, signals, watch, events, record.failure),
        landed_at=float(landed),
        slip=float(slip.max()),
        tilt=float(signals.tilt.max()),
        energy=record.integral(signals.used_power * ~(t > landed)),
        work=record.integral(signals.gimbal_power + signals.rotor_power),
        dissipated=record.integral(signals.dissipated),
        energy_change=float(total[-1] - total[0]),
        steps=record.steps,
    )


def _outcome(
    plan: StepPlan, signals: Signals, watch: LandingWatch, events: list[Event], failure: str
) -> str:
    sizes = {e.kind: e.size for e in events}
    tipped, turned = sizes.get("tipping", 0.0), sizes.get("turning", 0.0)
    if watch.tipped or (failure and max(tipped, turned)):
        return "tipped" if tipped >= turned else "turned away"
    if failure:
        return failure
    if watch.landed is not None:
        down = signals.theta[-1] > plan.frame.turn - TILT
        return "landed" if down else "fell back"
    back = [e for e in events if e.kind == "touchdown" and e.spike in watch.leaving]
    return "fell back" if back else "did not land"
