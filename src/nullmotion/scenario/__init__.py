"""Scenario files: read, checked, built, run, stored."""

from __future__ import annotations

from nullmotion.scenario.load import library_names, load_scenario
from nullmotion.scenario.problems import Problem, ScenarioError
from nullmotion.scenario.scenario import Scenario

__all__ = ["Problem", "Scenario", "ScenarioError", "library_names", "load_scenario"]
