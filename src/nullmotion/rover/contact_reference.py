"""The plan or history that a law is told, evaluated at any time in a few microseconds.

Between nodes k and k + 1 accelerations are linear, so that

    x' = x'_k + a_k u + j u^2 / 2,   x = x_k + x'_k u + a_k u^2 / 2 + j u^3 / 6,   u = t - t_k

After the last node the angle stays and rates are zero.
"""

from __future__ import annotations

from bisect import bisect_right

import numpy as np

from nullmotion.rover.step_plan import StepPlan
from nullmotion.rover.step_run import StepRun

_FIELDS = ("theta", "theta_dot", "theta_ddot", "delta", "delta_dot", "delta_ddot")


class Reference:
    """What a law is told over time; see `contact_command.Told`.

    Attributes:
        acts: Whether the law acts; set to False to brake the gimbal.
        duration: Time of the last node [s].
    """

    def __init__(self, step: StepPlan | StepRun) -> None:
        """Take the nodes of a plan, or of a closed loop's run."""
        values = [np.asarray(getattr(step, key), float) for key in _FIELDS]
        self._t: list[float] = np.asarray(step.t, float).tolist()
        self._nodes: list[list[float]] = np.array(values).T.tolist()
        self.acts, self.duration = True, self._t[-1]

    def __call__(self, t: float) -> list[float]:
        """Return what the law is told at a time [s]."""
        acts = 1.0 if self.acts else 0.0
        if t >= self.duration:
            theta, delta = self._nodes[-1][0], self._nodes[-1][3]
            return [acts, theta, 0.0, 0.0, delta, 0.0, 0.0]
        k = bisect_right(self._t, t) - 1
        u, h = t - self._t[k], self._t[k + 1] - self._t[k]
        now, then = self._nodes[k], self._nodes[k + 1]
        told = [acts]
        for i in (0, 3):
            x, v, a = now[i : i + 3]
            j = (then[i + 2] - a) / h
            told += [x + u * (v + u * (a / 2 + u * j / 6)), v + u * (a + u * j / 2), a + u * j]
        return told
