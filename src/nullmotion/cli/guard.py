"""Turn whatever goes wrong into one message and an exit status."""

from __future__ import annotations

import os
import sys
import traceback
import warnings
from collections.abc import Sequence
from typing import Any

from nullmotion.errors import InputError, MemoryLimitError, TraceError, UnsupportedArrayError

DONE, FAILED, BAD_INPUT, INTERRUPTED = 0, 1, 2, 130
_STOPPED = "interrupted; no result was written"
_BAD_INPUT = (InputError, UnsupportedArrayError, TraceError, MemoryLimitError)
_OS_BAD_INPUT = (
    FileNotFoundError,
    FileExistsError,
    IsADirectoryError,
    NotADirectoryError,
    PermissionError,
)


def call(app: Any, arguments: Sequence[str]) -> int:
    """Run the app and return the exit status: 0 done, 2 bad input, 130 Ctrl-C, 1 anything else."""
    debug = "--debug" in arguments
    warnings.showwarning = _warn  # type: ignore[assignment]
    try:
        status = app([a for a in arguments if a != "--debug"], standalone_mode=False)
        sys.stdout.flush()
        if status == INTERRUPTED:  # typer turns Ctrl-C into this status
            return _say(_STOPPED, INTERRUPTED, False)
        return status if isinstance(status, int) else DONE
    except KeyboardInterrupt:
        return _say(_STOPPED, INTERRUPTED, debug)
    except BrokenPipeError:  # the reader of our output has gone
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return FAILED
    except _BAD_INPUT as error:
        return _say(f"error: {error}", BAD_INPUT, debug)
    except Exception as error:
        if hasattr(error, "show") and hasattr(error, "exit_code"):  # typer's own usage errors
            error.show()
            return int(error.exit_code)
        if type(error).__name__ == "Abort":
            return _say(_STOPPED, INTERRUPTED, debug)
        if isinstance(error, OSError) and error.filename is not None:
            return _say(f"error: {error.filename}: {error.strerror}", _os_status(error), debug)
        text = " ".join(str(error).split())
        hint = "" if debug else " (add --debug for the traceback)"
        return _say(f"error: {type(error).__name__}: {text}{hint}", FAILED, debug)


def _os_status(error: OSError) -> int:
    return BAD_INPUT if isinstance(error, _OS_BAD_INPUT) else FAILED


def _say(message: str, status: int, debug: bool) -> int:
    if debug:
        traceback.print_exc()
    print(message, file=sys.stderr)
    return status


def _warn(message: Warning | str, *_: Any) -> None:
    print(f"warning: {message}", file=sys.stderr)
