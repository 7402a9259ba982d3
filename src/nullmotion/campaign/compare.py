"""Laws x metrics on one scenario, at one value or over the values of a key."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

from nullmotion import laws
from nullmotion.campaign import cases as chosen
from nullmotion.campaign import fly
from nullmotion.campaign.comparison import Case, Comparison
from nullmotion.campaign.vary import Vary
from nullmotion.errors import UnsupportedArrayError
from nullmotion.scenario import build, requirements, sections
from nullmotion.scenario.scenario import Scenario
from nullmotion.scenario.schema import CaseSection
from nullmotion.sim.setup import Setup

Progress = Callable[[float], None]
Planned = tuple[Scenario, Any, str, CaseSection]


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
    judged = requirements.evaluate(at, run.summary) if run else []
    return Case(
        label=label,
        law=cls.name,
        parameters_kind=chosen.parameters_kind(case),
        parameters=chosen.given_parameters(case)
        if isinstance(setup, str)
        else sections.written(setup.law),
        information=cls.information if isinstance(setup, str) else setup.law.information_used,
        value=value,
        trajectory=run.trajectory if run else None,
        reason=setup if isinstance(setup, str) else "",
        metrics={"stopped_at_s": run.trajectory.stopped_at_s, **run.trajectory.metrics}
        if run
        else {},
        summary={**run.summary, **({"requirements": judged} if judged else {})} if run else {},
    )


def write(comparison: Comparison, folder: Path) -> None:
    """Write ``compare.json`` into a folder."""
    (folder / "compare.json").write_text(comparison.to_json(), encoding="utf-8")
