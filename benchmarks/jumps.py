"""Jumps of six robots from the ground, measured by a plain loop over MuJoCo's own steps.

    python benchmarks/jumps.py [PART_OF_A_NAME ...]

Prints a Markdown table of what each bare robot does in the two jumps of the paper, scaled to it:
height asked and reached, the largest joint torque over its limit, how far a foot slides while it
pushes, what is missing in the balance of energy, and how long the plan took; or which limit forbids
the jump. Nothing of the batch engine is used but the model and the references of the legs.
"""

import sys
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import mujoco
import numpy as np
from paired import ROBOTS

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))

from energy import step_with_work
from wheels import paper_device

from ocs_design.common.arrays import FloatArray
from ocs_design.jumping.jump import JumpPlan, jump_of
from ocs_design.jumping.legged_body import LeggedBody
from ocs_design.jumping.planning import JumpPlanner
from ocs_design.requirement.froude import default_maneuvers
from ocs_design.requirement.maneuver import Maneuver
from ocs_design.robot.reader import read_robot
from ocs_design.robot.robot import Robot
from ocs_design.simulation.scene import Wheels
from ocs_design.simulation.schedule import LegReferences
from ocs_design.simulation.world import World
from ocs_design.simulation.world_builder import WorldBuilder

JUMPING = (
    "solo_description/robots/solo12",
    "a1_description/urdf/a1",
    "go1_description/urdf/go1",
    "anymal_c_simple_description/urdf/anymal",
    "hyq_description/robots/hyq_no_sensors",
    "bolt_description/robots/bolt",
)


LOADED = 0.01
"""Share of the weight that one contact bears where a foot counts as loaded."""

AFTER = 0.05
"""Feet that touch the floor so soon after the planned lift-off have not left it yet [s]."""


@dataclass(frozen=True)
class Measured:
    """Of one jump.

    Attributes:
        velocity: of the centre of mass when the last foot leaves the ground, forward and up [m/s].
        rise: of the centre of mass from then on [m].
        torque_share: largest joint torque over its limit; 0 without limits.
        slip: farthest that the ground's side of a foot slid while it was loaded [m].
        energy_missing: in flight, over the energy turned over in the whole run.
    """

    velocity: tuple[float, float]
    rise: float
    torque_share: float
    slip: float
    energy_missing: float


class Jumper:
    """One world, stepped from its start until it comes down."""

    def __init__(self, world: World) -> None:
        self.world, self.model = world, world.model
        self.model.opt.enableflags |= int(mujoco.mjtEnableBit.mjENBL_ENERGY)
        self.data, self._middle = mujoco.MjData(self.model), mujoco.MjData(self.model)
        self.data.qpos[:], self.data.qvel[:] = world.qpos, world.qvel
        self._legs = LegReferences([world], 1)
        self._control = np.zeros((1, 1, self.model.nu))
        self.slid: dict[int, FloatArray] = {}

    def steps(self) -> Iterator[FloatArray]:
        """Before each step, the derived quantities computed: work done until then [J], shape (2,).

        That on the robot by all but gravity, and that of its drives, all counted as positive.
        """
        work = np.zeros(2)
        # Before touchdown no weight is added to the plan.
        bears = np.zeros(1, dtype=bool)
        for k in range(int(self.world.duration / self.model.opt.timestep)):
            self._legs.write(k, self._control, bears)
            self.data.ctrl[:] = self._control[0, 0]
            mujoco.mj_forward(self.model, self.data)
            yield work
            work = work + step_with_work(self.model, self.data, self._middle)

    def slide(self) -> None:
        """Add what the ground's side of each foot slides in this step, while the foot is loaded."""
        model, data, wrench = self.model, self.data, np.zeros(6)
        weight = mujoco.mj_getTotalmass(model) * abs(model.opt.gravity[2])
        moved: dict[int, list[FloatArray]] = {}
        for index, contact in enumerate(data.contact):
            mujoco.mj_contactForce(model, data, index, wrench)
            if wrench[0] < LOADED * weight:
                continue
            body, jacobian = model.geom_bodyid[max(contact.geom)], np.zeros((3, model.nv))
            mujoco.mj_jac(model, data, jacobian, None, contact.pos, body)
            moved.setdefault(body, []).append((jacobian @ data.qvel)[:2])
        for body, velocities in moved.items():
            before = self.slid.get(body, np.zeros(2))
            self.slid[body] = before + np.mean(velocities, axis=0) * model.opt.timestep


def measure(jumper: Jumper) -> Measured:
    """Run it through push-off and flight, until something touches the floor again."""
    data, model, planned = jumper.data, jumper.model, jumper.world.legs.lift_off
    limits = model.actuator_forcerange[:, 1]
    limited = limits > 0.0
    share, flight = 0.0, []
    for work in jumper.steps():
        torque = np.abs(data.actuator_force[limited]) / limits[limited]
        share = max(share, np.max(torque, initial=0.0))
        if data.ncon and data.time < planned + AFTER:
            flight.clear()
            jumper.slide()
        elif data.ncon:
            break
        mujoco.mj_subtreeVel(model, data)
        center, velocity = data.subtree_com[0], data.subtree_linvel[0]
        flight.append((*velocity[[0, 2]], center[2], data.energy.sum() - work[0]))
    forward, up, height, unexplained = np.array(flight).T
    return Measured(
        (forward[0], up[0]),
        height.max() - height[0],
        share,
        max(map(np.linalg.norm, jumper.slid.values())),
        np.ptp(unexplained) / work[1],
    )


def planned(planner: JumpPlanner, body: LeggedBody, maneuver: Maneuver) -> tuple[JumpPlan, float]:
    """The bare robot's plan, and the processor time that it took [s]."""
    jump = jump_of(maneuver)
    assert jump is not None
    before = time.process_time()
    plan = planner.plan(jump, body.trunk).plan
    return plan, time.process_time() - before


def rows_of(robot: Robot, name: str) -> Iterator[str]:
    """One line of the table for each jump."""
    body, builder = LeggedBody.of(robot), WorldBuilder(robot, paper_device())
    planner = JumpPlanner(body)
    for maneuver in default_maneuvers(robot):
        jump = jump_of(maneuver)
        if jump is None:
            continue
        plan, seconds = planned(planner, body, maneuver)
        height = jump.upward**2 / (2.0 * jump.gravity)
        start = f"| {name} | {maneuver.name} | {height:.3f} |"
        if plan.legs is None:
            yield f"{start} {plan.note} | | | | | {seconds:.1f} |"
            continue
        measured = measure(Jumper(builder.flight(maneuver, Wheels.ABSENT, None, plan)))
        yield (
            f"{start} {measured.rise:.3f} "
            f"| {measured.velocity[0]:.2f}, {measured.velocity[1]:.2f} of "
            f"{jump.forward:.2f}, {jump.upward:.2f} | {measured.torque_share:.2f} "
            f"| {1e3 * measured.slip:.1f} | {measured.energy_missing:.1e} | {seconds:.1f} |"
        )


def main() -> None:
    """The table."""
    print(
        "| robot | jump | asked [m] | reached [m] | lift-off [m/s] | torque/limit | slip [mm] "
        "| energy missing | plan [s] |\n|---|---|---|---|---|---|---|---|---|"
    )
    for place in JUMPING:
        if len(sys.argv) == 1 or any(part in place for part in sys.argv[1:]):
            for row in rows_of(read_robot(ROBOTS / f"{place}.urdf"), place.rpartition("/")[2]):
                print(row, flush=True)


if __name__ == "__main__":
    main()
