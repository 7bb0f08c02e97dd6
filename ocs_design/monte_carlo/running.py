"""Blocks of samples, one after the other, many at once, or on a cluster, until enough is known.

A block is a pure function of its campaign and its indices: where and how often it is flown makes no
difference. A worker that is lost costs the blocks that it was at, which others take over.
"""

import pickle
from abc import ABC, abstractmethod
from collections.abc import Callable, Generator, Mapping, Sequence
from contextlib import closing
from importlib import import_module
from typing import TypeAlias

import numpy as np

from ocs_design.common.errors import MissingToolError, OcsError, extra_command
from ocs_design.monte_carlo.campaign import Campaign, fly_samples
from ocs_design.monte_carlo.outcomes import Block, Outcomes, Storage, shares
from ocs_design.simulation.engine import Progress, scaled

Arrivals = Generator[tuple[Block, Outcomes], None, None]

Enough: TypeAlias = Callable[[Outcomes], bool]
"""Rule that stops a campaign: whether what was flown so far will do."""


def narrow(width: float) -> Enough:
    """Stop as soon as the interval of each scenario is no wider than this."""
    return lambda outcomes: all(share.width <= width for share in shares(outcomes))


class Workers(ABC):
    """Who flies blocks."""

    @abstractmethod
    def fly(self, campaign: Campaign, blocks: Sequence[Block], progress: Progress) -> Arrivals:
        """Each block with its outcomes, in any order.

        Args:
            campaign: what is flown.
            blocks: to fly.
            progress: told how much of all of them is done, 0..1, as often as that is known.
        """


AT_ONCE = 4
"""Blocks that are flown at once where all of them are wanted."""

AT_ONCE_ON_DEVICE = 64
"""The same where a GPU steps all worlds together; the memory of the worlds limits it, too."""


class ThisMachine(Workers):
    """One block after the other, or a few at once, on all processors."""

    def __init__(self, threads: int | None = None, at_once: int = 1) -> None:
        """Take this many threads for the physics; None: one per processor.

        What is computed between the steps of the physics takes about as long for few samples as
        for many: where all are wanted, more blocks `at_once` are faster.
        """
        self._threads, self._at_once = threads, at_once

    def fly(self, campaign: Campaign, blocks: Sequence[Block], progress: Progress) -> Arrivals:
        """Fly these blocks (`Workers.fly`)."""
        for start in range(0, len(blocks), self._at_once):
            some = blocks[start : start + self._at_once]
            tell = scaled(progress, start / len(blocks), (start + len(some)) / len(blocks))
            indices = [index for block in some for index in block]
            flown = fly_samples(campaign, indices, threads=self._threads, progress=tell)
            for block in some:
                yield block, flown.take(np.isin(flown.index, block))


def run_campaign(
    campaign: Campaign,
    blocks: Sequence[Block],
    *,
    workers: Workers,
    storage: Storage | None = None,
    enough: Enough | None = None,
    progress: Progress | None = None,
) -> Outcomes:
    """Fly blocks until all are flown, or enough is known.

    The rule is asked after each block in the order of the samples, so that what is counted does not
    depend on who was faster.

    Args:
        campaign: what is flown.
        blocks: of samples, in order.
        workers: who fly them.
        storage: where blocks are kept as they come, and found if they have been flown already.
        enough: whether the samples flown so far will do; None: all are flown.
        progress: told the part of the work that is done, 0..1.
    """
    flown = {} if storage is None else dict(storage.found(blocks))
    missing = [block for block in blocks if block not in flown]
    tell = scaled(progress, len(flown) / len(blocks), 1.0)
    outcomes = _counted(blocks, flown, enough)
    with closing(workers.fly(campaign, missing, tell)) as arrivals:
        while outcomes is None:
            block, flown[block] = next(arrivals)
            if storage is not None:
                storage.keep(block, flown[block])
            outcomes = _counted(blocks, flown, enough)
    return outcomes


def _counted(
    blocks: Sequence[Block], flown: Mapping[Block, Outcomes], enough: Enough | None
) -> Outcomes | None:
    """What is counted; None as long as more must be flown."""
    counted: list[Outcomes] = []
    for block in blocks:
        if block not in flown:
            return None
        counted.append(flown[block])
        if enough is not None:
            so_far = Outcomes.joined(counted)
            if enough(so_far):
                return so_far
    return Outcomes.joined(counted)


PATIENCE = 10.0
"""How long a scheduler may take to answer [s]."""

RETRIES = 10
"""How often a block is flown again whose worker was lost."""


class Cluster(Workers):
    """The workers of a Dask scheduler, each thread of theirs at one block."""

    def __init__(self, address: str) -> None:
        """Connect to the scheduler at `address`, as in `tcp://host:8786`.

        Raises:
            MissingToolError: Dask is not installed.
            OcsError: nobody answers there.
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
        """Fly these blocks (`Workers.fly`)."""
        # The scheduler keeps the bytes: what was sent to a worker that is lost is sent again.
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
        """Leave the cluster as it was."""
        self._client.close()


class _Unpacked:
    """A campaign on its worker; unpacked there once, whatever Dask does with its arguments."""

    def __init__(self, content: bytes) -> None:
        self.campaign: Campaign = pickle.loads(content)

    def fly(self, block: Block) -> tuple[Block, Outcomes]:
        """Fly a block in one thread: the others fly other blocks."""
        return block, fly_samples(self.campaign, block, threads=1)
