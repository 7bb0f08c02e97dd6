"""Every motor behind every gear, as arrays."""

from collections.abc import Sequence
from dataclasses import dataclass, fields
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ocs_design.arrays import FloatArray
from ocs_design.drive.gear import Gear, GearRoom
from ocs_design.drive.line import (
    DriveLine,
    armature,
    drive_line,
    missing_figures,
    rotor_share,
)
from ocs_design.drive.motor import Motor
from ocs_design.sizing.foot import PLATE_THICKNESS
from ocs_design.sizing.housing import WALL
from ocs_design.sizing.mass_moments import MassMoments, rows_of, stacked
from ocs_design.sizing.motor_mount import MotorMount, mount_of
from ocs_design.sizing.selection.problem import SelectionProblem
from ocs_design.sizing.standing import drive_moments, gear_moments, motor_middle
from ocs_design.sizing.web import NO_HUB

OVERSPEED = 1.2
"""Speed at which a rim is proved, over the highest that it can get to."""


@dataclass(frozen=True, eq=False)
class DriveTable:
    """Drives, one per entry of each array.

    Attributes:
        motor, gear: their indices in the problem's sequences.
        behind: of motor, gear and mount, less its holes; see `standing.behind_floor`.
        behind_depth, behind_radius: see `MotorMount.behind` [m].
        mount_reach, mount_mass: of the mount's holes [m, kg].
        hub_mass: of the wheel's hub [kg].
        hub_radius: of that, or of the screws' heads beside it [m]; 0 without a web.
        hub_share: of the spin inertia. hub_across: about any axis across [kg m^2].
        rotor_share: of the spin inertia [kg m^2].
        armature: what the motor accelerates beyond the spin inertia [kg m^2].
        stall_torque, no_load_speed, torque_limit, speed_max: see `DriveLine`, nothing held back.
    """

    motor: NDArray[np.intp]
    gear: NDArray[np.intp]
    behind: MassMoments[FloatArray]
    behind_depth: FloatArray
    behind_radius: FloatArray
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
    seats = _Seats.of(problem, pairs)
    if problem.web:
        columns[1] = np.maximum(columns[1], seats.head_reach)
    return DriveTable(motors, gears, seats.behind, *seats.columns, *columns)


class _Seats(NamedTuple):
    """Where the motors of some pairs stand, see `DriveTable`.

    Attributes:
        behind: see there. columns: depth, radius, reach and mass of holes, shape (4, n).
        head_reach: of the screws in the housing [m], shape (n,).
    """

    behind: MassMoments[FloatArray]
    columns: FloatArray
    head_reach: FloatArray

    @classmethod
    def of(cls, problem: SelectionProblem, pairs: NDArray[np.intp]) -> "_Seats":
        """Each motor is looked at once on its wheel and once behind any gear, each gear once."""
        known, of_motor = np.unique(pairs[:, 0], return_inverse=True)
        motors = [problem.motors[m] for m in known.tolist()]
        mounts = [(mount_of(motor, GearRoom()), mount_of(motor, None)) for motor in motors]
        held = stacked([mount.moments() for both in mounts for mount in both])
        rows = [
            [_seat(motor, mount) for mount in both]
            for motor, both in zip(motors, mounts, strict=True)
        ]
        rooms = np.array([_room(gear) for gear in problem.gears])[pairs[:, 1]]
        direct, depth, up = rooms[:, 0].astype(np.intp), rooms[:, 1], rooms[:, 2]
        seats = np.array(rows)[of_motor, direct].T
        seats[0] += depth
        alone = rows_of(stacked([drive_moments(motor) for motor in motors]), of_motor)
        gears = stacked([gear_moments(gear) for gear in problem.gears])
        behind = (
            alone.shifted(seats[5] - depth, up)
            + rows_of(gears, pairs[:, 1])
            + rows_of(held, 2 * of_motor + direct)
        )
        return cls(behind, seats[:4], seats[4])


def _seat(motor: Motor, mount: MotorMount) -> tuple[float, ...]:
    """How far back and to the sides, of the holes reach and what they take, heads, middle."""
    lost = -mount.holes.cut_out(WALL + PLATE_THICKNESS).mass
    middle = motor_middle(motor, mount)
    return (*mount.behind(motor), mount.holes.reach, lost, mount.head_reach, middle)


def _room(gear: Gear) -> tuple[float, float, float]:
    """1 if there is no gear, and how deep and how far up it is [m]."""
    return (1.0, 0.0, 0.0) if gear.room is None else (0.0, gear.room.depth, gear.room.offset)


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
