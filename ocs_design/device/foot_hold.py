"""How a foot's two screws hold it: heads on slots, what it tilts about, its friction."""

from collections.abc import Sequence
from dataclasses import dataclass

from ocs_design.device.device import Device
from ocs_design.device.records.device import MarginRecord
from ocs_design.device.solids import foot_of
from ocs_design.parts.foot import foot_shock, screw_pull
from ocs_design.parts.joints import FRICTION, TIGHTENING_FACTOR
from ocs_design.parts.printed import (
    PRESSURE_SHARE,
    SHOCK,
    STRENGTH,
    TRUNK_SCREW,
    TRUNK_SCREW_COUNT,
    WASHER_ACROSS,
)

BEARING_MOMENT = "bearing moment"
"""Name of the margin of what turns a wheel's axis."""


@dataclass(frozen=True)
class FootHold:
    """What holds the feet of a device.

    Attributes:
        pull: largest of one screw under `SHOCK` along the wheel's axis [N].
        washers: whether washers go under the heads: without, what the print lets them be
            tightened to is less than that pull.
        area: that a head, or its washer, presses on beside its slot [m^2].
        prints_bear: acceleration at which stem or base break [m/s^2].
        slot_radius: of the circle that the screws stand on [m].
    """

    pull: float
    washers: bool
    area: float
    prints_bear: float
    slot_radius: float

    @property
    def heads_bear(self) -> float:
        """Acceleration at which the heads, or their washers, sink into the base [m/s^2]."""
        return SHOCK * STRENGTH * self.area / self.pull

    @property
    def preload(self) -> float:
        """Force that a screw is tightened to, by the print under it [N]."""
        return PRESSURE_SHARE * STRENGTH * self.area

    @property
    def turning(self) -> float:
        """Moment about the vertical that their friction bears at the least preload [N m]."""
        least = self.preload / TIGHTENING_FACTOR
        return FRICTION * TRUNK_SCREW_COUNT * least * self.slot_radius


def foot_hold(device: Device) -> FootHold:
    """What holds the feet: on a plate they tilt about its edge, which is within their own."""
    foot, plate = foot_of(device), device.plate
    module = device.flywheel.mass + device.carrier.mass
    edge = foot.base_radius if plate is None else min(foot.base_radius, plate.radius)
    pull = screw_pull(foot, module, edge)
    bare = TRUNK_SCREW.slot_area(TRUNK_SCREW.head_diameter)
    washers = pull > PRESSURE_SHARE * STRENGTH * bare
    area = TRUNK_SCREW.slot_area(WASHER_ACROSS) if washers else bare
    return FootHold(pull, washers, area, foot_shock(foot, module, edge), foot.slot_radius)


def unheld_moment(device: Device, margins: Sequence[MarginRecord]) -> float:
    """Moment of a wheel that would turn its foot about the vertical [N m]; 0: friction holds it.

    It counts as vertical, whole, as it is where a trunk that pitches turns a wheel whose axis lies
    level and off the lateral direction.

    Args:
        device: whose feet are held by `foot_hold`. margins: of its motion.
    """
    asked = max((each.demand for each in margins if each.name == BEARING_MOMENT), default=0.0)
    return asked if asked > foot_hold(device).turning else 0.0
