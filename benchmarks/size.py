"""`ocs-design size` on Solo12, a cold process that writes everything, against `bare.py`.

    python benchmarks/size.py [PAIRS]

Both take the same number of Runge-Kutta steps of the same six models, robot and device on a floor:
three maneuvers, each with the device and without. `bare.py` leaves the wheels alone and writes
nothing. Goals: at most 1.5 times the bare script with a motor chosen from the catalogue and 1.2
times without a motor, and a peak memory below 1 GiB.
"""

import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

import mujoco
import numpy as np
from paired import PROGRAM, SOLO12, alternate, print_pairs, run_process

from ocs_design.requirement.device_sections import MotorSection
from ocs_design.requirement.froude import default_maneuvers
from ocs_design.requirement.sections import RobotSection
from ocs_design.requirement.specification import Specification
from ocs_design.simulation.scene import Wheels
from ocs_design.simulation.world import World
from ocs_design.simulation.world_builder import WorldBuilder
from ocs_design.workflows.size import design_ocs

LIMITS = {"auto": 1.5, "none": 1.2}
"""By what is said of the motor."""

BARE = str(Path(__file__).with_name("bare.py"))


def main() -> None:
    pairs = int(sys.argv[1]) if len(sys.argv) > 1 else 7
    for motor, limit in LIMITS.items():
        with tempfile.TemporaryDirectory() as folder:
            compare(motor, limit, Path(folder), pairs)


def compare(motor: str, limit: float, folder: Path, pairs: int) -> None:
    """One table of pairs."""
    out, models = folder / "solo12-ocs", folder / "models"
    worlds = worlds_of_size(motor, out)
    write_models(worlds, models)
    # The folder is replaced each time.
    size = [PROGRAM, "size", str(SOLO12), "--motor", motor, "-o", str(out), "--force"]
    bare = [sys.executable, BARE, str(models)]
    print(f"--motor {motor}: {len(worlds)} runs, {sum(map(steps_of, worlds))} steps")
    measured = alternate(lambda: run_process(size), lambda: run_process(bare), pairs)
    print_pairs(measured, ("ocs-design size", "bare script"), limit)


def worlds_of_size(motor: str, out: Path) -> list[World]:
    """What `size` simulates for the device that it finds."""
    specification = Specification(
        robot=RobotSection(file=str(SOLO12)), motor=MotorSection(name=motor)
    )
    outcome = design_ocs(specification, out=out)
    builder = WorldBuilder(outcome.robot, outcome.device)
    return [
        builder.flight(maneuver, wheels)
        for maneuver in default_maneuvers(outcome.robot)
        for wheels in (Wheels.ACTIVE, Wheels.ABSENT)
    ]


def write_models(worlds: Sequence[World], folder: Path) -> None:
    """Each world's model, and where it starts."""
    folder.mkdir()
    for index, world in enumerate(worlds):
        path = folder / f"{index}.mjb"
        mujoco.mj_saveModel(world.model, str(path))
        np.savez(
            path.with_suffix(".npz"),
            qpos=world.qpos,
            qvel=world.qvel,
            ctrl=world.ctrl,
            steps=steps_of(world),
        )


def steps_of(world: World) -> int:
    """Steps of one run."""
    return int(np.ceil(world.duration / world.model.opt.timestep))


if __name__ == "__main__":
    main()
