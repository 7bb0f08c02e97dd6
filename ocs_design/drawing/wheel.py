"""What a drawing of a wheel shows, SI."""

from dataclasses import dataclass, replace
from enum import Enum
from functools import cached_property

from ocs_design.drawing.balancing import FLYWHEEL_GRADE
from ocs_design.drawing.tolerances import Grade, plus_minus, tolerance_width
from ocs_design.parts.part import total
from ocs_design.parts.wheel import Wheel
from ocs_design.parts.wheel_parts import wheel_parts
from ocs_design.robot.mass_properties import MassProperties


class Seat(Enum):
    """How the rim is held; the value stands behind its bore's dimension."""

    FREE = ""
    ONE_PIECE = "one piece"
    FITTED = "H7/h6"


@dataclass(frozen=True)
class WheelDrawing:
    """A wheel with what its title block says.

    Attributes:
        wheel: as it is made.
        robot: name of what it is made for.
        identity: of the design, such as the beginning of its hash.
        tool: program and version.
        speed: highest in service [rad/s]; None: not limited.
        grade: of balance [mm/s].
    """

    wheel: Wheel
    robot: str
    identity: str
    tool: str
    speed: float | None
    grade: float = FLYWHEEL_GRADE

    @cached_property
    def masses(self) -> tuple[float, ...]:
        """Of each piece, the rim first [kg]."""
        return tuple(part.mass_properties().mass for part in wheel_parts(self.wheel))

    @cached_property
    def mass_properties(self) -> MassProperties:
        """Of the whole wheel, without the motor's rotor."""
        return total(wheel_parts(self.wheel))


BROKEN_EDGE = 0.2e-3
"""Of edges without indication, at 45 degrees [m]."""


def seat(wheel: Wheel) -> Seat:
    """How the rim is held."""
    if wheel.hub is None:
        return Seat.FREE
    return Seat.ONE_PIECE if wheel.one_piece else Seat.FITTED


def widest(wheel: Wheel) -> float:
    """Largest extent along the axis [m]."""
    return max(wheel.rim.height, 0.0 if wheel.hub is None else wheel.hub.height)


def lost_by_breaking(wheel: Wheel) -> tuple[float, float]:
    """What breaking the rim's sharp edges takes: mass [kg], and share of the wheel's inertia."""
    sharp, broken = (
        total(wheel_parts(Wheel(replace(wheel.rim, chamfer=chamfer, balancing=None))))
        for chamfer in (0.0, BROKEN_EDGE)
    )
    whole = total(wheel_parts(wheel)).inertia[2, 2]
    return sharp.mass - broken.mass, float((sharp.inertia - broken.inertia)[2, 2] / whole)


def rim_inertia_error(wheel: Wheel) -> float:
    """Largest relative error of the rim's spin inertia within the tolerances of its sizes.

    To first order, I = pi rho h (R^4 - r^4) / 2: 4 (R^3 dR + r^3 dr) / (R^4 - r^4) + dh / h.
    """
    r, R, h = wheel.rim.inner_radius, wheel.rim.outer_radius, wheel.rim.height
    outer = plus_minus(2.0 * R, Grade.IT9) / 2.0
    if seat(wheel) is Seat.FITTED:
        inner = tolerance_width(2.0 * r, Grade.IT7) / 2.0
    else:
        inner = plus_minus(2.0 * r, Grade.IT9) / 2.0
    return 4.0 * (R**3 * outer + r**3 * inner) / (R**4 - r**4) + plus_minus(h, Grade.IT11) / h
