"""Applies the torques of a plan to a spacecraft with reaction wheels in Basilisk: JSON in and out.

Run by the interpreter of an environment with `bsk`, which needs an older Matplotlib than the tests.
The package is not imported.
"""

import json
import sys

import numpy as np
from Basilisk.architecture import messaging
from Basilisk.simulation import reactionWheelStateEffector, spacecraft
from Basilisk.utilities import RigidBodyKinematics, SimulationBaseClass, macros, simIncludeRW


def main():
    """Write wheel speeds [rad/s] and attitudes (w, x, y, z) at the end of every step."""
    problem = json.load(sys.stdin)
    step = macros.sec2nano(problem["step"])
    sim = SimulationBaseClass.SimBaseClass()
    sim.CreateNewProcess("process").addTask(sim.CreateNewTask("physics", step))
    body = spacecraft.Spacecraft()
    body.hub.mHub, body.hub.IHubPntBc_B = 1.0, problem["inertia"]
    body.hub.sigma_BNInit = RigidBodyKinematics.EP2MRP(np.array(problem["attitude"]))[:, None]
    body.hub.omega_BN_BInit = np.array(problem["rate"])[:, None]
    wheels = reactionWheelStateEffector.ReactionWheelStateEffector()
    factory = simIncludeRW.rwFactory()
    for axis, speed in zip(np.transpose(problem["axes"]).tolist(), problem["speed"], strict=True):
        factory.create(
            "custom",
            axis,
            Js=problem["spin_inertia"],
            useMaxTorque=False,
            Omega_max=1e6,
            Omega=speed / macros.RPM,
        )
    factory.addToSpacecraft("wheels", wheels, body)
    command = messaging.ArrayMotorTorqueMsg()
    wheels.rwMotorCmdInMsg.subscribeTo(command)
    # The wheels read their command before the body is propagated.
    for model in (wheels, body):
        sim.AddModelToTask("physics", model)
    attitudes, speeds = [], []
    torques = problem["torques"]
    command.write(messaging.ArrayMotorTorqueMsgPayload(motorTorque=torques[0]))
    sim.InitializeSimulation()
    for k, torque in enumerate(torques):
        command.write(messaging.ArrayMotorTorqueMsgPayload(motorTorque=torque))
        sim.ConfigureStopTime((k + 1) * step)
        sim.ExecuteSimulation()
        attitudes.append(RigidBodyKinematics.MRP2EP(body.scStateOutMsg.read().sigma_BN).tolist())
        speeds.append(list(wheels.rwSpeedOutMsg.read().wheelSpeeds[: len(torque)]))
    json.dump({"attitude": attitudes, "speed": speeds}, sys.stdout)


if __name__ == "__main__":
    main()
