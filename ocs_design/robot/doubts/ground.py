"""Feet that do not stand on one ground."""

from collections.abc import Iterator, Mapping, Sequence

from ocs_design.robot.robot import Leg
from ocs_design.robot.stance.leg_geometry import placements_in_base, up_axis
from ocs_design.robot.tree import Tree

IN_THE_AIR = 0.05
"""Of a foot over the lowest one, over the leg's length: 8 mm of Solo12's."""


def foot_doubts(
    tree: Tree, trunk: str, legs: Sequence[Leg], posture: Mapping[str, float]
) -> Iterator[str]:
    """Feet that are above the ground that the lowest foot stands on, the trunk being level."""
    if not legs:
        return
    up = up_axis(tree, trunk, legs)
    placements = placements_in_base(tree, trunk, posture)
    soles = {
        leg.name: float(up @ (placements[leg.body].rotation @ leg.foot))
        + float(up @ placements[leg.body].position)
        - leg.foot_radius
        for leg in legs
    }
    ground = min(soles.values())
    for leg in legs:
        height = soles[leg.name] - ground
        if height > IN_THE_AIR * leg.length:
            yield f"foot '{leg.name}' is {1e3 * height:.3g} mm above the ground in this posture"
