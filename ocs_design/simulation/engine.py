"""The batch engine: one world or thousands, the wheel law closed over all of them at once.

With more than one thread the worlds are dealt to two batches that run beside each other. One
computes its law while the other has the processors for its physics, and neither waits at every
control step for threads to wake up, which took as long as the physics of a few worlds.
"""

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from functools import partial
from threading import Event
from typing import NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray

from ocs_design.processors import processors
from ocs_design.simulation.batch import Batch
from ocs_design.simulation.recording import Recording, joined
from ocs_design.simulation.scene import STEP
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

    Worlds of one time step run together, those of another after them.

    Args:
        worlds: with models of equal sizes.
        hold: steps of `STEP` per control step, through which torques stay as they are.
        threads: of the physics; None: one per processor. The numbers do not depend on it.
        pose_rate: of the recorded poses [1/s]; None: none are, which thousands of worlds have no
            memory for.
        progress: told the part of the work that is done, 0..1.
    """
    told, groups = progress or _ignore, _of_one_step(worlds)
    recordings: list[Recording] = []
    shares: list[NDArray[np.intp]] = []
    done = 0.0
    for group, work in groups:
        step = worlds[group[0]].model.opt.timestep
        dealt = _dealt(worlds, group, threads or processors())
        batches = [
            Batch([worlds[index] for index in share], round(hold * STEP / step), pose_rate)
            for share in dealt.shares
        ]
        with _no_warnings():
            recordings += _run_beside(batches, dealt.threads, partial(_tell, told, done, work))
        shares += dealt.shares
        done += work
    told(1.0)
    return joined(recordings, shares)


class _Dealt(NamedTuple):
    """Worlds of each batch by their places, and the threads of its physics."""

    shares: list[NDArray[np.intp]]
    threads: int


def _dealt(worlds: Sequence[World], group: NDArray[np.intp], threads: int) -> _Dealt:
    """Longest first, and of a pair of equals one to each batch."""
    available = min(threads, len(group))
    count = min(available, 2)
    order = group[np.argsort([-worlds[index].duration for index in group], kind="stable")]
    return _Dealt([order[first::count] for first in range(count)], available // count)


def _of_one_step(worlds: Sequence[World]) -> list[tuple[NDArray[np.intp], float]]:
    """Places of the worlds of each time step, and their part of all the work."""
    steps = np.array([world.model.opt.timestep for world in worlds])
    work = np.array([world.duration for world in worlds]) / steps
    groups = [np.flatnonzero(steps == step) for step in np.unique(steps)]
    return [(group, float(work[group].sum() / work.sum())) for group in groups]


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
    return recordings


def _tell(progress: Progress, done: float, work: float, part: float) -> None:
    progress(done + work * part)


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
