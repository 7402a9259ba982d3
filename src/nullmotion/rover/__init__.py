"""Rovers that roll over their edges: PETER with one CMG (Elliott 2019, Chapter 5) and its kin.

    plan = plan_step(peter(), edge=1, site=Site(incline=np.radians(30)))
    start = initialise(plan, delta=0.0)               # the gimbal goes where the step begins
    run = track(plan)                                 # the step in closed loop
    landing = land(run)                               # the same on springy ground, free to slip
    trip = travel(field, peter(), start, goal)        # from start to goal over a height field

SI and radians; edges count from 1, as e1 to e6 of the paper.
"""

from nullmotion.rover.chassis import Chassis
from nullmotion.rover.edge_frame import EdgeFrame
from nullmotion.rover.fly_step import track
from nullmotion.rover.ground import Ground
from nullmotion.rover.ground_file import load_ground
from nullmotion.rover.initialise import Initialisation, initialise
from nullmotion.rover.landing import land
from nullmotion.rover.landing_result import Landing
from nullmotion.rover.path_mission import travel
from nullmotion.rover.path_travel import Travel
from nullmotion.rover.plan_error import PlanError, Violation
from nullmotion.rover.planner import plan_step
from nullmotion.rover.rover import MARS, Cmg, Rover, Site, peter
from nullmotion.rover.settings import Settings
from nullmotion.rover.step_plan import StepPlan
from nullmotion.rover.step_run import StepRun
from nullmotion.rover.terrain import HeightField
from nullmotion.rover.terrain_files import load_terrain
from nullmotion.rover.terrain_random import generated
from nullmotion.rover.tracking import Gains
from nullmotion.rover.wheels import WheelRover, hedgehog, hypothesised

__all__ = [
    "MARS",
    "Chassis",
    "Cmg",
    "EdgeFrame",
    "Gains",
    "Ground",
    "HeightField",
    "Initialisation",
    "Landing",
    "PlanError",
    "Rover",
    "Settings",
    "Site",
    "StepPlan",
    "StepRun",
    "Travel",
    "Violation",
    "WheelRover",
    "generated",
    "hedgehog",
    "hypothesised",
    "initialise",
    "land",
    "load_ground",
    "load_terrain",
    "peter",
    "plan_step",
    "track",
    "travel",
]
