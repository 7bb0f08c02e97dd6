"""The batch engine: runs one world or thousands, and extracts poses for replay.

With more than one thread the worlds are dealt to two batches that run in parallel. One computes its
law while the other uses the processors for its physics, and neither waits at every control step for
threads to wake up, which took as long as the physics of a few worlds.
"""

from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from threading import Event

import mujoco
import numpy as np
from numpy.typing import NDArray

from ocs_design.common.files import processors
from ocs_design.export.physics import STEP
from ocs_design.simulation.batch import Batch, Recording, joined
from ocs_design.simulation.engine import Engine
from ocs_design.simulation.run import Poses
from ocs_design.simulation.world import ANCHOR, World

Progress = Callable[[float], None]


def simulate(
    worlds: Sequence[World],
    *,
    hold: int = 5,
    threads: int | None = None,
    pose_rate: float | None = None,
    progress: Progress | None = None,
    engine: Engine | None = None,
) -> Recording:
    """Run all worlds to their ends.

    Worlds with equal time steps run together, one group after another; worlds on a pivot form
    groups of their own.

    Args:
        worlds: with models of equal sizes, except for the anchor of a pivot.
        hold: steps of `STEP` per control step, over which torques are held.
        threads: of the physics; None: one per processor. The results do not depend on it.
        pose_rate: of the recorded poses [1/s]; None: no poses, for which thousands of worlds would
            have no memory.
        progress: called with the share of the work that is done, 0..1.
        engine: takes all worlds as one batch; None: MuJoCo on the CPU.
    """
    recordings: list[Recording] = []
    places: list[NDArray[np.intp]] = []
    steps = np.array([world.model.opt.timestep for world in worlds])
    bodies = np.array([world.model.nbody for world in worlds])
    work = np.array([world.duration for world in worlds]) / steps
    done = 0.0
    for step, count in sorted(set(zip(steps.tolist(), bodies.tolist(), strict=True))):
        group = np.flatnonzero((steps == step) & (bodies == count))
        part = float(work[group].sum() / work.sum())
        # Longest first, and equal ones alternate between the batches.
        order = group[
            np.argsort([-worlds[index].duration for index in group.tolist()], kind="stable")
        ]
        available = min(threads or processors(), len(group)) if engine is None else 1
        parts = min(available, 2)
        shares = [order[first::parts] for first in range(parts)]
        batches = [
            Batch([worlds[index] for index in share], round(hold * STEP / step), pose_rate, engine)
            for share in shares
        ]
        within = partial_progress(progress, done, done + part)
        # MuJoCo would write MUJOCO_LOG.TXT into the working directory; `Recording.stable` has it.
        previous_handler = mujoco.get_mju_user_warning()
        mujoco.set_mju_user_warning(lambda _message: None)
        try:
            recordings += _run_in_parallel(batches, available // parts, within)
        finally:
            mujoco.set_mju_user_warning(previous_handler)
        places += shares
        done += part
    partial_progress(progress, 0.0, 1.0)(1.0)
    return joined(recordings, places)


def partial_progress(progress: Progress | None, begin: float, end: float) -> Progress:
    """Progress of a part of the work that runs from share `begin` to share `end` of the whole."""
    if progress is None:
        return _ignore
    return lambda share: progress(begin + (end - begin) * share)


def _run_in_parallel(batches: Sequence[Batch], threads: int, progress: Progress) -> list[Recording]:
    """Run the first batch here and report its progress; run each other one in a thread."""
    stop = Event()
    with ThreadPoolExecutor(max(len(batches) - 1, 1)) as others:
        try:
            running = [others.submit(batch.run, threads, stop, _ignore) for batch in batches[1:]]
            first = batches[0].run(threads, stop, progress)
            recordings = [first, *(future.result() for future in running)]
        finally:
            # Whatever ends the first batch early, such as an interrupt, must end the others too.
            stop.set()
    return recordings


def _ignore(_done: float) -> None:
    """Ignore progress."""


POSE_RATE = 60.0
"""Poses per second of a replay on a screen [1/s]."""


def poses_of(recording: Recording, index: int, world: World) -> Poses | None:
    """Poses of one world of a recording; None if there are none."""
    if not recording.pose_stride:
        return None
    time = recording.time[: recording.lengths[index] : recording.pose_stride]
    qpos, model = recording.qpos[: len(time), index], world.model
    data = mujoco.MjData(model)
    shown = [body for body in range(1, model.nbody) if model.body(body).name != ANCHOR]
    position = np.empty((len(qpos), len(shown), 3))
    attitude = np.empty((len(qpos), len(shown), 4))
    for k, pose in enumerate(qpos):
        data.qpos[:] = pose
        mujoco.mj_kinematics(model, data)
        position[k], attitude[k] = data.xpos[shown], data.xquat[shown]
    wheels = model.jnt_qposadr[model.dof_jntid[list(world.addresses.wheels)]]
    return Poses(
        time=time,
        qpos=qpos,
        bodies=tuple(model.body(body).name for body in shown),
        position=position,
        attitude=attitude,
        wheel_angle=qpos[:, wheels],
    )
