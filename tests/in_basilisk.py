"""Torques of a plan on a spacecraft with reaction wheels in Basilisk: JSON in, JSON out.

Run by the interpreter of an environment that has `bsk`, which asks for an older Matplotlib than the
tests. Nothing of the package is imported.
"""

import json
import sys

import numpy as np
from Basilisk.architecture import messaging
from Basilisk.simulation import reactionWheelStateEffector, spacecraft
from Basilisk.utilities import RigidBodyKinematics, SimulationBaseClass, macros, simIncludeRW


def main():
    """Wheel speeds [rad/s] and attitudes (w, x, y, z) at the end of every step."""
    asked = json.load(sys.stdin)
    step = macros.sec2nano(asked["step"])
    sim = SimulationBaseClass.SimBaseClass()
    sim.CreateNewProcess("process").addTask(sim.CreateNewTask("physics", step))
    body = spacecraft.Spacecraft()
    body.hub.mHub, body.hub.IHubPntBc_B = 1.0, asked["inertia"]
    body.hub.sigma_BNInit = RigidBodyKinematics.EP2MRP(np.array(asked["attitude"]))[:, None]
    body.hub.omega_BN_BInit = np.array(asked["rate"])[:, None]
    wheels = reactionWheelStateEffector.ReactionWheelStateEffector()
    factory = simIncludeRW.rwFactory()
    for axis, speed in zip(np.transpose(asked["axes"]).tolist(), asked["speed"], strict=True):
        factory.create(
            "custom",
            axis,
            Js=asked["spin_inertia"],
            useMaxTorque=False,
            Omega_max=1e6,
            Omega=speed / macros.RPM,
        )
    factory.addToSpacecraft("wheels", wheels, body)
    command = messaging.ArrayMotorTorqueMsg()
    wheels.rwMotorCmdInMsg.subscribeTo(command)
    # The wheels read their command before the body is moved on.
    for model in (wheels, body):
        sim.AddModelToTask("physics", model)
    attitudes, speeds = [], []
    torques = asked["torques"]
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
