"""Variable-speed CMGs: their gyroscopic dynamics, limits and startup."""

from nullmotion.vscmg.hardware import Units

__all__ = ["Units"]
