"""The batch engine: one world or thousands, the wheel law closed over all of them at once.

With more than one thread the worlds are dealt to two batches that run beside each other. One
computes its law while the other has the processors for its physics, and neither waits at every
control step for threads to wake up, which took as long as the physics of a few worlds.
"""

import os
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from threading import Event

import mujoco
import numpy as np

from ocs_design.simulation.batch import Batch
from ocs_design.simulation.recording import Recording, joined
from ocs_design.simulation.world import World

Progress = Callable[[float], None]


def simulate(
    worlds: Sequence[World],
    *,
    hold: int = 5,
    threads: int | None = None,
    pose_rate: float | None = None,
    progress: Progress | None = None,
) -> Recording:
    """Run all worlds to their ends.

    Args:
        worlds: with models of equal sizes.
        hold: physics steps per control step, through which torques stay as they are.
        threads: of the physics; None: one per processor. The numbers do not depend on it.
        pose_rate: of the recorded poses [1/s]; None: none are, which thousands of worlds have no
            memory for.
        progress: told the part of the work that is done, 0..1.
    """
    available = min(threads or len(os.sched_getaffinity(0)), len(worlds))
    count = min(available, 2)
    # Longest first, and of a pair of equals one to each batch.
    order = np.argsort([-world.duration for world in worlds], kind="stable")
    shares = [order[first::count] for first in range(count)]
    batches = [Batch([worlds[index] for index in share], hold, pose_rate) for share in shares]
    with _no_warnings():
        recordings = _run_beside(batches, available // count, progress or _ignore)
    return joined(recordings, shares)


def _run_beside(batches: Sequence[Batch], threads: int, progress: Progress) -> list[Recording]:
    """Run the first batch here and the others each in a thread of its own.

    Args:
        batches: to run.
        threads: of the physics of each.
        progress: told how far the first one is; the others are much like it.
    """
    stop = Event()
    with ThreadPoolExecutor(max(len(batches) - 1, 1)) as others:
        try:
            running = [others.submit(batch.run, threads, stop, _ignore) for batch in batches[1:]]
            first = batches[0].run(threads, stop, progress)
            recordings = [first, *(future.result() for future in running)]
        finally:
            # Whatever ends the first batch early, an interrupt above all, must end the others too.
            stop.set()
    progress(1.0)
    return recordings


def _ignore(_done: float) -> None:
    """Where nobody wants to know."""


@contextmanager
def _no_warnings() -> Iterator[None]:
    """Keeps MuJoCo from writing MUJOCO_LOG.TXT where the user stands; `Recording.stable` tells."""
    before = mujoco.get_mju_user_warning()
    mujoco.set_mju_user_warning(lambda _message: None)
    try:
        yield
    finally:
        mujoco.set_mju_user_warning(before)
