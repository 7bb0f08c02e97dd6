"""Candidates as arrays: every motor behind every gear, with a rim of every material."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ocs_design.actuation.drive import (
    DriveLine,
    armature,
    drive_line,
    missing_figures,
    rotor_share,
)
from ocs_design.actuation.motor import Gear, GearRoom, Motor
from ocs_design.common.arrays import FloatArray, Table
from ocs_design.parts.foot import PLATE_THICKNESS
from ocs_design.parts.housing import half_height
from ocs_design.parts.module import (
    Printed,
    drive_moments,
    gear_moments,
    motor_middle,
    shell_moments,
)
from ocs_design.parts.moments import MassMoments, round_body, stacked
from ocs_design.parts.motor_mount import mount_of
from ocs_design.parts.printed import WALL
from ocs_design.parts.rim import NO_HUB, WEB_THICKNESS, cylinder_transverse_inertia
from ocs_design.sizing.bound.rim_problem import (
    RimLimits,
    RimProblem,
    limits_with_mount,
    limits_with_web,
    smallest_spin_inertia,
)
from ocs_design.sizing.lightest_module import ModuleShape, lightest_module_at
from ocs_design.sizing.placement import module_size
from ocs_design.sizing.selection.composite_inertia import Modules
from ocs_design.sizing.selection.problem import SelectionProblem

OVERSPEED = 1.2
"""Speed at which a rim is proved, over the highest that it can get to."""

_OFF_THE_EDGE = 1.0 + 1e-10
"""Factor on the smallest rim of all, which must not get lost to rounding."""

_NOTHING = 1e-12
"""Spin inertia below that of any wheel [kg m^2]."""


@dataclass(frozen=True, eq=False)
class Drives(Table):
    """Motors behind gears, one per row.

    Attributes:
        motor, gear: their indices in the problem's sequences.
        behind: moments of motor, gear and mount, less its holes, about the middle of the outside of
            the housing's floor (`module.behind_floor`).
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

    @property
    def mass(self) -> FloatArray:
        """Mass of motor, gear and the wheel's hub, less the mount's holes [kg]."""
        return self.behind.mass + self.hub_mass

    @property
    def beside_rim(self) -> FloatArray:
        """Part of the spin inertia that rim and web need not have [kg m^2]."""
        return self.rotor_share + self.hub_share

    @property
    def line(self) -> DriveLine:
        """Voltage lines and limits that a design may use."""
        whole = DriveLine(self.stall_torque, self.no_load_speed, self.torque_limit, self.speed_max)
        return whole.reserved()

    @property
    def top_speed(self) -> FloatArray:
        """Speed of the wheel that a design may use [rad/s]."""
        return np.minimum(self.line.no_load_speed, self.speed_max)

    @property
    def overspeed(self) -> FloatArray:
        """Speed at which the hoop stress of a rim is limited [rad/s]."""
        return OVERSPEED * np.minimum(self.no_load_speed, self.speed_max)


@dataclass(frozen=True, eq=False)
class Candidates(Table):
    """Drives with a rim of one material each, one per row.

    Attributes:
        problem: robot, requirement and room, shared by all.
        drives: motor and gear of each. material: its index in the problem's sequence.
    """

    problem: SelectionProblem
    drives: Drives
    material: NDArray[np.intp]

    def __len__(self) -> int:
        return self.material.size

    @cached_property
    def limits(self) -> RimLimits:
        """Limits of their rims."""
        drives = self.drives
        return rim_limits(
            self.problem, self.material, drives.overspeed, drives.hub_radius, drives.mount_reach
        )

    @property
    def shell(self) -> Printed:
        """Housing and foot around their wheels."""
        return Printed(self.drives.mount_reach)

    @cached_property
    def least_spin_inertia(self) -> FloatArray:
        """Spin inertia with the smallest rim that the lower limits leave [kg m^2], positive.

        A rotor that turns against its wheel may have as much momentum as the smallest rim.
        """
        least = smallest_spin_inertia(self.limits) * _OFF_THE_EDGE + self.drives.beside_rim
        return np.maximum(least, _NOTHING)

    def shapes_at(self, spin_inertia: FloatArray, radius: FloatArray) -> ModuleShape:
        """Lightest modules of these spin inertias [kg m^2] with outer radii near these [m]."""
        rim = spin_inertia - self.drives.beside_rim
        return lightest_module_at(rim, radius, self.limits, self.shell)

    def modules(self, spin_inertia: FloatArray, shapes: ModuleShape) -> Modules:
        """One module of each candidate, braked."""
        drives, wheel = self.drives, spin_inertia - self.drives.rotor_share
        inner, outer, height = shapes.inner_radius, shapes.outer_radius, shapes.height
        across = cylinder_transverse_inertia(inner, outer, height, 1.0)
        across = across - self.limits.cuts.transverse_inertia(inner, outer, height, 1.0)
        across = across * self.limits.density
        # A web's mass tells its thickness: m (3 r^2 + t^2) / 12.
        web = shapes.web_mass * (3.0 * inner**2 + WEB_THICKNESS**2) / 12.0
        mass = shapes.rim_mass + shapes.web_mass + drives.hub_mass
        whole = (
            round_body(mass, wheel, across + web + drives.hub_across)
            + shell_moments(outer, height, drives.mount_reach)
            + drives.behind.shifted(-half_height(height), np.zeros_like(height))
        )
        size = module_size(
            outer, height, drives.behind_depth, drives.behind_radius, drives.mount_reach
        )
        return Modules.of(whole, size)


def rim_limits(
    problem: SelectionProblem,
    material: NDArray[np.intp],
    overspeed: FloatArray,
    hub_radius: FloatArray,
    mount_reach: FloatArray,
) -> RimLimits:
    """Limits of rims, one per row.

    Args:
        problem: room and materials.
        material: index of each. overspeed: at which its hoop stress is limited [rad/s].
        hub_radius: in its middle [m]. mount_reach: of the holes in its housing's floor [m].
    """
    room = problem.envelope
    each = [RimProblem(0.0, room, kind, 1.0).limits for kind in problem.materials]
    figures = np.array([(one.density, one.stretch_max, one.poisson_ratio) for one in each])
    density, stretch, poisson_ratio = figures[material].T
    alone = RimLimits(
        density=density,
        outer_radius_max=room.outer_radius_max,
        inner_radius_min=np.full_like(density, room.inner_radius_min),
        height_max=room.height_max,
        height_min=np.full_like(density, room.height_min),
        wall_min=room.wall_min,
        mass_max=room.mass_max,
        # The hoop stress grows with the square of the speed, from that at 1 rad/s.
        stretch_max=stretch / overspeed**2,
        poisson_ratio=poisson_ratio,
        web=np.zeros_like(density),
    )
    mounted = limits_with_mount(alone, mount_reach)
    return limits_with_web(mounted, hub_radius, problem.cuts) if problem.web else mounted


def known_pairs(motors: Sequence[Motor], gears: Sequence[Gear]) -> NDArray[np.bool_]:
    """Whether all figures are known that a motor behind a gear needs, shape (motors, gears)."""
    # Which figures are needed depends on no more of a gear than this.
    kinds = {(gear.ratio <= 1.0, gear.reverses): gear for gear in gears}
    known = {
        kind: [not missing_figures(motor, gear) for motor in motors] for kind, gear in kinds.items()
    }
    columns = [known[gear.ratio <= 1.0, gear.reverses] for gear in gears]
    return np.array(columns, dtype=np.bool_).reshape(len(gears), len(motors)).T


def drives_of(problem: SelectionProblem, pairs: NDArray[np.intp]) -> Drives:
    """Drives of the problem.

    Args:
        problem: motors, gears, bus voltage, stated highest speed of a wheel.
        pairs: indices of motor and gear, whose figures are known, shape (n, 2).
    """
    motors, gears = pairs.T
    figures: list[tuple[float, ...]] = []
    for index, gear_index in pairs.tolist():
        motor, gear = problem.motors[index], problem.gears[gear_index]
        line, hub = drive_line(motor, gear, problem.bus_voltage), problem.hub(motor, gear) or NO_HUB
        rotor, top = motor.rotor_inertia or 0.0, problem.wheel_speed_max or np.inf
        figures.append(
            (
                hub.mass,
                hub.radius,
                hub.axial_inertia,
                hub.transverse_inertia,
                rotor_share(rotor, gear),
                armature(rotor, gear),
                float(line.stall_torque),
                float(line.no_load_speed),
                float(line.torque_limit),
                min(float(line.speed_max), top),
            )
        )
    columns = np.array(figures, dtype=np.float64).reshape(len(figures), -1).T.copy()
    seats = _seats(problem, pairs)
    if problem.web:
        columns[1] = np.maximum(columns[1], seats.head_reach)
    return Drives(motors, gears, seats.behind, *seats.columns, *columns)


class _Seats(NamedTuple):
    """Places of the motors behind their floors, see `Drives`.

    Attributes:
        behind: see there.
        columns: depth, radius, reach and mass of the mount's holes, shape (4, n).
        head_reach: of the screws in the housing [m], shape (n,).
    """

    behind: MassMoments[FloatArray]
    columns: FloatArray
    head_reach: FloatArray


def _seats(problem: SelectionProblem, pairs: NDArray[np.intp]) -> _Seats:
    """Each motor is looked at once on its wheel and once behind any gear, each gear once."""
    known, of_motor = np.unique(pairs[:, 0], return_inverse=True)
    motors = [problem.motors[m] for m in known.tolist()]
    # One row per motor behind a gear, and the next for the motor with the wheel on its shaft.
    held = [(motor, mount_of(motor, room)) for motor in motors for room in (GearRoom(), None)]
    rows = np.array(
        [
            (
                *mount.behind(motor),
                mount.holes.reach,
                -mount.holes.cut_out(WALL + PLATE_THICKNESS).mass,
                mount.head_reach,
                motor_middle(motor, mount),
            )
            for motor, mount in held
        ]
    )
    gears = [problem.gears[g].room for g in pairs[:, 1].tolist()]
    row = 2 * of_motor + np.array([room is None for room in gears])
    depth = np.array([0.0 if room is None else room.depth for room in gears])
    up = np.array([0.0 if room is None else room.offset for room in gears])
    seats = rows[row].T
    seats[0] += depth
    alone = stacked([drive_moments(motor) for motor in motors]).take(of_motor)
    geared = stacked([gear_moments(gear) for gear in problem.gears]).take(pairs[:, 1])
    mounts = stacked([mount.moments() for _, mount in held]).take(row)
    return _Seats(alone.shifted(seats[5] - depth, up) + geared + mounts, seats[:4], seats[4])
