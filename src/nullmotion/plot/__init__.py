"""Static figures. matplotlib is imported when the first one is drawn."""

from __future__ import annotations

from typing import Any

__all__ = ["compare_figure", "run_figure"]


def __getattr__(name: str) -> Any:
    if name in __all__:
        from nullmotion.plot import figures

        return getattr(figures, name)
    raise AttributeError(f"module 'nullmotion.plot' has no attribute {name!r}")
