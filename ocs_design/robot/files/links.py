"""Links and connections as a robot file has them, before they are lumped into moving bodies."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from ocs_design.exceptions import RobotError
from ocs_design.robot.mass_properties import MassProperties
from ocs_design.robot.tree import Joint, Placement, Shape

MOST_LINKS = 2000
"""Of a robot; public ones have up to 150, and time grows with the square."""


def check_number_of_links(count: int) -> None:
    """Refuse what is no robot but would be computed for minutes.

    Raises:
        RobotError: there are too many.
    """
    if count > MOST_LINKS:
        raise RobotError(
            f"the file has {count} links, more than {MOST_LINKS}",
            hint="leave out what is not the robot's, or join what moves as one",
        )


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
