"""The `[[maneuver]]` tables of a specification: which kinds there are, and their keys."""

from collections.abc import Mapping
from dataclasses import MISSING, dataclass, fields
from types import MappingProxyType
from typing import Any

from ocs_design.requirement.believed import INCIDENCE, TILT, TURN
from ocs_design.requirement.maneuver import Disturbance, Drop, Flip, Maneuver, Shove
from ocs_design.requirement.values import (
    Quantities,
    Quantity,
    Sign,
    Text,
    Value,
)
from ocs_design.units import Dimension


@dataclass(frozen=True)
class ManeuverKind:
    """A kind of maneuver as the file sees it.

    Attributes:
        maneuver: the class.
        values: how each of its fields is read.
    """

    maneuver: type[Maneuver]
    values: Mapping[str, Value[Any]]

    @property
    def required(self) -> tuple[str, ...]:
        """Fields that have no default."""
        return tuple(item.name for item in fields(self.maneuver) if item.default is MISSING)


_COMMON: Mapping[str, Value[Any]] = {
    "name": Text(),
    "gravity": Quantity(Dimension.ACCELERATION),
    "incidence": INCIDENCE,
}
_TIME = Quantity(Dimension.TIME)
_LONGEST_STRIDE = 5.0
"""[s]: a giraffe's takes one; a robot is watched for several."""

MANEUVER_KINDS: Mapping[str, ManeuverKind] = MappingProxyType(
    {
        "disturbance": ManeuverKind(
            Disturbance,
            {
                **_COMMON,
                "takeoff_velocity": Quantities(Dimension.SPEED, (2,)),
                "torque": Quantities(Dimension.TORQUE, (3,)),
                "onset": Quantity(Dimension.TIME, Sign.NOT_NEGATIVE),
                "duration": _TIME,
            },
        ),
        "shove": ManeuverKind(
            Shove,
            {
                **_COMMON,
                "torque": Quantities(Dimension.TORQUE, (3,)),
                "duration": _TIME,
                "settling": _TIME,
                "stride": Quantity(Dimension.TIME, Sign.NOT_NEGATIVE, most=_LONGEST_STRIDE),
            },
        ),
        "drop": ManeuverKind(
            Drop,
            {**_COMMON, "height": Quantity(Dimension.LENGTH), "roll": TILT, "pitch": TILT},
        ),
        "flip": ManeuverKind(
            Flip,
            {
                **_COMMON,
                "jump_height": Quantity(Dimension.LENGTH),
                "angle": TURN,
                "duration": _TIME,
            },
        ),
    }
)
"""Every kind by the word that `kind` takes."""


def kind_of(maneuver: Maneuver) -> tuple[str, Mapping[str, Value[Any]]]:
    """The word that `kind` takes for a maneuver, and how its fields are read."""
    return next(
        (word, kind.values)
        for word, kind in MANEUVER_KINDS.items()
        if kind.maneuver is type(maneuver)
    )
