"""Where in the user's source a trace stands, and errors that tell it."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import FrameType

from nullmotion.errors import TraceError

_PACKAGE = str(Path(__file__).resolve().parent.parent)


def _machinery(file: str) -> bool:
    """Return whether a source file belongs to tracing itself rather than to what is traced."""
    inside = file.startswith((str(Path(_PACKAGE) / "compile"), str(Path(_PACKAGE) / "ops.py")))
    return inside or f"{os.sep}numpy{os.sep}" in file


def user_frame() -> tuple[str, int]:
    """Return file and line of the innermost running frame outside the tracing machinery."""
    frame: FrameType | None = sys._getframe(1)
    while frame is not None:
        if not _machinery(frame.f_code.co_filename):
            return frame.f_code.co_filename, frame.f_lineno
        frame = frame.f_back
    return "", 0


@contextmanager
def tracing() -> Iterator[None]:
    """Turn the errors of routines that cannot take symbols into a `TraceError` with its place."""
    try:
        yield
    except (TypeError, AttributeError, ValueError, IndexError) as error:
        place, frame = ("", 0), error.__traceback__
        while frame is not None:
            if not _machinery(frame.tb_frame.f_code.co_filename):
                place = (frame.tb_frame.f_code.co_filename, frame.tb_lineno)
            frame = frame.tb_next
        raise TraceError(
            f"this line does not work on symbols ({type(error).__name__}: {error})", *place
        ) from error
