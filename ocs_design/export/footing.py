"""What the feet stand on: whether the trunk is as wide as they are, and level beneath them."""

from collections.abc import Iterator
from math import sqrt

import numpy as np

from ocs_design.design import Device
from ocs_design.export.workshop import printed_foot
from ocs_design.robot.bounds import trunk_extent, trunk_top
from ocs_design.robot.robot import Robot
from ocs_design.sizing.foot import TRUNK_SCREW
from ocs_design.units import format_quantity

_LEFT = np.array([0.0, 1.0, 0.0])

_STANDS = 1e-4
"""From the trunk's top, to which a foot is on it [m]."""


def footing_remarks(robot: Robot, device: Device) -> tuple[str, ...]:
    """One sentence each; the trunk is the box around its shapes.

    Args:
        robot: that carries the device. device: whose feet are looked at, if it has any.
    """
    if device.carrier.mass == 0.0:
        return ()
    underside = float(device.modules[0].position[2]) - printed_foot(device).wheel_height
    above = underside - trunk_top(robot.tree, robot.trunk)
    if abs(above) > _STANDS:
        gap = format_quantity(abs(above), "mm", digits=3)
        where = "above" if above > 0.0 else "below"
        return (
            f"the feet are {gap} {where} the trunk's top: each needs a bracket of your own, level "
            "and fixed to the trunk, which no mass has in it",
        )
    return tuple(_beside(robot, device))


def _beside(robot: Robot, device: Device) -> Iterator[str]:
    """How far base and outer screw are beyond the trunk's flank."""
    foot, out = printed_foot(device), float(device.modules[0].position[1])
    half = min(trunk_extent(robot.tree, robot.trunk, side) for side in (_LEFT, -_LEFT))
    over = out + foot.base_radius - half
    # Without shapes the trunk has no width.
    if half <= 0.0 or over <= 0.0:
        return
    beyond = format_quantity(over, "mm", digits=2)
    screw = out + foot.slot_radius / sqrt(2.0) + TRUNK_SCREW.clearance_hole / 2.0 - half
    if screw <= 0.0:
        yield f"the feet stand {beyond} over the trunk's sides; their screws are on it"
        return
    width = format_quantity(2.0 * (half + over), "mm")
    yield (
        f"the feet stand {beyond} over the trunk's sides, and the outer screw of each is "
        f"{format_quantity(screw, 'mm', digits=2)} off it: put a plate of {width} across the "
        "trunk under both, which no mass has in it, or ask for a smaller device with --r-max"
    )
