"""How the device sits on its robot, in the terminal."""

from collections.abc import Iterator, Sequence

from ocs_design.design_file import ClearanceRecord, MountingRecord, OcsRecord, ReachRecord
from ocs_design.report.quantities import millimetres, tenths

_AXES = ("roll", "pitch", "yaw")
_SHOWN = 2


def mounted(ocs: OcsRecord) -> Iterator[tuple[str, str]]:
    """What is near, and what the device changes."""
    yield "nearest, standing", _nearest(ocs.clearance)
    if ocs.mounting is None:
        return
    if ocs.mounting.landing is not None:
        yield "nearest, landing", _nearest(ocs.mounting.landing)
    yield "the device shifts", _changes(ocs.mounting)


def could_hit(ocs: OcsRecord) -> Sequence[str]:
    """Limbs that would hit a module on the way to their limits, in one sentence."""
    found = () if ocs.mounting is None else ocs.mounting.reachable
    if not found:
        return ()
    told = "; ".join(map(_reach, found[:_SHOWN]))
    more = f"; and {len(found) - _SHOWN} more, see design.json" if len(found) > _SHOWN else ""
    return (f"within their joints' limits these could hit a module: {told}{more}",)


def _nearest(clearance: ClearanceRecord | None) -> str:
    if clearance is None:
        return "not checked: the robot has no geometry"
    gap = millimetres(abs(clearance.distance))
    how = f"{gap} away" if clearance.distance >= 0.0 else f"overlapping by {gap}"
    return f"{clearance.part}, {how}"


def _changes(mounting: MountingRecord) -> str:
    shift = ", ".join(map(tenths, mounting.com_shift))
    changes = zip(_AXES, mounting.inertia_change, strict=True)
    inertia = ", ".join(f"{name} {change:+.1%}" for name, change in changes)
    return f"the centre of mass by {shift} mm; the inertia: {inertia}"


def _reach(reach: ReachRecord) -> str:
    joints = ", ".join(f"{name} {value:.2f}" for name, value in reach.joints.items())
    return f"{reach.part} ({joints})"
