"""Every motor behind every gear, as arrays."""

from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from ocs_design.arrays import FloatArray
from ocs_design.drive.gear import DIRECT, Gear
from ocs_design.drive.line import (
    DriveLine,
    armature,
    drive_line,
    missing_figures,
    rotor_share,
)
from ocs_design.drive.motor import Motor
from ocs_design.sizing.carrier import drive_carrier
from ocs_design.sizing.selection.problem import SelectionProblem
from ocs_design.sizing.web import NO_HUB, hub_of

OVERSPEED = 1.2
"""Speed at which a rim is proved, over the highest that it can get to."""


@dataclass(frozen=True, eq=False)
class DriveTable:
    """Drives, one per entry of each array.

    Attributes:
        motor, gear: their indices in the problem's sequences.
        mass: of motor, gear and the wheel's hub [kg].
        axial_inertia: of motor and gear, see `Carrier` [kg m^2].
        transverse_inertia: of these and the hub [kg m^2].
        rotor_share, hub_share: of the spin inertia [kg m^2].
        hub_radius: [m]; 0 without a web.
        armature: what the motor accelerates beyond the spin inertia [kg m^2].
        stall_torque, no_load_speed, torque_limit, speed_max: see `DriveLine`, nothing held back.
    """

    motor: NDArray[np.intp]
    gear: NDArray[np.intp]
    mass: FloatArray
    axial_inertia: FloatArray
    transverse_inertia: FloatArray
    rotor_share: FloatArray
    hub_share: FloatArray
    hub_radius: FloatArray
    armature: FloatArray
    stall_torque: FloatArray
    no_load_speed: FloatArray
    torque_limit: FloatArray
    speed_max: FloatArray

    def __len__(self) -> int:
        return self.motor.size

    def take(self, rows: NDArray[np.intp] | NDArray[np.bool_]) -> "DriveTable":
        """The drives of these rows."""
        return DriveTable(*(getattr(self, field.name)[rows] for field in fields(self)))

    @property
    def beside_rim(self) -> FloatArray:
        """What of the spin inertia rim and web need not have [kg m^2]."""
        return self.rotor_share + self.hub_share

    @property
    def line(self) -> DriveLine:
        """What a design may use of each."""
        whole = DriveLine(self.stall_torque, self.no_load_speed, self.torque_limit, self.speed_max)
        return whole.reserved()

    @property
    def top_speed(self) -> FloatArray:
        """That a design may use of each [rad/s]."""
        return np.minimum(self.line.no_load_speed, self.speed_max)

    @property
    def overspeed(self) -> FloatArray:
        """At which the hoop stress of a rim is limited [rad/s]."""
        return OVERSPEED * np.minimum(self.no_load_speed, self.speed_max)


def known_pairs(motors: Sequence[Motor], gears: Sequence[Gear]) -> NDArray[np.bool_]:
    """Whether all figures are known that a motor behind a gear needs, shape (motors, gears)."""
    # What is needed depends on no more of a gear than this.
    kinds = {(gear.ratio <= 1.0, gear.reverses): gear for gear in gears}
    known = {
        kind: [not missing_figures(motor, gear) for motor in motors] for kind, gear in kinds.items()
    }
    columns = [known[gear.ratio <= 1.0, gear.reverses] for gear in gears]
    return np.array(columns, dtype=np.bool_).reshape(len(gears), len(motors)).T


def drive_table(problem: SelectionProblem, pairs: NDArray[np.intp]) -> DriveTable:
    """Drives of the problem.

    Args:
        problem: motors, gears, bus voltage, stated highest speed of a wheel.
        pairs: indices of motor and gear, whose figures are known, shape (n, 2).
    """
    rows = [
        (m, g, *_figures(problem, problem.motors[m], problem.gears[g])) for m, g in pairs.tolist()
    ]
    columns = np.array(rows, dtype=np.float64).reshape(-1, len(fields(DriveTable))).T.copy()
    if problem.wheel_speed_max is not None:
        columns[-1] = np.minimum(columns[-1], problem.wheel_speed_max)
    return DriveTable(columns[0].astype(np.intp), columns[1].astype(np.intp), *columns[2:])


def _figures(problem: SelectionProblem, motor: Motor, gear: Gear) -> tuple[float, ...]:
    line, carrier = drive_line(motor, gear, problem.bus_voltage), drive_carrier(motor, gear)
    hub = hub_of(motor, direct=gear == DIRECT) if problem.web else NO_HUB
    rotor = motor.rotor_inertia or 0.0
    return (
        carrier.mass + hub.mass,
        carrier.axial_inertia,
        carrier.transverse_inertia + hub.transverse_inertia,
        rotor_share(rotor, gear),
        hub.axial_inertia,
        hub.radius,
        armature(rotor, gear),
        float(line.stall_torque),
        float(line.no_load_speed),
        float(line.torque_limit),
        float(line.speed_max),
    )
