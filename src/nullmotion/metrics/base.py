"""What a metric is: a scalar of one sample of a run, and how a run sums it up."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar, Literal

import numpy as np

from nullmotion import linalg, ops
from nullmotion.array.model import CmgArray

Reduction = Literal["min", "max", "rms", "mean", "final", "total", "latest"]
PLAIN = ("total", "latest")  # reductions whose result goes by the metric's own name


@dataclass(frozen=True)
class Sample:
    """One instant of a run, as floats or symbols; what is derived is computed when asked for.

    Attributes:
        array: The array as it really is (with the plant's errors).
        delta: True gimbal angles [rad], (n,).
        hdot: Commanded rate of momentum [N m], (m,).
        t: Time since the start [s].
        rates: Gimbal rates applied from this instant on [rad/s], (n,); at the end of a
            run, those of the last step.
        previous_rates: Those of the step before (equal to ``rates`` in the first step).
        momentum_wanted: h(0) + integral of hdot so far [N m s], (m,).
        impulse: Integral of A delta_dot so far, by the run's integrator [N m s], (m,).
        asked: Rates asked by the law in force, before any limit [rad/s], (n,).
        motor_torque: Torque of the gimbal motors about their axes [N m], (n,).
        speed: Gimbal rates at this instant [rad/s], (n,); ``rates`` is their mean over the step.
        q_BN: Attitude, (4,); None without a spacecraft, as the next two.
        omega_BN_B: Body rate in B [rad/s], (3,).
        q_BR: Attitude error against the reference, scalar part not negative, (4,).
        dt: Integration step [s].
        turning: The array without its stuck CMGs; None if all turn. With variable wheel speeds:
            the array at the speeds it was designed for.
        wheel_speed: Wheel speeds [rad/s], (n,); None where they are constant, as the next.
        wheel_acceleration: Their derivatives over the step [rad/s^2], (n,).
    """

    array: CmgArray
    delta: Any
    hdot: Any
    t: Any
    rates: Any
    previous_rates: Any
    momentum_wanted: Any
    impulse: Any
    asked: Any = None
    motor_torque: Any = None
    speed: Any = None
    q_BN: Any = None
    omega_BN_B: Any = None
    q_BR: Any = None
    dt: Any = None
    turning: Any = None
    wheel_speed: Any = None
    wheel_acceleration: Any = None

    @property
    def working(self) -> CmgArray:
        """The CMGs that turn: what measures of singularity look at."""
        return self.array if self.turning is None else self.turning

    @cached_property
    def design_speed(self) -> Any:
        """Wheel speeds that the array was designed for [rad/s], (n,); 0 for a stuck CMG."""
        return self.working.h0 / self.array.flywheels.inertia

    @cached_property
    def jacobian(self) -> Any:
        """A at delta [N m s/rad], (m, n)."""
        return self.array.jacobian(self.delta)

    @cached_property
    def momentum(self) -> Any:
        """Momentum of the array [N m s], (m,)."""
        return self.array.momentum(self.delta)

    @cached_property
    def torque(self) -> Any:
        """Achieved rate of momentum A delta_dot [N m], (m,); the vehicle gets its negative.

        With variable wheel speeds: A delta_dot + C_W I_W Omega_dot.
        """
        if self.wheel_acceleration is None:
            return self.jacobian @ self.rates
        given = self.array.wheels.inertia * self.wheel_acceleration  # type: ignore[union-attr]
        return self.jacobian @ self.rates + self.array.wheel_axes(self.delta) @ given

    @cached_property
    def singular_values(self) -> Any:
        """Singular values of A over the mean momentum of the working CMGs, descending, (m,)."""
        return linalg.svd(self.working.unit_jacobian(self.delta)).s

    @cached_property
    def command(self) -> Any:
        """|hdot| [N m]."""
        return np.sqrt(self.hdot @ self.hdot)

    @cached_property
    def direction(self) -> Any:
        """Unit vector of hdot, zero when nothing is commanded, (m,)."""
        return self.hdot / ops.where(ops.less(0.0, self.command), self.command, 1.0)


@dataclass(frozen=True)
class Metric:
    """Base of metrics: one file under ``metrics/`` with one frozen dataclass.

    A metric is a scalar of a `Sample` (method `of`, without branches: it runs in the
    kernel as well), summed up over a run by its ``reductions``: the summary holds
    ``min_<name>`` and so on (``total``, the integral over time, and ``latest``, the
    greatest value, go by ``<name>`` alone), and a scenario may stop at ``<name>_below`` or
    ``<name>_above``.

    Class attributes:
        name: Name in summaries and stop conditions; ends in its unit if it has one.
        title: Label of axes and tables.
        unit: SI unit, or ``1``.
        citation: Where it is defined.
        reductions: How a run sums it up.
        needs_rates: True if it has no meaning at the end of a run, where no rate applies.
        needs_body: True if it has no meaning without a spacecraft.
        needs_wheels: True if it has no meaning where wheel speeds are constant.
    """

    name: ClassVar[str] = ""
    title: ClassVar[str] = ""
    unit: ClassVar[str] = "1"
    citation: ClassVar[str] = ""
    reductions: ClassVar[tuple[Reduction, ...]] = ("min", "final")
    needs_rates: ClassVar[bool] = False
    needs_body: ClassVar[bool] = False
    needs_wheels: ClassVar[bool] = False

    def of(self, sample: Sample) -> Any:
        """Return the metric at one sample."""
        raise NotImplementedError
