"""Design of the bias between two planes of CMGs: `solve.design` for a `goal.Goal`."""

from nullmotion.guarantee.design.family import Family, family_of
from nullmotion.guarantee.design.goal import OBJECTIVES, Goal, Reward, goal_of
from nullmotion.guarantee.design.solve import Design, design

__all__ = ["OBJECTIVES", "Design", "Family", "Goal", "Reward", "design", "family_of", "goal_of"]
