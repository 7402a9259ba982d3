"""What the planner is allowed and how it solves (Elliott 2019, Table 1 and Section 5.4.1)."""

from __future__ import annotations

from dataclasses import dataclass

from nullmotion.errors import InputError
from nullmotion.rover.chassis import positive


@dataclass(frozen=True)
class Settings:
    """Settings of `plan_step`.

    Args:
        nodes: Collocation nodes of the first solves and of the one that starts from the best.
        most_nodes: As far as nodes are doubled when the margin falls between them.
        dense: How many times denser the grid is on which the margin is checked.
        drop: Share of the margin that it may fall between nodes.
        regularisation: Weight of the integral of delta''^2 beside the margin over M g L/2. With
            none delta'' jumps from node to node.
        start_durations: Guesses of t_f [s]; each is tried.
        shortest: Least t_f [s].
        longest: Greatest t_f [s].
        acceleration: Greatest planned gimbal acceleration [rad/s^2].
        authority: Least |o . r|.
        body_rate: Greatest rate of the body [rad/s].

    Raises:
        InputError: For a value that makes no sense.
    """

    nodes: tuple[int, int] = (60, 120)
    most_nodes: int = 960
    dense: int = 10
    drop: float = 0.02
    regularisation: float = 3e-3
    start_durations: tuple[float, ...] = (2.5, 6.0)
    shortest: float = 0.5
    longest: float = 10.0
    acceleration: float = 5.0
    authority: float = 0.1
    body_rate: float = 2.0

    def __post_init__(self) -> None:
        """Check what can be checked."""
        for key in ("regularisation", "shortest", "longest", "acceleration", "body_rate", "drop"):
            positive(key, getattr(self, key))
        if min(self.nodes) < 10:
            raise InputError("nodes", self.nodes, "two numbers of nodes, 10 or more each")
        if not self.start_durations or self.dense < 1:
            allowed = "one or more guesses, and a grid at least as dense as the nodes"
            raise InputError("start_durations", self.start_durations, allowed)
        if not self.shortest < self.longest:
            raise InputError("longest", self.longest, f"above the shortest ({self.shortest} s)")
        if not 0 < self.authority < 1:
            raise InputError("authority", self.authority, "between 0 and 1")
