"""Bounds of recorded source in ball arithmetic (python-flint), one box at a time.

For the checker of proofs, which must share no arithmetic with what made them: midpoints of
80 bits with radii, by Arb. The method is that of `compile.interval_slopes`: every number y of
the source has a range r, a value c at the box's centre and slopes s_j, so that y is in r as
well as in c + sum s_j d_j with |d_j| at most half the width. What may be undefined is nan.

The steps are written as Python source once, to lose no time between the balls.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any

from nullmotion.compile.steps import Step, Steps, dependent, pivotal
from nullmotion.guarantee import arb_rules

PRECISION = 80  # bits

# values from those of the operands {0}, {1}...; other steps are functions of `arb_rules`
_VALUES = {
    "add": "{0} + {1}",
    "sub": "{0} - {1}",
    "neg": "-{0}",
    "mul": "{0} * {1}",
    "div": "{0} / {1}",
    "abs": "abs({0})",
}
# what the operands' slopes are multiplied by: r, c are the result's range and centre, r0, c0...
# the operands'; other steps are functions of `arb_rules` of the operands' ranges and slopes
_FACTORS = {
    "add": ("", ""),
    "sub": ("", "-"),
    "neg": ("-",),
    "mul": ("{r1} * ", "{c0} * "),
    "square": ("({r0} + {c0}) * ",),
    "sqrt": ("inverse({r} + {c}) * ",),
    "abs": ("sign({r0}) * ",),
    "sin": ("cos_({r0}) * ",),
    "cos": ("-sin_({r0}) * ",),
    "exp": ("{r} * ",),
    "log": ("inverse({r0}) * ",),
    "acos": ("-inverse((one - square_({r0})).sqrt()) * ",),
}
_TRUTHS = frozenset({"less", "less_equal", "equal", "and", "or", "not"})


Bounded = Callable[[Sequence[float], Sequence[float], Any], bool]


def bounding(steps: Steps) -> Bounded:
    """Return a function of a box's ends that tells whether every output is certainly <= 0.

    Its third argument is asked for an output that is not, with its centre, its slopes, and the
    centres and reaches of the box's sides: it may know that the claim is about less than the box.
    """
    source = "\n".join(_Writer(steps).lines())
    names: dict[str, Any] = dict(vars(arb_rules))
    exec(source, names)
    bounded: Bounded = names["bounded"]
    return bounded


class _Writer:
    """Writes steps as Python: c1, r1, s1_0... are the centre, range and slopes of step 1."""

    def __init__(self, steps: Steps) -> None:
        self._steps = steps
        self._depends = dependent(steps)
        self._forms = forms(steps)
        self._cut = pivotal(steps)
        self._axes = range(len(steps.inputs))

    def lines(self) -> list[str]:
        """Return the source of ``bounded(lower, upper, part)``."""
        lines = ["def bounded(lower, upper, part):"]
        for j, i in zip(self._axes, self._steps.inputs, strict=True):
            lines += [f" c{i}, r{i}, d{j} = side(lower[{j}], upper[{j}])", f" s{i}_{j} = one"]
        for i, step in self._steps:
            if step.name == "constant":
                lines.append(f" c{i} = r{i} = constant(float('{step.value}'))")
                if isinstance(step.value, bool):
                    lines[-1] = f" r{i} = {step.value}, {not step.value}, True"
            elif step.name != "input":
                lines += [f" {line}" for line in self._step(i, step)]
        sides = [*(f"c{i}" for i in self._steps.inputs)], [f"d{j}" for j in self._axes]
        centres, reaches = (f"({', '.join(names)},)" for names in sides)
        for i in self._steps.outputs:
            names = [f"s{i}_{j}" if self._depends[i, j] else "zero" for j in self._axes]
            claim = f"r{i} <= 0 or part(c{i}, ({', '.join(names)},), {centres}, {reaches})"
            lines += [f" if not ({claim}):", "  return False"]
        return [*lines, " return True"]

    def _step(self, i: int, step: Step) -> list[str]:
        ranges = [f"r{a}" for a in step.args]
        lines = [f"r{i} = {self._value(step, ranges)}"]
        if self._is_truth(i):
            return lines
        # the centre takes the choice that holds in the whole box
        select = step.name == "select"
        centres = [f"c{a}" if k or not select else f"r{a}" for k, a in enumerate(step.args)]
        lines.append(f"c{i} = {self._value(step, centres)}")
        axes = [j for j in self._axes if self._depends[i, j]]
        lines += [f"s{i}_{j} = {self._slope(i, step, j)}" for j in axes]
        if axes and i in self._cut:
            reach = " + ".join(f"s{i}_{j} * d{j}" for j in axes)
            lines.append(f"r{i} = meet(r{i}, c{i} + {reach})")
        return lines

    def _is_truth(self, i: int) -> bool:
        return self._steps.steps[i].name in _TRUTHS

    def _value(self, step: Step, operands: Sequence[str]) -> str:
        low, high = self._forms[step.args[0]]
        if step.name == "sqrt" and low >= 0.0:
            operands = [f"{operands[0]}.nonnegative_part()"]
        if step.name == "acos" and low >= -1.0 and high <= 1.0:
            operands = [*operands, "True"]
        return _VALUES.get(step.name, f"{step.name}_({', '.join(operands)})").format(*operands)

    def _slope(self, i: int, step: Step, axis: int) -> str:
        """Return the slope along an axis of a step that depends on it."""
        moving = [self._depends[a, axis] and not self._is_truth(a) for a in step.args]
        slopes = [f"s{a}_{axis}" if m else "" for a, m in zip(step.args, moving, strict=True)]
        names = {"r": f"r{i}", "c": f"c{i}"}
        for k, a in enumerate(step.args):
            names |= {f"r{k}": f"r{a}", f"c{k}": f"c{a}"}
        if step.name == "div":
            top = f"{slopes[0]} - {names['c']} * {slopes[1]}" if slopes[1] else slopes[0]
            return f"({top}) / {names['r1']}"
        if step.name in _FACTORS:
            pairs = zip(_FACTORS[step.name], slopes, strict=True)
            return " + ".join(factor.format(**names) + s for factor, s in pairs if s)
        operands = [*(f"r{a}" for a in step.args), *(s or "zero" for s in slopes)]
        return f"{step.name}_slope({', '.join(operands)})"


def forms(steps: Steps) -> list[tuple[float, float]]:
    """Return bounds that each step has by its form, whatever the box.

    A ball that should end at 0 reaches a little beyond: a root of a sum of squares must know.
    """
    found: list[tuple[float, float]] = []
    for _, step in steps:
        lows, highs = [found[a][0] for a in step.args], [found[a][1] for a in step.args]
        low, high = -math.inf, math.inf
        if step.name == "constant":
            low = high = float(step.value or 0.0)
        elif step.name in ("minimum", "maximum"):
            choose = min if step.name == "minimum" else max
            low, high = choose(lows), choose(highs)
        elif step.name == "select":
            low, high = min(lows[1:]), max(highs[1:])
        elif step.name in ("square", "abs", "sqrt", "exp") or (
            step.name in ("add", "mul", "div") and min(lows) >= 0.0
        ):
            low = 0.0
        found.append((low, high))
    return found
