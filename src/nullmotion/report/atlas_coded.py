"""Numbers of a data block: base64 in one table that everything shares."""

from __future__ import annotations

import base64

import numpy as np

_HALF_TURN = 32768  # of an angle in 16 bits


class Coded:
    """Collects arrays; equal ones are kept once."""

    def __init__(self) -> None:
        """Start without any."""
        self.texts: list[str] = []
        self._known: dict[bytes, int] = {}

    def add(self, values: np.ndarray) -> int:
        """Return the place of an array in the table."""
        plain = np.ascontiguousarray(values)
        raw = plain.dtype.str.encode() + plain.tobytes()
        if raw not in self._known:
            self._known[raw] = len(self.texts)
            kind = plain.dtype.newbyteorder("<").str[1:]
            coded = base64.b64encode(plain.astype(f"<{kind}", copy=False).tobytes()).decode()
            self.texts.append(f"{kind}:{coded}")
        return self._known[raw]


def angles(delta: np.ndarray) -> np.ndarray:
    """Return angles [rad] in 16 bits."""
    turn = np.rint(np.asarray(delta, float) / np.pi * _HALF_TURN)
    found: np.ndarray = (turn + _HALF_TURN) % (2 * _HALF_TURN) - _HALF_TURN
    return found.astype(np.int16)
