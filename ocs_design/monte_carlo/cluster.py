"""Blocks of samples on the workers of a Dask cluster.

A block is a pure function of its campaign and its indices: where and how often it is flown makes no
difference. A worker that is lost costs the blocks that it was at, which others take over.
"""

import pickle
from collections.abc import Sequence
from importlib import import_module
from types import ModuleType

from ocs_design.exceptions import MissingToolError, OcsError
from ocs_design.monte_carlo.blocks import Block
from ocs_design.monte_carlo.campaign import Campaign, fly_samples
from ocs_design.monte_carlo.outcomes import Outcomes
from ocs_design.monte_carlo.running import Arrivals, Workers
from ocs_design.simulation.engine import Progress

PATIENCE = 10.0
"""How long a scheduler may take to answer [s]."""

RETRIES = 10
"""How often a block is flown again whose worker was lost."""


class Cluster(Workers):
    """The workers of a Dask scheduler, each thread of theirs at one block."""

    def __init__(self, address: str) -> None:
        """Of the scheduler at `address`, as in `tcp://host:8786`.

        Raises:
            MissingToolError: Dask is not installed.
            OcsError: nobody answers there.
        """
        self._dask = _distributed()
        try:
            self._client = self._dask.Client(address, timeout=PATIENCE)
        except (OSError, ValueError) as error:
            raise OcsError(
                f"--scheduler {address}: no Dask scheduler answers there",
                hint="start one with `dask scheduler`, workers with `dask worker ADDRESS`",
            ) from error

    def fly(self, campaign: Campaign, blocks: Sequence[Block], progress: Progress) -> Arrivals:
        """See `Workers.fly`."""
        # The scheduler keeps the bytes: what was sent to a worker that is lost is sent again.
        shared = self._client.submit(_Unpacked, pickle.dumps(campaign), pure=False)
        futures = [
            self._client.submit(_fly_block, shared, block, retries=RETRIES, pure=False)
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


def _fly_block(shared: _Unpacked, block: Block) -> tuple[Block, Outcomes]:
    """On a worker: one thread, for the cluster has others for other blocks."""
    return block, fly_samples(shared.campaign, block.samples, threads=1)


def _distributed() -> ModuleType:
    """The package `distributed`.

    Raises:
        MissingToolError: it is not installed.
    """
    try:
        return import_module("distributed")
    except ImportError as error:
        raise MissingToolError(
            "--scheduler needs Dask, which is not installed",
            hint="pip install 'ocs-design[cluster]'",
        ) from error
