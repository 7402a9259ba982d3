"""Pages that a person opens in a browser: one file each, no network."""

from nullmotion.report.compare import compare_report
from nullmotion.report.run import run_report

__all__ = ["compare_report", "run_report"]
