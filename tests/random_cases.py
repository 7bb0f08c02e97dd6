"""Random robots of 1 kg to 80 kg, with requirements and small catalogues.

Everything scales with the robot, so that about half of the motors meet the requirement: a box of
about Solo12's proportions, falls of a good third of a second, motors around the torque and speed
that the maneuvers need.
"""

from dataclasses import dataclass
from itertools import product
from math import inf, pi, radians, sqrt

import numpy as np
from rims import PAPER_STEEL, STEEL
from selections import ALUMINIUM, with_mounts

from ocs_design.actuation.motor import DIRECT, Gear, Motor
from ocs_design.actuation.supply import Supply
from ocs_design.catalogue.materials import Material
from ocs_design.parts.rim import NO_CUTS, RimCuts
from ocs_design.requirement.device_sections import Envelope
from ocs_design.requirement.pushes import Disturbance
from ocs_design.requirement.requirement import Requirement
from ocs_design.requirement.turns import Drop, Flip
from ocs_design.robot.manual import robot_by_hand
from ocs_design.robot.robot import Robot
from ocs_design.sizing.free_place import place_on_top
from ocs_design.sizing.selection.problem import SelectionProblem

BRASS = Material(
    name="brass", density=8500.0, yield_strength=180e6, ultimate_strength=340e6,
    poisson_ratio=0.34, source="for tests",
)  # fmt: skip
MATERIALS = (STEEL, ALUMINIUM, BRASS, PAPER_STEEL)


@dataclass(frozen=True)
class RandomCase:
    """A robot and its selection problem."""

    robot: Robot
    problem: SelectionProblem


@dataclass(frozen=True)
class WheelScale:
    """Approximate torque, momentum, speed and radius [m] of a wheel for this robot."""

    torque: float
    momentum: float
    speed: float
    radius: float


def random_case(seed):
    """The case of this seed."""
    rng = np.random.default_rng(seed)
    mass = float(np.exp(rng.uniform(0.0, np.log(80.0))))
    size = float((mass / 2.5) ** (1.0 / 3.0) * rng.uniform(0.85, 1.2))
    robot = _robot(rng, mass, size)
    standing = standing_height(robot)
    maneuvers = tuple(_maneuvers(rng, robot, size, standing))
    scale = _scale(rng, robot, maneuvers, standing)
    voltage = float(rng.uniform(12.0, 60.0))
    count = int(rng.integers(3, 6))
    chosen = rng.permutation(len(MATERIALS))[: rng.integers(2, 4)]
    problem = SelectionProblem(
        robot=robot.mass_properties,
        requirement=Requirement(maneuvers, rng.choice([None, rng.uniform(0.5, 2.0)]), 1.0, None),
        envelope=_envelope(rng, scale.radius, mass),
        place=place_on_top(robot),
        motors=tuple(_motor(rng, f"motor {i}", scale, voltage) for i in range(count)),
        gears=(
            DIRECT,
            _gear(rng, "reducing", rng.uniform(1.5, 4.0), scale, reverses=True),
            _gear(rng, "speeding up", rng.uniform(0.4, 0.8), scale, reverses=False),
        ),
        materials=tuple(MATERIALS[index] for index in chosen),
        supply=Supply(voltage),
        incidence=rng.choice([None, None, rng.uniform(0.2, 0.9)]),
        wheel_speed_max=rng.choice([None, None, 1.5 * scale.speed]),
        web=seed % 2 == 0,
        cuts=RimCuts(0.3e-3) if seed % 4 == 0 else NO_CUTS,
        web_material=ALUMINIUM if seed % 6 == 2 else None,
    )
    return RandomCase(robot, with_mounts(problem, seed))


def standing_height(robot):
    """Height of the origin above the lowest corner of the robot's box [m]."""
    (box,) = robot.tree.bodies[0].shapes
    corners = np.array(list(product((-1.0, 1.0), repeat=3))) * np.asarray(box.size)
    return float(-(np.asarray(box.position) + corners @ np.asarray(box.rotation).T)[:, 2].min())


def _robot(rng, mass, size):
    a, b, c = size * np.array([0.47, 0.32, 0.2]) * rng.uniform(0.8, 1.25, 3)
    moments = mass / 12.0 * np.array([b**2 + c**2, a**2 + c**2, a**2 + b**2])
    pairs = np.sqrt(moments[[0, 0, 1]] * moments[[1, 2, 2]])
    products = 0.03 * pairs * rng.uniform(-1.0, 1.0, 3)
    com = size * np.array([0.02, 0.003, 0.02]) * rng.uniform(-1.0, 1.0, 3)
    return robot_by_hand(mass, (*moments, *products), tuple(com))


def _maneuvers(rng, robot, size, standing):
    slow = sqrt(size)
    fall = float(rng.uniform(0.32, 0.5) * slow)
    yield Drop(
        name="drop",
        standing_height=standing,
        height=standing + 9.81 * fall**2 / 2.0,
        pitch=float(radians(rng.choice([-1.0, 1.0]) * rng.uniform(10.0, 32.0))),
        roll=float(radians(rng.choice([0.0, rng.uniform(-10.0, 10.0)]))),
    )
    if rng.random() < 0.6:
        flight = float(rng.uniform(0.5, 0.7) * slow)
        lasting = float(rng.uniform(0.05, 0.1) * flight)
        rates = np.array([rng.uniform(-0.6, 0.6), rng.uniform(-1.2, 1.2), 0.0])
        yield Disturbance(
            name="push",
            takeoff_velocity=(float(rng.uniform(0.0, 1.0)), 9.81 * flight / 2.0),
            torque=tuple(np.diag(robot.inertia) * rates / lasting),
            onset=float(rng.uniform(0.1, 0.25) * flight),
            duration=lasting,
        )
    if rng.random() < 0.6:
        yield _flip(rng, size)


def _flip(rng, size):
    """A full flip on the Moon or on Mars."""
    gravity, height = float(rng.choice([1.62, 3.71])), float(rng.uniform(0.8, 1.2) * size)
    return Flip(
        name="flip",
        gravity=gravity,
        incidence=rng.choice([None, 0.0]),
        jump_height=height,
        angle=float(rng.choice([-1.0, 1.0]) * 2.0 * pi),
        duration=float(2.0 * sqrt(2.0 * height / gravity) * rng.uniform(0.8, 0.9)),
    )


def _scale(rng, robot, maneuvers, standing):
    turns = []
    for maneuver in maneuvers:
        if isinstance(maneuver, Drop):
            turns.append((abs(maneuver.pitch), sqrt(2.0 * (maneuver.height - standing) / 9.81)))
        elif isinstance(maneuver, Flip):
            turns.append((abs(maneuver.angle), maneuver.duration))
    pitch = robot.inertia[1, 1]
    torque = max(2.0 * pitch * angle / time**2 for angle, time in turns)
    momentum = max(pitch * angle / time for angle, time in turns)
    radius = 0.045 * (pitch / 0.055) ** 0.2 * rng.uniform(0.85, 1.3)
    disc = pi * 7850.0 * 0.3 * radius**5 / 2.0
    return WheelScale(torque, momentum, momentum / (0.3 * disc), radius)


def _envelope(rng, radius, mass):
    return Envelope(
        outer_radius_max=float(radius),
        inner_radius_min=float(radius * rng.uniform(0.05, 0.3)),
        height_max=float(radius * rng.uniform(0.15, 0.4)),
        height_min=float(radius * rng.uniform(0.02, 0.06)),
        wall_min=float(radius * rng.uniform(0.02, 0.06)),
        mass_max=float(rng.choice([inf, 0.1 * mass])),
        stress_safety=float(rng.uniform(1.5, 3.0)),
    )


def _motor(rng, name, scale, voltage):
    """A random motor: some are too weak, some lack rotor inertia or maximum speed."""
    peak = scale.torque * float(np.exp(rng.uniform(np.log(0.5), np.log(4.0))))
    mass = 0.12 * peak**0.75 * float(rng.uniform(0.7, 1.4))
    radius = 0.02 * (mass / 0.08) ** (1.0 / 3.0)
    free = scale.speed * float(rng.uniform(0.6, 3.0))
    k_t, stall = voltage / free, peak * float(rng.uniform(0.7, 8.0))
    rated = voltage * float(rng.uniform(0.8, 1.3))
    rotor = 0.4 * mass * radius**2 * float(rng.uniform(0.3, 1.0))
    return Motor(
        name=name,
        maker="drawn",
        mass=mass,
        diameter=2.0 * radius,
        length=0.8 * radius,
        torque_constant=k_t,
        resistance=voltage * k_t / stall,
        rated_voltage=rated,
        no_load_speed=rng.choice([None, rated / k_t * 0.97]),
        speed_max=rng.choice([None, free * rng.uniform(0.8, 1.4)]),
        peak_torque=peak,
        peak_current=None,
        continuous_torque=None,
        rotor_inertia=rng.choice([None, rotor, rotor]),
        source="drawn",
        confidence="good",
    )


def _gear(rng, name, ratio, scale, *, reverses):
    return Gear(
        name=name,
        ratio=float(ratio),
        efficiency=float(rng.uniform(0.85, 0.97)),
        mass=0.02 * scale.torque**0.7,
        inertia=1e-3 * scale.momentum / scale.speed,
        motor_speed_max=float(rng.choice([inf, 3.0 * scale.speed])),
        wheel_speed_max=float(rng.choice([inf, 2.0 * scale.speed])),
        torque_max=float(rng.choice([inf, 3.0 * scale.torque])),
        reverses=reverses,
        source="drawn",
    )
