"""The screws of a module: what they hold, how many and how long they are."""

from collections.abc import Iterator

from ocs_design.design import Device
from ocs_design.drive_solids import motor_mount
from ocs_design.fasteners import Fastening
from ocs_design.sizing.foot import TRUNK_SCREWS
from ocs_design.sizing.housing import LID_SCREWS


def fastenings(device: Device) -> Iterator[Fastening]:
    """Of wheel and motor, where the catalogue has their threads, and of what is printed."""
    for screwed in motor_mount(device).screwed:
        yield screwed.fastening
    yield LID_SCREWS
    yield TRUNK_SCREWS
