"""Closed-loop batch against open-loop `rollout`, and the paper's runs against bare `mj_step`.

Ratios of one process on one machine, as absolute rates mean little elsewhere:

    python benchmarks/batch.py ROBOT.urdf
"""

import argparse
import time
from dataclasses import replace

import mujoco
import numpy as np
from mujoco.rollout import Rollout

from ocs_design.actuation.drive import Drive
from ocs_design.device.device import Device, Flywheel, Module
from ocs_design.device.layout import module_axes
from ocs_design.requirement.froude import default_maneuvers
from ocs_design.robot.reader import read_robot
from ocs_design.simulation.scene import Wheels
from ocs_design.simulation.simulate import simulate
from ocs_design.simulation.world import start_states
from ocs_design.simulation.world_builder import WorldBuilder

SECONDS = 0.2
WORLDS = 256
ROUNDS = 5


def paper_device() -> Device:
    """The wheels of the paper's table 2 at 40 deg without motor limits."""
    wheel = Flywheel(
        0.022, 0.03, 0.01, "steel", 7860.0, 0.10273, 7.108e-5, 3.64e-5, None, None, 0.0
    )
    axes = module_axes(np.radians(40.0))
    left = Module("left", axes[:, 0], np.array([0.0, 0.04, 0.05]))
    right = Module("right", axes[:, 1], np.array([0.0, -0.04, 0.05]))
    motor = Drive(
        name="unlimited",
        mass=0.0,
        stall_torque=None,
        no_load_speed=np.inf,
        torque_limit=None,
        rotor_inertia=0.0,
        source="benchmark",
    )
    return Device(np.radians(40.0), (left, right), wheel, motor)


def open_loop_rate(worlds, threads):
    """Physics steps per second of one `rollout` of all worlds."""
    steps = round(SECONDS / worlds[0].model.opt.timestep)
    control = np.repeat(np.stack([w.ctrl for w in worlds])[:, None], steps, axis=1)
    models, data = (
        [w.model for w in worlds],
        [mujoco.MjData(worlds[0].model) for _ in range(threads)],
    )
    with Rollout(nthread=threads if threads > 1 else 0) as pool:
        start = time.perf_counter()
        pool.rollout(models, data, start_states(worlds), control)
        return len(worlds) * steps / (time.perf_counter() - start)


def closed_loop_rate(worlds, threads, hold):
    """Physics steps per second of the engine."""
    start = time.perf_counter()
    recording = simulate(worlds, hold=hold, threads=threads)
    return int(recording.lengths.sum()) * hold / (time.perf_counter() - start)


def closed_loop_time(worlds, threads):
    """Seconds that the engine takes for all worlds to their ends."""
    start = time.perf_counter()
    simulate(worlds, threads=threads)
    return time.perf_counter() - start


def bare_step_time(worlds):
    """Seconds for the same steps of the same worlds by `mj_step(m, d, nstep)` on one thread."""
    start = time.perf_counter()
    for world in worlds:
        data = mujoco.MjData(world.model)
        data.qpos[:], data.qvel[:], data.ctrl[:] = world.qpos, world.qvel, world.ctrl
        steps = int(np.ceil(world.duration / world.model.opt.timestep))
        mujoco.mj_step(world.model, data, steps)
    return time.perf_counter() - start


def interleaved(cases):
    """Each case once a round, so that other load on the machine meets all alike."""
    rounds = [{name: case() for name, case in cases.items()} for _ in range(ROUNDS)]
    return {name: np.array([measured[name] for measured in rounds]) for name in cases}


def spread(ratios):
    """Median and range of the rounds."""
    return f"{np.median(ratios):.2f} ({ratios.min():.2f} to {ratios.max():.2f})"


def main():
    """Prints the ratios: closed loop against open loop, and `size` against its bare physics."""
    parser = argparse.ArgumentParser()
    parser.add_argument("robot")
    parser.add_argument("--threads", type=int, default=2)
    arguments = parser.parse_args()
    robot, threads = read_robot(arguments.robot), arguments.threads
    builder, maneuvers = WorldBuilder(robot, paper_device()), default_maneuvers(robot)
    batch = [replace(builder.flight(maneuvers[2], Wheels.ACTIVE), duration=SECONDS)] * WORLDS
    rates = interleaved(
        {
            "open loop": lambda: open_loop_rate(batch, threads),
            "held 1 step": lambda: closed_loop_rate(batch, threads, 1),
            "held 5 steps": lambda: closed_loop_rate(batch, threads, 5),
        }
    )
    print(f"{WORLDS} worlds, {threads} threads, {ROUNDS} interleaved rounds")
    for name, rate in rates.items():
        print(f"{name:14s}{rate.max():9.0f} steps/s, ratio {spread(rate / rates['open loop'])}")
    six = [
        builder.flight(maneuver, wheels)
        for maneuver in maneuvers
        for wheels in (Wheels.ACTIVE, Wheels.ABSENT)
    ]
    times = interleaved(
        {"bare": lambda: bare_step_time(six), "ours": lambda: closed_loop_time(six, threads)}
    )
    ratio = spread(times["ours"] / times["bare"])
    print(f"six runs {times['ours'].min():.2f} s, {ratio} of bare mj_step on one thread")


if __name__ == "__main__":
    main()
