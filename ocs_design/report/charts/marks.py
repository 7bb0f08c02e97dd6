"""What a chart shows: lines, areas, points and rules, in the units of its axes."""

from dataclasses import dataclass
from enum import StrEnum
from typing import TypeAlias

from ocs_design.arrays import FloatArray


class Ink(StrEnum):
    """Colours by what they say; the style sheet has them for light and for dark.

    The first six are those of M. Okabe and K. Ito ("Color universal design", 2008), told apart by
    colour-blind eyes too; where two lines lie close, one of them is dashed as well.
    """

    BLUE = "blue"
    VERMILION = "vermilion"
    GREEN = "green"
    PURPLE = "purple"
    ORANGE = "orange"
    SKY = "sky"
    PLAIN = "plain"
    FAINT = "faint"


SERIES = (Ink.BLUE, Ink.VERMILION, Ink.GREEN, Ink.PURPLE, Ink.ORANGE, Ink.SKY)
"""In the order that they are taken in."""


@dataclass(frozen=True, eq=False)
class _Drawn:
    """Places in the units of the axes; `name` goes into the legend."""

    x: FloatArray
    y: FloatArray
    ink: Ink
    name: str = ""


@dataclass(frozen=True, eq=False)
class Line(_Drawn):
    """A curve, or several broken by NaN."""

    dashed: bool = False
    thin: bool = False


@dataclass(frozen=True, eq=False)
class Area(_Drawn):
    """A closed outline, filled faintly."""


@dataclass(frozen=True, eq=False)
class Points(_Drawn):
    """Discs; `hollow` ones are rings. `labels` stand beside them; empty: none."""

    hollow: bool = False
    labels: tuple[str, ...] = ()


@dataclass(frozen=True)
class Rule:
    """A dashed line across the chart at one value of an axis.

    A `label` stands at an upright one; `name` goes into the legend.
    """

    value: float
    upright: bool
    label: str = ""
    ink: Ink = Ink.PLAIN
    name: str = ""


Mark: TypeAlias = Line | Area | Points | Rule
