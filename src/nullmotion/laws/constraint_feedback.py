"""Constraint law, feedback: null motion towards the angles of a constraint function."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, ClassVar, Literal

import numpy as np

from nullmotion import linalg, ops
from nullmotion.array.model import CmgArray
from nullmotion.compile.tape import guard
from nullmotion.errors import InputError, UnsupportedArrayError
from nullmotion.guarantee.default import checked
from nullmotion.guarantee.tracking import refused, tracking
from nullmotion.law import Claim, Law, Observation, check_parameters, command_size

_FLOOR = 1e-4
_LEAST = 1.0  # 1/s: the gain at rest


@dataclass(frozen=True)
class ConstraintFeedback(Law):
    """Least rates for the torque, and feedback of the gimbal angles in the null space.

        [A] delta_dot = [hdot               ]        delta_d = F(h), relabelled        (Eq 13)
        [N]             [N K (delta_d - delta)]

    with A, h and hdot divided by the mean momentum. With N's rows an orthonormal basis of A's
    null space (any other basis spans the same, so that nothing is lost) this is

        delta_dot = A^+ hdot + (I - A^+ A) K (delta_d - delta)

    with differences of angles within half a turn, and the singular values' floor of
    `pseudo-inverse` in A^+. The array may leave the constraint: where its angles turn in no
    time (planar: at h = 0) nothing is singular, but nothing is guaranteed either.

    Relabelled: the CMGs with one gimbal axis take the nearest matching of the constraint's
    angles. It is this that carries a planar array through zero momentum, where the angles
    turn by 180 deg at once: with fixed labels some CMGs would cross the whole circle, and
    the array becomes nearly singular on the way. Near h = 0 a common turn of all angles
    changes nothing but the direction that the array is ready for: of it only
    h^2/(h^2 + turn_above^2) is asked, so that momentum that hovers about zero does not keep
    the gimbals turning.

    A planar array that loses CMGs goes over to the closed form of those that work, and a
    failed CMG stands still. The status tells where null motion is off: ``outside-constraint``
    (the momentum is outside the constrained envelope), ``no-constraint`` (none is known for
    the CMGs that work).

    Args:
        constraint: Name of the constraint function; None for the array's own.
        constraint_parameters: Its parameters; the rest keep their defaults.
        K: Gain [1/s], one or n; None for |hdot| / mean momentum, at least 1/s. What counts is
            K over |hdot| / mean momentum: at 1 a planar array of 4 to 7 CMGs keeps 0.73 of
            its best TC on straight courses through zero momentum and 0.59 on those that pass
            it by; at 1/2 it is 0.6 and 0.1, at 2 both are 0.8.
        relabel: ``nearest``, or ``fixed``: CMG i keeps the i-th angle.
        turn_above: Momentum, in one CMG's, at which half of a common turn is asked.
    """

    name: ClassVar[str] = "constraint-feedback"
    full_name: ClassVar[str] = "Constraint, feedback in the null space"
    aliases: ClassVar[tuple[str, ...]] = ("null-space-feedback",)
    citation: ClassVar[str] = "Elliott, dissertation (2019), Eq 13; Jones et al. (2012)"
    claims: ClassVar[frozenset[Claim]] = frozenset(Claim) - {Claim.BOUNDED, Claim.HOMOGENEOUS}
    knows_axes: ClassVar[bool] = True

    constraint: str | None = None
    constraint_parameters: Mapping[str, Any] = field(default_factory=dict)
    K: float | tuple[float, ...] | None = None
    relabel: Literal["nearest", "fixed"] = "nearest"
    turn_above: float = 0.1

    def __post_init__(self) -> None:
        """Check the parameters."""
        check_parameters(self, positive=("turn_above",), not_negative=("K",))
        given = checked(self.constraint, self.constraint_parameters)
        object.__setattr__(self, "constraint_parameters", given)
        if self.relabel not in ("nearest", "fixed"):
            raise InputError("law.relabel", self.relabel, "'nearest' or 'fixed'")

    def supports(self, array: CmgArray) -> str:
        """Ask for an array that the constraint holds, for equal momenta and as many gains."""
        if isinstance(self.K, tuple) and len(self.K) != array.n:
            return f"{len(self.K)} gains K for {array.n} CMGs"
        return refused(self.constraint, self.constraint_parameters, array)

    def exact_above(self, array: CmgArray) -> float:
        """Return the floor of the singular values."""
        return _FLOOR

    def step(self, array: CmgArray, obs: Observation, state: Any) -> tuple[Any, Any]:
        """Return the rates of Eq 13."""
        followed = tracking(self.constraint, self.constraint_parameters, array)
        if isinstance(followed, str):
            raise UnsupportedArrayError(self.name, followed)
        wanted = followed.target(array, obs.delta, labels=self.relabel)
        known = ops.logical_and(wanted.held, wanted.inside)
        guard("no-constraint", wanted.held)
        guard("outside-constraint", ops.logical_or(ops.logical_not(wanted.held), wanted.inside))
        small, square = self.turn_above * self.turn_above, wanted.momentum * wanted.momentum
        way = wanted.way - small / (small + square) * followed.common_turn(array, wanted)
        rows = linalg.rows(array.unit_jacobian(obs.delta), obs.hdot / array.mean_momentum)
        squares = ops.maximum(rows.squares, _FLOOR * _FLOOR)
        null = rows.project_out(self._gain(array, obs) * ops.where(known, way, 0.0), squares)
        return rows.solve(squares) + null, state

    def _gain(self, array: CmgArray, obs: Observation) -> Any:
        if self.K is not None:
            return np.asarray(self.K)
        return ops.maximum(command_size(array, obs), _LEAST)
