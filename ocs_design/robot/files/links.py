"""Links and connections as a robot file has them, before they are lumped into moving bodies."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from ocs_design.robot.mass_properties import MassProperties
from ocs_design.robot.tree import Joint, Placement, Shape


@dataclass(frozen=True, eq=False)
class Link:
    """A link of a URDF or a body of a MJCF.

    Attributes:
        name: unique in the file.
        mass_properties: raw, in the link's frame; None where the file states none.
        shapes: in the link's frame.
    """

    name: str
    mass_properties: MassProperties | None
    shapes: tuple[Shape, ...] = ()


@dataclass(frozen=True, eq=False)
class Connection:
    """How a link hangs on another.

    Attributes:
        name: unique in the file.
        parent, child: links.
        placement: of the joint's frame in the parent's frame at zero.
        joint: None if the two are rigidly joined.
        child_in_joint: the child's frame in the joint's frame.
        held: what the file calls a joint that is held still for want of a single coordinate; else
            empty.
    """

    name: str
    parent: str
    child: str
    placement: Placement
    joint: Joint | None = None
    child_in_joint: Placement = field(default_factory=Placement.identity)
    held: str = ""


Children = Mapping[str, Sequence[Connection]]
"""Connections below each link, in file order."""
