"""The push in mid-air flown by a plain loop over MuJoCo, without any of ocs-design's code.

    ocs-design size examples/solo12.urdf
    python examples/independent_controller.py solo12-ocs

It reads the exported robot and `design.json`, puts the robot on a floor, its legs on joint drives
and a controller on its wheels, each written anew from docs/theory.md and docs/validation.md, and
compares the attitude at touchdown with what `size` recorded. Start from it for a controller of your
own.
"""

import json
import sys
from pathlib import Path

import mujoco
import numpy as np

STEP, HOLD = 1e-3, 5  # of the physics [s]; steps from one torque to the next
GRAVITY = 9.81  # the standard one, that the joint drives are made for [m/s^2]
LEG = 0.32  # of Solo12, hip to knee to foot [m]
STABLE = 0.5  # share of what an explicit step bears


def main() -> None:
    """Fly and compare."""
    folder = Path(sys.argv[1])
    design = json.loads((folder / "design.json").read_text())
    run = next(r for r in design["validation"] if r["scenario"] == "disturbance" and r["ocs"])
    roll, pitch = touchdown(folder, design)
    for name, here in (("roll", roll), ("pitch", pitch)):
        there = run["metrics"][f"touchdown_{name}"]
        print(f"{name:5s} {np.degrees(here):10.6f} deg, recorded {np.degrees(there):10.6f} deg")
    error = max(
        abs(roll - run["metrics"]["touchdown_roll"]), abs(pitch - run["metrics"]["touchdown_pitch"])
    )
    print(f"differ by {error:.1e} rad")


def touchdown(folder: Path, design: dict) -> tuple[float, float]:
    """Roll and pitch at the last control instant of the flight [rad]."""
    push = next(m for m in design["requirement"]["maneuvers"] if m["kind"] == "disturbance")
    model, data = world(folder, design, push)
    law = Controller(design)
    trunk = model.body(design["robot"]["trunk"]).id
    wheels = [int(model.joint(name).dofadr[0]) for name in ("ocs_left", "ocs_right")]
    motors = [model.actuator(name).id for name in ("ocs_left", "ocs_right")]
    while True:
        rotation = data.xmat[trunk].reshape(3, 3).copy()
        up = rotation[2]
        data.ctrl[motors] = law.torque(up, data.qvel[3:6], data.qvel[wheels])
        share = overlap(data.time, HOLD * STEP, push["parameters"])
        data.xfrc_applied[trunk, 3:] = share * (rotation @ push["parameters"]["torque"])
        for _ in range(HOLD):
            mujoco.mj_step(model, data)
            mujoco.mj_forward(model, data)
            if data.ncon:
                return float(np.arcsin(up[1])), float(np.arctan2(-up[0], up[2]))


def world(folder: Path, design: dict, push: dict) -> tuple[mujoco.MjModel, mujoco.MjData]:
    """Robot and floor at lift-off, level, the feet just clear of the ground."""
    robot, (xml,) = design["robot"], (folder / "robot").glob("*_ocs.xml")
    spec = mujoco.MjSpec.from_file(str(xml))
    for geom in spec.geoms:  # links may overlap: only the floor is met
        geom.conaffinity = int(bool(geom.contype or geom.conaffinity))
        geom.contype = 0
    spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_PLANE, size=[0, 0, 1], conaffinity=0)
    for name in robot["posture"]:
        spec.add_actuator(name=name, target=name, trntype=mujoco.mjtTrn.mjTRN_JOINT)
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_RK4
    spec.option.timestep, spec.option.tolerance = STEP, 1e-12
    spec.option.gravity = [0, 0, -push["gravity"]]
    model = spec.compile()
    data = mujoco.MjData(model)
    for name, angle in robot["posture"].items():
        data.qpos[model.joint(name).qposadr[0]] = angle
    drive_legs(model, data, robot)
    data.qpos[2] = robot["standing_height"] * 1.001
    forward, upward = push["parameters"]["takeoff_velocity"]
    data.qvel[:3] = forward, 0.0, upward
    mujoco.mj_forward(model, data)
    return model, data


def drive_legs(model: mujoco.MjModel, data: mujoco.MjData, robot: dict) -> None:
    """Proportional-derivative drives that hold the posture; gains from weight and leg length."""
    mujoco.mj_forward(model, data)
    mass_matrix = np.empty((model.nv, model.nv))
    mujoco.mj_fullM(model, data, mass_matrix)
    felt = 1.0 / np.diag(np.linalg.inv(mass_matrix))
    stiffness = 0.5 * robot["mass"] * GRAVITY * LEG
    damping = 0.5 * stiffness * np.sqrt(LEG / GRAVITY)
    for name, angle in robot["posture"].items():
        drive, joint = model.actuator(name).id, model.joint(name)
        model.actuator_gainprm[drive, 0] = stiffness
        model.actuator_biastype[drive] = mujoco.mjtBias.mjBIAS_AFFINE
        bearable = STABLE * felt[joint.dofadr[0]] / STEP
        model.actuator_biasprm[drive, 1:3] = -stiffness, -min(damping, bearable)
        data.ctrl[drive] = angle


class Controller:
    """Level flight by two wheels, in the frame of the trunk."""

    def __init__(self, design: dict) -> None:
        ocs, motor = design["ocs"], design["ocs"]["motor"]
        self.inertia = np.array(ocs["total_inertia"])
        self.axes = np.array([module["axis"] for module in ocs["modules"]]).T
        self.spin, armature = ocs["spin_inertia"], motor["armature"]
        self.reaction = self.spin / (self.spin + armature)
        self.driven = self.inertia - self.reaction * self.spin * self.axes @ self.axes.T
        self.kp, self.kd = design["control"]["kp"], design["control"]["kd"]
        self.limit = motor["torque_limit"] or np.inf
        self.line = motor["no_load_speed"]
        self.slope = self.line / motor["stall_torque"] if motor["stall_torque"] else 0.0
        self.top = motor["speed_max"] or np.inf
        # Speed that a wheel gains in a control step per torque, both motors pushing alike.
        coupling = self.axes.T @ np.linalg.inv(self.driven) @ self.axes
        alone = 1.0 / (self.spin + armature)
        largest = np.abs(coupling).sum(axis=1).max()
        self.gain = HOLD * STEP * (alone + self.reaction**2 * largest)

    def torque(self, up: np.ndarray, rate: np.ndarray, speed: np.ndarray) -> np.ndarray:
        """Of the motors [N m]: `J w_dot = -g A tau - w x H` with roll and pitch as wanted."""
        error = np.cross([0.0, 0.0, 1.0], up)
        sine = np.linalg.norm(error)
        angle = error * (np.arctan2(sine, up[2]) / sine if sine > 0.0 else 1.0)
        wanted = self.kp * angle[:2] - self.kd * rate[:2]
        momentum = self.inertia @ rate + self.spin * self.axes @ speed
        # Unknown are both torques and the acceleration of yaw, which comes as it will.
        unknown = np.column_stack([self.reaction * self.axes, self.driven[:, 2]])
        known = -np.cross(rate, momentum) - self.driven[:, :2] @ wanted
        return self.clipped(np.linalg.solve(unknown, known)[:2], speed)

    def clipped(self, torque: np.ndarray, speed: np.ndarray) -> np.ndarray:
        """Within current limit, voltage line and top speed at the end of the control step."""
        give = self.gain + self.slope
        most = np.minimum((self.line - speed) / give, (self.top - speed) / self.gain)
        least = np.maximum((-self.line - speed) / give, (-self.top - speed) / self.gain)
        return np.clip(np.clip(torque, least, most), -self.limit, self.limit)


def overlap(time: float, period: float, push: dict) -> float:
    """Part of the control step in which the push acts."""
    begin = max(time, push["onset"])
    end = min(time + period, push["onset"] + push["duration"])
    return max(end - begin, 0.0) / period


if __name__ == "__main__":
    main()
