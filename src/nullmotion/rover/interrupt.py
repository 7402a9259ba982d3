"""Ctrl-C while a solver runs.

CasADi takes Ctrl-C for itself and returns as if the program had no solution: the step would count
as one that cannot be made, and the work go on. Here Ctrl-C is only noted, and raised at the next
report of progress, which solvers pass on.
"""

from __future__ import annotations

import signal
from collections.abc import Iterator
from contextlib import contextmanager
from threading import current_thread, main_thread
from typing import Any

from nullmotion.rover.watch import Progress


@contextmanager
def interruptible(progress: Progress | None) -> Iterator[Progress | None]:
    """Give a function of the finished share that raises Ctrl-C where it is safe.

    A second Ctrl-C acts at once. In a thread, or where a program handles Ctrl-C in its own way,
    nothing is changed.

    Args:
        progress: What is told the share.

    Raises:
        KeyboardInterrupt: At the end at the latest, if Ctrl-C was pressed.
    """
    usual = signal.default_int_handler
    if current_thread() is not main_thread() or signal.getsignal(signal.SIGINT) is not usual:
        yield progress
        return
    pressed = False

    def note(*_: Any) -> None:
        nonlocal pressed
        pressed = True
        signal.signal(signal.SIGINT, usual)

    def report(share: float) -> None:
        if pressed:
            raise KeyboardInterrupt
        if progress:
            progress(share)

    signal.signal(signal.SIGINT, note)
    try:
        yield report
    finally:
        signal.signal(signal.SIGINT, usual)
    if pressed:
        raise KeyboardInterrupt
