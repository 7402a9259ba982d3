"""Which laws a comparison runs, and on what parameters."""

from __future__ import annotations

from collections.abc import Sequence

from nullmotion import laws
from nullmotion.errors import UnknownNameError
from nullmotion.scenario import sections
from nullmotion.scenario.scenario import Scenario
from nullmotion.scenario.schema import CaseSection, LawSection, NamedLaw


def parameters_kind(section: NamedLaw) -> str:
    """Return ``defaults``, ``published``, ``given``, or ``published, given``."""
    keys = section.model_fields_set - {"name", "label", "period_s", "delay_s"}
    published = bool(getattr(section, "as_published", False))
    kinds = ["published"] * published + ["given"] * bool(keys - {"as_published"})
    return ", ".join(kinds) or "defaults"


def given_parameters(section: NamedLaw) -> dict[str, object]:
    """Return what the file gives beside the name."""
    keys = [k for k in type(section).model_fields if k in section.model_fields_set]
    return {
        k: getattr(section, k) for k in keys if k not in ("name", "label", "period_s", "delay_s")
    }


def listed(
    scenario: Scenario, names: Sequence[str] | None, more: Sequence[str] = ()
) -> list[tuple[str, CaseSection]]:
    """Return the labelled cases: [law], those of the file or the named laws, then more.

    Raises:
        UnknownNameError: For a law that does not exist, with the nearest names.
    """
    own = _as_case(scenario.law)
    others = list(scenario.cases) if names is None else [_default(name) for name in names]
    known = [own, *others]
    others += [
        case for case in map(_default, more) if not any(_same(case, other) for other in known)
    ]
    found = [own] if not any(_same(own, other) for other in others) else []
    return _labelled([*found, *others])


def _default(name: str) -> CaseSection:
    try:
        laws.get(name)
    except UnknownNameError:
        raise UnknownNameError("law", name, laws.names(), "--laws") from None
    return sections.case_model(name)(name=name)


def _as_case(law: LawSection) -> CaseSection:
    values = {k: getattr(law, k) for k in law.model_fields_set if k not in ("period_s", "delay_s")}
    return sections.case_model(law.name).model_validate(values)


def _same(a: CaseSection, b: CaseSection) -> bool:
    same_law = laws.get(a.name) is laws.get(b.name)
    return same_law and given_parameters(a) == given_parameters(b)


def _labelled(found: Sequence[CaseSection]) -> list[tuple[str, CaseSection]]:
    """Give each case a label of its own."""
    taken: dict[str, int] = {}
    result = []
    for case in found:
        kind = parameters_kind(case)
        label = case.label or (case.name if kind == "defaults" else f"{case.name} ({kind})")
        taken[label] = taken.get(label, 0) + 1
        result.append((label if taken[label] == 1 else f"{label} #{taken[label]}", case))
    return result
