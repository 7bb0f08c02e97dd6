"""The screws of a module: what they hold, how many and how long they are."""

from collections.abc import Iterator
from dataclasses import dataclass

from ocs_design.design import Device
from ocs_design.drive.mounting import BoltCircle, Mounting
from ocs_design.export.workshop import printed_foot
from ocs_design.fasteners import IN_PLASTIC, Screw, screw
from ocs_design.sizing.foot import (
    BASE_THICKNESS,
    PLATE_THICKNESS,
    TRUNK_SCREW,
    TRUNK_SCREW_COUNT,
)
from ocs_design.sizing.housing import EAR_COUNT, LID_SCREW, WALL

_DEPTH = "check the depth of the motor's thread"


@dataclass(frozen=True)
class Fastening:
    """Equal screws of one module.

    Attributes:
        screw: what they are. count: how many.
        thickness: of what they go through [m].
        purpose: what they hold, and what to mind.
        depth: of their threads over their diameter, at least.
    """

    screw: Screw
    count: int
    thickness: float
    purpose: str
    depth: float = 1.0

    @property
    def length(self) -> float:
        """[m]."""
        return self.screw.length_through(self.thickness, self.depth)


def fastenings(device: Device, *, printed: bool) -> Iterator[Fastening]:
    """Of wheel and motor, where the catalogue has their threads, and of what is printed.

    Args:
        device: to be put together.
        printed: whether it has housings and feet.
    """
    mounting, web = device.motor.mounting or Mounting(), device.flywheel.web
    if mounting.rotor is not None and web is not None:
        yield _of(mounting.rotor, web.hub.height, "wheel on rotor")
    if not printed:
        return
    if printed_foot(device).housing.mount.rings and mounting.stator is not None:
        yield _of(mounting.stator, WALL + PLATE_THICKNESS, "motor on housing and foot")
    yield Fastening(LID_SCREW, EAR_COUNT, WALL, "lid on drum, which is tapped", IN_PLASTIC)
    mind = "foot on trunk; longer if its thread begins deeper"
    yield Fastening(TRUNK_SCREW, TRUNK_SCREW_COUNT, BASE_THICKNESS, mind)


def _of(circle: BoltCircle, thickness: float, purpose: str) -> Fastening:
    return Fastening(screw(circle.thread), circle.bolts, thickness, f"{purpose}; {_DEPTH}")
