"""Plans: the best null motion over a whole manoeuvre, searched with proof or without."""

from __future__ import annotations

from nullmotion.plan.methods import METHODS, prepared, search
from nullmotion.plan.result import Found, PlanResult
from nullmotion.plan.rollout import Rollouts

__all__ = ["METHODS", "Found", "PlanResult", "Rollouts", "prepared", "search"]
