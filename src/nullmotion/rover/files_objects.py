"""Rover, site, ground and limits from the sections of a file, in SI and radians."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np

from nullmotion.errors import InputError
from nullmotion.rover.chassis import Chassis
from nullmotion.rover.cmg import Cmg
from nullmotion.rover.files_read import Reader
from nullmotion.rover.ground import Ground
from nullmotion.rover.ground_file import KEYS, LIBRARY, load_ground
from nullmotion.rover.rover import Rover, Site
from nullmotion.rover.settings import Settings
from nullmotion.rover.wheels import WheelRover

_SHAPE = "tetrahedron"
_CHASSIS = {
    "vertices": "vertices_m",
    "inertia": "inertia_kg_m2",
    "chassis": "shape",
    "solid": "shape",
    "edge_length": "edge_length_m",
    "mass": "mass_kg",
}


def chassis(reader: Reader) -> tuple[Chassis | None, float | None]:
    """Return the chassis of ``[chassis]``, and the friction of its spikes."""
    given = reader.section("chassis", needed=True)
    if given is None:
        return None, None
    if given.vertices_m is not None:
        for key in ("shape", "edge_length_m"):
            if given.given(key):
                reader.add(("chassis", key), getattr(given, key), "not beside vertices_m")
    return reader.attempt("chassis", lambda: _chassis(given), **_CHASSIS), given.friction


def _chassis(given: Any) -> Chassis:
    if given.vertices_m is None:
        name = given.shape or _SHAPE
        made = Chassis.named(name, given.edge_length_m or 1.0, given.mass_kg)
    else:
        name, points = "polyhedron", np.array(given.vertices_m, float)
        if given.inertia_kg_m2 is not None:
            return Chassis(points, given.mass_kg, _inertia(given), name)
        made = Chassis.uniform(points, given.mass_kg, name)
    if given.inertia_kg_m2 is None:
        return made
    return Chassis(made.vertices, given.mass_kg, _inertia(given), name)


def _inertia(given: Any) -> np.ndarray:
    values = np.asarray(given.inertia_kg_m2, float)
    return np.diag(values) if values.ndim == 1 else values


def rover(reader: Reader, name: str) -> Rover | WheelRover | None:
    """Return the rover of ``[chassis]`` with ``[cmg]`` or ``[wheels]``.

    Args:
        reader: Notes what is wrong.
        name: What to call the rover.
    """
    body, friction = chassis(reader)
    if reader.given("wheels"):
        if reader.given("cmg"):
            allowed = "not beside [wheels]: a rover has a CMG or wheels"
            reader.add(("cmg",), reader.source.data["cmg"], allowed)
        return _with_wheels(reader, body, name)
    given = reader.section("cmg", needed=True)
    if body is None or given is None:
        return None
    cmg = reader.attempt("cmg", lambda: _cmg(body, given), gimbal_axis="gimbal_axis",
                         spin_axis="spin_axis", inertia="inertia_kg_m2")  # fmt: skip
    return None if cmg is None else Rover(body, cmg, friction, name)


def _cmg(body: Chassis, given: Any) -> Cmg:
    g = body.gimbal_axis() if given.gimbal_axis is None else np.array(given.gimbal_axis, float)
    return Cmg(
        gimbal_axis=g,
        spin_axis=np.array(given.spin_axis, float),
        momentum=given.momentum_Nms,
        rate_limit=given.rate_limit_rad_s,
        acceleration_limit=given.acceleration_limit_rad_s2,
        inertia=np.array(given.inertia_kg_m2, float),
        rotor_inertia=given.rotor_inertia_kg_m2,
        rotor_speed=given.rotor_speed_rad_s,
    )


def _with_wheels(reader: Reader, body: Chassis | None, name: str) -> WheelRover | None:
    given = reader.section("wheels")
    if body is None or given is None:
        return None
    speed, torque = given.speed_limit_rad_s or math.inf, given.torque_limit_Nm or math.inf
    return reader.attempt(
        "wheels",
        lambda: WheelRover(body, given.inertia_kg_m2, speed, torque, name),
        wheel_inertia="inertia_kg_m2",
    )


def site(given: Any) -> Site:
    """Return the site of ``[site]``."""
    return Site(
        given.gravity_m_s2, math.radians(given.incline_deg), math.radians(given.heading_deg)
    )


def settings(reader: Reader) -> Settings | None:
    """Return the planner's settings of ``[planner]``."""
    given = reader.section("planner")
    if given is None:
        return None
    names = {key.removesuffix("_rad_s2").removesuffix("_rad_s").removesuffix("_s"): key
             for key in type(given).model_fields}  # fmt: skip
    values = {name: getattr(given, key) for name, key in names.items()}
    return reader.attempt("planner", lambda: Settings(**values), **names)


def ground(reader: Reader) -> Ground | None:
    """Return the ground of ``[ground]``; rock without one."""
    given = reader.section("ground")
    if given is None:
        return None
    if given.file is None:
        values = {KEYS[k]: getattr(given, k) for k in KEYS if getattr(given, k) is not None}
        return reader.attempt("ground", lambda: Ground(**values), **{v: k for k, v in KEYS.items()})
    for key in KEYS:
        if given.given(key):
            reader.add(("ground", key), getattr(given, key), "not beside file")
    if given.file in LIBRARY:
        return load_ground(given.file)
    path = Path(reader.source.folder or "") / given.file
    try:
        return load_ground(path if path.is_file() else given.file)
    except InputError as error:
        if error.where:
            raise  # what is wrong in the ground's own file
        reader.add(("ground", "file"), given.file, error.allowed)
    return None
