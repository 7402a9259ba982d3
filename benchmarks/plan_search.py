"""Plans: exact search and full enumeration on one core, on the paper's three manoeuvres."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace

import numpy as np
from common import Row, median_time

from nullmotion import plan
from nullmotion.plan import Found, Rollouts, continuous, enumerate, exact, preferred, skip
from nullmotion.plan.from_scenario import setup_of

CASES = ("roll", "three-axis", "kinematic")


def rollouts(case: str, depth: int = 10) -> Rollouts:
    """Return a manoeuvre of the paper, compiled."""
    setup, wanted = setup_of(f"papakonstantinou-{case}")
    made = plan.prepared(setup, **{k: v for k, v in wanted.items() if k != "levels"})
    made.threads = 1
    return made if depth == 10 else made.of_depth(depth)


def timed(search: Callable[[], Found], rounds: int) -> tuple[float, Found]:
    """Return the median time of a search and what it found."""
    found = search()
    return median_time(search, rounds), found


def row(what: str, search: Callable[[], Found], rounds: int, at_most: float | None = None) -> Row:
    """Return the time of a search, with its effort and gain."""
    seconds, found = timed(search, rounds)
    proof = "proven" if found.proven else "not proven"
    note = f"{found.rollouts:.0f} rollouts, value {found.value:.4f}, {proof}"
    return Row(what, seconds, "s", at_most=at_most, note=note)


def of_case(case: str, quick: bool) -> list[Row]:
    """Measure one manoeuvre."""
    ten, rounds = rollouts(case), 2 if quick else 15
    out = [
        row(f"{case}: exact, depth 10", lambda: exact.search(ten), rounds, 0.1),
        row(f"{case}: exact, depth 10, seven levels", lambda: exact.search(ten, 7), rounds, 1.0),
        row(f"{case}: the paper's heuristic", lambda: skip.search(ten), rounds),
        row(f"{case}: all 59,049, starts shared", lambda: enumerate.search(ten), rounds, 0.15),
    ]
    if quick:
        return out
    for depth, limit in ((16, 0.5), (24, None)):
        deep = rollouts(case, depth)
        out.append(row(f"{case}: exact, depth {depth}", lambda r=deep: exact.search(r), 5, limit))
    whole = row(
        f"{case}: all 59,049, each by itself", lambda: enumerate.search(ten, shared=False), 5, 0.6
    )
    return [
        *out,
        whole,
        *of_any_value(case),
        row(f"{case}: preferred start", lambda: preferred.search(ten), 3),
    ]


KNOWN = {"roll": 0.26, "three-axis": 0.58, "kinematic": 0.19}  # gains of 20 knots, measured apart


def of_any_value(case: str) -> list[Row]:
    """Measure knots of any value from the ternary optimum, 20 of them."""
    ten = rollouts(case)
    ternary = exact.search(ten)
    start = time.perf_counter()
    found = continuous.search(ten, np.array(ternary.knots), length=20)
    seconds = time.perf_counter() - start
    gain = found.value / ternary.value - 1.0
    note = f"value {ternary.value:.4f} -> {found.value:.4f}, gain {100 * gain:.1f} %"
    share = gain / KNOWN[case]
    return [
        Row(f"{case}: 20 knots of any value", seconds, "s", at_most=10.0, note=note),
        Row(f"{case}: gain / best gain known", share, at_least=0.95),
    ]


def compiling(case: str, rounds: int) -> Row:
    """Measure what comes before a search."""
    from nullmotion.compile import llvm

    def fresh() -> None:
        llvm.machine.cache_clear()
        rollouts(case)

    return Row(f"{case}: compile the manoeuvre", median_time(fresh, rounds), "s")


def rows(quick: bool) -> list[Row]:
    """Measure everything."""
    cases = CASES[:1] if quick else CASES
    found = [r for case in cases for r in [compiling(case, 3), *of_case(case, quick)]]
    return [replace(r, what=f"plan {r.what}") for r in found]


if __name__ == "__main__":
    import sys

    for each in rows("--quick" in sys.argv):
        print(each.markdown())
