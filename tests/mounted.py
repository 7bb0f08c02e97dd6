"""Devices of real robots, and where MuJoCo sees them touched."""

from contextlib import contextmanager
from functools import cache

import mujoco
import pytest
from exported import LEGGED
from robots import ROBOTS

from ocs_design.device.bodies import flywheel_names
from ocs_design.export.attach import attach_device
from ocs_design.requirement.device_sections import MotorSection
from ocs_design.requirement.sections import RobotSection
from ocs_design.requirement.specification import Specification
from ocs_design.requirement.sweep import Task
from ocs_design.requirement.vocabulary import NO_MOTOR
from ocs_design.robot.mujoco_model import build_spec, posture_qpos
from ocs_design.robot.reader import read_robot
from ocs_design.simulation.scene import Wheels
from ocs_design.simulation.simulate import simulate
from ocs_design.simulation.world import TrunkChain
from ocs_design.simulation.world_builder import WorldBuilder
from ocs_design.sizing.design import design_device
from ocs_design.sizing.mounting import mounting_of

MEASURED = [name for name in LEGGED if "romeo" not in name]


@cache
def designed(name):
    """Robot, what was resolved, and the device without a motor for its default maneuvers."""
    specification = Specification(
        robot=RobotSection(file=str(ROBOTS / f"{name}.urdf")), motor=MotorSection(name=NO_MOTOR)
    )
    robot = read_robot(ROBOTS / f"{name}.urdf")
    task = Task.of(specification, robot)
    return robot, task.resolved, design_device(task)


@cache
def mounted(name):
    """Robot, device and mounting."""
    robot, resolved, found = designed(name)
    maneuvers = resolved.requirement.maneuvers
    return robot, found.device, mounting_of(robot, found.device, maneuvers, found.sized.total)


def contacts(robot, device, postures):
    """Bodies of the robot that touch a wheel in any of the postures, by MuJoCo's contacts."""
    spec = build_spec(robot, visuals=False).spec
    attach_device(spec, robot, device)
    # All geoms meet the wheels, and nothing else; as delivered wheels meet no link.
    for geom in spec.geoms:
        is_wheel = geom.name in flywheel_names(device)
        geom.contype, geom.conaffinity = (0, 1) if is_wheel else (1, 0)
    model = spec.compile()
    wheels = [model.geom(name).id for name in flywheel_names(device)]
    data, found = mujoco.MjData(model), []
    for posture in postures:
        data.qpos[:] = posture_qpos(model, robot)
        for joint, value in robot.tree.complete({**robot.posture, **posture}).items():
            data.qpos[model.joint(joint).qposadr] = value
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        mujoco.mj_collision(model, data)
        touching = set(data.contact.geom.ravel().tolist()) - set(wheels)
        found += [model.body(int(model.geom_bodyid[geom])).name for geom in touching]
    return found


def flown_postures(name):
    """Values of the legs' joints at each control step of the flights with the device."""
    robot, resolved, found = designed(name)
    builder = WorldBuilder(robot, found.device)
    joints = [joint for leg in robot.legs for joint in leg.joints]
    postures = []
    for maneuver in resolved.requirement.maneuvers:
        world = builder.flight(maneuver, Wheels.ACTIVE)
        with recorded_coordinates() as coordinates:
            simulate([world], threads=1)
        addresses = [int(world.model.joint(joint).qposadr[0]) for joint in joints]
        postures += [dict(zip(joints, row[addresses], strict=True)) for row in coordinates]
    return postures


@contextmanager
def recorded_coordinates():
    """The coordinates of the one world that flies meanwhile; a recording has no joints."""
    coordinates, attitude = [], TrunkChain.attitude

    def listening(self, qpos):
        coordinates.append(qpos[0].copy())
        return attitude(self, qpos)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(TrunkChain, "attitude", listening)
        yield coordinates
