"""The torque-speed plane of the drive, with the maneuvers drawn into it."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.design import Motor
from ocs_design.drive.line import RESERVE
from ocs_design.report.charts.chart import Chart
from ocs_design.report.charts.marks import SERIES, Area, Ink, Line, Mark, Rule
from ocs_design.report.charts.scales import Axis
from ocs_design.report.figures.amounts import in_unit
from ocs_design.report.flight import Flight

_SAMPLES = 121


@dataclass(frozen=True)
class _Plane:
    """Limits of a drive at its wheel; infinite where it has none [N m, rad/s]."""

    stall: float
    no_load: float
    limit: float

    @classmethod
    def of(cls, motor: Motor) -> "_Plane":
        """Of a recorded motor, which has None for what is not limited."""
        stall = np.inf if motor.stall_torque is None else motor.stall_torque
        limit = np.inf if motor.torque_limit is None else motor.torque_limit
        return cls(stall, motor.no_load_speed, limit)

    def highest(self, speed: FloatArray, share: float) -> FloatArray:
        """Largest torque forwards at a speed, on a share of voltage and current."""
        if np.isinf(self.stall):
            line = np.where(np.abs(speed) <= share * self.no_load, np.inf, 0.0)
        else:
            line = self.stall * (share - speed / self.no_load)
        return np.asarray(np.minimum(share * self.limit, np.maximum(line, 0.0)))


def torque_speed_chart(motor: Motor, flights: Sequence[Flight]) -> Chart | None:
    """All four quadrants; None where nothing was flown with the device."""
    driven = [flight for flight in flights if flight.ocs]
    if not driven:
        return None
    plane = _Plane.of(motor)
    paths = [
        path
        for flight, ink in zip(driven, SERIES * 2, strict=False)
        for path in _paths(flight, ink)
    ]
    reach = max(float(np.nanmax(np.abs(path.x))) for path in paths)
    torque = max(float(np.nanmax(np.abs(path.y))) for path in paths)
    widest = max(reach, in_unit(min(plane.no_load, 3.0 * np.pi / 30.0 * reach), "rpm"))
    tallest = 1.15 * max(torque, plane.limit if np.isfinite(plane.limit) else 0.0) or 1.0
    top = widest if motor.speed_max is None else min(widest, in_unit(motor.speed_max, "rpm"))
    speed = np.linspace(-top, top, _SAMPLES)
    marks: list[Mark] = [*_limits(plane, speed, tallest), *_top_speed(motor, widest), *paths]
    return Chart(
        name="torque_speed",
        title="Torque and speed of a wheel",
        description="What the drive can give at each speed of the wheel, at full voltage and "
        f"current and at the {RESERVE:.0%} that the design may use, with the path of each maneuver "
        "up to touchdown; solid for the left wheel, dashed for the right one.",
        x=Axis("wheel speed", "rpm", -1.05 * widest, 1.05 * widest),
        y=Axis("torque on the wheel", "N m", -tallest, tallest),
        marks=tuple(marks),
        height=330.0,
    )


def _limits(plane: _Plane, speed_rpm: FloatArray, tallest: float) -> Iterator[Mark]:
    """The whole range, and the edge of what the design may use."""
    if np.isinf(plane.stall) and np.isinf(plane.limit):
        return
    speed = speed_rpm * np.pi / 30.0
    for share in (1.0, RESERVE):
        high = np.minimum(plane.highest(speed, share), 2.0 * tallest)
        low = -np.minimum(plane.highest(-speed, share), 2.0 * tallest)
        x = np.concatenate([speed_rpm, speed_rpm[::-1], speed_rpm[:1]])
        y = np.concatenate([high, low[::-1], high[:1]])
        if share == 1.0:
            yield Area(x, y, Ink.FAINT, "range of the drive")
        else:
            yield Line(x, y, Ink.FAINT, f"{share:.0%} of it", dashed=True, thin=True)


def _top_speed(motor: Motor, widest: float) -> Iterator[Rule]:
    if motor.speed_max is None:
        return
    fastest = in_unit(motor.speed_max, "rpm")
    if fastest <= 1.05 * widest:
        yield Rule(-fastest, upright=True, ink=Ink.PLAIN)
        yield Rule(fastest, upright=True, label="top speed", ink=Ink.PLAIN)


def _paths(flight: Flight, ink: Ink) -> Iterator[Line]:
    """Up to touchdown, when what follows is no part of the maneuver."""
    flown = flight.driven
    for side, dashed in (("left", False), ("right", True)):
        speed = in_unit(flight.columns[f"wheel_speed_{side}_rad_s"][flown], "rpm")
        torque = flight.columns[f"wheel_torque_{side}_nm"][flown]
        yield Line(speed, torque, ink, "" if dashed else flight.scenario, dashed=dashed)
