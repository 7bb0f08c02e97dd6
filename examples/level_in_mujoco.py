"""A robot with its device in a simulation of your own: it falls tilted and lands level.

ocs-design size examples/solo12.urdf
python examples/level_in_mujoco.py solo12-ocs
"""

import sys
from pathlib import Path

import mujoco
import numpy as np

from ocs_design import OcsDesign, read_design

HEIGHT, PITCH = 1.0, np.radians(20.0)  # of the trunk at release [m, rad]
KP, KD = 60.0, 12.0  # of the trunk's tilt [1/s^2, 1/s]


def main(folder: Path) -> float:
    """Drop the robot; its pitch at touchdown [rad]."""
    design = read_design(folder / "design.json")
    model, data = load(folder)
    while data.time < 2.0 and not data.ncon:
        drive_wheels(data, design)
        mujoco.mj_step(model, data)
    pitch = tilt(data)[1]
    print(f"touches down after {data.time:.3f} s, {np.degrees(pitch):.1f} deg off in pitch")
    return float(pitch)


def load(folder: Path) -> tuple[mujoco.MjModel, mujoco.MjData]:
    """The exported robot over its floor, in its posture, tilted; its legs hold themselves."""
    model = mujoco.MjModel.from_xml_path(str(folder / "robot" / "scene.xml"))
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, model.key("ocs_home").id)
    data.qpos[2] = HEIGHT
    data.qpos[3:7] = np.cos(PITCH / 2.0), 0.0, np.sin(PITCH / 2.0), 0.0
    mujoco.mj_forward(model, data)
    return model, data


def drive_wheels(data: mujoco.MjData, design: OcsDesign) -> None:
    """Torques on the trunk by its tilt and rate, and what the wheels must do for them."""
    inertia = np.diag(design.ocs.total_inertia)[:2]
    rate = data.sensor("ocs_imu_rate").data[:2]
    on_trunk = -inertia * (KP * tilt(data) + KD * rate)
    axes = np.column_stack([module.axis for module in design.ocs.modules])[:2]
    # What a motor gives its wheel, the trunk gets the other way round.
    wheels = -np.linalg.pinv(axes) @ on_trunk
    for name, torque in zip(("ocs_left", "ocs_right"), wheels, strict=True):
        data.actuator(name).ctrl[0] = torque


def tilt(data: mujoco.MjData) -> np.ndarray:
    """Of the trunk about its x and y [rad], from the device's own IMU."""
    rotation = np.empty(9)
    mujoco.mju_quat2Mat(rotation, data.sensor("ocs_imu_attitude").data)
    x, y, z = rotation.reshape(3, 3)[2]
    return np.array([np.arctan2(y, z), -np.arcsin(x)])


if __name__ == "__main__":
    main(Path(sys.argv[1]))
