"""What events do to the array as it is and to the array as the law knows it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from nullmotion import ops
from nullmotion.array.model import CmgArray
from nullmotion.spacecraft.events import Event

Events = tuple[Event, ...]


def of_kind(events: Events, kind: str) -> Events:
    """Return the events of one kind."""
    return tuple(e for e in events if e.kind == kind)


def as_it_is(array: CmgArray, events: Events, t: Any) -> CmgArray:
    """Return the true array at a time: wheels that spin down have lost momentum."""
    spinning = of_kind(events, "spin-down")
    return array.altered(h0=array.h0 * _left(spinning, array.n, t)) if spinning else array


def as_working(array: CmgArray, events: Events, t: Any) -> CmgArray:
    """Return the true array at a time with stuck CMGs left out: what can still give torque."""
    if not events:
        return array
    now = as_it_is(array, events, t)
    return now.altered(h0=now.h0 * stuck(events, array.n, t))


def momentum_loss(array: CmgArray, events: Events, t: Any, delta: Any, start: Any) -> Any:
    """Return sum_i dh0_i/dt (s_i cos delta_i + t_i sin delta_i) of wheels spinning down [N m].

    A wheel begins at the start of a step: the end of the step before knows nothing of it.
    """
    spinning = of_kind(events, "spin-down")
    if not spinning:
        return np.zeros(array.m)
    slopes = _slopes(spinning, array.n, t, start)
    momenta = array.altered(h0=array.h0 * slopes).rotor_momenta(delta)
    return sum(momenta[i] for i in range(array.n))


def as_known(array: CmgArray, events: Events, t: Any, delta: Any) -> CmgArray:
    """Return the array that the law steers with: its own, and what it has been told since.

    A stuck CMG counts without momentum, and what it holds at the measured angles as bias.
    """
    if not events:
        return array
    n = array.n
    turning = _per_cmg(
        of_kind(events, "stuck"), n, 1.0, lambda e, now: ops.where(_found(e, t), 0.0, now)
    )
    known = _per_cmg(
        of_kind(events, "spin-down"),
        n,
        1.0,
        lambda e, now: ops.where(_found(e, t), now * _share(e, t), now),
    )
    limit = _per_cmg(
        of_kind(events, "slow"),
        n,
        array.rate_limit,
        lambda e, now: ops.where(_found(e, t), ops.minimum(now, e.rate_limit), now),
    )
    held = array.altered(h0=array.h0 * known * (1.0 - turning)).rotor_momenta(delta)
    bias = array.momentum_bias + sum(held[i] for i in range(n)) @ array.torque_axes
    altered = {"h0": array.h0 * known * turning, "momentum_bias": bias, "rate_limit": limit}
    dead = of_kind(events, "wheel-dead")
    if dead and array.wheels is not None:
        most = array.wheels.torque_limit
        told = _per_cmg(dead, n, most, lambda e, now: ops.where(_found(e, t), 0.0, now))
        altered["wheels"] = array.wheels.altered(torque_limit=told)
    return array.altered(**altered)


def shares(events: Events, n: int, times: np.ndarray) -> np.ndarray:
    """Return the share of its momentum that each CMG has at each time, (times, n).

    Of a wheel that spins down it is what is left; a stuck CMG counts as without.
    """
    table = np.ones((len(times), n))
    for event in of_kind(events, "spin-down"):
        table[:, event.cmg] *= _share(event, times)
    for event in of_kind(events, "stuck"):
        table[_begun(event, times), event.cmg] = 0.0
    return table


def stuck(events: Events, n: int, t: Any) -> Any:
    """Return 1 for each CMG that turns and 0 for each that is stuck, (n,)."""
    kind = of_kind(events, "stuck")
    return _per_cmg(kind, n, 1.0, lambda e, now: ops.where(_begun(e, t), 0.0, now))


def running(events: Events, n: int, t: Any) -> Any:
    """Return 1 for each CMG whose wheel has a motor that works, else 0, (n,)."""
    kind = of_kind(events, "wheel-dead")
    return _per_cmg(kind, n, 1.0, lambda e, now: ops.where(_begun(e, t), 0.0, now))


def rate_bound(events: Events, n: int, t: Any) -> Any:
    """Return the greatest rate that each gimbal can turn at [rad/s], (n,)."""
    kind = of_kind(events, "slow")
    return _per_cmg(
        kind, n, np.inf, lambda e, now: ops.where(_begun(e, t), ops.minimum(now, e.rate_limit), now)
    )


def _per_cmg(events: Events, n: int, start: Any, change: Callable[[Event, Any], Any]) -> Any:
    """Return a value for each CMG, changed by each of its events in turn."""
    values = list(np.broadcast_to(start, (n,)))
    for event in events:
        values[event.cmg] = change(event, values[event.cmg])
    return np.array(values)


def _begun(event: Event, t: Any) -> Any:
    return ops.less_equal(event.at, t)


def _found(event: Event, t: Any) -> Any:
    return ops.less_equal(event.at + event.detected_after, t)


def _left(events: Events, n: int, t: Any) -> Any:
    return _per_cmg(events, n, 1.0, lambda e, now: now * _share(e, t))


def _share(event: Event, t: Any) -> Any:
    """Return the share of a wheel's momentum that is left."""
    since = ops.maximum(t - event.at, 0.0)
    decay = ops.exp(-since / event.time_constant)
    return event.final_fraction + (1.0 - event.final_fraction) * decay


def _slopes(events: Events, n: int, t: Any, start: Any) -> Any:
    """Return the derivative of `_left` [1/s] within a step: by the product rule."""
    shares, slopes = [1.0] * n, [0.0] * n
    for event in events:
        i, share = event.cmg, _share(event, t)
        slopes[i] = slopes[i] * share + shares[i] * _slope(event, t, start)
        shares[i] = shares[i] * share
    return np.array(slopes)


def _slope(event: Event, t: Any, start: Any) -> Any:
    """Return the derivative of `_share` [1/s] within a step."""
    decay = ops.exp(-ops.maximum(t - event.at, 0.0) / event.time_constant)
    slope = -(1.0 - event.final_fraction) / event.time_constant * decay
    return ops.where(_begun(event, start), slope, 0.0)
