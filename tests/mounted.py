"""Devices on real robots, and their contacts in MuJoCo."""

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
    """Robot, resolved requirement, and design without a motor for the default maneuvers."""
    specification = Specification(
        robot=RobotSection(file=str(ROBOTS / f"{name}.urdf")), motor=MotorSection(name=NO_MOTOR)
    )
    robot = read_robot(ROBOTS / f"{name}.urdf")
    task = Task.of(specification, robot)
    return robot, task.resolved, design_device(task)


@cache
def mounted(name):
    """Robot, device and mounting."""
    robot, resolved, design = designed(name)
    maneuvers = resolved.requirement.maneuvers
    return robot, design.device, mounting_of(robot, design.device, maneuvers, design.sized.total)


def contacts(robot, device, postures):
    """Bodies of the robot that touch a wheel in any of the postures, from MuJoCo's contacts."""
    spec = build_spec(robot, visuals=False).spec
    attach_device(spec, robot, device)
    # Geoms collide with the wheels only; in the exported model wheels collide with no link.
    for geom in spec.geoms:
        is_wheel = geom.name in flywheel_names(device)
        geom.contype, geom.conaffinity = (0, 1) if is_wheel else (1, 0)
    model = spec.compile()
    wheels = [model.geom(name).id for name in flywheel_names(device)]
    data, bodies = mujoco.MjData(model), []
    for posture in postures:
        data.qpos[:] = posture_qpos(model, robot)
        for joint, value in robot.tree.complete({**robot.posture, **posture}).items():
            data.qpos[model.joint(joint).qposadr] = value
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        mujoco.mj_collision(model, data)
        touching = set(data.contact.geom.ravel().tolist()) - set(wheels)
        bodies += [model.body(int(model.geom_bodyid[geom])).name for geom in touching]
    return bodies


def flown_postures(name):
    """Values of the legs' joints at each control step of the flights with the device."""
    robot, resolved, design = designed(name)
    builder = WorldBuilder(robot, design.device)
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
    """Coordinates of the one world simulated within this context; recordings lack the joints."""
    coordinates, attitude = [], TrunkChain.attitude

    def recording_attitude(self, qpos):
        coordinates.append(qpos[0].copy())
        return attitude(self, qpos)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(TrunkChain, "attitude", recording_attitude)
        yield coordinates
