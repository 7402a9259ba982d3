"""Arrays of control moment gyroscopes: geometry, momentum, limits, layouts."""

from nullmotion.array.model import CmgArray

__all__ = ["CmgArray"]
