"""Robot with its device in MuJoCo, as it is written and drawn."""

from dataclasses import dataclass
from pathlib import PurePath

import mujoco

from ocs_design.device.device import Device
from ocs_design.device.naming import PLATE, carrier_name, flywheel_names
from ocs_design.export.attach import add_sensors, attach_device
from ocs_design.export.visuals import WHEEL_MESH, carrier_visuals, device_meshes, plate_visuals
from ocs_design.robot.mjcf_spec import compiled
from ocs_design.robot.mujoco_bodies import GEOM_TYPES, HIDDEN_GROUP, VISUAL_GROUP, quaternion
from ocs_design.robot.mujoco_model import build_spec
from ocs_design.robot.robot import Robot


@dataclass(frozen=True, eq=False)
class RobotModel:
    """Whole robot, free in space, its device on its trunk.

    Attributes:
        spec: with the bytes of its meshes and textures.
        compiled: from `spec`.
        warnings: differences of the model from the robot's file, one sentence each.
    """

    spec: mujoco.MjSpec
    compiled: mujoco.MjModel
    warnings: tuple[str, ...]


def robot_model(robot: Robot, device: Device) -> RobotModel:
    """Model of robot, wheels, motors and sensors, with the shapes of the device."""
    built = build_spec(robot)
    spec = built.spec
    attach_device(spec, robot, device)
    add_sensors(spec, robot, device)
    # Wheels and carriers get what they look like, without mass and contact.
    for path, content in device_meshes(device).items():
        spec.assets[path.name] = content
        spec.add_mesh(name=path.stem, file=path.name)
    quiet = {"group": VISUAL_GROUP, "contype": 0, "conaffinity": 0, "mass": 0.0}
    for name in flywheel_names(device):
        # The cylinder that stands for the rim in contacts is hidden.
        solid = spec.geom(name)
        solid.group = HIDDEN_GROUP
        mesh, kind = PurePath(WHEEL_MESH).stem, mujoco.mjtGeom.mjGEOM_MESH
        spec.body(name).add_geom(type=kind, meshname=mesh, rgba=solid.rgba, **quiet)
    shown = [
        (carrier_name(module), visual)
        for module in device.modules
        for visual in carrier_visuals(device, module)
    ]
    for body, visual in (*shown, *((PLATE, visual) for visual in plate_visuals(device))):
        geom = spec.body(body).add_geom(
            type=GEOM_TYPES[visual.kind],
            pos=visual.place.position,
            quat=quaternion(visual.place.rotation),
            rgba=visual.color,
            **quiet,
        )
        if visual.mesh is None:
            geom.size = [*visual.size, 0.0, 0.0][:3]
        else:
            geom.meshname = visual.mesh.stem
    spec.compiler.saveinertial = True
    return RobotModel(spec, compiled(spec), built.warnings)
