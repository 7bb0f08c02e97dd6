"""What happened in a maneuver, with the device and without it."""

from collections.abc import Sequence

import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.report.charts.chart import Chart
from ocs_design.report.charts.marks import Area, Ink, Line, Mark, Rule
from ocs_design.report.charts.scales import Axis
from ocs_design.report.figures.amounts import in_unit
from ocs_design.report.flight import Flight
from ocs_design.simulation.verdict import LANDING_TOLERANCE
from ocs_design.units import to_unit

_HEIGHT = 236.0

_SIDES = (("left", Ink.BLUE, False), ("right", Ink.VERMILION, True))
_AXES = (("pitch", "y", Ink.BLUE), ("roll", "x", Ink.VERMILION))


def time_charts(scenario: str, name: str, flights: Sequence[Flight]) -> tuple[Chart, ...]:
    """Attitude, rates, and speed and torque of the wheels over time.

    Args:
        scenario: name of the maneuver.
        name: of it, fit for file names and elements.
        flights: of it, with the device first where there is one.
    """
    driven = [flight for flight in flights if flight.ocs]
    charts = [_tilt(scenario, name, flights), _rates(scenario, name, flights)]
    charts += [_speeds(scenario, name, flight) for flight in driven]
    charts += [_torques(scenario, name, flight) for flight in driven]
    return tuple(charts)


def _tilt(scenario: str, name: str, flights: Sequence[Flight]) -> Chart:
    tolerance = to_unit(LANDING_TOLERANCE, "deg")
    lines = _about_axes(flights, "{axis}_rad", "deg", thin=False)
    marks: list[Mark] = [
        *lines,
        *(
            Rule(side * tolerance, upright=False, ink=Ink.FAINT, name="allowed at touchdown")
            for side in (-1.0, 1.0)
        ),
        *_events(flights),
    ]
    return Chart(
        name=f"tilt_{name}",
        title=f"{scenario}: attitude of the trunk",
        description="Pitch and roll over time, solid with the device, dashed without it; rules "
        f"at {tolerance:.0f} degrees either side of level are the landing tolerance.",
        x=_time(flights),
        y=Axis.around("angle", "deg", [-2.0 * tolerance, 2.0 * tolerance, *_ends(lines)]),
        marks=tuple(marks),
        height=_HEIGHT,
    )


def _rates(scenario: str, name: str, flights: Sequence[Flight]) -> Chart:
    lines = _about_axes(flights, "rate_{letter}_rad_s", "deg/s", thin=True)
    return Chart(
        name=f"rates_{name}",
        title=f"{scenario}: rates of the trunk",
        description="Pitch and roll rate over time, solid with the device, dashed without it.",
        x=_time(flights),
        y=Axis.around("rate", "deg/s", _ends(lines)),
        marks=(*lines, *_events(flights)),
        height=_HEIGHT,
    )


def _speeds(scenario: str, name: str, flight: Flight) -> Chart:
    lines = _of_sides(flight, "wheel_speed_{side}_rad_s", "rpm", "wheel", thin=False)
    return Chart(
        name=f"wheel_speed_{name}",
        title=f"{scenario}: speed of the wheels",
        description="Speed of both wheels relative to the trunk over time.",
        x=_time([flight]),
        y=Axis.around("wheel speed", "rpm", _ends(lines)),
        marks=(*lines, *_events([flight])),
        height=_HEIGHT,
    )


def _torques(scenario: str, name: str, flight: Flight) -> Chart:
    limits = _limits(flight)
    lines = _of_sides(flight, "wheel_torque_{side}_nm", "N m", "motor", thin=True)
    return Chart(
        name=f"wheel_torque_{name}",
        title=f"{scenario}: torque of the motors",
        description="Torque of both motors on their wheels over time, within the shaded range that "
        "the left one can give at its speed.",
        x=_time([flight]),
        y=Axis.around("torque", "N m", _ends([*limits, *lines])),
        marks=(*limits, *lines, *_events([flight])),
        height=_HEIGHT,
    )


def _about_axes(flights: Sequence[Flight], column: str, unit: str, *, thin: bool) -> list[Line]:
    """About pitch and roll, of each flight; dashed without the device."""
    return [
        Line(
            flight.time,
            in_unit(flight.columns[column.format(axis=axis, letter=letter)], unit),
            ink,
            f"{axis} {_carrying(flight)}",
            dashed=not flight.ocs,
            thin=thin,
        )
        for flight in flights
        for axis, letter, ink in _AXES
    ]


def _of_sides(flight: Flight, column: str, unit: str, part: str, *, thin: bool) -> list[Line]:
    """Of the left and the right wheel or motor."""
    return [
        Line(
            flight.time,
            in_unit(flight.columns[column.format(side=side)], unit),
            ink,
            f"{side} {part}",
            dashed=dashed,
            thin=thin,
        )
        for side, ink, dashed in _SIDES
    ]


def _limits(flight: Flight) -> list[Area]:
    """What the left motor can give; nothing where that is not limited."""
    lowest = flight.columns.get("wheel_torque_lowest_left_nm")
    highest = flight.columns.get("wheel_torque_highest_left_nm")
    if lowest is None or highest is None:
        return []
    there_and_back = np.concatenate([flight.time, flight.time[::-1]])
    outline = np.concatenate([highest, lowest[::-1]])
    return [Area(there_and_back, outline, Ink.FAINT, "range of the motor")]


def _events(flights: Sequence[Flight]) -> list[Rule]:
    """Where the last of the flights leaves the ground, or is pushed, and the first comes down."""
    left = max((flight.lift_off or 0.0 for flight in flights), default=0.0)
    down = [each.touchdown for each in flights if each.flies and each.touchdown is not None]
    first = "lift-off" if any(flight.flies for flight in flights) else "push"
    times = [(left, first)] if left > 0.0 else []
    times += [(min(down), "touchdown")] if down else []
    return [Rule(time, upright=True, label=label, ink=Ink.FAINT) for time, label in times]


def _time(flights: Sequence[Flight]) -> Axis:
    return Axis("time", "s", 0.0, max(float(flight.time[-1]) for flight in flights) or 1.0)


def _ends(lines: Sequence[Line | Area]) -> FloatArray:
    return np.concatenate([[np.nanmin(line.y), np.nanmax(line.y), 0.0] for line in lines])


def _carrying(flight: Flight) -> str:
    return "with" if flight.ocs else "without"
