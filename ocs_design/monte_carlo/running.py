"""Blocks of samples, one after the other or many at once, until enough is known."""

from abc import ABC, abstractmethod
from collections.abc import Generator, Mapping, Sequence
from contextlib import closing
from functools import partial

from ocs_design.monte_carlo.blocks import Block
from ocs_design.monte_carlo.campaign import Campaign, fly_samples
from ocs_design.monte_carlo.outcomes import Outcomes
from ocs_design.monte_carlo.storage import Storage
from ocs_design.monte_carlo.summary import shares
from ocs_design.simulation.engine import Progress

Arrivals = Generator[tuple[Block, Outcomes], None, None]


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


class ThisMachine(Workers):
    """One block after the other, each on all processors."""

    def __init__(self, threads: int | None = None) -> None:
        """With so many threads for the physics; None: one per processor."""
        self._threads = threads

    def fly(self, campaign: Campaign, blocks: Sequence[Block], progress: Progress) -> Arrivals:
        """See `Workers.fly`."""
        for done, block in enumerate(blocks):
            tell = partial(_tell, progress, done, len(blocks))
            yield block, fly_samples(campaign, block.samples, threads=self._threads, progress=tell)


def run_campaign(
    campaign: Campaign,
    blocks: Sequence[Block],
    *,
    workers: Workers,
    storage: Storage | None = None,
    until_width: float | None = None,
    progress: Progress | None = None,
) -> Outcomes:
    """Fly blocks until all are flown, or the intervals are narrow enough.

    The rule is asked after each block in the order of the samples, so that what is counted does not
    depend on who was faster.

    Args:
        campaign: what is flown.
        blocks: of samples, in order.
        workers: who fly them.
        storage: where blocks are kept as they come, and found if they have been flown already.
        until_width: stop as soon as the interval of each scenario is no wider than this.
        progress: told the part of the work that is done, 0..1.
    """
    flown = {} if storage is None else dict(storage.found(blocks))
    missing = [block for block in blocks if block not in flown]
    tell = partial(_tell_rest, progress, len(flown) / len(blocks)) if progress else _ignore
    outcomes = _enough(blocks, flown, until_width)
    with closing(workers.fly(campaign, missing, tell)) as arrivals:
        while outcomes is None:
            block, flown[block] = next(arrivals)
            if storage is not None:
                storage.keep(block, flown[block])
            outcomes = _enough(blocks, flown, until_width)
    return outcomes


def _enough(
    blocks: Sequence[Block], flown: Mapping[Block, Outcomes], until_width: float | None
) -> Outcomes | None:
    """What is counted; None as long as more must be flown."""
    counted: list[Outcomes] = []
    for block in blocks:
        if block not in flown:
            return None
        counted.append(flown[block])
        if until_width is not None:
            so_far = Outcomes.joined(counted)
            if all(share.width <= until_width for share in shares(so_far)):
                return so_far
    return Outcomes.joined(counted)


def _tell(progress: Progress, done: int, of: int, part: float) -> None:
    progress((done + part) / of)


def _tell_rest(progress: Progress, already: float, part: float) -> None:
    progress(already + (1.0 - already) * part)


def _ignore(_done: float) -> None:
    """Where nobody wants to know."""
