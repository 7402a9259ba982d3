"""What happened to the spikes: lift-offs, touchdowns, sliding, slip, tipping; times and sizes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nullmotion import rotation
from nullmotion.rover.contact_record import Record
from nullmotion.rover.contact_signals import Signals

NOTICED = 1e-5  # m: a spike that rises less is only unloaded
SLIP = 0.01  # m
TILT = float(np.radians(1.0))  # rad


@dataclass(frozen=True)
class Event:
    """Something that happened.

    Attributes:
        t: When it began [s].
        kind: ``departure`` of a spike that the step lifts, ``lift-off`` of another, ``touchdown``,
            ``sliding`` (friction used up), ``slip`` (the edge more than 10 mm along the ground),
            ``tipping`` (the edge more than 1 deg off the ground), ``turning`` (the edge's
            direction by more than 1 deg), ``landing``.
        size: How high it rose, how fast it came down, how far it slid, how far it turned.
        unit: Unit of the size: ``m``, ``m/s`` or ``rad``.
        spike: Corner of the chassis; None if it is about the rover.
    """

    t: float
    kind: str
    size: float
    unit: str
    spike: int | None = None

    def __str__(self) -> str:
        """Return the event on one line."""
        where = "" if self.spike is None else f" of spike {self.spike}"
        return f"{self.t:8.4f} s  {self.kind}{where}: {self.size:.3g} {self.unit}"


def spike_paths(x: np.ndarray, spikes: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return positions [m] and velocities [m/s] of the spikes in ground axes, (k, V, 3) each."""
    q = x[:, 3:7] / np.linalg.norm(x[:, 3:7], axis=1, keepdims=True)
    C_BN = rotation.matrix(q.T)
    swept = np.cross(x[:, None, 10:13], spikes)
    places = x[:, None, :3] + np.einsum("bnk,ib->kin", C_BN, spikes)
    return places, x[:, None, 7:10] + np.einsum("bnk,kib->kin", C_BN, swept)


def contact_events(
    record: Record, spikes: np.ndarray, edge: tuple[int, int], leaving: set[int]
) -> list[Event]:
    """Return what happened, in order of time.

    Args:
        record: The simulation.
        spikes: Tips about the mass centre in body axes [m], (V, 3).
        edge: Spikes of the step's edge.
        leaving: Spikes that the step lifts off the ground.
    """
    t, signals = np.array(record.t), record.signals()
    places, velocities = spike_paths(np.array(record.x), spikes)
    found = _changes(record, t, signals, spikes, leaving)
    found += _sliding(record, t, signals, velocities)
    slip = slips(places, edge)
    found += _first(t, slip, SLIP, "slip", "m")
    lean, yaw = edge_angles(places, edge)
    found += _first(t, lean, TILT, "tipping", "rad")
    found += _first(t, yaw, TILT, "turning", "rad")
    return sorted(found, key=lambda event: event.t)


def slips(places: np.ndarray, edge: tuple[int, int]) -> np.ndarray:
    """Return how far the edge's spikes are from where they stood, along the ground [m], (k,)."""
    moved = places[:, edge, :2] - places[0, edge, :2]
    farther: np.ndarray = np.linalg.norm(moved, axis=2).max(axis=1)
    return farther


def edge_angles(places: np.ndarray, edge: tuple[int, int]) -> tuple[np.ndarray, np.ndarray]:
    """Return by how much the edge leaves the ground, and its direction there [rad], (k,) each."""
    along = places[:, edge[1]] - places[:, edge[0]]
    flat = np.linalg.norm(along[:, :2], axis=1)
    return np.abs(np.arctan2(along[:, 2], flat)), np.abs(np.arctan2(along[:, 0], along[:, 1]))


def _first(t: np.ndarray, values: np.ndarray, limit: float, kind: str, unit: str) -> list[Event]:
    """Return the event that values pass a limit, if they do."""
    over = np.flatnonzero(values > limit)
    return [Event(float(t[over[0]]), kind, float(values.max()), unit)] if over.size else []


def _changes(
    record: Record, t: np.ndarray, signals: Signals, spikes: np.ndarray, leaving: set[int]
) -> list[Event]:
    """Return departures, lift-offs and touchdowns; those that cannot be noticed are left out."""
    found: list[Event] = []
    unnoticed: set[int] = set()
    changes = record.changes
    for i, change in enumerate(changes):
        spike = change.spike
        places, velocities = spike_paths(change.x[None], spikes)
        if change.carries:
            if spike not in unnoticed:
                speed = -float(velocities[0, spike, 2])
                found.append(Event(change.t, "touchdown", speed, "m/s", spike))
            continue
        back = next((c.t for c in changes[i + 1 :] if c.spike == spike), np.inf)
        low, during = -float(places[0, spike, 2]), (t >= change.t) & (t <= back)
        rise = low - float(signals.sinkage[during, spike].min(initial=low))
        unnoticed.add(spike) if rise < NOTICED else unnoticed.discard(spike)
        if rise >= NOTICED:
            kind = "departure" if spike in leaving else "lift-off"
            found.append(Event(change.t, kind, rise, "m", spike))
            leaving = leaving - {spike}
    return found


def _sliding(
    record: Record, t: np.ndarray, signals: Signals, velocities: np.ndarray
) -> list[Event]:
    """Return when spikes slid because friction was used up."""
    slid = np.array(record.carrying) & (signals.sliding > 0)
    weight, speed = np.array(record.weight), np.linalg.norm(velocities[..., :2], axis=2)
    found = []
    for spike in np.flatnonzero(slid.any(axis=0)):
        bounds = np.flatnonzero(np.diff(np.concatenate([[False], slid[:, spike], [False]])))
        for begin, end in bounds.reshape(-1, 2):
            far = float(weight[begin:end] @ speed[begin:end, spike])
            if far >= NOTICED:
                found.append(Event(float(t[begin]), "sliding", far, "m", int(spike)))
    return found
