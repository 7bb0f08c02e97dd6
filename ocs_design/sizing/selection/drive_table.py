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
from ocs_design.sizing.carrier import behind_floor, motor_middle
from ocs_design.sizing.mass_moments import MassMoments, point, rows_of, stacked
from ocs_design.sizing.mount import mount_holes
from ocs_design.sizing.selection.problem import SelectionProblem
from ocs_design.sizing.web import NO_HUB

OVERSPEED = 1.2
"""Speed at which a rim is proved, over the highest that it can get to."""


@dataclass(frozen=True, eq=False)
class DriveTable:
    """Drives, one per entry of each array.

    Attributes:
        motor, gear: their indices in the problem's sequences.
        behind: of motor and gear, less the mount's holes; see `carrier.behind_floor`.
        motor_length, motor_radius: [m]; 0 where not known.
        mount_reach, mount_mass: of the mount's holes [m, kg].
        hub_mass: of the wheel's hub [kg]. hub_radius: [m]; 0 without a web.
        hub_share: of the spin inertia. hub_across: about any axis across [kg m^2].
        rotor_share: of the spin inertia [kg m^2].
        armature: what the motor accelerates beyond the spin inertia [kg m^2].
        stall_torque, no_load_speed, torque_limit, speed_max: see `DriveLine`, nothing held back.
    """

    motor: NDArray[np.intp]
    gear: NDArray[np.intp]
    behind: MassMoments[FloatArray]
    motor_length: FloatArray
    motor_radius: FloatArray
    mount_reach: FloatArray
    mount_mass: FloatArray
    hub_mass: FloatArray
    hub_radius: FloatArray
    hub_share: FloatArray
    hub_across: FloatArray
    rotor_share: FloatArray
    armature: FloatArray
    stall_torque: FloatArray
    no_load_speed: FloatArray
    torque_limit: FloatArray
    speed_max: FloatArray

    def __len__(self) -> int:
        return self.motor.size

    def take(self, rows: NDArray[np.intp] | NDArray[np.bool_]) -> "DriveTable":
        """The drives of these rows."""
        arrays = {
            field.name: getattr(self, field.name)[rows]
            for field in fields(self)
            if field.name != "behind"
        }
        return DriveTable(behind=rows_of(self.behind, rows), **arrays)

    @property
    def mass(self) -> FloatArray:
        """Of motor, gear and the wheel's hub, less the mount's holes [kg]."""
        return self.behind.mass + self.hub_mass

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
    motors, gears = pairs.T
    rows = [_figures(problem, problem.motors[m], problem.gears[g]) for m, g in pairs.tolist()]
    columns = np.array(rows, dtype=np.float64).reshape(len(rows), -1).T.copy()
    if problem.wheel_speed_max is not None:
        columns[-1] = np.minimum(columns[-1], problem.wheel_speed_max)
    known = sorted(set(motors.tolist()))
    of_motor = np.searchsorted(known, motors)
    seats = np.array([_seat(problem.motors[m]) for m in known]).reshape(-1, 4)[of_motor].T
    return DriveTable(motors, gears, _behind(problem, pairs, known), *seats, *columns)


def _behind(
    problem: SelectionProblem, pairs: NDArray[np.intp], known: Sequence[int]
) -> MassMoments[FloatArray]:
    """What stands behind the floor, worked out once for each of the motors that are `known`."""
    alone = [
        behind_floor(motor, DIRECT, mount_holes(motor.mounting))
        for motor in (problem.motors[m] for m in known)
    ]
    middles = np.array([motor_middle(problem.motors[m]) for m in known])
    gears = np.array([problem.gears[g].mass for g in pairs[:, 1].tolist()])
    of_motor = np.searchsorted(known, pairs[:, 0])
    return rows_of(stacked(alone), of_motor) + point(gears).shifted(middles[of_motor], 0.0 * gears)


def _seat(motor: Motor) -> tuple[float, float, float, float]:
    """Length, radius, and of the mount's holes the reach and what they take."""
    holes = mount_holes(motor.mounting)
    length, radius = motor.length or 0.0, (motor.diameter or 0.0) / 2.0
    return length, radius, holes.reach, -holes.cut_out().mass


def _figures(problem: SelectionProblem, motor: Motor, gear: Gear) -> tuple[float, ...]:
    line = drive_line(motor, gear, problem.bus_voltage)
    hub = problem.hub(motor, gear) or NO_HUB
    rotor = motor.rotor_inertia or 0.0
    return (
        hub.mass,
        hub.radius,
        hub.axial_inertia,
        hub.transverse_inertia,
        rotor_share(rotor, gear),
        armature(rotor, gear),
        float(line.stall_torque),
        float(line.no_load_speed),
        float(line.torque_limit),
        float(line.speed_max),
    )
