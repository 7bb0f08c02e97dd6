"""What a front may be drawn against."""

from collections.abc import Mapping
from dataclasses import replace
from math import hypot
from types import MappingProxyType

from ocs_design.exceptions import UsageError
from ocs_design.requirement.froude import default_bus_voltage
from ocs_design.requirement.maneuver import Drop, Flip, Maneuver
from ocs_design.requirement.slower import slower
from ocs_design.requirement.sweep import KeySweep, ManeuverSweep, Sweep
from ocs_design.units import Dimension


def _time(maneuver: Maneuver, standing_height: float) -> float | None:
    """Of the fall or of the turn [s]."""
    match maneuver:
        case Drop():
            return maneuver.time(standing_height)
        case Flip():
            return maneuver.duration
        case _:
            return None


def _with_time(maneuver: Maneuver, ratio: float, standing_height: float) -> Maneuver:
    """A fall from the height that takes so long; a turn in a jump that is longer by as much."""
    match maneuver:
        case Drop():
            return slower(maneuver, ratio, standing_height)
        case Flip():
            return replace(
                maneuver,
                duration=maneuver.duration * ratio,
                jump_height=maneuver.jump_height * ratio**2,
            )
        case _:
            return maneuver


def _angle(maneuver: Maneuver, standing_height: float) -> float | None:
    """Of the tilt or of the turn [rad], without its sign."""
    del standing_height
    match maneuver:
        case Drop():
            return hypot(maneuver.roll, maneuver.pitch)
        case Flip():
            return abs(maneuver.angle)
        case _:
            return None


def _with_angle(maneuver: Maneuver, ratio: float, standing_height: float) -> Maneuver:
    """Roll and pitch of a tilt keep their proportion."""
    del standing_height
    match maneuver:
        case Drop():
            return replace(maneuver, roll=maneuver.roll * ratio, pitch=maneuver.pitch * ratio)
        case Flip():
            return replace(maneuver, angle=maneuver.angle * ratio)
        case _:
            return maneuver


_SWEEPS = (
    ManeuverSweep("time", "time of the turn", Dimension.TIME, "ms", (0.8, 1.6), _time, _with_time),
    ManeuverSweep(
        "angle", "angle of the turn", Dimension.ANGLE, "deg", (0.4, 1.6), _angle, _with_angle
    ),
    KeySweep(
        "radius",
        "room for the rim, r_max",
        Dimension.LENGTH,
        "mm",
        (0.6, 1.4),
        "flywheel",
        "r_max",
        lambda task: task.resolved.envelope.outer_radius_max,
    ),
    KeySweep(
        "height",
        "room for the rim, h_max",
        Dimension.LENGTH,
        "mm",
        (0.4, 2.0),
        "flywheel",
        "h_max",
        lambda task: task.resolved.envelope.height_max,
    ),
    KeySweep(
        "voltage",
        "bus voltage",
        Dimension.VOLTAGE,
        "V",
        (0.5, 2.5),
        "motor",
        "bus_voltage",
        lambda task: task.specification.motor.bus_voltage or default_bus_voltage(task.robot),
    ),
)

SWEEPS: Mapping[str, Sweep] = MappingProxyType({sweep.name: sweep for sweep in _SWEEPS})
"""Everything that can be varied, by the word that `--against` takes."""


def sweep_of(name: str, maneuver: str = "") -> Sweep:
    """The sweep called `name`, of one maneuver alone if that is named.

    Raises:
        UsageError: there is none, or it is not of maneuvers.
    """
    sweep = SWEEPS.get(name)
    if sweep is None:
        raise UsageError(f"--against {name}: is none of {', '.join(SWEEPS)}")
    if not maneuver:
        return sweep
    if not isinstance(sweep, ManeuverSweep):
        raise UsageError(f"--maneuver {maneuver}: the {name} is not that of a maneuver")
    return replace(sweep, maneuver=maneuver)
