"""The one time loop: setups in, trajectories and batch results out."""

from nullmotion.sim.batch import BatchResult, run_batch
from nullmotion.sim.run import run
from nullmotion.sim.setup import Setup, Stop
from nullmotion.sim.trajectory import Trajectory

__all__ = ["BatchResult", "Setup", "Stop", "Trajectory", "run", "run_batch"]
