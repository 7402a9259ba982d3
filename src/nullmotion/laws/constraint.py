"""Constraint law, augmented Jacobian: the gimbals keep to a constraint function."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, ClassVar

from nullmotion import linalg, ops
from nullmotion.array.model import CmgArray
from nullmotion.compile.tape import guard
from nullmotion.errors import UnsupportedArrayError
from nullmotion.guarantee.default import checked
from nullmotion.guarantee.target import Target
from nullmotion.guarantee.tracking import refused, tracking
from nullmotion.law import Claim, Law, Observation, check_parameters, command_size

_FLOOR = 1e-4
_FASTEST = 20.0  # rates of the target over the command's: beyond, TC is below 1/20
_BESIDE = 0.1  # rad from the target: beyond, TC is not what the constraint says


@dataclass(frozen=True)
class AugmentedJacobian(Law):
    """Rates that give the torque and keep to a constraint, delta = F(h).

        [A ] delta_dot = [hdot              ]     J_c = N (I - G A),   G = dF/dh
        [J_c]            [trim N (F - delta)]                                     (Eq 12)

    with A, h and hdot divided by the mean momentum and the rows of N an orthonormal basis of
    A's null space. On the constraint A G = I, rates are G hdot, and the torque capability is
    the constraint's own (Eq 49); beside it the gimbals return with the bandwidth ``trim``. It
    is solved as what it amounts to, which needs no N and is exact wherever A is regular:

        delta_dot = A^+ hdot + (I - A^+ A) (G hdot + trim (F - delta))

    A^+ has the singular values' floor of `pseudo-inverse`. F(h) is relabelled: CMGs with one
    gimbal axis take the nearest matching of its angles. A planar array that loses CMGs goes
    over to the closed form of those that work, and a failed CMG stands still.

    The status tells when the law is not what it promises: ``outside-constraint`` (the
    momentum is outside the constrained envelope) and ``no-constraint`` (none is known for
    the CMGs that work), where pseudo-inverse rates remain; ``algorithmic-singularity`` (the
    target turns more than 20 times as fast as one CMG would that gave the torque alone: it is
    not followed); ``off-constraint`` (a gimbal is more than 0.1 rad from its target);
    ``torque-beyond-guarantee`` (|hdot| is more than the constraint guarantees in every
    direction within the rate limit).

    Args:
        constraint: Name of the constraint function; None for the array's own.
        constraint_parameters: Its parameters; the rest keep their defaults.
        trim: Bandwidth of the return onto the constraint [1/s]; 0 as in the dissertation's
            simulation.
    """

    name: ClassVar[str] = "constraint"
    full_name: ClassVar[str] = "Constraint, augmented Jacobian"
    aliases: ClassVar[tuple[str, ...]] = ("augmented-jacobian",)
    citation: ClassVar[str] = "Elliott, dissertation (2019), Eqs 12, 49"
    claims: ClassVar[frozenset[Claim]] = frozenset(Claim) - {Claim.BOUNDED, Claim.HOMOGENEOUS}
    knows_axes: ClassVar[bool] = True

    constraint: str | None = None
    constraint_parameters: Mapping[str, Any] = field(default_factory=dict)
    trim: float = 0.5

    def __post_init__(self) -> None:
        """Check the parameters."""
        check_parameters(self, not_negative=("trim",))
        given = checked(self.constraint, self.constraint_parameters)
        object.__setattr__(self, "constraint_parameters", given)

    def supports(self, array: CmgArray) -> str:
        """Ask for an array that the constraint holds, and for equal momenta."""
        return refused(self.constraint, self.constraint_parameters, array)

    def exact_above(self, array: CmgArray) -> float:
        """Return the floor of the singular values."""
        return _FLOOR

    def step(self, array: CmgArray, obs: Observation, state: Any) -> tuple[Any, Any]:
        """Return the rates of Eq 12."""
        followed = tracking(self.constraint, self.constraint_parameters, array)
        if isinstance(followed, str):
            raise UnsupportedArrayError(self.name, followed)
        wanted = followed.target(array, obs.delta, obs.hdot)
        known = ops.logical_and(wanted.held, wanted.inside)
        size = command_size(array, obs)  # not a number is not calm
        calm = ops.less_equal(ops.amax(ops.absolute(wanted.rates)), _FASTEST * size)
        _tell(array, wanted, size, calm)
        null = ops.where(calm, wanted.rates, 0.0) + self.trim * wanted.way
        rows = linalg.rows(array.unit_jacobian(obs.delta), obs.hdot / array.mean_momentum)
        squares = ops.maximum(rows.squares, _FLOOR * _FLOOR)
        null = rows.project_out(ops.where(known, null, 0.0), squares)
        return rows.solve(squares) + null, state


def _tell(array: CmgArray, wanted: Target, size: Any, calm: Any) -> None:
    """Raise the status flags of what does not hold; what lies outside has no other flag."""
    guard("no-constraint", wanted.held)
    outside = ops.logical_not(ops.logical_and(wanted.held, wanted.inside))
    guard("outside-constraint", ops.logical_or(ops.logical_not(wanted.held), wanted.inside))
    guard("algorithmic-singularity", ops.logical_or(outside, calm))
    near = ops.less_equal(ops.amax(ops.absolute(wanted.way)), _BESIDE)
    guard("off-constraint", ops.logical_or(outside, near))
    slowest = ops.minimum(ops.amin(array.rate_limit), 1e300)
    able = ops.less_equal(size, wanted.capability * slowest)
    guard("torque-beyond-guarantee", ops.logical_or(outside, able))
