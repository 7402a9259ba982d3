"""The terms of a cost, smoothed, as stages of a run's loop."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple

from nullmotion import ops, tree
from nullmotion.compile.loop import Loop, Stage
from nullmotion.compile.tape import Symbol
from nullmotion.metrics.base import Metric
from nullmotion.plan.segment import LEAVES
from nullmotion.sim.setup import Setup
from nullmotion.sim.stages import loop
from nullmotion.sim.state import parameters

SIGN = {"max": 1.0, "latest": 1.0, "min": -1.0}  # of extremes


class _State(NamedTuple):
    run: Any
    sums: tuple[Any, ...]


class _Parameters(NamedTuple):
    run: Any
    width: Any
    extremes: tuple[Any, ...]
    rates: tuple[Any, ...]


@dataclass(frozen=True, eq=False)
class Margin(Metric):
    """A term of a cost at one sample; of a count, how far the sample is from the edge.

    Attributes:
        term: The term.
        reduction: How it is summed up.
        choice: Of a count, what a sample adds if the comparison holds and if not.
    """

    term: Metric
    reduction: str
    choice: list[float] = field(default_factory=list)

    reductions = ("final",)

    def of(self, sample: Any) -> Any:
        """Return the term, or the margin of the one comparison that a count comes from."""
        value = self.term.of(sample)
        self.choice.clear()
        if not isinstance(value, Symbol) or self.reduction not in ("mean", "total"):
            return value
        nodes = value.tape.nodes
        parts = [nodes[i] for i in nodes[value.node].args]
        if nodes[value.node].op != "select" or not parts[0].op.startswith("less"):
            return value
        if {parts[1].op, parts[2].op} != {"constant"}:
            return value
        self.choice.extend(float(part.value) for part in parts[1:])  # type: ignore[arg-type]
        a, b = (Symbol(value.tape, i) for i in parts[0].args)
        size = abs(a) + abs(b)
        return (b - a) / ops.where(ops.less(0.0, size), size, 1.0)

    def added(self, x: Any, width: Any, extreme: Any, rate: Any) -> Any:
        """Return what a sample with the value x adds to the sum."""
        if self.choice:
            yes, no = self.choice
            return no + (yes - no) * _sigmoid(x / width)
        if self.reduction in SIGN:
            return ops.exp(SIGN[self.reduction] * (x - extreme) * rate)
        return x * x if self.reduction == "rms" else x


def _sigmoid(z: Any) -> Any:
    """Return 1 / (1 + exp(-z)), whatever z."""
    small = ops.exp(-ops.absolute(z))
    return ops.where(ops.less(z, 0.0), small, 1.0) / (1.0 + small)


def smoothed(setup: Setup, terms: list[Margin]) -> tuple[Loop, list[bool]]:
    """Return the loop that sums smoothed terms up, and which of its parameters have tangents."""
    own = parameters(setup)
    base = loop(setup)
    law = len(tree.flatten(own[: own._fields.index("law")]))
    leaves = len(tree.flatten(own))
    zeros = (0.0,) * len(terms)

    def inside(stage: Stage) -> Stage:
        def step(k: Any, row: Any, s: _State, p: _Parameters) -> _State:
            return s._replace(run=stage.function(k, row, s.run, p.run))

        return replace(stage, function=step)

    def gather(k: Any, row: Any, s: _State, p: _Parameters) -> _State:
        given = zip(terms, s.run.sums, s.sums, p.extremes, p.rates, strict=True)
        return s._replace(
            sums=tuple(old + t.added(x, p.width, e, rate) for t, x, old, e, rate in given)
        )

    what = Loop(
        start=lambda p: _State(base.start(p.run), zeros),
        stages=(*map(inside, base.stages), Stage(gather)),
        outputs=lambda s, p: s.sums,
        parameters=_Parameters(own, 0.0, zeros, zeros),
        varying=(*[law <= i < law + LEAVES for i in range(leaves)], *[True] * (1 + 2 * len(terms))),
        row=base.row,
        row_period=base.row_period,
    )
    return what, [law <= i < law + 2 for i in range(len(what.varying))]
