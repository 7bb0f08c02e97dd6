"""Where on a robot the device sits: all that its snippets need to know of the robot."""

from typing import Protocol

from ocs_design.robot.robot import Mount


class Seat(Protocol):
    """A robot, or as much of one as was kept of it.

    Attributes:
        trunk: link that carries the device; its frame is the base frame B.
        mount: how B is fixed to the robot's own link; None if `trunk` is one.
    """

    @property
    def trunk(self) -> str:
        """See the class."""

    @property
    def mount(self) -> Mount | None:
        """See the class."""


def trunk_link(seat: Seat) -> str:
    """The robot's own link that carries the device."""
    return seat.trunk if seat.mount is None else seat.mount.link
