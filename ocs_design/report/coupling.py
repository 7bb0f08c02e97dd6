"""What it costs that whoever pitches rolls, where robot and device are not symmetric."""

from collections.abc import Iterator

import numpy as np

from ocs_design.design_file import DemandRecord, ManeuverRecord, OcsDesign
from ocs_design.drive.tilt_inertia import OUT_OF_REACH, TiltInertia
from ocs_design.report.quantities import degrees
from ocs_design.requirement.bound import AXES, authority

WORTH_TELLING = 0.02
"""Of what the turn alone asks; 30 of 31 public robots with legs couple both axes by less than 0.9 %
of their inertia, which is this much only at small incidences."""


def coupling_notes(design: OcsDesign) -> Iterator[str]:
    """A line for each turn about one axis that the other one has a part in."""
    maneuvers = {maneuver.name: maneuver for maneuver in design.requirement.maneuvers}
    whole = TiltInertia.of(design.ocs.total_inertia)
    for demand in design.requirement.demands:
        axis = _only_axis(maneuvers.get(demand.source))
        if axis is not None:
            yield from _told(demand, axis, float(whole.drift[1 - axis]))


def _only_axis(maneuver: ManeuverRecord | None) -> int | None:
    """Which of `AXES` a maneuver turns the trunk about; None: both, or it is no turn."""
    if maneuver is None:
        return None
    roll, pitch = (maneuver.parameters.get(axis, 0.0) != 0.0 for axis in AXES)
    if maneuver.kind == "flip":
        pitch = True
    return None if roll == pitch else int(pitch)


def _told(demand: DemandRecord, axis: int, drift: float) -> Iterator[str]:
    """What the turn about this axis takes of the other one."""
    shares = authority(demand.incidence)
    about, across = AXES[axis], AXES[1 - axis]
    if shares[1 - axis] <= OUT_OF_REACH:
        if drift > WORTH_TELLING:
            yield (
                f"{demand.source}: at {degrees(demand.incidence)} the wheels do not reach "
                f"{across}: robot and device are not symmetric, and drift by {drift:.2f} deg of "
                f"{across} per degree of {about}, there and back in a whole turn"
            )
        return
    asked = np.array([demand.roll_momentum, demand.pitch_momentum]) / shares
    more = asked[1 - axis] / asked[axis]
    if more > WORTH_TELLING:
        yield (
            f"{demand.source}: robot and device are not symmetric: to {about} alone takes momentum "
            f"about {across} too, {more:.0%} more of the busier wheel at "
            f"{degrees(demand.incidence)}; the device is sized for it"
        )
