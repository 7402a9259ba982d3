"""Terms of costs: metrics of a run that a plan looks at, over the samples before each step."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar, Literal

from nullmotion import linalg, ops, rotation
from nullmotion.metrics.base import Metric, Reduction, Sample

Index = Literal["sqrt-det", "det"]


@dataclass(frozen=True)
class Term(Metric):
    """Base of terms: the final state, which no step follows, does not count."""

    needs_rates: ClassVar[bool] = True


def manipulability(sample: Sample, index: Index) -> Any:
    """Return sqrt(det(A A^T)) of A / mean momentum, or the determinant itself."""
    A = sample.working.unit_jacobian(sample.delta)
    det = ops.maximum(linalg.det(A @ A.T), 0.0)
    return ops.sqrt(det) if index == "sqrt-det" else det


@dataclass(frozen=True)
class MeanManipulability(Term):
    """Manipulability, summed up."""

    name: ClassVar[str] = "manipulability"
    reductions: ClassVar[tuple[Reduction, ...]] = ("mean",)

    index: Index = "sqrt-det"

    def of(self, sample: Sample) -> Any:
        """Return the manipulability."""
        return manipulability(sample, self.index)


@dataclass(frozen=True)
class LeastManipulability(MeanManipulability):
    """The least manipulability."""

    reductions: ClassVar[tuple[Reduction, ...]] = ("min",)


@dataclass(frozen=True)
class LowManipulability(Term):
    """Number of samples with a manipulability below a threshold."""

    name: ClassVar[str] = "low_manipulability"
    reductions: ClassVar[tuple[Reduction, ...]] = ("mean",)

    threshold: float = 0.5
    index: Index = "sqrt-det"

    def of(self, sample: Sample) -> Any:
        """Return 1 below the threshold."""
        low = ops.less(manipulability(sample, self.index), self.threshold)
        return ops.where(low, 1.0, 0.0)


@dataclass(frozen=True)
class RateExcess(Term):
    """Number of samples at which a gimbal is asked for more than a rate."""

    name: ClassVar[str] = "rate_excess"
    reductions: ClassVar[tuple[Reduction, ...]] = ("mean",)

    threshold: float | None = None

    def of(self, sample: Sample) -> Any:
        """Return 1 if a rate before any limit is above the threshold, else the gimbal's limit."""
        limit = sample.array.rate_limit if self.threshold is None else self.threshold
        over = ops.less(1.0, ops.amax(ops.absolute(sample.asked) * (1.0 / limit)))
        return ops.where(over, 1.0, 0.0)


@dataclass(frozen=True)
class AttitudeError(Term):
    """Greatest attitude error about one axis: |yaw|, |pitch| or |roll| of q_BR [rad]."""

    name: ClassVar[str] = "attitude_error_rad"
    unit: ClassVar[str] = "rad"
    reductions: ClassVar[tuple[Reduction, ...]] = ("max",)

    axis: int = 0

    def of(self, sample: Sample) -> Any:
        """Return one angle of the 3-2-1 sequence."""
        return ops.absolute(rotation.euler_321(sample.q_BR)[self.axis])


@dataclass(frozen=True)
class MomentumLeft(Term):
    """Greatest part of a target momentum that is still missing along one axis [N m s]."""

    name: ClassVar[str] = "momentum_left_Nms"
    unit: ClassVar[str] = "N m s"
    reductions: ClassVar[tuple[Reduction, ...]] = ("max",)

    axis: int = 0
    target: float = 0.0

    def of(self, sample: Sample) -> Any:
        """Return |target - h| along the axis."""
        return ops.absolute(self.target - sample.momentum[self.axis])


@dataclass(frozen=True)
class TorqueError(Term):
    """Greatest torque error along one axis: |A delta_dot - hdot| [N m]."""

    name: ClassVar[str] = "torque_error_Nm"
    unit: ClassVar[str] = "N m"
    reductions: ClassVar[tuple[Reduction, ...]] = ("max",)

    axis: int = 0

    def of(self, sample: Sample) -> Any:
        """Return the error of the achieved rate of momentum along the axis."""
        return ops.absolute(sample.torque[self.axis] - sample.hdot[self.axis])


@dataclass(frozen=True)
class SquaredRates(Term):
    """Sum of the squared gimbal rates, summed up [rad^2/s^2]."""

    name: ClassVar[str] = "squared_rates_rad2_s2"
    unit: ClassVar[str] = "rad^2/s^2"
    reductions: ClassVar[tuple[Reduction, ...]] = ("mean",)

    def of(self, sample: Sample) -> Any:
        """Return delta_dot . delta_dot."""
        return sample.rates @ sample.rates


@dataclass(frozen=True)
class GreatestRate(Term):
    """Greatest gimbal rate [rad/s]."""

    name: ClassVar[str] = "greatest_rate_rad_s"
    unit: ClassVar[str] = "rad/s"
    reductions: ClassVar[tuple[Reduction, ...]] = ("max",)

    def of(self, sample: Sample) -> Any:
        """Return max |delta_dot_i|."""
        return ops.amax(ops.absolute(sample.rates))
