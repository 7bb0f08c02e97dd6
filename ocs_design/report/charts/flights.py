"""Charts of flights: time series, paths in the torque-speed plane, and Monte Carlo histograms."""

from collections.abc import Callable, Collection, Iterator, Sequence

import numpy as np

from ocs_design.actuation.drive import RESERVE, Drive
from ocs_design.common.arrays import FloatArray
from ocs_design.common.files import safe_name
from ocs_design.common.units import to_unit
from ocs_design.common.wording import in_unit
from ocs_design.device.answers import MonteCarloRecord
from ocs_design.parts.module import part_name
from ocs_design.report.charts.chart import SERIES, Axis, Chart, Curve, FilledArea, Ink, Mark, Rule
from ocs_design.report.story import RecordedFlight
from ocs_design.robot.stance import LANDING_TOLERANCE

_HEIGHT, _HISTOGRAM = 236.0, 200.0
"""Heights of the charts [px]."""

_SPEED_SAMPLES = 121
"""Speeds at which the edge of the drive's range is drawn."""

_TILT_AXES = (("pitch", "y", Ink.BLUE), ("roll", "x", Ink.VERMILION))


def time_charts(scenario: str, flights: Sequence[RecordedFlight]) -> Iterator[Chart]:
    """Time series of the flights of one maneuver: attitude, rates, wheel speeds and torques.

    The flight with the device comes first.
    """
    tolerance = to_unit(LANDING_TOLERANCE, "deg")
    on_pivot = any(flight.record.was_on_pivot for flight in flights)
    rule_name = f"allowed {'when due' if on_pivot else 'at touchdown'}"
    allowed = [
        Rule(side * tolerance, upright=False, ink=Ink.FAINT, name=rule_name) for side in (-1.0, 1.0)
    ]

    def chart(
        kind: str,
        title: str,
        description: str,
        axis: tuple[str, str],
        curves: Sequence[Curve | FilledArea],
        *,
        of_flights: Sequence[RecordedFlight] = flights,
        rules: Sequence[Rule] = (),
        ends: Sequence[float] = (),
    ) -> Chart:
        end = max(float(flight.time[-1]) for flight in of_flights) or 1.0
        extremes = [(np.nanmin(curve.y), np.nanmax(curve.y), 0.0) for curve in curves]
        return Chart(
            name=f"{kind}_{safe_name(scenario)}",
            title=f"{scenario}: {title}",
            description=description,
            x=Axis("time", "s", 0.0, end),
            y=Axis.around(*axis, [*ends, *np.ravel(extremes)]),
            marks=(*curves, *rules, *_events(of_flights)),
            height=_HEIGHT,
        )

    yield chart(
        "tilt",
        "attitude of the trunk",
        "Pitch and roll over time, solid with the device, dashed without it; rules "
        f"at {tolerance:.0f} degrees either side of level are the landing tolerance.",
        ("angle", "deg"),
        _tilt_curves(flights, "{axis}_rad", "deg", thin=False),
        rules=allowed,
        ends=[-2.0 * tolerance, 2.0 * tolerance],
    )
    yield chart(
        "rates",
        "rates of the trunk",
        "Pitch and roll rate over time, solid with the device, dashed without it.",
        ("rate", "deg/s"),
        _tilt_curves(flights, "rate_{letter}_rad_s", "deg/s", thin=True),
    )
    for flight in flights:
        if not flight.record.ocs:
            continue
        yield chart(
            "wheel_speed",
            "speed of the wheels",
            "Speed of each wheel relative to the trunk over time.",
            ("wheel speed", "rpm"),
            _wheel_curves(flight, flight.wheel_speed, "rpm", "wheel", thin=False),
            of_flights=[flight],
        )
        # Torque range of the first motor; none if its torque is not limited.
        torque_range = []
        lowest, highest = (
            flight.columns.get(f"wheel_torque_{end}_{flight.wheels[0]}_nm")
            for end in ("lowest", "highest")
        )
        if lowest is not None and highest is not None:
            there_and_back = np.concatenate([flight.time, flight.time[::-1]])
            outline = np.concatenate([highest, lowest[::-1]])
            torque_range = [FilledArea(there_and_back, outline, Ink.FAINT, "range of the motor")]
        yield chart(
            "wheel_torque",
            "torque of the motors",
            "Torque of each motor on its wheel over time, within the shaded range that the first "
            "one can give at its speed.",
            ("torque", "N m"),
            [*torque_range, *_wheel_curves(flight, flight.wheel_torque, "N m", "motor", thin=True)],
            of_flights=[flight],
        )


def _tilt_curves(
    flights: Sequence[RecordedFlight], column: str, unit: str, *, thin: bool
) -> list[Curve]:
    """Curves of pitch and roll of each flight, dashed where it has no device."""
    return [
        Curve(
            flight.time,
            in_unit(flight.columns[column.format(axis=axis, letter=letter)], unit),
            ink,
            f"{axis} {'with' if flight.record.ocs else 'without'}",
            dashed=not flight.record.ocs,
            thin=thin,
        )
        for flight in flights
        for axis, letter, ink in _TILT_AXES
    ]


def _wheel_curves(
    flight: RecordedFlight, series: Callable[[str], FloatArray], unit: str, part: str, *, thin: bool
) -> list[Curve]:
    """Curve of each wheel or motor, every other one dashed."""
    return [
        Curve(
            flight.time,
            in_unit(series(wheel), unit),
            ink,
            part_name(part, wheel),
            dashed=index % 2 == 1,
            thin=thin,
        )
        for index, (wheel, ink) in enumerate(zip(flight.wheels, SERIES, strict=False))
    ]


def _events(flights: Sequence[RecordedFlight]) -> list[Rule]:
    """Rules at the last lift-off, or push, and at the first touchdown of the flights."""
    records = [flight.record for flight in flights]
    lift_off = max((record.lift_off or 0.0 for record in records), default=0.0)
    touchdowns = [
        record.touchdown
        for record in records
        if record.was_airborne and record.touchdown is not None
    ]
    start_label = "lift-off" if any(record.was_airborne for record in records) else "push"
    times = [(lift_off, start_label)] if lift_off > 0.0 else []
    end_label = "upright by now" if any(record.was_on_pivot for record in records) else "touchdown"
    times += [(min(touchdowns), end_label)] if touchdowns else []
    return [Rule(time, upright=True, label=label, ink=Ink.FAINT) for time, label in times]


def _largest_torque(motor: Drive, speed: FloatArray, share: float) -> FloatArray:
    """Largest forward torque at the wheel at a speed, with a share of voltage and current [N m]."""
    if motor.stall_torque is None:
        torque = np.where(np.abs(speed) <= share * motor.no_load_speed, np.inf, 0.0)
    else:
        torque = motor.stall_torque * (share - speed / motor.no_load_speed)
    limit = np.inf if motor.torque_limit is None else share * motor.torque_limit
    return np.asarray(np.minimum(limit, np.maximum(torque, 0.0)))


def drive_charts(motor: Drive, flights: Sequence[RecordedFlight]) -> Iterator[Chart]:
    """Torque and speed in all four quadrants; none if no flight has the device."""
    with_device = [flight for flight in flights if flight.record.ocs]
    if not with_device:
        return
    # The path of each wheel up to the instant of the verdict; the rest is not part of the maneuver.
    paths = [
        Curve(
            in_unit(flight.wheel_speed(wheel)[flight.driven_samples], "rpm"),
            flight.wheel_torque(wheel)[flight.driven_samples],
            ink,
            "" if index else flight.record.scenario,
            dashed=index > 0,
        )
        for flight, ink in zip(with_device, SERIES * 2, strict=False)
        for index, wheel in enumerate(flight.wheels)
    ]
    top_path_speed = max(float(np.nanmax(np.abs(path.x))) for path in paths)
    top_path_torque = max(float(np.nanmax(np.abs(path.y))) for path in paths)
    no_load = in_unit(min(motor.no_load_speed, 3.0 * np.pi / 30.0 * top_path_speed), "rpm")
    speed_half_range = max(top_path_speed, no_load) or 1.0
    torque_half_range = 1.15 * max(top_path_torque, motor.torque_limit or 0.0) or 1.0
    speed_max_rpm = np.inf if motor.speed_max is None else in_unit(motor.speed_max, "rpm")
    outline_speed = min(speed_half_range, speed_max_rpm)
    marks: list[Mark] = []
    # Whole range of the drive, and the limit that the design may use.
    speed_rpm = np.linspace(-outline_speed, outline_speed, _SPEED_SAMPLES)
    speed = speed_rpm * np.pi / 30.0
    is_limited = motor.stall_torque is not None or motor.torque_limit is not None
    for share in (1.0, RESERVE) if is_limited else ():
        high = np.minimum(_largest_torque(motor, speed, share), 2.0 * torque_half_range)
        low = -np.minimum(_largest_torque(motor, -speed, share), 2.0 * torque_half_range)
        x = np.concatenate([speed_rpm, speed_rpm[::-1], speed_rpm[:1]])
        y = np.concatenate([high, low[::-1], high[:1]])
        if share == 1.0:
            marks.append(FilledArea(x, y, Ink.FAINT, "range of the drive"))
        else:
            marks.append(Curve(x, y, Ink.FAINT, f"{share:.0%} of it", dashed=True, thin=True))
    if speed_max_rpm <= 1.05 * speed_half_range:
        marks.append(Rule(-speed_max_rpm, upright=True, ink=Ink.PLAIN))
        marks.append(Rule(speed_max_rpm, upright=True, label="top speed", ink=Ink.PLAIN))
    first, *other_wheels = (part_name("wheel", wheel) for wheel in with_device[0].wheels)
    others = other_wheels[0] if len(other_wheels) == 1 else "others"
    legend = f": solid {first}, dashed {others}" if other_wheels else ""
    yield Chart(
        name="torque_speed",
        title=f"Torque and speed of a wheel{legend}",
        description="What the drive can give at each speed of the wheel, at full voltage and "
        f"current and at the {RESERVE:.0%} that the design may use, with the path of each maneuver "
        "up to where it is judged; solid for the first wheel, dashed for the others.",
        x=Axis("wheel speed", "rpm", -1.05 * speed_half_range, 1.05 * speed_half_range),
        y=Axis("torque on the wheel", "N m", -torque_half_range, torque_half_range),
        marks=(*marks, *paths),
        height=330.0,
    )


def distribution_charts(record: MonteCarloRecord, pivots: Collection[str] = ()) -> Iterator[Chart]:
    """Histograms of the judged attitude, the peak speed and the peak torque of each scenario.

    `pivots` are the scenarios about a pivot, which have no touchdown.
    """
    for scenario in record.scenarios:
        instant = "when due" if scenario.scenario in pivots else "at touchdown"
        spreads = (
            (
                "off_level",
                f"off level {instant}",
                "deg",
                scenario.attitude_error,
                LANDING_TOLERANCE,
            ),
            ("peak_speed", "highest wheel speed", "rpm", scenario.peak_wheel_speed, None),
            ("peak_torque", "highest torque", "N m", scenario.peak_wheel_torque, None),
        )
        for name, label, unit, spread, limit in spreads:
            if spread is None:
                continue
            quantiles, counts = in_unit(np.array(spread.quantiles), unit), spread.counts
            low, median, high = quantiles[[0, len(quantiles) // 2, -1]].tolist()
            # Identical flights still get a bin of some width.
            width = max(high - low, 1e-3 * max(abs(high), 1.0))
            x = np.repeat(np.linspace(low, low + width, len(counts) + 1), 2)
            y = np.concatenate([[0.0], np.repeat(counts, 2), [0.0]]).astype(float)
            rules, ends = [Rule(median, upright=True, label="median")], [low, low + width]
            if limit is not None:
                allowed = in_unit(limit, unit)
                rules.append(Rule(allowed, upright=True, label="allowed", ink=Ink.VERMILION))
                ends.append(allowed)
            yield Chart(
                name=f"{name}_{safe_name(scenario.scenario)}",
                title=f"{scenario.scenario}: {label}",
                description=f"Histogram over all samples: {label}, with its median.",
                x=Axis.around(label, unit, ends),
                y=Axis("flights", "", 0.0, 1.1 * max(counts)),
                marks=(FilledArea(x, y, Ink.BLUE), Curve(x, y, Ink.BLUE), *rules),
                height=_HISTOGRAM,
            )
