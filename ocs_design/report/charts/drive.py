"""The torque-speed plane of the drive, with the maneuvers drawn into it."""

from collections.abc import Iterator, Sequence

import numpy as np

from ocs_design.actuation.drive import RESERVE, Drive
from ocs_design.common.arrays import FloatArray
from ocs_design.common.wording import in_unit
from ocs_design.report.charts.chart import SERIES, Area, Axis, Chart, Ink, Line, Mark, Rule
from ocs_design.report.story import RecordedFlight

_SAMPLES = 121


def _highest(motor: Drive, speed: FloatArray, share: float) -> FloatArray:
    """Largest torque at the wheel forwards at a speed, on a share of voltage and current [N m]."""
    if motor.stall_torque is None:
        line = np.where(np.abs(speed) <= share * motor.no_load_speed, np.inf, 0.0)
    else:
        line = motor.stall_torque * (share - speed / motor.no_load_speed)
    limit = np.inf if motor.torque_limit is None else share * motor.torque_limit
    return np.asarray(np.minimum(limit, np.maximum(line, 0.0)))


def drive_charts(motor: Drive, flights: Sequence[RecordedFlight]) -> Iterator[Chart]:
    """Torque and speed in all four quadrants; none where nothing was flown with the device."""
    driven = [flight for flight in flights if flight.ocs]
    if not driven:
        return
    # The path of each wheel up to where it is judged; what follows is no part of the maneuver.
    paths = [
        Line(
            in_unit(flight.wheel_speed(wheel)[flight.driven], "rpm"),
            flight.wheel_torque(wheel)[flight.driven],
            ink,
            "" if index else flight.scenario,
            dashed=index > 0,
        )
        for flight, ink in zip(driven, SERIES * 2, strict=False)
        for index, wheel in enumerate(flight.wheels)
    ]
    reach = max(float(np.nanmax(np.abs(path.x))) for path in paths)
    torque = max(float(np.nanmax(np.abs(path.y))) for path in paths)
    widest = max(reach, in_unit(min(motor.no_load_speed, 3.0 * np.pi / 30.0 * reach), "rpm"))
    tallest = 1.15 * max(torque, motor.torque_limit or 0.0) or 1.0
    fastest = np.inf if motor.speed_max is None else in_unit(motor.speed_max, "rpm")
    top = min(widest, fastest)
    marks: list[Mark] = []
    # Whole range of the drive, and the edge of what the design may use.
    speed_rpm = np.linspace(-top, top, _SAMPLES)
    speed = speed_rpm * np.pi / 30.0
    limited = motor.stall_torque is not None or motor.torque_limit is not None
    for share in (1.0, RESERVE) if limited else ():
        high = np.minimum(_highest(motor, speed, share), 2.0 * tallest)
        low = -np.minimum(_highest(motor, -speed, share), 2.0 * tallest)
        x = np.concatenate([speed_rpm, speed_rpm[::-1], speed_rpm[:1]])
        y = np.concatenate([high, low[::-1], high[:1]])
        if share == 1.0:
            marks.append(Area(x, y, Ink.FAINT, "range of the drive"))
        else:
            marks.append(Line(x, y, Ink.FAINT, f"{share:.0%} of it", dashed=True, thin=True))
    if fastest <= 1.05 * widest:
        marks.append(Rule(-fastest, upright=True, ink=Ink.PLAIN))
        marks.append(Rule(fastest, upright=True, label="top speed", ink=Ink.PLAIN))
    yield Chart(
        name="torque_speed",
        title="Torque and speed of a wheel",
        description="What the drive can give at each speed of the wheel, at full voltage and "
        f"current and at the {RESERVE:.0%} that the design may use, with the path of each maneuver "
        "up to where it is judged; solid for the first wheel, dashed for the others.",
        x=Axis("wheel speed", "rpm", -1.05 * widest, 1.05 * widest),
        y=Axis("torque on the wheel", "N m", -tallest, tallest),
        marks=(*marks, *paths),
        height=330.0,
    )
