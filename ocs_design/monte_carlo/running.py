"""Runs blocks of samples in sequence, several at once, or on a cluster, until enough is known.

A block is a pure function of its campaign and its indices: where and how often it is flown makes no
difference. If a worker is lost, other workers take over its unfinished blocks.
"""

import pickle
from collections.abc import Callable, Generator, Sequence
from contextlib import closing
from importlib import import_module
from typing import TypeAlias

import numpy as np

from ocs_design.common.errors import MissingToolError, OcsError, extra_command
from ocs_design.monte_carlo.campaign import Campaign, fly_samples
from ocs_design.monte_carlo.outcomes import Block, Outcomes, Storage, shares
from ocs_design.simulation.simulate import Progress, partial_progress

Arrivals = Generator[tuple[Block, Outcomes], None, None]

StoppingRule: TypeAlias = Callable[[Outcomes], bool]
"""Stopping rule of a campaign: whether the outcomes so far suffice."""


def narrow(width: float) -> StoppingRule:
    """Stop as soon as the confidence interval of each scenario is no wider than `width`."""
    return lambda outcomes: all(share.width <= width for share in shares(outcomes))


Fly: TypeAlias = Callable[[Campaign, Sequence[Block], Progress], Arrivals]
"""Function that flies blocks and yields each with its outcomes, in any order.

It reports progress as the share of all blocks that is done, 0..1.
"""

BLOCKS_AT_ONCE = 4
"""Number of blocks that are flown together if all of them are needed."""

BLOCKS_AT_ONCE_ON_GPU = 64
"""The same number if a GPU steps all worlds together; `MEMORY` also limits it."""


def fly_here(
    campaign: Campaign,
    blocks: Sequence[Block],
    progress: Progress,
    *,
    threads: int | None = None,
    at_once: int = 1,
) -> Arrivals:
    """Fly one block after the other, or a few at once, on this machine (`Fly`).

    Computation between the physics steps takes about as long for few samples as for many: if all
    are needed, more blocks `at_once` are faster. `threads` are those of the physics; None: one per
    processor.
    """
    for start in range(0, len(blocks), at_once):
        group = blocks[start : start + at_once]
        report = partial_progress(progress, start / len(blocks), (start + len(group)) / len(blocks))
        indices = [index for block in group for index in block]
        flown = fly_samples(campaign, indices, threads=threads, progress=report)
        for block in group:
            yield block, flown.take(np.isin(flown.index, block))


def run_campaign(
    campaign: Campaign,
    blocks: Sequence[Block],
    *,
    fly: Fly = fly_here,
    storage: Storage | None = None,
    stop_when: StoppingRule | None = None,
    progress: Progress | None = None,
) -> Outcomes:
    """Fly blocks until all are flown, or enough is known.

    The rule is applied after each block in the order of the samples, so that the counted samples do
    not depend on which block was fastest.

    Args:
        storage: keeps blocks as they arrive, and has those flown already; None: nothing is kept.
        stop_when: stopping rule; None: all blocks are flown.
        progress: called with the share of the work that is done, 0..1.
    """
    flown = {} if storage is None else dict(storage.load_blocks(blocks))
    missing = [block for block in blocks if block not in flown]
    report = partial_progress(progress, len(flown) / len(blocks), 1.0)
    counted: list[Outcomes] = []
    with closing(fly(campaign, missing, report)) as arrivals:
        for next_block in blocks:
            while next_block not in flown:
                block, flown[block] = next(arrivals)
                if storage is not None:
                    storage.save_block(block, flown[block])
            counted.append(flown[next_block])
            if stop_when is not None and stop_when(so_far := Outcomes.joined(counted)):
                return so_far
    return Outcomes.joined(counted)


PATIENCE = 10.0
"""Time that a scheduler has to answer [s]."""

RETRIES = 10
"""Number of times that a block is flown again after its worker was lost."""


class Cluster:
    """The workers of a Dask scheduler; each of their threads flies one block."""

    def __init__(self, address: str) -> None:
        """Connect to the scheduler at `address`, as in `tcp://host:8786`.

        Raises:
            MissingToolError: Dask is not installed.
            OcsError: no scheduler answers there.
        """
        try:
            self._dask = import_module("distributed")
        except ImportError as error:
            raise MissingToolError(
                "--scheduler needs Dask, which is not installed",
                hint=extra_command("cluster"),
            ) from error
        try:
            self._client = self._dask.Client(address, timeout=PATIENCE)
        except (OSError, ValueError) as error:
            raise OcsError(
                f"--scheduler {address}: no Dask scheduler answers there",
                hint="start one with `dask scheduler`, workers with `dask worker ADDRESS`",
            ) from error

    def fly(self, campaign: Campaign, blocks: Sequence[Block], progress: Progress) -> Arrivals:
        """Fly these blocks (`Fly`)."""
        # The scheduler keeps the bytes, and sends them again if a worker is lost.
        shared = self._client.submit(_Unpacked, pickle.dumps(campaign), pure=False)
        futures = [
            self._client.submit(_Unpacked.fly, shared, block, retries=RETRIES, pure=False)
            for block in blocks
        ]
        try:
            arrived = self._dask.as_completed(futures, with_results=True)
            for done, (future, flown) in enumerate(arrived, 1):
                future.release()
                progress(done / len(blocks))
                yield flown
        finally:
            self._client.cancel([shared, *futures], force=True)

    def close(self) -> None:
        """Disconnect; the cluster keeps running."""
        self._client.close()


class _Unpacked:
    """A campaign on a worker, unpacked there only once."""

    def __init__(self, content: bytes) -> None:
        self.campaign: Campaign = pickle.loads(content)

    def fly(self, block: Block) -> tuple[Block, Outcomes]:
        """Fly a block in one thread: other threads fly other blocks."""
        return block, fly_samples(self.campaign, block, threads=1)
