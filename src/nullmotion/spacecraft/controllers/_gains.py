"""Gains of attitude feedback: given, or of the inertia and the response wanted.

    kp = 2 J w^2,    kw = 2 zeta J w

give a small error about any axis, q_v = angle / 2, the second-order response of natural
frequency w and damping zeta, whatever the inertia.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from nullmotion.errors import InputError
from nullmotion.law import check_parameters

_RESPONSE = {"natural_frequency_rad_s": 0.5, "damping": 1.0}


def check_gains(controller: Any) -> None:
    """Check the gains of a controller under construction; put defaults where none are given.

    Raises:
        InputError: For a gain without the other, or beside the response that it would decide.
    """
    gains = ("kp", "kw")
    check_parameters(controller, (*gains, *_RESPONSE), kind="controller")
    given = [key for key in gains if getattr(controller, key) is not None]
    for key in gains:
        value = getattr(controller, key)
        if isinstance(value, tuple) and len(value) != 3:
            raise InputError(f"controller.{key}", value, "one number or three")
        if given and value is None:
            raise InputError(f"controller.{key}", None, f"given where {given[0]} is, or neither")
    for key, default in _RESPONSE.items():
        value = getattr(controller, key)
        if given and value is not None:
            raise InputError(f"controller.{key}", value, "left out where kp and kw are given")
        if not given and value is None:
            object.__setattr__(controller, key, default)


def feedback(controller: Any, inertia: Any, q_v: Any, rate: Any) -> Any:
    """Return the torque -(kp q_v + kw rate) [N m], (3,)."""
    if controller.kp is None:
        w, zeta = controller.natural_frequency_rad_s, controller.damping
        return -(inertia @ ((2.0 * w * w) * q_v + (2.0 * zeta * w) * rate))
    return -(np.array(controller.kp) * q_v + np.array(controller.kw) * rate)
