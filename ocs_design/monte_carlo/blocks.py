"""Samples that are flown, sent and kept together."""

from dataclasses import dataclass

BLOCK = 64
"""Samples of a block: enough for the processors, few enough for the memory."""


@dataclass(frozen=True)
class Block:
    """Samples `start` to `stop`, the last one not among them."""

    start: int
    stop: int

    @property
    def samples(self) -> range:
        """Their indices."""
        return range(self.start, self.stop)


def blocks_of(samples: int, size: int = BLOCK) -> tuple[Block, ...]:
    """All samples in blocks; the last may be smaller."""
    starts = range(0, samples, size)
    return tuple(Block(start, min(start + size, samples)) for start in starts)
