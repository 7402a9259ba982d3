"""Many runs with a purpose: comparisons of laws."""

from __future__ import annotations

from nullmotion.campaign.compare import Case, Comparison, compare

__all__ = ["Case", "Comparison", "compare"]
