"""Sign patterns: one for each singular surface, told in few minus signs."""

from __future__ import annotations

import numpy as np


def minority(signs: np.ndarray, working: np.ndarray) -> np.ndarray:
    """Return sign patterns turned so that less than half are -1, few of them first, (k, n).

    (u, epsilon) and (-u, -epsilon) are the same point.
    """
    minus = np.sum((signs < 0) & working, axis=1)
    flip = 2 * minus > working.sum()
    turned = np.where(flip[:, None] & working, -signs, signs)
    order = np.lexsort((*(turned.T[::-1]), np.sum(turned < 0, axis=1)))
    found: np.ndarray = turned[order]
    return found


def sign_name(signs: np.ndarray) -> str:
    """Return a sign pattern as text, a place for each CMG; a ring for one at any angle."""
    return "".join("○+−"[int(sign)] for sign in signs)


def minus(signs: np.ndarray) -> int:
    """Return how many minus signs a pattern has, or plus signs if they are fewer."""
    return int(min(np.sum(signs < 0), np.sum(signs > 0)))
