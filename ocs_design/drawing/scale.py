"""Scales of drawings (ISO 5455)."""

from collections.abc import Callable
from dataclasses import dataclass

_STEPS = (1, 2, 5)


@dataclass(frozen=True)
class Scale:
    """Paper to part.

    Attributes:
        paper, part: as in `paper:part`; one of them is 1.
    """

    paper: int
    part: int

    def __str__(self) -> str:
        return f"{self.paper}:{self.part}"

    def __call__(self, length: float) -> float:
        """A length of the part [m] on paper [mm]."""
        return 1e3 * length * self.paper / self.part

    def length(self, on_paper: float) -> float:
        """Of the part [m] that is so long on paper [mm]."""
        return 1e-3 * on_paper * self.part / self.paper


_ENLARGED = [Scale(step * 10**power, 1) for power in (2, 1, 0) for step in reversed(_STEPS)]
_REDUCED = [Scale(1, step * 10**power) for power in range(7) for step in _STEPS][1:]


def largest_scale(fits: Callable[[Scale], bool]) -> Scale:
    """The largest standard scale for which `fits` holds; the smallest if it holds for none."""
    scales = [*_ENLARGED, *_REDUCED]
    return next((scale for scale in scales if fits(scale)), scales[-1])
