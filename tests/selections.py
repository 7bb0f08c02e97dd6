"""Random robots, requirements and small catalogues for tests of the selection."""

from dataclasses import replace

import numpy as np
from rims import STEEL

from ocs_design.actuation.fasteners import BoltCircle
from ocs_design.actuation.motor import DIRECT, Face, Gear, GearRoom, Motor, Mounting
from ocs_design.actuation.supply import Supply
from ocs_design.catalogue.materials import Material
from ocs_design.requirement.device_sections import Envelope
from ocs_design.requirement.pushes import Disturbance
from ocs_design.requirement.requirement import Requirement
from ocs_design.requirement.turns import Drop, Flip
from ocs_design.robot.mass import MassProperties
from ocs_design.sizing.place import Place
from ocs_design.sizing.selection.problem import SelectionProblem
from ocs_design.sizing.selection.search import search
from ocs_design.sizing.selection.select import select, with_demands

ALUMINIUM = Material(
    name="aluminium", density=2700.0, yield_strength=250e6, ultimate_strength=300e6,
    poisson_ratio=0.33, source="for tests",
)  # fmt: skip
NO_LIMIT = float("inf")


def motor(rng, name, torque, speed, voltage):
    """A random motor of about this peak torque, with a typical mass and inertia."""
    peak = torque * rng.uniform(0.6, 2.5)
    mass = 0.18 * peak**0.7 * rng.uniform(0.7, 1.3)
    k_t = voltage / (speed * rng.uniform(0.7, 2.0))
    stall = peak * rng.uniform(1.2, 8.0)
    radius = 0.5 * 0.065 * (mass / 0.1) ** (1.0 / 3.0)
    return Motor(
        name=name, maker="test", mass=mass, diameter=2.0 * radius, length=0.6 * radius,
        torque_constant=k_t, resistance=voltage * k_t / stall, rated_voltage=voltage,
        no_load_speed=voltage / k_t, speed_max=voltage / k_t * rng.uniform(0.8, 1.5),
        peak_torque=peak, peak_current=None, continuous_torque=None,
        rotor_inertia=0.4 * mass * radius**2 * rng.uniform(0.3, 1.0),
        source="made up", confidence="good",
    )  # fmt: skip


def gear(rng, name, ratio, torque):
    return Gear(
        name=name, ratio=ratio, efficiency=rng.uniform(0.85, 0.97), mass=0.02 * torque**0.7,
        inertia=1e-7 * torque, motor_speed_max=NO_LIMIT, wheel_speed_max=NO_LIMIT,
        torque_max=torque * rng.uniform(1.0, 4.0), reverses=bool(rng.integers(2)), source="made up",
    )  # fmt: skip


def random_problem(seed, motors=3, *, mounted=True):
    """A robot of 1 to 30 kg, one to three maneuvers, and a catalogue that may be too weak."""
    rng = np.random.default_rng(seed)
    size = rng.uniform(0.8, 2.2)
    mass = 2.5 * size**3 * rng.uniform(0.6, 1.4)
    roll, pitch, yaw = mass * (size * np.array([0.11, 0.15, 0.165])) ** 2 * rng.uniform(0.8, 1.2, 3)
    robot = MassProperties(mass, [0.01 * size, 0.0, -0.02 * size], np.diag([roll, pitch, yaw]))
    standing = 0.25 * size
    fall = 0.75 * size * rng.uniform(0.8, 1.5)
    time = np.sqrt(2.0 * fall / 9.81)
    torque = 2.0 * pitch * np.radians(30.0) / time**2
    momentum = pitch * 2.0 * np.radians(40.0) / time
    radius = 0.045 * size * rng.uniform(0.8, 1.3)
    envelope = Envelope(
        outer_radius_max=radius, inner_radius_min=0.1 * radius, height_max=0.3 * radius,
        height_min=0.03 * radius, wall_min=0.03 * radius * rng.uniform(0.5, 1.5),
        mass_max=rng.choice([NO_LIMIT, 0.1 * mass]), stress_safety=2.0,
    )  # fmt: skip
    speed = momentum / (0.05 * mass * radius**2) * rng.uniform(0.5, 1.5)
    voltage = float(rng.choice([12.0, 24.0, 48.0]))
    ratios = (1.0 / rng.uniform(1.2, 2.0), rng.uniform(1.2, 4.0))
    problem = SelectionProblem(
        robot=robot,
        requirement=Requirement(
            tuple(_maneuvers(rng, standing, fall, torque, time)),
            rng.choice([None, rng.uniform(0.5, 1.5)]), 1.0, None,
        ),
        envelope=envelope,
        place=Place(((0.005 * size, 0.0, 0.05 * size),) * 2, ((0.0, 1.1, 1.1), (0.0, -1.1, 1.1))),
        motors=tuple(motor(rng, f"m{i}", torque, speed, voltage) for i in range(motors)),
        gears=(DIRECT, *(gear(rng, f"g{ratio:.2f}", ratio, 4.0 * torque) for ratio in ratios)),
        materials=(STEEL, ALUMINIUM),
        supply=Supply(voltage),
        incidence=rng.choice([None, None, 0.6]),
        wheel_speed_max=rng.choice([None, speed * 1.5]),
    )  # fmt: skip
    return with_mounts(problem, seed) if mounted else problem


def with_offset_load(problem, seed):
    """The problem with a load on one side of the robot."""
    rng, robot = np.random.default_rng(1000 + seed), problem.robot
    size = np.sqrt(np.trace(robot.inertia) / robot.mass)
    com = robot.com + np.array([0.0, rng.uniform(-0.1, 0.1) * size, 0.0])
    load = rng.normal(size=3)
    load *= rng.uniform(0.1, 0.4) * size / np.linalg.norm(load)
    own = robot.mass * (load @ load * np.eye(3) - np.outer(load, load))
    return replace(problem, robot=MassProperties(robot.mass, com, robot.inertia + own))


def lightest(problem):
    """The lightest device, with the demand of each part of the requirement."""
    return with_demands(problem, select(problem).best)


def has_device(problem):
    """Whether an exhaustive search finds any feasible device."""
    return bool(search(problem).ranking)


def with_radius(problem, share):
    """The problem with both radii of its envelope scaled by `share`."""
    envelope = problem.envelope
    radius, bore = share * envelope.outer_radius_max, share * envelope.inner_radius_min
    return replace(
        problem, envelope=replace(envelope, outer_radius_max=radius, inner_radius_min=bore)
    )


def _maneuvers(rng, standing, fall, torque, time):
    pitch, roll = np.radians(rng.uniform(15.0, 35.0)), np.radians(rng.choice([0.0, 8.0]))
    yield Drop(
        name="drop", standing_height=standing, height=standing + fall,
        pitch=float(pitch), roll=float(roll),
    )  # fmt: skip
    if rng.random() < 0.7:
        push = torque * rng.uniform(0.5, 2.0)
        yield Disturbance(
            name="push", takeoff_velocity=(0.5, 4.9 * time), onset=0.1 * time,
            torque=(0.3 * push, push, 0.0), duration=0.1 * time,
        )  # fmt: skip
    if rng.random() < 0.5:
        incidence = rng.choice([None, 0.0])
        yield Flip(
            name="flip", gravity=1.62, incidence=incidence, jump_height=1.0, angle=-np.pi,
            duration=float(3.0 * time),
        )  # fmt: skip


def with_mounts(problem, seed):
    """The problem with random mountings: threads in front, at the back or none; room of gears."""
    rng = np.random.default_rng([seed, 1])
    return replace(
        problem,
        motors=tuple(replace(motor, mounting=_mounting(rng, motor)) for motor in problem.motors),
        gears=tuple(
            gear if gear.room is None else replace(gear, room=_room(rng)) for gear in problem.gears
        ),
    )


def _mounting(rng, motor):
    """A random mounting that fits on the motor."""
    across = motor.diameter * rng.uniform(0.5, 0.65)
    face = rng.choice([None, Face.OUTPUT, Face.BACK, Face.BACK])
    shaft = rng.choice([None, 0.1 * motor.diameter])
    if face is None or across < 0.012:
        return rng.choice([None, Mounting(shaft)])
    rotor = None if shaft is not None else BoltCircle(0.6 * across, 4, "M2")
    stator = BoltCircle(across, int(rng.integers(3, 5)), "M2")
    return Mounting(shaft, rotor, stator, Face(face))


def _room(rng):
    depth, offset = rng.uniform(0.005, 0.02), rng.choice([0.0, rng.uniform(0.02, 0.05)])
    return GearRoom(depth, offset, 0.01, 0.01, center=0.4 * offset)
