"""What the ground does to a spike: a spring and a damper across it, a damper along it.

    x   = p + C_NB c,   v = p' + C_NB (omega x c)      tip of spike c
    s   = -z                                           its sinkage; z is normal to the ground
    F_n = K_c s - C_c z'   if both s and that are above 0, else 0
    F_t = -C_d v_t min(1, F_n / F_g) min(1, mu F_n / (C_d |v_t|))

(Elliott 2019, Fig 33 and Table 3, with neither F_g nor mu.) The ground pushes and never pulls. A
spike that leaves faster than the ground follows carries nothing while it is still below the plane:
the spring then works on its damper alone. F_g is a small part of the weight: without it the damper
along the ground would come and go at once with the last of the load. Which spikes carry is a given
here, `carries`, that `contact` changes at the instants when it has to: between them all is smooth.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from nullmotion import linalg, ops, rotation
from nullmotion.rover.contact_state import State

_LEAST = 1e-30  # N: 0 / 0 where neither friction nor motion is


class GroundNumbers(NamedTuple):
    """A ground as plain numbers: see `nullmotion.rover.ground.Ground`.

    Attributes:
        stiffness: K_c [N/m].
        damping: C_c [N s/m].
        drag: C_d [N s/m].
        friction: mu.
        cone: 1 if friction is bounded, else 0.
        grip: F_g [N].
    """

    stiffness: Any
    damping: Any
    drag: Any
    friction: Any
    cone: Any
    grip: Any


class Touch(NamedTuple):
    """The ground under one spike.

    Attributes:
        force: In ground axes [N], (3,).
        torque: About the mass centre in body axes [N m], (3,).
        sinkage: s, negative above the ground [m].
        normal: K_c s - C_c z', what the spike carries or would if it did [N].
        sliding: C_d |v_t| - mu F_n of a spike that carries [N]: above 0 friction is used up.
        stored: Energy in the spring [J].
        dissipated: Power lost in dampers and friction [W].
    """

    force: Any
    torque: Any
    sinkage: Any
    normal: Any
    sliding: Any
    stored: Any
    dissipated: Any


def touch(state: State, spike: Any, carries: Any, ground: GroundNumbers) -> Touch:
    """Return what the ground does to a spike, on floats and symbols alike.

    Args:
        state: The rover's state.
        spike: c, from the mass centre to the tip in body axes [m], (3,).
        carries: 1 if the spike carries, 0 if not.
        ground: The ground.
    """
    g, C_BN = ground, rotation.matrix(rotation.normalised(state.attitude))
    s = -(state.position + spike @ C_BN)[2]
    v = state.velocity + linalg.cross(state.rate, spike) @ C_BN
    normal = g.stiffness * s - g.damping * v[2]
    F_n = carries * normal
    wanted = carries * g.drag * ops.sqrt(v[0] * v[0] + v[1] * v[1])
    most = g.friction * ops.maximum(0.0, F_n)
    kept = most / ops.maximum(ops.maximum(most, wanted), _LEAST)
    share = (1.0 - g.cone * (1.0 - kept)) * ops.clip(F_n / g.grip, 0.0, 1.0)
    drag = -carries * g.drag * share
    force = np.array([drag * v[0], drag * v[1], F_n])
    below = carries * s + (1.0 - carries) * ops.maximum(0.0, s)
    return Touch(
        force=force,
        torque=linalg.cross(spike, C_BN @ force),
        sinkage=s,
        normal=normal,
        sliding=g.cone * (wanted - most),
        stored=0.5 * g.stiffness * below * below,
        dissipated=g.stiffness * below * v[2] - force @ v,
    )
