"""A time loop whose state carries tangents: derivatives of a whole simulation."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np

from nullmotion import tree
from nullmotion.compile.loop import Loop, Stage
from nullmotion.compile.tangent import Recorded


class Moving(NamedTuple):
    """State of a differentiated loop.

    Attributes:
        state: State of the loop.
        tangents: Of those leaves of the state that change with the seeded parameters.
    """

    state: Any
    tangents: tuple[Any, ...]


class Seeded(NamedTuple):
    """Parameters of a differentiated loop.

    Attributes:
        parameters: Of the loop.
        seeds: Tangents of its seeded parameters: the direction of the derivative.
    """

    parameters: Any
    seeds: tuple[Any, ...]


def differentiated(loop: Loop, seeded: Sequence[bool]) -> Loop:
    """Return a loop that gives its outputs and their derivative along a direction.

    One lane follows one direction: a gradient with respect to n parameters is a batch of n
    lanes with the unit vectors for seeds. Its outputs are (outputs, tangents of the outputs).

    Args:
        loop: What to differentiate.
        seeded: For each leaf of the parameters, whether it has a tangent, the direction's
            component. Such leaves and their seeds differ between lanes.

    Raises:
        TraceError: When a stage decides by a value, or has no derivative.
    """
    return _Differentiator(loop, seeded).loop()


class _Differentiator:
    """The parts of a loop, recorded, and which of its state changes with the seeds."""

    def __init__(self, loop: Loop, seeded: Sequence[bool]) -> None:
        self.source, self.seeded = loop, list(seeded)
        self.varies = [a or b for a, b in zip(loop.varying, seeded, strict=True)]
        self.begin = Recorded(loop.start, [loop.parameters], self.varies)
        self.like = self.begin.like
        self.size = len(tree.flatten(self.like))
        on = [True] * (1 + loop.row)
        before = [0.0, np.zeros(loop.row), self.like, loop.parameters]
        every = [*on, *[True] * self.size, *self.varies]
        self.steps = [Recorded(stage.function, before, every) for stage in loop.stages]
        after = [self.like, loop.parameters]
        self.end = Recorded(loop.outputs, after, [*[True] * self.size, *self.varies])
        self.active = self._activity()

    def _activity(self) -> list[bool]:
        """Return which leaves of the state ever change with the seeds."""
        active = self.begin.depends(self.seeded)
        while True:
            grown = active
            for step in self.steps:
                still = [False] * (1 + self.source.row)
                after = step.depends([*still, *grown, *self.seeded])
                grown = [a or b for a, b in zip(grown, after, strict=True)]
            if grown == active:
                return active
            active = grown

    def loop(self) -> Loop:
        """Return the differentiated loop."""
        source = self.source
        going, record = source.active, source.record
        seeds = tuple(0.0 for flag in self.seeded if flag)
        return Loop(
            start=self._start,
            stages=tuple(
                Stage(self._stage(recorded), stage.period, stage.phase)
                for recorded, stage in zip(self.steps, source.stages, strict=True)
            ),
            outputs=self._outputs,
            parameters=Seeded(source.parameters, seeds),
            varying=(*self.varies, *[True] * len(seeds)),
            row=source.row,
            row_period=source.row_period,
            active=None if going is None else lambda s: going(s.state),
            record=None if record is None else lambda s: record(s.state),
            recorded_after=source.recorded_after,
        )

    def _parameters(self, p: Seeded) -> tuple[list[Any], list[Any]]:
        seeds = iter(p.seeds)
        return tree.flatten(p.parameters), [next(seeds) if f else None for f in self.seeded]

    def _state(self, s: Moving) -> tuple[list[Any], list[Any]]:
        tangents = iter(s.tangents)
        return tree.flatten(s.state), [next(tangents) if f else None for f in self.active]

    def _moving(self, values: list[Any], tangents: list[Any]) -> Moving:
        kept = [t for t, flag in zip(tangents, self.active, strict=True) if flag]
        filled = tuple(0.0 if t is None else t for t in kept)
        return Moving(tree.unflatten(self.like, values), filled)

    def _start(self, p: Seeded) -> Moving:
        return self._moving(*self.begin.push(*self._parameters(p)))

    def _stage(self, recorded: Recorded) -> Callable[..., Moving]:
        def stage(k: Any, row: Any, s: Moving, p: Seeded) -> Moving:
            (state, moves), (parameters, seeds) = self._state(s), self._parameters(p)
            values = [k, *tree.flatten(row), *state, *parameters]
            still = [None] * (1 + self.source.row)
            return self._moving(*recorded.push(values, [*still, *moves, *seeds]))

        return stage

    def _outputs(self, s: Moving, p: Seeded) -> tuple[Any, Any]:
        (state, moves), (parameters, seeds) = self._state(s), self._parameters(p)
        values, tangents = self.end.push([*state, *parameters], [*moves, *seeds])
        filled = [0.0 if t is None else t for t in tangents]
        return tree.unflatten(self.end.like, values), tree.unflatten(self.end.like, filled)
