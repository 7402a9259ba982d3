"""Figures of runs and comparisons for papers and slides."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from nullmotion.plot.draw import save
from nullmotion.plot.overlays import overlays
from nullmotion.plot.panels import figure_panels
from nullmotion.plot.varied import varied_panels
from nullmotion.plot.view import Run


def run_figure(trajectory: Run, path: str | Path, title: str = "") -> Path:
    """Write the panels that the field shows of a run (Mao 2019, Figs 7-31).

    Output torque, norm of the momentum, gimbal rates, gimbal angles, effective residual
    momentum, singularity measures. Of an attitude run: pointing error, attitude, body rate,
    output torque, gimbal rates, gimbal angles, singularity measures, motor torque. Where wheel
    speeds change: pointing error, wheel speeds, wheel torques, gimbal rates, body rate, output
    torque, attitude, gimbal angles.

    Args:
        trajectory: The run.
        path: File to write; its suffix says png, pdf or svg.
        title: Above all.

    Returns:
        The path.
    """
    return save(figure_panels(trajectory), path, title=title)


def compare_figure(comparison: Any, path: str | Path, title: str = "") -> Path:
    """Write the charts of a comparison: cases over each other, or metrics over a varied key.

    Args:
        comparison: What `nullmotion.campaign.compare` returns.
        path: File to write; its suffix says png, pdf or svg.
        title: Above all.

    Returns:
        The path.
    """
    panels = varied_panels(comparison) or overlays(comparison.cases)
    return save(panels, path, title=title, common_legend=True)
