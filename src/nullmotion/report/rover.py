"""Pages of the rover: a step over an edge, and a mission over uneven ground.

    write_step_report("step.html", plan, run=track(plan), landing=land(plan))
    write_mission_report("mission.html", trip, field, peter())

Each is one file that needs no network: an animation in three dimensions, charts that follow it,
and the numbers. `nullmotion.rover` stands above this package: its objects are taken as they come.
"""

from __future__ import annotations

from nullmotion.report.rover_mission import write_mission_report
from nullmotion.report.rover_step import write_step_report

__all__ = ["write_mission_report", "write_step_report"]
