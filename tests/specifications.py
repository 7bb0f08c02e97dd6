"""Specifications to write and read back."""

from dataclasses import replace
from math import pi, radians

import pytest

from ocs_design.common.errors import SpecificationError
from ocs_design.requirement.device_sections import (
    FlywheelSection,
    MotorSection,
    OcsSection,
    SupplySection,
)
from ocs_design.requirement.phrases import About, Climb, Kick, Pivot, Tilt
from ocs_design.requirement.pivoted import Balance, StandUp
from ocs_design.requirement.pushes import Disturbance, Shove
from ocs_design.requirement.resolving import resolve
from ocs_design.requirement.sections import RequirementSection, RobotSection, ValidationSection
from ocs_design.requirement.specification import Specification
from ocs_design.requirement.turns import Catch, Drop, Flip, TurnTo
from ocs_design.requirement.uncertainty import UncertaintySection, Uniform, spreads

MANEUVERS = (
    Disturbance(
        name="push",
        takeoff_velocity=(0.5, 2.4),
        torque=(0.2, -0.8, 0.1),
        onset=0.1,
        duration=0.05,
    ),
    Shove(name="nudge", torque=(0.5, 0.0, 0.0), duration=0.1, settling=0.4, stride=0.3),
    Drop(name="drop", height=1.0, pitch=radians(30.0), roll=-0.1, incidence=0.0),
    Flip(name="back-flip", gravity=1.62, jump_height=1.0, angle=-2 * pi, duration=2.0),
    TurnTo(
        name="round",
        gravity=1.62,
        jump_height=1.9,
        yaw=pi / 2,
        roll=0.1,
        pitch=-0.2,
        duration=2.9,
        wheel_speed=100.0,
        end="attitude",
    ),
    Balance(
        name="stagger",
        pivot=(0.1, 0.0, -0.2),
        roll=0.05,
        pitch=-0.1,
        duration=1.2,
        rate=(0.1, 0.2, 0.0),
        impulse=(0.0, 0.3, 0.0),
        point=(0.0, 0.1, 0.2),
    ),
    StandUp(
        name="get up",
        pivot=(0.0, 0.0, -0.2),
        edge=(0.0, 1.0, 0.0),
        pitch=-0.7,
        duration=0.8,
        wheel_speed=-50.0,
        actuation="brake",
    ),
    Catch(name="catch", jump_height=0.5, duration=0.6, rate=(0.4, 0.8, -0.1), end="at rest"),
)

FULL_SPECIFICATION = Specification(
    robot=RobotSection(
        file='a "quoted" \\ path/ä\x7f.urdf',
        name="r",
        legs=("FL_FOOT", "FR_FOOT"),
        trunk="t",
        posture="stand",
        joints={"a b": 1 / 3},
        weighed=2.7,
    ),
    requirement=RequirementSection(
        rate_change=0.1,
        wheel_speed_max=31415.926,
        spin_inertia=7.11e-5,
        gravity=9.81,
        reliability=0.95,
        survives="none",
        detection=0.02,
        jump_height=(0.4, 0.55),
        kick=(Kick(12.0, (0.1, 0.0, 1e-17), (0.0, 1.0, 0.0)), Kick(0.3, "hip")),
        fall=(1.0,),
        tilt=(Tilt(0.1, radians(20.0)),),
        flip=(radians(-360.0),),
        turn=(About(0.0, 0.1, radians(90.0), 2.9, "rad"), About(0.3, 0.0, 0.0, None, "rad")),
        catch=(About(0.1, 1 / 3, 0.0, 0.5, "rad/s"),),
        pivot=Pivot((0.0, 0.1, -0.2), (1.0, 0.0, 0.0)),
        balance=(About(0.1, 0.0, 0.0, 1.5, "rad"), Kick(0.3, (0.0, 0.1, 0.2), (0.0, 1.0, 0.0))),
        stand_up=(
            Climb(About(1 / 3, 0.0, 0.0, None, "rad"), brake=True),
            Climb(About(0.2, 0.0, 0.0, 0.5, "rad"), brake=False),
        ),
    ),
    ocs=OcsSection(
        layout="pair",
        alpha=radians(40.0),
        alpha_criterion="lightest",
        position=(0.1, 0.2, 1e-17),
        co_design=True,
        guard="containing",
        wheel="disc",
        mass_max=1.25,
        lighter_by=0.09,
    ),
    flywheel=FlywheelSection(
        r_max=0.05,
        r_min=0.005,
        h_max=0.01,
        h_min=0.002,
        wall_min=0.002,
        wheel_mass_max=0.25,
        material="auto",
        stress_safety=2.5,
        web="disc",
        lightening=5,
        chamfer=0.3e-3,
        balancing_holes=4,
        balancing_hole_diameter=2e-3,
        balancing_hole_depth=1.5e-3,
    ),
    motor=MotorSection(
        name="auto",
        gear="direct",
        any=True,
        motors="m.csv",
        with_catalogue=True,
        gears="g.toml",
        torque_max=1.1,
    ),
    supply=SupplySection(voltage=24.0, current_max=40.0, power_max=1e3 / 3, controllers=0.035),
    validation=ValidationSection(
        enabled=False,
        projection="transpose",
        kp=60.0,
        kd=12.0,
        ballistic=True,
        seed=7,
        control_period=0.004,
        desaturate=True,
        certify=True,
        video=True,
    ),
    reality=UncertaintySection(
        file="own/reality.toml", **{name: Uniform(0.01, 1 / 30) for name in spreads()}
    ),
    maneuvers=MANEUVERS,
)


def same_specification(one, other):
    """Whether specifications are equal; their maneuvers, which compare by identity, by fields."""
    same_sections = replace(one, maneuvers=()) == replace(other, maneuvers=())
    return same_sections and [vars(m) for m in one.maneuvers] == [vars(m) for m in other.maneuvers]


def problems_of(specification, robot, size):
    """Problems of a specification for a robot of this size, by key."""
    with pytest.raises(SpecificationError) as caught:
        resolve(specification, robot, size)
    return caught.value.problems
