"""Runs that are stepped from Python, spread over processes."""

from __future__ import annotations

import multiprocessing
import os
import pickle
import signal
import sys
import time
from collections.abc import Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from contextlib import contextmanager
from typing import Any

from nullmotion.sim.run import Progress, run
from nullmotion.sim.setup import Setup
from nullmotion.sim.trajectory import Trajectory

_WORTH = 5.0  # s of work left that pay for starting processes
_FIRST = 2  # runs that stay here; the second tells how long one takes, the first compiles


def run_each(
    setups: Sequence[Setup],
    progress: Progress | None = None,
    workers: int | None = None,
    **options: Any,
) -> list[Trajectory]:
    """Run setups one by one (host laws, different structures); return trajectories in order.

    If what is left after two runs is worth it, it goes to worker processes. That changes no
    bit: every run is computed on its own, wherever that is. A law that cannot be sent to
    another process (one defined in a script) stays here.

    Args:
        setups: What to run.
        progress: Called with the finished share.
        workers: Most processes; as many as the machine has cores by default.
        options: Of `sim.run`.
    """
    results: list[Trajectory] = []
    count = len(setups)
    for i, setup in enumerate(setups):
        begin = time.perf_counter()
        results.append(run(setup, **options))
        if progress:
            progress((i + 1) / count)
        left = (count - i - 1) * (time.perf_counter() - begin)
        if i + 1 == _FIRST and left > _WORTH:
            most = min(workers or os.cpu_count() or 1, count - i - 1)
            sent = _packed(setups[i + 1 :], options) if most > 1 else None
            if sent is not None:
                return [*results, *_spread(sent, most, i + 1, progress)]
    return results


def _packed(setups: Sequence[Setup], options: dict[str, Any]) -> list[bytes] | None:
    """Return what to send to other processes; None where they could not read it."""
    if multiprocessing.parent_process() is not None:
        return None  # this is a worker
    try:
        sent = [pickle.dumps((setup, options)) for setup in setups]
    except (pickle.PicklingError, AttributeError, TypeError):
        return None
    return None if any(b"__main__" in data for data in sent) else sent


def _spread(
    sent: Sequence[bytes], workers: int, before: int, progress: Progress | None
) -> list[Trajectory]:
    """Return the trajectories of packed setups; on Ctrl-C nothing is left running."""
    context = multiprocessing.get_context("spawn")
    others = set(multiprocessing.active_children())
    with ProcessPoolExecutor(workers, context, initializer=_deaf) as pool:
        try:
            with _unseen_main():
                futures = [pool.submit(_fly, data) for data in sent]
            pending: set[Future[Trajectory]] = set(futures)
            while pending:
                finished, pending = wait(pending, timeout=0.2, return_when=FIRST_COMPLETED)
                for future in finished:
                    future.result()  # the first failure ends it all
                if progress and finished:
                    done = before + len(sent) - len(pending)
                    progress(done / (before + len(sent)))
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            for worker in set(multiprocessing.active_children()) - others:
                worker.terminate()
            raise
    return [future.result() for future in futures]


def _fly(data: bytes) -> Trajectory:
    setup, options = pickle.loads(data)
    return run(setup, **options)


def _deaf() -> None:
    """Leave Ctrl-C to the parent, which ends its workers."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)


@contextmanager
def _unseen_main() -> Iterator[None]:
    """Keep new processes from importing the user's script, which may not expect it."""
    main = sys.modules["__main__"]
    names: dict[str, Any] = main.__dict__
    kept: dict[str, Any] = {k: names[k] for k in ("__file__", "__spec__") if k in names}
    names.pop("__file__", None)
    names["__spec__"] = None
    try:
        yield
    finally:
        names.update(kept)
