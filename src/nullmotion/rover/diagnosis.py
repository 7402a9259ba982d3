"""Which of Table 1's limits stands in the way of a step, and by how much.

Each limit is made soft by a share of itself (torques by a share of M g L/2), and the sum of the
shares is made least: a sum, not squares, so that few limits are passed.
"""

from __future__ import annotations

from nullmotion.rover import solve
from nullmotion.rover.collocation_rows import SOFT
from nullmotion.rover.plan_error import Violation
from nullmotion.rover.solve import Solution, Task, Tick

_UNITS = ("rad/s", "rad/s^2", "rad/s", "s", "", "N m", "N m")
_SEEN = 1e-5  # a share below this is the solver's tolerance


def least_violation(task: Task, duration: float, tick: Tick | None = None) -> Solution | None:
    """Return the step of a branch that passes its limits least, or None without convergence."""
    start = solve.guess(task, task.settings.nodes[0], duration)._replace(c=0.0)
    solution = solve.solve(task, start, elastic=True, tick=tick)
    return solution if solution.closed else None


def violations(task: Task, solution: Solution) -> tuple[Violation, ...]:
    """Return the limits that a solution of the elastic program passes, the worst first."""
    shares = sorted(enumerate(solution.soft.tolist()), key=lambda item: -item[1])
    return tuple(_violation(task, i, share) for i, share in shares if share > _SEEN)


def off_axis(margin: float) -> Violation:
    """Return the violation of a step whose least margin is below 0 [N m]."""
    return Violation("off-axis torque: min(C) =", margin, "at least", 0.0, "N m")


def _violation(task: Task, i: int, share: float) -> Violation:
    if SOFT[i] == "off-axis torque":
        return off_axis(-share * task.model.scale)
    if SOFT[i] == "dynamic threshold":
        value = -share * task.model.scale
        return Violation("dynamic threshold", value, "at least", 0.0, "N m")
    limit = task.limits[i]
    if SOFT[i] == "singular orientation":
        return Violation(
            "singular orientation: |o.r| =", limit * (1 - share), "at least", limit, ""
        )
    return Violation(SOFT[i], limit * (1 + share), "at most", limit, _UNITS[i])
