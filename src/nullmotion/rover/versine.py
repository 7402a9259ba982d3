"""The versine step: a turn that starts and ends at rest, with its greatest rate at the middle.

    theta = theta_f / 2 (1 - cos A t),    A = 2 rate / theta_f,    t_f = pi / A        (Eqs 93-95)

theta_f is the angle of the whole step, 2 alpha for a regular chassis. The acceleration jumps to
A rate at the start. A rover that is to follow it

- *stalls* when its actuator cannot give the torque: gravity then wins;
- *tips* when one spike of the edge would have to pull on the ground, the other still pressing;
- *lifts off* when both would.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nullmotion.rover.chassis import positive

SAMPLES = 4001


@dataclass(frozen=True, eq=False)
class Versine:
    """A versine over time, (k,).

    Attributes:
        t: Times [s].
        theta: Angle turned [rad].
        theta_dot: Its rate [rad/s].
        theta_ddot: Its acceleration [rad/s^2].
    """

    t: np.ndarray
    theta: np.ndarray
    theta_dot: np.ndarray
    theta_ddot: np.ndarray

    @classmethod
    def over(cls, turn: float, rate: float, samples: int = SAMPLES) -> Versine:
        """Return the versine that turns by an angle.

        Args:
            turn: theta_f [rad].
            rate: Greatest rate [rad/s].
            samples: Number of times.

        Raises:
            InputError: For a rate that is not above 0.
        """
        half, rate = turn / 2, positive("rate_rad_s", rate)
        A = rate / half
        t = np.linspace(0.0, np.pi / A, samples)
        c, s = np.cos(A * t), np.sin(A * t)
        return cls(t, half * (1 - c), rate * s, A * rate * c)


@dataclass(frozen=True)
class Verdict:
    """How a step comes out.

    Attributes:
        outcome: ``landed``, ``stalled``, ``tipped`` or ``lifted off``.
        time: When it goes wrong, or t_f [s].
        angle: Where it goes wrong, or theta_f [rad].
        reason: What goes wrong, in words.
    """

    outcome: str
    time: float
    angle: float
    reason: str = ""


def verdict(
    step: Versine, short: np.ndarray, spare: tuple[np.ndarray, np.ndarray], lacking: str
) -> Verdict:
    """Return how a versine comes out.

    Args:
        step: The versine.
        short: Whether the actuator cannot give what it takes, (k,).
        spare: Torque to spare before spike b, and spike a, lifts off [N m], (k,) each.
        lacking: What the actuator lacks, in words.
    """
    for_b, for_a = spare
    loose = np.minimum(for_a, for_b) < 0
    wrong = short | loose
    if not wrong.any():
        return Verdict("landed", float(step.t[-1]), float(step.theta[-1]))
    i = int(np.argmax(wrong))
    if not loose[i]:
        outcome, reason = "stalled", lacking
    elif for_a[i] + for_b[i] < 0:
        outcome, reason = "lifted off", "both spikes of the edge would have to pull on the ground"
    else:
        spike = "a" if for_a[i] < for_b[i] else "b"
        outcome, reason = "tipped", f"spike {spike} of the edge would have to pull on the ground"
    return Verdict(outcome, float(step.t[i]), float(step.theta[i]), reason)
