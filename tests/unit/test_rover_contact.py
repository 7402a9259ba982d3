"""The rover on ground that yields: physics that must hold, events, and the published steps."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from nullmotion.errors import InputError
from nullmotion.rover import Chassis, Cmg, Gains, Rover, Site, peter, plan_step, track
from nullmotion.rover import step_dynamics as step
from nullmotion.rover.contact import simulate
from nullmotion.rover.contact_command import Measured, Numbers, tracking
from nullmotion.rover.contact_dynamics import energy, motion
from nullmotion.rover.contact_events import spike_paths
from nullmotion.rover.contact_field import Field
from nullmotion.rover.contact_forces import touch
from nullmotion.rover.contact_reference import Reference
from nullmotion.rover.contact_signals import Setting
from nullmotion.rover.contact_state import STATES, Machine, State
from nullmotion.rover.edge_frame import EdgeFrame
from nullmotion.rover.ground import Ground
from nullmotion.rover.ground_file import LIBRARY, load_ground
from nullmotion.rover.landing import land
from nullmotion.rover.landing_start import attitude, standing
from nullmotion.rover.polyhedron import NAMES
from nullmotion.rover.step_model import step_model
from nullmotion.rover.tracking import loop

pytestmark = pytest.mark.slow  # it simulates whole steps

STEEPEST = float(np.degrees(np.arctan(np.sqrt(2))))  # the paper's "55 degrees"
INCLINES = (0.0, 15.0, 30.0, 45.0, STEEPEST)


@cache
def planned(edge: int, incline: float) -> Any:
    return plan_step(peter(), edge, Site(incline=np.radians(incline)))


@cache
def landed(edge: int, incline: float) -> Any:
    return land(planned(edge, incline))


def prescribed(told: Any, numbers: Any, measured: Measured) -> Any:
    """A law that follows a given gimbal acceleration."""
    return told[0]


def field(
    rover: Rover,
    site: Site,
    ground: Ground,
    carrying: Any = None,
    acceleration: Any = lambda t: 0.0,
) -> Field:
    """The equations of a rover whose gimbal accelerates as given."""
    setting = Setting(
        Machine.of(rover, site),
        ground.numbers(rover.mass * site.gravity),
        np.array([1.0, 0.0, 0.0, 0.0]),
        np.array([0.0, 1.0, 0.0]),
        (),
    )
    spikes = rover.chassis.vertices
    carries = np.zeros(len(spikes)) if carrying is None else carrying
    return Field(prescribed, lambda t: [acceleration(t)], setting, spikes, carries)


def touches(ground: Ground, point: Any, velocity: Any, carries: float = 1.0) -> Any:
    """What the ground does to a spike at a point, of a rover that does not turn."""
    still = State.at_rest()._replace(position=np.asarray(point), velocity=np.asarray(velocity))
    return touch(still, np.zeros(3), carries, ground.numbers(weight=1.0))


def until(t: float) -> Any:
    return lambda record: t


def spinning(rng: np.random.Generator, height: float = 1.0) -> np.ndarray:
    """A state with every rate different from zero."""
    x = np.concatenate([[0.0, 0.0, height], rng.normal(size=12)])
    x[3:7] /= np.linalg.norm(x[3:7])
    return x


def rover_of(name: str) -> Rover:
    """A rover of another shape with PETER's CMG."""
    return Rover(Chassis.named(name, edge_length=0.6, mass=30.0), peter().cmg, name=name)


# ground


def test_table_3_is_the_default_ground():
    ground = Ground()
    assert (ground.stiffness, ground.damping, ground.drag) == (1e5, 1e6, 1e5)
    assert ground.friction is None and load_ground("rock") == ground


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("stiffness", 0.0),
        ("stiffness", -1.0),
        ("stiffness", np.inf),
        ("damping", -1e-9),
        ("drag", np.nan),
        ("friction", -0.1),
        ("friction", "0.5"),
        ("drag", True),
    ],
)
def test_a_ground_refuses_what_no_ground_has(key: str, value: Any):
    with pytest.raises(InputError, match=f"ground.{key} = .*number") as caught:
        Ground(**{key: value})
    assert caught.value.key == f"ground.{key}" and caught.value.value is value


def test_ground_from_a_file(tmp_path: Path):
    file = tmp_path / "dunes.toml"
    file.write_text("[ground]\nstiffness_N_m = 2e4\nfriction = 0.7\n")
    ground = load_ground(file)
    assert ground == Ground(2e4, 1e6, 1e5, 0.7, str(file))
    assert load_ground(str(file)) == ground and load_ground(ground) is ground
    named = load_ground('[ground]\nname = "dunes"\ndrag_Ns_m = 10\ndamping_Ns_m = 0\n')
    assert named == Ground(1e5, 0.0, 10.0, None, "dunes")


WRONG = [
    ("stiffness_N_m = -1e4", "ground text:2: ground.stiffness_N_m = -10000.0: a number above 0"),
    ("friction = true", "ground text:2: ground.friction = true: a number at least 0"),
    ("name = 3", "ground text:2: ground.name = 3: a text in quotes"),
    ("frction = 0.5", "ground.frction = 0.5: unknown key; did you mean friction?"),
    ("stiffness_kN_m = 1.0", "ground.stiffness_kN_m = 1.0: unknown key; did you mean stiffness"),
    ("[gravel]", "ground text:2: gravel: unknown section"),
]


@pytest.mark.parametrize(("line", "said"), WRONG)
def test_a_wrong_file_says_key_value_allowed_and_line(line: str, said: str):
    with pytest.raises(InputError) as caught:
        load_ground(f"[ground]\n{line}\n")
    assert said in str(caught.value)


def test_everything_wrong_with_a_file_is_said_at_once():
    with pytest.raises(InputError) as caught:
        load_ground("[ground]\nfriction = -1\ndrag_Ns_m = 'a'\n")
    assert str(caught.value).count("\n") == 1


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("grvel", "did you mean gravel"),
        ("none.toml", "an existing TOML file"),
        ("[ground\nfriction = 1", "TOML"),
        ("ground = 3", "a section with keys"),
        ("[terrain]\n", "this section is missing"),
    ],
)
def test_a_ground_that_is_not_there(name: str, said: str):
    with pytest.raises(InputError, match=said):
        load_ground(name)


def test_a_ground_that_is_not_text(tmp_path: Path):
    file = tmp_path / "ground.toml"
    file.write_bytes(b"\xff\xfe\x00")
    with pytest.raises(InputError, match="UTF-8"):
        load_ground(file)


# forces


def test_the_ground_pushes_and_holds_as_table_3_says():
    point, velocity = [0.0, 0.0, -1e-3], [0.01, -0.02, -1e-5]
    found = touches(Ground(), point, velocity)
    assert found.force == pytest.approx([-1e3, 2e3, 1e5 * 1e-3 + 1e6 * 1e-5])
    assert found.stored == pytest.approx(0.5 * 1e5 * 1e-6)
    free = touches(Ground(), point, velocity, carries=0.0)
    assert not free.force.any() and free.normal == pytest.approx(found.normal)


def test_friction_bounds_the_force_along_the_ground():
    ground, point = Ground(friction=0.5), [0.0, 0.0, -1e-3]
    for speed in (1e-5, 1e-4, 1e-3, 1.0):
        velocity = speed * np.array([0.6, 0.8, 0.0])
        force = touches(ground, point, velocity).force
        assert np.linalg.norm(force[:2]) == pytest.approx(min(1e5 * speed, 0.5 * 100.0))
        assert force[:2] @ velocity[:2] < 0
    assert touches(ground, point, np.zeros(3)).force == pytest.approx([0, 0, 100])


def test_losses_are_never_gains(rng: np.random.Generator):
    ground = Ground(1e4, 1e3, 1e3, 0.4)
    for _ in range(500):
        point, velocity = 1e-2 * rng.normal(size=3), rng.normal(size=3)
        trial = touches(ground, point, velocity)
        carries = float(trial.sinkage > 0 and trial.normal > 0)
        assert touches(ground, point, velocity, carries).dissipated >= 0


# dynamics


def test_the_jacobian_is_exact(rng: np.random.Generator):
    plan = planned(1, 45.0)
    equations = closed_loop(plan, Ground(friction=0.6))
    for _ in range(5):
        t, x = float(rng.uniform(0, plan.duration)), spinning(rng, 0.2)
        x[7:] *= 0.1
        exact = equations.slopes(t, x)
        found = np.empty((STATES, STATES))
        for j in range(STATES):
            ahead = [equations.change(t, x + k * 1e-5 * np.eye(STATES)[j]) for k in (-2, -1, 1, 2)]
            found[:, j] = (ahead[0] - 8 * ahead[1] + 8 * ahead[2] - ahead[3]) / 12e-5
        scale = np.abs(exact).max(axis=1, keepdims=True) + 1.0
        assert (np.abs(exact - found) / scale).max() < 1e-8


def closed_loop(plan: Any, ground: Ground) -> Field:
    """The equations of a step under the tracking controller, all spikes carrying."""
    rover, cmg, gains = plan.rover, plan.rover.cmg, Gains()
    numbers = Numbers(
        step_model(rover, plan.frame, plan.site),
        gains.kp,
        gains.kd,
        gains.gimbal,
        cmg.rate_limit,
        cmg.acceleration_limit,
    )
    machine, start = Machine.of(rover, plan.site), attitude(plan.frame)
    setting = Setting(machine, ground.numbers(174.0), start, plan.frame.r, numbers)
    return Field(tracking, Reference(plan), setting, rover.chassis.vertices, np.ones(4))


def test_the_law_is_the_tracking_controller(rng: np.random.Generator):
    plan = planned(1, 45.0)
    closed, told = loop(plan, Gains()), Reference(plan)
    numbers = closed_loop(plan, Ground()).setting.numbers
    for _ in range(50):
        t, y = float(rng.uniform(0, 1.2 * plan.duration)), rng.normal(size=4).tolist()
        wanted = closed.state(t, y).delta_ddot
        found = tracking(told(t), numbers, Measured(*y))
        assert found == pytest.approx(wanted, rel=1e-9, abs=1e-9)


def test_free_fall():
    """Momentum in inertial axes, the mass centre's path and the energy are those of a free body."""
    rover, site = peter(), Site(incline=0.3)
    machine = Machine.of(rover, site)
    x = spinning(np.random.default_rng(5), height=50.0)
    equations = field(rover, site, Ground(), acceleration=lambda t: 9.0 * np.cos(3.0 * t))
    record = simulate(equations, x, until(2.0))
    end, t = record.x[-1], record.t[-1]
    assert t == pytest.approx(2.0) and not record.changes
    fallen = x[:3] + x[7:10] * t + machine.gravity * t**2 / 2
    assert end[:3] == pytest.approx(fallen, abs=1e-6)
    assert angular_momentum(end, machine) == pytest.approx(angular_momentum(x, machine), rel=1e-6)
    signals = record.signals()
    work = record.integral(signals.gimbal_power + signals.rotor_power)
    gained = energy(State.of(end), machine) - energy(State.of(x), machine)
    assert np.abs(signals.gimbal_power).max() > 50.0
    assert gained == pytest.approx(work, abs=1e-5)


def angular_momentum(x: np.ndarray, machine: Machine) -> np.ndarray:
    """Angular momentum about the mass centre in inertial axes, from body, CMG and rotor apart."""
    g, s0 = machine.gimbal_axis, machine.spin_axis
    about_g = Rotation.from_rotvec(x[13] * g)
    axes = np.array([about_g.apply(s0), g, about_g.apply(np.cross(g, s0))])
    gimbal = x[10:13] + x[14] * g
    in_body = machine.inertia @ x[10:13] + axes.T @ (machine.cmg_inertia * (axes @ gimbal))
    in_body = in_body + machine.momentum * axes[0]
    return Rotation.from_quat(x[3:7], scalar_first=True).apply(in_body)


def test_a_held_edge_gives_the_equations_of_a_step(rng: np.random.Generator):
    """Forces that hold the edge's spikes leave theta'' and the loads of Eqs 72 to 83."""
    rover = peter()
    for edge, incline in ((1, 0.4), (2, 0.0), (5, -0.2)):
        site, frame = Site(incline=incline), rover.edge_frame(edge)
        machine, model = Machine.of(rover, site), step_model(rover, frame, site)
        theta, theta_dot, delta, delta_dot, delta_ddot = rng.normal(size=5)
        turned = Rotation.from_matrix(frame.rotation(theta))
        arm = -turned.apply(frame.point)
        omega = np.array([0.0, theta_dot, 0.0])
        state = State(
            arm,
            turned.as_quat(scalar_first=True),
            np.cross(omega, arm),
            theta_dot * frame.r,
            delta,
            delta_dot,
        )
        theta_ddot, loads = held(state, delta_ddot, machine, rover.chassis.vertices, frame)
        pivot = step.State(theta, theta_dot, delta, delta_dot, delta_ddot)
        wanted = step.acceleration(model, pivot)
        assert theta_ddot == pytest.approx(wanted, rel=1e-9)
        spare = step.thresholds(model, pivot, wanted).spare
        assert frame.length * loads[::-1] == pytest.approx(np.array(spare), rel=1e-8, abs=1e-8)


def held(
    state: State, delta_ddot: float, machine: Machine, spikes: np.ndarray, frame: EdgeFrame
) -> tuple[float, np.ndarray]:
    """The turn's acceleration and normal loads when forces hold the edge's spikes."""
    free = motion(state, delta_ddot, machine, np.zeros(6)).change
    C_NB = Rotation.from_quat(state.attitude, scalar_first=True).as_matrix()
    g, s0 = machine.gimbal_axis, machine.spin_axis
    about_g = Rotation.from_rotvec(state.delta * g)
    axes = np.array([about_g.apply(s0), g, about_g.apply(np.cross(g, s0))])
    J = machine.inertia + axes.T @ np.diag(machine.cmg_inertia) @ axes
    rows, still = [], []
    for spike in frame.spikes:
        c, omega = spikes[spike], state.rate
        turning = np.cross(free.rate, c) + np.cross(omega, np.cross(omega, c))
        still.append(-(free.velocity + C_NB @ turning))
        rows.append(np.hstack([np.eye(3), -C_NB @ _skew(c)]))
    A = np.vstack(rows)
    mobility = np.zeros((6, 6))
    mobility[:3, :3], mobility[3:, 3:] = np.eye(3) / machine.mass, np.linalg.inv(J)
    forces = np.linalg.lstsq(A @ mobility @ A.T, np.concatenate(still), rcond=1e-9)[0]
    omega_dot = free.rate + (mobility @ A.T @ forces)[3:]
    return float(omega_dot @ frame.r), forces[[2, 5]]


def _skew(v: np.ndarray) -> np.ndarray:
    return np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])


# rest


@pytest.mark.parametrize("name", NAMES)
def test_a_standing_rover_sinks_by_its_weight(name: str):
    rover, ground, site = rover_of(name), Ground(2e4, 3e3, 1e4), Site()
    frame = rover.edge_frame(1)
    x, carrying = standing(rover, site, frame, ground, delta=0.7)
    base = rover.chassis.faces[frame.start_face]
    assert set(np.flatnonzero(carrying)) == set(base)
    places, _ = spike_paths(x[None], rover.chassis.vertices)
    sunk = rover.mass * site.gravity / (ground.stiffness * len(base))
    assert -places[0, list(base), 2] == pytest.approx(sunk, rel=1e-9)
    raised = x + np.eye(STATES)[2] * sunk / 4
    record = simulate(field(rover, site, ground, carrying), raised, until(4.0))
    assert record.x[-1] == pytest.approx(x, abs=1e-8) and not record.changes


@pytest.mark.parametrize("edge", [1, 2, 3])
@pytest.mark.parametrize("incline", [-30.0, 20.0, 50.0])
def test_a_standing_rover_loads_its_spikes_in_balance(edge: int, incline: float):
    """The centre of the load is where gravity through the mass centre meets the ground."""
    rover, site = peter(), Site(incline=np.radians(incline))
    x, carrying = standing(rover, site, rover.edge_frame(edge), Ground())
    places, _ = spike_paths(x[None], rover.chassis.vertices)
    load = 1e5 * np.maximum(0.0, -places[0, :, 2]) * carrying
    weight = rover.mass * site.vector
    assert load.sum() == pytest.approx(-weight[2], rel=1e-3)
    centre = load @ places[0, :, :2] / load.sum()
    foot = x[:3] - weight * (x[2] / weight[2])
    assert centre == pytest.approx(foot[:2], abs=2e-3)


def test_a_tetrahedron_creeps_down_a_slope_as_its_dampers_let_it():
    """Without a bound on friction the slope's pull is shared by three dampers."""
    rover, site = peter(), Site(incline=np.radians(30))
    x, carrying = standing(rover, site, rover.edge_frame(1), Ground())
    record = simulate(field(rover, site, Ground(), carrying), x, until(1.0))
    moved = (record.x[-1] - x)[:3]
    assert moved[0] == pytest.approx(rover.mass * site.vector[0] / (3 * 1e5), rel=1e-3)
    assert abs(moved[1]) < 1e-9


def test_bouncing_without_dampers_keeps_the_energy():
    ground = Ground(stiffness=1e4, damping=0.0, drag=0.0)
    x = spinning(np.random.default_rng(2), height=0.9)
    record = simulate(field(peter(), Site(), ground), x, until(1.5))
    signals = record.signals()
    total = signals.energy + signals.stored
    work = record.integral(signals.gimbal_power + signals.rotor_power)
    assert len(record.changes) >= 4 and not record.failure
    assert np.ptp(signals.stored) > 5.0
    assert abs(record.integral(signals.dissipated)) < 1e-8 * np.ptp(signals.stored)
    assert total[-1] - total[0] == pytest.approx(work, abs=1e-5 * np.ptp(signals.stored))


def test_a_drop_onto_rock_does_not_bounce():
    """What falls 0.1 m loses all of that height's energy in the ground."""
    rover, site = peter(), Site()
    x, _ = standing(rover, site, rover.edge_frame(1), Ground())
    lifted = x + np.eye(STATES)[2] * 0.1
    record = simulate(field(rover, site, Ground()), lifted, until(0.6))
    assert {c.spike for c in record.changes if c.carries} == {0, 1, 2}
    assert np.abs(record.x[-1][7:13]).max() < 1e-3
    signals = record.signals()
    fallen = rover.mass * site.gravity * (lifted[2] - record.x[-1][2])
    lost = record.integral(signals.dissipated)
    assert lost == pytest.approx(fallen - signals.stored[-1], rel=1e-5)


# steps


def test_a_step_lands_and_says_what_happened():
    plan, found = planned(1, 45.0), landed(1, 45.0)
    assert found.outcome == "landed" and found.as_planned and found.ground == Ground()
    kinds = [event.kind for event in found.events]
    assert kinds[0] == "departure" and {"touchdown", "landing"} <= set(kinds)
    assert not {"slip", "tipping", "turning", "sliding"} & set(kinds)
    landing = next(e for e in found.events if e.kind == "landing")
    assert landing.t == found.landed_at == pytest.approx(plan.duration, abs=0.3)
    assert 0 < landing.size < 0.2
    assert str(landing).endswith(f"landing: {landing.size:.3g} m/s")
    assert np.all(np.diff(found.t) >= 0) and found.state.shape == (len(found.t), STATES)
    assert found.signals.force.shape == (len(found.t), 4, 3)
    down = found.spikes[-1, list(plan.rover.chassis.faces[plan.frame.end_face])]
    assert np.abs(down[:, 2]).max() < 1e-3


def test_after_landing_the_gimbal_stands_still():
    found = landed(1, 45.0)
    assert abs(found.state[-1, 14]) < 1e-6
    limit = peter().cmg.acceleration_limit * (1 + 1e-12)
    assert np.abs(found.signals.delta_ddot).max() <= limit
    assert np.abs(found.state[:, 14]).max() <= peter().cmg.rate_limit * (1 + 1e-6)


def test_progress_is_told_and_may_stop_the_simulation():
    seen: list[float] = []
    land(planned(1, 45.0), settle=0.0, progress=seen.append)
    assert seen == sorted(seen) and 0.9 < seen[-1] <= 1.0

    def stop(share: float) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        land(planned(1, 45.0), progress=stop)


@pytest.mark.parametrize("key", ["settle", "patience"])
@pytest.mark.parametrize("value", [-1.0, np.nan, np.inf])
def test_times_must_be_possible(key: str, value: float):
    with pytest.raises(InputError, match=key):
        land(planned(1, 45.0), **{key: value})


def test_spikes_lift_off_when_the_margin_is_used_up():
    """The pivot model's margin under the same gimbal motion tells when the contact model tips."""
    plan = planned(1, 45.0)
    weak = track(plan, Gains(kp=3.0, kd=1.0))
    assert weak.margin.min() < 0
    found = land(weak, Ground(1e7, 1e5, 1e7), open_loop=True)
    lifted = [e.t for e in found.events if e.kind == "lift-off" and e.spike in plan.frame.spikes]
    assert lifted[0] == pytest.approx(weak.t[np.argmax(weak.margin < 0)], abs=0.01)
    assert found.outcome in ("tipped", "turned away") and not found.as_planned
    assert {"slip", "turning"} <= {event.kind for event in found.events}


def test_a_step_without_feedback_drifts_away_from_its_plan():
    run = track(planned(1, 45.0))
    free = land(run, open_loop=True, patience=0.2)
    assert free.max_angle_error > 3 * landed(1, 45.0).max_angle_error


def test_a_soft_ground_takes_a_step_too():
    found = land(planned(1, 45.0), "soft")
    assert found.as_planned and found.energy_balance < 1e-5
    on_rock, on_soft = (np.median(f.signals.sinkage.max(axis=1)) for f in (landed(1, 45.0), found))
    assert on_soft > 2 * on_rock


def test_a_slippery_ground_is_named():
    found = land(planned(1, 45.0), "ice")
    assert found.outcome in ("turned away", "did not land", "fell back", "tipped")
    sliding = [e for e in found.events if e.kind == "sliding"]
    assert sliding and max(e.size for e in sliding) > 0.01
    assert any(e.kind == "slip" and e.size == found.slip for e in found.events)
    normal, force = found.signals.normal, found.signals.force
    across = np.linalg.norm(force[..., :2], axis=-1)
    assert np.all(across <= LIBRARY["ice"].friction * np.maximum(normal, 0.0) * (1 + 1e-9) + 1e-9)


def test_spikes_bring_their_own_friction():
    plan = planned(1, 45.0)
    smooth = replace(plan, rover=replace(plan.rover, friction=0.1))
    ground = Ground(friction=None)
    assert any(e.kind == "sliding" for e in land(smooth, ground, patience=0.0).events)


@pytest.mark.slow
@pytest.mark.parametrize("edge", [1, 2])
@pytest.mark.parametrize("incline", INCLINES)
def test_the_published_steps_land(edge: int, incline: float):
    plan, found = planned(edge, incline), landed(edge, incline)
    run = track(plan)
    assert found.outcome == run.outcome == "landed" and found.as_planned
    assert found.slip < 0.01
    assert found.tilt < np.radians(1.0)
    assert found.max_angle_error < 0.05
    assert found.energy == pytest.approx(run.energy, rel=0.03)
    assert found.energy_balance < 1e-5
    assert not [e for e in found.events if e.kind in ("tipping", "turning", "slip")]


@pytest.mark.slow
def test_other_shapes_land():
    chassis = Chassis.named("cube", edge_length=0.5, mass=40.0)
    cmg = Cmg(chassis.gimbal_axis(), [1.0, 0.0, 0.0], 115.0, 2.0, 20.0)
    plan = plan_step(Rover(chassis, cmg), 1)
    run, found = track(plan), land(plan)
    assert found.as_planned and found.energy_balance < 1e-5
    assert found.landed_at == pytest.approx(run.t[-1], abs=0.1)
    assert found.energy == pytest.approx(run.energy, rel=0.03)
    down = {e.spike for e in found.events if e.kind == "touchdown"}
    assert down & (set(chassis.faces[plan.frame.end_face]) - set(plan.frame.spikes))
