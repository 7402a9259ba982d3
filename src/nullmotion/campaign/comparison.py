"""What a comparison holds: its cases, and how they are written."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from nullmotion.scenario import dataset
from nullmotion.scenario.scenario import Scenario
from nullmotion.sim.trajectory import Trajectory


@dataclass(frozen=True)
class Case:
    """One law on the scenario (at one value, when a key is varied).

    Attributes:
        label: Name in tables.
        law: The law's name.
        parameters_kind: ``defaults``, ``published``, ``given`` or ``published, given``.
        parameters: The law's parameters, defaults put in.
        information: What the law reads beyond delta, hdot, t and the period.
        value: What the varied key was; None when none is.
        trajectory: The run; None when the law cannot steer the array.
        reason: Why it could not run; empty when it did.
        metrics: Numbers of the run by name, ``stopped_at_s`` among them.
        summary: What ``summary.json`` would hold of the run.
    """

    label: str
    law: str
    parameters_kind: str
    parameters: Mapping[str, Any]
    information: tuple[str, ...] = ()
    value: Any = None
    trajectory: Trajectory | None = None
    reason: str = ""
    metrics: Mapping[str, Any] = field(default_factory=dict)
    summary: Mapping[str, Any] = field(default_factory=dict)

    def row(self) -> dict[str, Any]:
        """Return the case as ``compare.json`` holds it."""
        found: dict[str, Any] = {
            "label": self.label,
            "law": self.law,
            "parameters_kind": self.parameters_kind,
            "parameters": dict(self.parameters),
            "information": list(self.information),
        }
        if self.value is not None:
            found["value"] = self.value
        if self.trajectory is None:
            return found | {"ran": False, "reason": self.reason}
        return found | {"ran": True, **self.summary}


@dataclass(frozen=True)
class Comparison:
    """All cases of a comparison.

    Attributes:
        scenario: What was flown.
        cases: In the order of the file; all cases of the first value come first.
        varied: Dotted key that was varied; None when none was.
        values: What it took.
    """

    scenario: Scenario
    cases: tuple[Case, ...]
    varied: str | None = None
    values: tuple[Any, ...] = ()

    @property
    def title(self) -> str:
        """What was compared."""
        return self.scenario.title

    def to_json(self) -> str:
        """Return the text of ``compare.json``; what is not finite is null."""
        found = {
            "scenario": self.scenario.name,
            "title": self.title,
            "varied": self.varied,
            "values": list(self.values),
            "versions": dataset.versions(),
            "scenario_text": self.scenario.source.effective_text(),
            "cases": [case.row() for case in self.cases],
        }
        return json.dumps(dataset.plain(found), indent=2) + "\n"
