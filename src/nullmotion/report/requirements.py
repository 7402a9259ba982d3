"""Requirements of a scenario and how runs kept them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from nullmotion.report.markup import Markup, join, tag
from nullmotion.report.tables import table
from nullmotion.report.wording import meaning, percent, quantity

_MOST_SHARE = 10.0  # of the limit; a larger margin as a share of it tells nothing
Results = Sequence[Mapping[str, Any]]
"""What `nullmotion.scenario.requirements.evaluate` returns."""


def tally(results: Results) -> str:
    """Return how many were passed, of how many."""
    return f"{sum(bool(result['passed']) for result in results)}/{len(results)}"


def name(result: Mapping[str, Any]) -> str:
    """Return a requirement in words, its limit with it."""
    key, side = _split(result)
    what, comma, when = meaning(key).words.partition(", ")
    said = f"{what} ({when})" if comma else what
    limit = f"{side} {_with_unit(key, result['limit'])}".replace(" ", "\u00a0")
    return f"{said} {limit}"


def requirement_table(results: Results) -> Markup:
    """Return the requirements of one run with values and margins."""
    rows = []
    for result in results:
        key, side = _split(result)
        words = meaning(key).words
        limit = f"{side} {_with_unit(key, result['limit'])}"
        named = words[:1].upper() + words[1:]
        rows.append((named, mark(result), _value(result), limit, _margin(result)))
    head = ("Requirement", "Result", "Value", "Limit", "Margin")
    return table(head, rows, "Requirements and how the run kept them", numeric=(2, 3, 4))


def compared_table(cases: Sequence[Any]) -> Markup:
    """Return the requirements of all cases of a comparison, a row a case; empty without any."""
    found = [(case.label, of_case(case)) for case in cases]
    known = next((results for _, results in found if results), [])
    if not known:
        return Markup("")
    rows = [
        (label, *(_cell(result) for result in results), tally(results))
        for label, results in found
        if results
    ]
    heads = [name(result) for result in known]
    head = ("Case", *(said[:1].upper() + said[1:] for said in heads), "Passed")
    numeric = range(1, len(head))
    return table(head, rows, "Requirements and how each case kept them", numeric)


def of_case(case: Any) -> Results:
    """Return the results of a comparison's case; none if there are no requirements."""
    found: Results = getattr(case, "summary", {}).get("requirements") or ()
    return found


def mark(result: Mapping[str, Any]) -> Markup:
    """Return the result as sign and word."""
    sign, word = ("✓", "passed") if result["passed"] else ("✗", "failed")
    return tag("span", tag("span", sign, aria_hidden="true"), f" {word}", class_=word)


def _cell(result: Mapping[str, Any]) -> Markup:
    word = "passed" if result["passed"] else "failed"
    sign = tag("span", "✓" if result["passed"] else "✗", aria_hidden="true")
    unseen = tag("span", f" ({word})", class_="unseen")
    return tag("span", sign, join(" ", _value(result)), unseen, class_=word)


def _split(result: Mapping[str, Any]) -> tuple[str, str]:
    key, _, side = str(result["name"]).rpartition("_")
    return key, side


def _value(result: Mapping[str, Any]) -> str:
    value = result["value"]
    return _with_unit(_split(result)[0], np.nan if value is None else value)


def _margin(result: Mapping[str, Any]) -> str:
    margin, limit = result["margin"], result["limit"]
    if margin is None:
        return "–"
    written = _with_unit(_split(result)[0], margin)
    tells = abs(margin) < _MOST_SHARE * abs(limit)
    return f"{written} ({percent(margin / abs(limit))} %)" if tells else written


def _with_unit(key: str, value: float) -> str:
    return " ".join(filter(None, quantity(value, meaning(key).unit, key)))
