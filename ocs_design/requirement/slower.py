"""Maneuvers with more time for what they ask, by keys that a user can set."""

from collections.abc import Iterator
from dataclasses import replace

from ocs_design.requirement.maneuver import Disturbance, Drop, Flip, Maneuver, Shove
from ocs_design.requirement.maneuver_table import kind_of
from ocs_design.requirement.values import Quantities, Quantity
from ocs_design.units import round_outwards, si_unit

_LONGER_THAN_ITS_TURN = 1.02
"""Flight over turn, where a longer turn needs a longer flight."""


def slower(maneuver: Maneuver, factor: float, standing_height: float) -> Maneuver:
    """The same turn in `factor` times the time: a higher fall, a longer turn, a higher jump.

    Args:
        maneuver: as it is. factor: positive; below 1: less time.
        standing_height: of the trunk over the ground [m].
    """
    match maneuver:
        case Drop():
            fall = (maneuver.height - standing_height) * factor**2
            return replace(maneuver, height=standing_height + fall)
        case Flip():
            duration = maneuver.duration * factor
            higher = max(_LONGER_THAN_ITS_TURN * duration / maneuver.flight_time, 1.0) ** 2
            return replace(maneuver, duration=duration, jump_height=maneuver.jump_height * higher)
        case Disturbance():
            longer = maneuver.flight_time + (factor - 1.0) * maneuver.time_left
            forward, _ = maneuver.takeoff_velocity
            return replace(maneuver, takeoff_velocity=(forward, longer * maneuver.gravity / 2.0))
        case Shove():
            return replace(maneuver, settling=maneuver.settling * factor)
        case _:
            return maneuver


def told_change(before: Maneuver, after: Maneuver) -> str:
    """The keys of `after` that are other than those of `before`, rounded up, as in `height 2 m`."""
    return f"{after.name} {' and '.join(_changed_keys(before, after))}"


def _changed_keys(before: Maneuver, after: Maneuver) -> Iterator[str]:
    for name, how in kind_of(after)[1].items():
        old, new = getattr(before, name), getattr(after, name)
        if old == new:
            continue
        match how:
            case Quantity(dimension=dimension):
                yield f"{name} {_up(new)} {si_unit(dimension)}"
            case Quantities(dimension=dimension):
                kept = zip(old, new, strict=True)
                figures = [f"{a:.6g}" if a == b else _up(b) for a, b in kept]
                yield f"{name} [{', '.join(figures)}] {si_unit(dimension)}"


def _up(value: float) -> str:
    return f"{round_outwards(value, upwards=True):.6g}"
