"""Attitudes that a scenario asks for: a target, a slew to it, or a profile in a CSV file."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from nullmotion import rotation
from nullmotion.errors import InputError
from nullmotion.scenario import profile
from nullmotion.scenario.scenario import Scenario
from nullmotion.scenario.schema import MissionSection
from nullmotion.scenario.source import Source

_Q = ["t_s", "q0", "q1", "q2", "q3"]
_RATE, _ACCELERATION = ["wx", "wy", "wz"], ["ax", "ay", "az"]
HEADERS = (_Q, [*_Q, *_RATE], [*_Q, *_RATE, *_ACCELERATION])
LEAST_LENGTH = 1e-6  # of a quaternion that has a direction


class AttitudeProfile(NamedTuple):
    """An attitude over time; rates [rad/s] and accelerations [rad/s^2] in its own frame R."""

    t: np.ndarray
    q: np.ndarray
    omega: np.ndarray | None
    alpha: np.ndarray | None


def load(source: Source, name: str) -> AttitudeProfile:
    """Return the attitude profile in a file named by a scenario.

    Raises:
        ProfileError: For a file that is missing or not such a table.
    """
    found, lines = profile.table(source, name, HEADERS)
    none = np.flatnonzero(np.linalg.norm(found[:, 1:5], axis=1) < LEAST_LENGTH)
    if len(none):
        raise profile.ProfileError(f"quaternions that are not zero ({name}:{lines[none[0]]})")
    width = found.shape[1]
    return AttitudeProfile(
        found[:, 0],
        found[:, 1:5],
        found[:, 5:8] if width > 5 else None,
        found[:, 8:11] if width > 8 else None,
    )


def check_profile(mission: MissionSection, source: Source, name: str) -> None:
    """Refuse an attitude profile that no smooth motion leads through, unless its rows hold.

    Raises:
        ProfileError: Saying what it has to be.
    """
    from nullmotion.spacecraft import reference as references

    t, q, omega, alpha = load(source, name)
    if mission.profile_hold:
        if omega is not None:
            raise profile.ProfileError(f"a CSV without rates ({','.join(_Q)}): its rows hold still")
        return
    try:
        references.from_csv_table(t=t, q=q, omega=omega, alpha=alpha, times=t[:1])
    except InputError as error:
        raise profile.ProfileError(f"{error.allowed} (t_s = {error.value})") from None


def quaternion(q: Any, euler_321_deg: Any) -> np.ndarray | None:
    """Return the unit quaternion that a file gives, as such or as yaw, pitch and roll."""
    if q is not None:
        given = np.asarray(q, float)
        unit: np.ndarray = given / np.linalg.norm(given)
        return unit
    return None if euler_321_deg is None else rotation.from_euler_321(np.radians(euler_321_deg))


def target(scenario: Scenario) -> np.ndarray | None:
    """Return the attitude to go to, q_RN; None if there is a reference over time.

    A startup goes to the attitude at its start unless it has a target.
    """
    mission, craft = scenario.mission, scenario.spacecraft
    if mission.profile is not None or mission.slew_time_s is not None:
        return None
    given = quaternion(mission.target_q_BN, mission.target_euler_321_deg)
    if given is not None or craft is None:
        return given
    start = quaternion(craft.q_BN, craft.euler_321_deg)
    return np.array([1.0, 0.0, 0.0, 0.0]) if start is None else start


def reference(scenario: Scenario, start: np.ndarray, times: np.ndarray) -> np.ndarray | None:
    """Return attitude, rate and acceleration to follow at given times, (rows, 10).

    Args:
        scenario: An attitude mission.
        start: Attitude at the start, from which a slew begins.
        times: When the law is sampled [s].
    """
    from nullmotion.spacecraft import reference as references

    mission = scenario.mission
    if mission.profile is not None:
        t, q, omega, alpha = load(scenario.source, mission.profile)
        if mission.profile_hold:
            return references.held(t, q, times)
        return references.from_csv_table(t=t, q=q, omega=omega, alpha=alpha, times=times)
    if mission.slew_time_s is None:
        return None
    end = quaternion(mission.target_q_BN, mission.target_euler_321_deg)
    return references.eigenaxis_slew(
        q_start=start, q_end=end, slew_time=mission.slew_time_s, times=times
    )
