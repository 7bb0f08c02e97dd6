"""The exported C controller on a spacecraft with reaction wheels in Basilisk.

    pip install bsk
    ocs-design size examples/solo12.urdf --ballistic
    ocs-design export solo12-ocs --formats controller -o fly && make -C fly/controller
    python examples/controller_in_basilisk.py solo12-ocs fly/controller

Robot and device are one rigid body with its wheels, in Basilisk's own equations of motion; only
`design.json` and the C code are read. In MuJoCo the legs are held by drives and give a little.
"""

import importlib.util
import json
import sys
from pathlib import Path

import numpy as np
from Basilisk.architecture import messaging, sysModel
from Basilisk.simulation import extForceTorque, reactionWheelStateEffector, spacecraft
from Basilisk.utilities import RigidBodyKinematics, SimulationBaseClass, macros, simIncludeRW

STEP = 1e-3  # of the physics, Runge-Kutta of fourth order [s]


def main() -> None:
    """Fly and compare."""
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    folder, exported = map(Path, sys.argv[1:])
    design = json.loads((folder / "design.json").read_text())
    if design["ocs"]["motor"]["armature"]:
        sys.exit("Basilisk's wheels have no armature, which this geared motor adds")
    (path,) = exported.glob("*_ocs_controller.py")
    specification = importlib.util.spec_from_file_location(path.stem, path)
    module = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(module)
    for index, maneuver in enumerate(design["requirement"]["maneuvers"]):
        runs = (r for r in design["validation"] if r["scenario"] == maneuver["name"] and r["ocs"])
        there = next(runs)["metrics"]
        up, turned = fly(design, maneuver, module, index, there["touchdown_time"])
        here = {
            "touchdown_roll": np.arcsin(up[1]),
            "touchdown_pitch": np.arctan2(-up[0], up[2]),
            "turned_angle": turned,
        }
        for name, angle in here.items():
            if there[name] is not None:
                print(
                    f"{maneuver['name']:12s} {name:15s} {np.degrees(angle):9.4f} deg, recorded "
                    f"{np.degrees(there[name]):9.4f} deg"
                )


class Law(sysModel.SysModel):
    """The C controller between Basilisk's messages."""

    def __init__(self, module: object, maneuver: int) -> None:
        super().__init__()
        self.controller, self.maneuver = module.Controller(), maneuver
        self.wheels, self.attitude, self.speeds = module.WHEELS, None, None
        self.torques = messaging.ArrayMotorTorqueMsg()

    def UpdateState(self, now: int) -> None:
        """Basilisk's name for a step; `now` is in nanoseconds."""
        body, speeds = self.attitude(), self.speeds().wheelSpeeds[: self.wheels]
        attitude = RigidBodyKinematics.MRP2EP(body.sigma_BN)
        torque = self.controller.step(self.maneuver, 1e-9 * now, attitude, body.omega_BN_B, speeds)
        self.torques.write(messaging.ArrayMotorTorqueMsgPayload(motorTorque=torque), now)


def fly(
    design: dict, maneuver: dict, module: object, index: int, end: float
) -> tuple[np.ndarray, float]:
    """The world's upward direction in B at the last control instant; angle turned about y [rad]."""
    ocs, specified, period = design["ocs"], maneuver["parameters"], module.PERIOD
    sim = SimulationBaseClass.SimBaseClass()
    process = sim.CreateNewProcess("process")
    process.addTask(sim.CreateNewTask("control", macros.sec2nano(period)), 2)
    process.addTask(sim.CreateNewTask("physics", macros.sec2nano(STEP)), 1)
    body = spacecraft.Spacecraft()
    body.hub.mHub, body.hub.IHubPntBc_B = ocs["total_mass"], ocs["total_inertia"]
    pitch = specified["pitch"] if maneuver["kind"] == "drop" else 0.0
    body.hub.sigma_BNInit = [[0.0], [np.tan(pitch / 4.0)], [0.0]]
    wheels, factory = (
        reactionWheelStateEffector.ReactionWheelStateEffector(),
        simIncludeRW.rwFactory(),
    )
    for wheel in ocs["modules"]:
        axis, spin_inertia = list(wheel["axis"]), ocs["spin_inertia"]
        factory.create("custom", axis, Js=spin_inertia, useMaxTorque=False, Omega_max=1e6)
    factory.addToSpacecraft("wheels", wheels, body)
    push, law = extForceTorque.ExtForceTorque(), Law(module, index)
    body.addDynamicEffector(push)
    law.attitude = body.scStateOutMsg.addSubscriber()
    law.speeds = wheels.rwSpeedOutMsg.addSubscriber()
    wheels.rwMotorCmdInMsg.subscribeTo(law.torques)
    sim.AddModelToTask("control", law)
    for model in (body, wheels, push):
        sim.AddModelToTask("physics", model)
    sim.InitializeSimulation()

    begin = specified.get("onset", 0.0)
    until, turned = begin + specified.get("duration", 0.0), 0.0
    for k in range(1, int(end / STEP) // round(period / STEP) * round(period / STEP) + 1):
        if maneuver["kind"] == "disturbance":
            acts = begin <= (k - 0.5) * STEP < until
            push.extTorquePntB_B = [[acts * component] for component in specified["torque"]]
        sim.ConfigureStopTime(macros.sec2nano(k * STEP))
        sim.ExecuteSimulation()
        turned += STEP * law.attitude().omega_BN_B[1]
    return RigidBodyKinematics.MRP2C(law.attitude().sigma_BN)[:, 2], turned


if __name__ == "__main__":
    main()
