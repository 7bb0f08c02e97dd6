"""Flights by a plain loop over MuJoCo, without any of ocs-design's code.

    ocs-design size examples/solo12.urdf --ballistic --motor none
    python examples/independent_controller.py solo12-ocs

It reads the exported robot and `design.json`, puts the robot on a floor, its legs on joint drives
and a controller on its wheels, each written anew from docs/theory.md and docs/validation.md, and
compares the attitude at touchdown with what `size` recorded. Start from it for a controller of your
own.

    ocs-design size examples/solo12.urdf --ballistic
    ocs-design export solo12-ocs --formats controller -o fly && make -C fly/controller
    python examples/independent_controller.py solo12-ocs fly/controller

flies the exported C controller in the same loop.
"""

import importlib.util
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
    if len(sys.argv) not in {2, 3}:
        sys.exit(__doc__)
    folder, *exported = map(Path, sys.argv[1:])
    design = json.loads((folder / "design.json").read_text())
    # With limited motors drops and flips follow planned trajectories, which only the C has.
    limited = design["ocs"]["motor"]["torque_limit"] is not None
    for index, maneuver in enumerate(design["requirement"]["maneuvers"]):
        if maneuver["kind"] != "disturbance" and limited and not exported:
            continue
        law = Compiled(exported[0], index) if exported else None
        runs = (r for r in design["validation"] if r["scenario"] == maneuver["name"] and r["ocs"])
        there = next(runs)["metrics"]
        here = touchdown(folder, design, maneuver, law)
        for name, angle in zip(("roll", "pitch"), here, strict=True):
            recorded = there[f"touchdown_{name}"]
            print(
                f"{maneuver['name']:12s} {name:5s} {np.degrees(angle):10.6f} deg, recorded "
                f"{np.degrees(recorded):10.6f} deg, differ by {abs(angle - recorded):.1e} rad"
            )


def touchdown(
    folder: Path, design: dict, maneuver: dict, law: "Compiled | None" = None
) -> tuple[float, float]:
    """Roll and pitch at the last control instant of the flight [rad]."""
    start = Start(maneuver, design["robot"]["standing_height"])
    model, data = world(folder, design, start)
    trunk = model.body(design["robot"]["trunk"]).id
    wheels = [int(model.joint(name).dofadr[0]) for name in ("ocs_left", "ocs_right")]
    motors = [model.actuator(name).id for name in ("ocs_left", "ocs_right")]
    law = law or Controller(design, locked_inertia(model, data), start.incidence)
    while True:
        rotation = data.xmat[trunk].reshape(3, 3).copy()
        up = rotation[2]
        data.ctrl[motors] = law.torque(
            rotation, data.qvel[3:6], data.qvel[wheels], start, data.time
        )
        share = overlap(data.time, HOLD * STEP, start.onset, start.duration)
        data.xfrc_applied[trunk, 3:] = share * (rotation @ start.push)
        for _ in range(HOLD):
            mujoco.mj_step(model, data)
            mujoco.mj_forward(model, data)
            if data.ncon:
                return float(np.arcsin(up[1])), float(np.arctan2(-up[0], up[2]))


class Start:
    """A maneuver: where it starts, what hits the trunk, and the pitch that it should have."""

    def __init__(self, maneuver: dict, standing: float) -> None:
        specified, self.gravity = maneuver["parameters"], maneuver["gravity"]
        self.height, self.velocity = standing * 1.001, np.zeros(3)
        self.push, self.onset, self.duration = np.zeros(3), 0.0, 0.0
        self.first, self.last, self.time = 0.0, 0.0, 1.0
        self.incidence = maneuver["incidence"]
        if maneuver["kind"] == "disturbance":
            self.velocity[[0, 2]] = specified["takeoff_velocity"]
            self.push = np.array(specified["torque"])
            self.onset, self.duration = specified["onset"], specified["duration"]
        elif maneuver["kind"] == "drop":  # tilted in pitch alone
            self.height, self.first = specified["height"], specified["pitch"]
            self.time = np.sqrt(2.0 * (self.height - standing) / self.gravity)
        else:
            self.velocity[2] = np.sqrt(2.0 * self.gravity * specified["jump_height"])
            self.last, self.time = specified["angle"], specified["duration"]

    def pitch(self, time: float) -> float:
        """Rest to rest by a polynomial of fifth order [rad]."""
        s = min(time / self.time, 1.0)
        return self.first + (self.last - self.first) * s**3 * (10.0 - 15.0 * s + 6.0 * s**2)

    def rate(self, time: float) -> float:
        """Its slope [rad/s]."""
        s = min(time / self.time, 1.0)
        return (self.last - self.first) / self.time * 30.0 * (s * (1.0 - s)) ** 2


def world(folder: Path, design: dict, start: Start) -> tuple[mujoco.MjModel, mujoco.MjData]:
    """Robot and floor at the start of a flight."""
    robot, (xml,) = design["robot"], (folder / "robot").glob("*_ocs.xml")
    spec = mujoco.MjSpec.from_file(str(xml))
    for geom in spec.geoms:  # links may overlap: only the floor is met
        geom.conaffinity = int(bool(geom.contype or geom.conaffinity))
        geom.contype = 0
    spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_PLANE, size=[0, 0, 1], conaffinity=0)
    spec.option.gravity = [0, 0, -start.gravity]
    model = spec.compile()
    if start.incidence is not None:
        turn_modules(model, start.incidence - design["ocs"]["incidence"])
    data = mujoco.MjData(model)
    for name, angle in robot["posture"].items():
        data.qpos[model.joint(name).qposadr[0]] = angle
    drive_legs(model, data, robot)
    data.qpos[2], data.qvel[:3] = start.height, start.velocity
    data.qpos[3:7] = np.cos(start.first / 2.0), 0.0, np.sin(start.first / 2.0), 0.0
    mujoco.mj_forward(model, data)
    return model, data


def turn_modules(model: mujoco.MjModel, angle: float) -> None:
    """Both wheels turned by hand about the vertical, towards the roll axis [rad]."""
    for name, side in (("ocs_left_flywheel", -1.0), ("ocs_right_flywheel", 1.0)):
        body, before = model.body(name).id, model.body(name).quat.copy()
        turn = np.array([np.cos(angle / 2.0), 0.0, 0.0, side * np.sin(angle / 2.0)])
        mujoco.mju_mulQuat(model.body_quat[body], turn, before)


def locked_inertia(model: mujoco.MjModel, data: mujoco.MjData) -> np.ndarray:
    """Of everything about its centre of mass, in the frame of the trunk [kg m^2]."""
    mass_matrix = np.empty((model.nv, model.nv))
    mujoco.mj_fullM(model, data, mass_matrix)
    mass, rotation = mass_matrix[0, 0], data.xmat[1].reshape(3, 3)
    x = rotation.T @ (data.subtree_com[0] - data.xpos[1])
    return mass_matrix[3:6, 3:6] - mass * (x @ x * np.eye(3) - np.outer(x, x))


def drive_legs(model: mujoco.MjModel, data: mujoco.MjData, robot: dict) -> None:
    """Proportional-derivative drives that hold the posture; gains from weight and leg length."""
    mujoco.mj_forward(model, data)
    mass_matrix = np.empty((model.nv, model.nv))
    mujoco.mj_fullM(model, data, mass_matrix)
    felt = 1.0 / np.diag(np.linalg.inv(mass_matrix))
    stiffness = 0.5 * model.body_mass.sum() * GRAVITY * LEG
    damping = 0.5 * stiffness * np.sqrt(LEG / GRAVITY)
    for name, angle in robot["posture"].items():
        drive, joint = model.actuator(name).id, model.joint(name)
        model.actuator_gainprm[drive, 0] = stiffness
        bearable = STABLE * felt[joint.dofadr[0]] / STEP
        model.actuator_biasprm[drive, 1:3] = -stiffness, -min(damping, bearable)
        data.ctrl[drive] = angle


class Controller:
    """Level flight by two wheels, in the frame of the trunk."""

    def __init__(self, design: dict, inertia: np.ndarray, incidence: float | None) -> None:
        ocs, motor = design["ocs"], design["ocs"]["motor"]
        self.inertia = inertia
        angle = ocs["incidence"] if incidence is None else incidence
        sine, cosine = np.sin(angle), np.cos(angle)
        self.axes = np.array([[sine, -sine], [cosine, cosine], [0.0, 0.0]])
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

    def torque(
        self, rotation: np.ndarray, rate: np.ndarray, speed: np.ndarray, start: Start, time: float
    ) -> np.ndarray:
        """Of the motors [N m]: `J w_dot = -g A tau - w x H` with roll and pitch as wanted."""
        up, pitch, turning = rotation[2], start.pitch(time), start.rate(time)
        target = np.array([-np.sin(pitch), 0.0, np.cos(pitch)])
        error = np.cross(target, up)
        sine = np.linalg.norm(error)
        angle = error * (np.arctan2(sine, target @ up) / sine if sine > 0.0 else 1.0)
        wanted = self.kp * angle[:2] + self.kd * (np.array([0.0, turning]) - rate[:2])
        wanted[1] += (start.rate(time + HOLD * STEP) - turning) / (HOLD * STEP)
        momentum = self.inertia @ rate + self.spin * self.axes @ speed
        known = -np.cross(rate, momentum) - self.driven[:, :2] @ wanted
        # The acceleration of yaw comes as it will; modules in line leave roll to itself.
        tilt = known[:2] - self.driven[:2, 2] * known[2] / self.driven[2, 2]
        found = np.linalg.lstsq(self.reaction * self.axes[:2], tilt, rcond=1e-6)[0]
        return self.clipped(found, speed)

    def clipped(self, torque: np.ndarray, speed: np.ndarray) -> np.ndarray:
        """Within current limit, voltage line and top speed at the end of the control step."""
        give = self.gain + self.slope
        most = np.minimum((self.line - speed) / give, (self.top - speed) / self.gain)
        least = np.maximum((-self.line - speed) / give, (-self.top - speed) / self.gain)
        return np.clip(np.clip(torque, least, most), -self.limit, self.limit)


class Compiled:
    """The exported controller of one maneuver, by its own Python binding."""

    def __init__(self, folder: Path, maneuver: int) -> None:
        (path,) = folder.glob("*_ocs_controller.py")
        specification = importlib.util.spec_from_file_location(path.stem, path)
        module = importlib.util.module_from_spec(specification)
        specification.loader.exec_module(module)
        self.controller, self.maneuver = module.Controller(), maneuver

    def torque(
        self, rotation: np.ndarray, rate: np.ndarray, speed: np.ndarray, start: Start, time: float
    ) -> list[float]:
        """Of the motors [N m]."""
        del start  # it has the plans
        attitude = np.empty(4)
        mujoco.mju_mat2Quat(attitude, rotation.ravel())
        return self.controller.step(self.maneuver, time, attitude, rate, speed)


def overlap(time: float, period: float, onset: float, duration: float) -> float:
    """Part of the control step in which the push acts."""
    return max(min(time + period, onset + duration) - max(time, onset), 0.0) / period


if __name__ == "__main__":
    main()
