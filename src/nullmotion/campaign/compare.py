"""Laws x metrics on one scenario, at one value or over the values of a key."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from nullmotion import laws
from nullmotion.campaign import cases as chosen
from nullmotion.campaign import fly
from nullmotion.campaign.vary import Vary
from nullmotion.errors import UnsupportedArrayError
from nullmotion.scenario import build, dataset, sections
from nullmotion.scenario.scenario import Scenario
from nullmotion.scenario.schema import CaseSection
from nullmotion.sim.setup import Setup
from nullmotion.sim.trajectory import Trajectory

Progress = Callable[[float], None]
Planned = tuple[Scenario, Any, str, CaseSection]


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


def compare(
    scenario: Scenario,
    law_names: Sequence[str] | None = None,
    vary: Vary | None = None,
    progress: Progress | None = None,
    more: Sequence[str] = (),
) -> Comparison:
    """Run laws on one scenario.

    Args:
        scenario: What is flown; its ``[law]`` comes first.
        law_names: Laws to run on their defaults in place of the file's ``[[compare.case]]``.
        vary: A key of the scenario and the values it takes.
        progress: Called with the finished share.
        more: Laws to run on their defaults beside all that.
    """
    plan = list(_plan(scenario, law_names, vary, more))
    made = [_prepared(at, case) for at, _, _, case in plan]
    setups = [setup for setup in made if not isinstance(setup, str)]
    flown = iter(fly.together(setups, progress) if vary else fly.one_by_one(setups, progress))
    done = []
    for entry, setup in zip(plan, made, strict=True):
        done.append(_case(*entry, setup, None if isinstance(setup, str) else next(flown)))
    return Comparison(
        scenario, tuple(done), vary.key if vary else None, vary.values if vary else ()
    )


def _plan(
    scenario: Scenario, names: Sequence[str] | None, vary: Vary | None, more: Sequence[str]
) -> Iterator[Planned]:
    """Yield what is to run; every value is checked before the first run."""
    labelled = chosen.listed(scenario, names, more)
    if vary is None:
        yield from ((scenario, None, *entry) for entry in labelled)
        return
    for value in vary.values:
        at = scenario.with_values({vary.key: value}, "--vary")
        if vary.key.startswith("law."):
            labelled = chosen.listed(at, names, more)
        yield from ((at, value, *entry) for entry in labelled)


def _prepared(scenario: Scenario, case: CaseSection) -> Setup | str:
    """Return a case's setup, or why its law cannot steer the array."""
    try:
        return build.setup(scenario.with_law(case))
    except UnsupportedArrayError as error:
        return error.reason


def _case(
    at: Scenario,
    value: Any,
    label: str,
    case: CaseSection,
    setup: Setup | str,
    run: fly.Flown | None,
) -> Case:
    cls = laws.get(case.name)
    return Case(
        label=label,
        law=cls.name,
        parameters_kind=chosen.parameters_kind(case),
        parameters=chosen.given_parameters(case)
        if isinstance(setup, str)
        else sections.written(setup.law),
        information=tuple(cls.information),
        value=value,
        trajectory=run.trajectory if run else None,
        reason=setup if isinstance(setup, str) else "",
        metrics={"stopped_at_s": run.trajectory.stopped_at_s, **run.trajectory.metrics}
        if run
        else {},
        summary=run.summary if run else {},
    )


def write(comparison: Comparison, folder: Path) -> None:
    """Write ``compare.json`` into a folder."""
    (folder / "compare.json").write_text(comparison.to_json(), encoding="utf-8")
