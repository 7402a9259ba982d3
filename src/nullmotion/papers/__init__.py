"""Published tables and figures, computed again, one paper a file."""

from __future__ import annotations

from nullmotion.papers.base import Cell, Paper, PaperResult
from nullmotion.registry import Registry

registry = Registry("paper", "nullmotion.papers", "nullmotion.papers.base.Paper")
names = registry.names
get = registry.get

__all__ = ["Cell", "Paper", "PaperResult", "get", "names", "registry"]
