"""What `bound` answers: the lower bound by hand, and its curve."""

from dataclasses import dataclass

import msgspec
import numpy as np

from ocs_design.design_file import SCHEMA_VERSION
from ocs_design.exceptions import UsageError
from ocs_design.requirement.bound import AXES, authority, bound_curve, spin_bound
from ocs_design.units import Dimension, parse_quantity

CURVE_POINTS = (0.25, 0.5, 1.0, 2.0, 4.0)
"""Rate changes and wheel speeds of the curve, over those asked for."""


@dataclass(frozen=True, kw_only=True)
class BoundAnswer:
    """A bound and where it lies on its curve; SI.

    Attributes:
        axis: "roll" or "pitch".
        inertia: of the robot about it. rate_change, wheel_speed_max, incidence: as asked.
        paper: inertia of the one-wheel model as the paper prints it.
        required: the same with the paper's sign put right; the tool sizes by this one.
        spin_inertia: of each of two wheels at the incidence, from `required`.
        rate_changes, wheel_speeds: of the curve.
        curve: required over robot's inertia, a row for each wheel speed.
    """

    schema_version: int
    axis: str
    inertia: float
    rate_change: float
    wheel_speed_max: float
    incidence: float
    paper: float
    required: float
    spin_inertia: float
    rate_changes: tuple[float, ...]
    wheel_speeds: tuple[float, ...]
    curve: tuple[tuple[float, ...], ...]


def bound_by_hand(
    *, inertia: str, rate_change: str, wheel_speed_max: str, alpha: str, axis: str
) -> BoundAnswer:
    """The bound for quantities as they are written on the command line.

    Raises:
        QuantityError, UsageError: a quantity or the axis cannot be read, or is out of range.
    """
    if axis not in AXES:
        raise UsageError(f"--axis {axis}: is neither pitch nor roll")
    moment = _positive(inertia, Dimension.INERTIA, "--inertia")
    rate = _positive(rate_change, Dimension.ANGULAR_SPEED, "--rate-change")
    speed = _positive(wheel_speed_max, Dimension.ANGULAR_SPEED, "--wheel-speed-max")
    incidence = parse_quantity(alpha, Dimension.ANGLE, "--alpha")
    if not 0.0 <= incidence <= np.pi / 2.0:
        raise UsageError(f"--alpha {alpha}: lies outside 0 to 90 deg")
    found = spin_bound(moment, rate, speed, float(authority(incidence)[AXES.index(axis)]))
    if not np.isfinite(found.spin_inertia):
        raise UsageError(
            f"no wheel can do this about {axis}: at alpha {alpha} and {wheel_speed_max} "
            "it would be infinitely large",
            hint="ask for less than the wheel's speed, or for an incidence that reaches the axis",
        )
    rates = tuple(point * rate for point in CURVE_POINTS)
    speeds = tuple(point * speed for point in CURVE_POINTS)
    return BoundAnswer(
        schema_version=SCHEMA_VERSION,
        axis=axis,
        inertia=moment,
        rate_change=rate,
        wheel_speed_max=speed,
        incidence=incidence,
        paper=found.paper,
        required=found.required,
        spin_inertia=found.spin_inertia,
        rate_changes=rates,
        wheel_speeds=speeds,
        curve=tuple(tuple(map(float, row)) for row in bound_curve(rates, speeds)),
    )


def bound_to_json(answer: BoundAnswer) -> bytes:
    """As indented UTF-8 JSON; what is infinite is null."""
    return msgspec.json.format(msgspec.json.encode(answer), indent=2) + b"\n"


def _positive(text: str, dimension: Dimension, option: str) -> float:
    value = parse_quantity(text, dimension, option)
    if value <= 0.0:
        raise UsageError(f"{option} {text}: must be positive")
    return value
