"""Exceptions: one root, and each carries what it is about."""

from __future__ import annotations

from collections.abc import Iterable
from difflib import get_close_matches


class NullmotionError(Exception):
    """Root of every error that nullmotion raises on purpose."""


class InputError(NullmotionError):
    """A value from outside that cannot be used.

    Args:
        key: What is wrong, as the user wrote it (``array.skew_deg``, ``gimbal_axes``).
        value: The offending value.
        allowed: What would have been accepted.
        where: File and line, when there is one.
    """

    def __init__(self, key: str, value: object, allowed: str, where: str = "") -> None:
        """Keep the data and compose the message."""
        self.key, self.value, self.allowed, self.where = key, value, allowed, where
        place = f"{where}: " if where else ""
        super().__init__(f"{place}{key} = {value!r}: {allowed}")


class UnknownNameError(InputError):
    """A registry was asked for a name that it does not hold."""

    def __init__(self, kind: str, name: str, known: Iterable[str], where: str = "") -> None:
        """Suggest the nearest known names."""
        names = sorted(known)
        near = get_close_matches(name, names, n=3, cutoff=0.4)
        hint = f"did you mean {' or '.join(near)}? " if near else ""
        self.kind, self.near = kind, near
        super().__init__(kind, name, f"{hint}allowed: {', '.join(names)}", where)


class UnsupportedArrayError(NullmotionError):
    """A law was asked to steer an array that it does not support."""

    def __init__(self, law: str, reason: str) -> None:
        """Keep the law's name and its reason."""
        self.law, self.reason = law, reason
        super().__init__(f"law {law!r} does not support this array: {reason}")


class TraceError(NullmotionError):
    """Source that cannot be traced: its control flow depends on a value."""

    def __init__(self, message: str, file: str = "", line: int = 0) -> None:
        """Keep the place in the user's source."""
        self.file, self.line = file, line
        place = f"{file}:{line}: " if file else ""
        super().__init__(place + message)


class MemoryLimitError(NullmotionError):
    """A history was asked for that would not fit beside everything else."""
