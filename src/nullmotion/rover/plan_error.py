"""A step that cannot be planned, and why."""

from __future__ import annotations

from dataclasses import dataclass

from nullmotion.errors import NullmotionError


@dataclass(frozen=True)
class Violation:
    """A constraint that cannot be kept.

    Attributes:
        name: Which one, as in Table 1 of Elliott 2019.
        value: The best that was found.
        relation: ``at most`` or ``at least``.
        limit: What it should be.
        unit: Unit of both.
    """

    name: str
    value: float
    relation: str
    limit: float
    unit: str

    @property
    def amount(self) -> float:
        """By how much the limit is passed."""
        return abs(self.value - self.limit)

    def __str__(self) -> str:
        unit = f" {self.unit}" if self.unit else ""
        return (
            f"{self.name} {self.value:.4g}{unit}, {self.relation} {self.limit:.4g} allowed "
            f"(violated by {self.amount:.3g}{unit})"
        )


class PlanError(NullmotionError):
    """No step was found.

    Args:
        step: Which step, in words.
        violations: What stands in the way, the worst first.
    """

    def __init__(self, step: str, violations: tuple[Violation, ...]) -> None:
        """Keep the data and compose the message."""
        self.step, self.violations = step, violations
        why = "; ".join(map(str, violations)) or "the solver did not converge"
        super().__init__(f"no step {step}: {why}")
