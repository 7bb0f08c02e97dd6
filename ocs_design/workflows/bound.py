"""Answer of `bound`: the lower bound for given figures, and its curve."""

import numpy as np

from ocs_design.common.errors import UsageError
from ocs_design.common.units import Dimension
from ocs_design.device.answers import BoundAnswer
from ocs_design.requirement.bound import (
    AXES,
    bound_curve,
    corrected_bound,
    elroy_beanie_bound,
    per_wheel,
)
from ocs_design.requirement.values import INCIDENCE, TRUNK_RATE, WHEEL_RATE, Quantity

CURVE_FACTORS = (0.25, 0.5, 1.0, 2.0, 4.0)
"""Rate changes and wheel speeds of the curve, relative to the given ones."""


def bound_by_hand(
    *, inertia: str, rate_change: str, wheel_speed_max: str, alpha: str, axis: str
) -> BoundAnswer:
    """The bound for quantities as written on the command line.

    Raises:
        QuantityError, UsageError: a quantity or the axis cannot be read, or is out of range.
    """
    if axis not in AXES:
        raise UsageError(f"--axis {axis}: must be pitch or roll")
    moment = Quantity(Dimension.INERTIA).read(inertia, "--inertia")
    rate = TRUNK_RATE.read(rate_change, "--rate-change")
    speed = WHEEL_RATE.read(wheel_speed_max, "--wheel-speed-max")
    incidence = INCIDENCE.read(alpha, "--alpha")
    required = corrected_bound(moment, rate, speed)
    about = np.array([required if name == axis else 0.0 for name in AXES])
    spin_inertia = per_wheel(about, incidence)
    if not np.isfinite(spin_inertia):
        raise UsageError(
            f"no wheel can do this about {axis}: at alpha {alpha} and {wheel_speed_max} "
            "it would be infinitely large",
            hint="reduce the rate change below the wheel's speed, or choose an incidence that "
            "reaches the axis",
        )
    rates = tuple(factor * rate for factor in CURVE_FACTORS)
    speeds = tuple(factor * speed for factor in CURVE_FACTORS)
    return BoundAnswer(
        axis=axis,
        inertia=moment,
        rate_change=rate,
        wheel_speed_max=speed,
        incidence=incidence,
        paper=elroy_beanie_bound(moment, rate, speed),
        required=required,
        spin_inertia=spin_inertia,
        rate_changes=rates,
        wheel_speeds=speeds,
        curve=tuple(tuple(map(float, row)) for row in bound_curve(rates, speeds)),
    )
