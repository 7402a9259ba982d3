"""A solver's iterations as they happen: progress, and a way out."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from nullmotion.errors import InputError

Progress = Callable[[float], None]


class Watch:
    """Called after each iteration; what it raises ends the solve and is raised after it.

    Attributes:
        tick: Called with the number of the iteration.
        error: What ended the solve.
    """

    def __init__(self) -> None:
        self.tick: Callable[[int], None] | None = None
        self.error: BaseException | None = None
        self.count = 0

    def start(self, tick: Callable[[int], None] | None) -> None:
        """Begin to watch another solve."""
        self.tick, self.error, self.count = tick, None, 0

    def iterated(self) -> bool:
        """Return whether the solver is to stop."""
        try:
            self.count += 1
            if self.tick is not None:
                self.tick(self.count)
        except BaseException as error:  # Ctrl-C arrives here, inside the solver
            self.error = error
            return True
        return False

    def finish(self) -> None:
        """Raise what ended the solve."""
        if self.error is not None:
            raise self.error


def casadi() -> Any:
    """Return the package CasADi.

    Raises:
        InputError: When it is not installed; says what to install.
    """
    try:
        import casadi
    except ImportError as error:
        allowed = "an installed CasADi: pip install 'nullmotion[rover]'"
        raise InputError("rover planner", "casadi", allowed) from error
    return casadi


def callback(watch: Watch, variables: int, rows: int) -> Any:
    """Return CasADi's iteration callback that asks the watch."""
    import casadi as ca

    sizes = {"f": 1, "x": variables, "lam_x": variables, "g": rows, "lam_g": rows}

    class Iterated(ca.Callback):
        def __init__(self) -> None:
            ca.Callback.__init__(self)
            self.construct("iterated", {})

        def get_n_in(self) -> int:
            return int(ca.nlpsol_n_out())

        def get_n_out(self) -> int:
            return 1

        def get_sparsity_in(self, i: int) -> Any:
            return ca.Sparsity.dense(sizes.get(ca.nlpsol_out(i), 0), 1)

        def eval(self, arguments: Any) -> list[int]:
            return [int(watch.iterated())]

    return Iterated()
