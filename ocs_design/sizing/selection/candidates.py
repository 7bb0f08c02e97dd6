"""Candidates as arrays: motors with gears, on the robot, each with a rim of one material."""

from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ocs_design.actuation.drive import (
    DriveLine,
    armature,
    drive_line,
    missing_figures,
    power_less_friction,
    rotor_share,
)
from ocs_design.actuation.motor import DIRECT, GearRoom, Motor
from ocs_design.common.arrays import FloatArray, Table, stacked
from ocs_design.parts.joints import bell_bond_radius
from ocs_design.parts.module import Printed, gear_moments, moments_at_floor, moments_at_wheel
from ocs_design.parts.moments import MassMoments, round_body
from ocs_design.parts.motor_mount import mount_of
from ocs_design.parts.printed import CLEARANCE, PANEL, WALL, half_height
from ocs_design.parts.rim import NO_HUB, WEB_THICKNESS, cylinder_transverse_inertia
from ocs_design.sizing.bound.rim_problem import (
    OFF_THE_EDGE,
    RimLimits,
    RimProblem,
    limits_with_web,
    smallest_rim_inertia,
    stretch_beside_holes,
)
from ocs_design.sizing.lightest_module import ModuleShape, lightest_module_at
from ocs_design.sizing.place import Size
from ocs_design.sizing.selection.composite_inertia import CompositeInertia
from ocs_design.sizing.selection.drives import Drives, HubFigures, Seat
from ocs_design.sizing.selection.problem import SelectionProblem

_NO_HEIGHT, _LEAST_BELL = 1e-9, 1e-3
"""Largest height of a ring that has no room, and a radius smaller than any bell's [m]."""

_NOTHING = 1e-12
"""A spin inertia smaller than any wheel's [kg m^2]."""


@lru_cache(maxsize=1024)
def _seat(motor: Motor, room: GearRoom | None, foot_plate: float, *, on_bell: bool) -> Seat[float]:
    """Seat of one motor, which does not depend on the problem."""
    mount = mount_of(motor, room, foot_plate, on_bell=on_bell)
    return Seat(
        at_floor=moments_at_floor(motor, DIRECT, mount),
        at_wheel=moments_at_wheel(motor, mount),
        behind=mount.behind(motor),
        posts=replace(mount.posts, foot_plate=foot_plate),
        reach=mount.holes.reach,
        holes=-mount.holes.cut_out(PANEL + foot_plate).mass,
        height_max=mount.rim_height_max,
        room=mount.room,
        bell=0.0 if mount.bell is None else mount.bell.bore,
        head_reach=mount.head_reach,
        heads_rim_height=mount.heads_rim_height,
    )


@dataclass(frozen=True, eq=False)
class Candidates(Table):
    """Drives with a rim of one material each, one per row.

    Attributes:
        problem: robot, requirement and envelope, shared by all.
        pairs: motor and gear of each; the hub's material is still open.
        material: its index in the problem's sequence.
    """

    problem: SelectionProblem
    pairs: Drives
    material: NDArray[np.intp]

    def __len__(self) -> int:
        return self.material.size

    @classmethod
    def of_each_material(cls, problem: SelectionProblem, drives: Drives) -> "Candidates":
        """Every drive with a rim of every material of the problem, drive by drive."""
        kinds, rows = np.arange(len(problem.materials)), np.arange(len(drives))
        material, row = (indices.ravel() for indices in np.meshgrid(kinds, rows))
        return cls(problem, drives.take(row), material)

    @cached_property
    def drives(self) -> Drives:
        """Motor and gear of each, with the hub of its wheel."""
        return self.pairs.with_web_densities(self.problem.web_densities[self.material])

    @cached_property
    def limits(self) -> RimLimits:
        """Limits of their rims."""
        problem, drives = self.problem, self.drives
        limits = rim_limits(problem, self.material, drives.overspeed, drives.seat.reach)
        if problem.web:
            hub = drives.hub
            limits = limits_with_web(
                limits,
                hub.radius,
                problem.cuts,
                None if problem.web_material is None else problem.web_material.density,
                hub.rim_height,
                web_thickness=problem.web_thickness,
                lightened=hub.lightened,
                lightened_bore=hub.lightened_bore,
                stretch_left=stretch_beside_holes(
                    hub.lightened_stress, problem.envelope.stress_safety
                ),
            )
        elif problem.on_bell:
            limits = _around_bells(self, limits)
        return replace(limits, height_max=np.minimum(limits.height_max, drives.seat.height_max))

    @property
    def shell(self) -> Printed:
        """Housing and foot around their wheels."""
        seat, guard = self.drives.seat, self.problem.guard_wall
        return Printed(seat.reach, seat.posts, guard, self.problem.foot_plate, seat.room)

    @cached_property
    def least_spin_inertia(self) -> FloatArray:
        """Spin inertia with the smallest rim within the lower limits [kg m^2], positive.

        A rotor that turns against its wheel may cancel the momentum of the smallest rim.
        """
        least = smallest_rim_inertia(self.limits) * OFF_THE_EDGE + self.drives.inertia_beside_rim
        return np.maximum(least, _NOTHING)

    def shapes_at(self, spin_inertia: FloatArray, radius: FloatArray) -> ModuleShape:
        """Lightest modules of these spin inertias [kg m^2] with outer radii near these [m]."""
        rim = spin_inertia - self.drives.inertia_beside_rim
        return lightest_module_at(rim, radius, self.limits, self.shell)

    def modules(
        self, spin_inertia: FloatArray, shapes: ModuleShape
    ) -> tuple[MassMoments[FloatArray], Size[FloatArray]]:
        """Moments about the wheel's centre and size of one module of each candidate, braked."""
        drives, wheel = self.drives, spin_inertia - self.drives.rotor_share
        seat, guard = drives.seat, self.problem.guard_wall
        inner, outer, height = shapes.inner_radius, shapes.outer_radius, shapes.height
        transverse = cylinder_transverse_inertia(inner, outer, height, 1.0)
        transverse = transverse - self.limits.cuts.transverse_inertia(inner, outer, height, 1.0)
        transverse = transverse * self.limits.density
        web = web_inertia(self.limits, inner) / 2.0
        web = web + shapes.web_mass * self.problem.web_thickness**2 / 12.0
        mass = shapes.rim_mass + shapes.web_mass + drives.hub_mass
        housed_height = np.maximum(height, seat.room)
        moments = (
            round_body(mass, wheel, transverse + web + drives.hub.across * drives.web_density_max)
            + self.shell.moments(outer, housed_height)
            + seat.posts.moments(height)
            + seat.at_wheel
            + seat.at_floor.shifted(-half_height(housed_height), np.zeros_like(housed_height))
        )
        return moments, drives.size(outer + guard, height)

    def on_robot(self, spin_inertia: FloatArray, shapes: ModuleShape) -> CompositeInertia:
        """Composite inertia of robot and modules of each candidate."""
        problem, (module, size) = self.problem, self.modules(spin_inertia, shapes)
        centers = problem.place.centers(size) - problem.robot.com
        return CompositeInertia(problem.robot, problem.layout, module, centers)


@dataclass(frozen=True, eq=False)
class Guess(Table):
    """Initial guesses of candidates, shape (n,) each.

    Attributes:
        spin_inertia: a lower bound [kg m^2].
        mass: a lower bound of all modules' mass [kg]; inf: infeasible.
        angle: incidence [rad]. width: range around it to search [rad]; 0: only there.
    """

    spin_inertia: FloatArray
    mass: FloatArray
    angle: FloatArray
    width: FloatArray


def web_inertia(limits: RimLimits, bore: FloatArray) -> FloatArray:
    """Inertia of webs about their axes in rims of these bore radii [m], without hubs [kg m^2]."""
    return np.asarray(np.pi / 2.0 * np.asarray(limits.density) * limits.web * bore**4)


def rim_limits(
    problem: SelectionProblem,
    material: NDArray[np.intp],
    overspeed: FloatArray,
    mount_reach: FloatArray,
) -> RimLimits:
    """Limits of plain rims, one per row; see `limits_with_web` for those around a web.

    Args:
        overspeed: speed at which the hoop stress is limited [rad/s].
        mount_reach: radius of the holes in the housing's floor [m].
    """
    room = problem.envelope
    rims = [RimProblem(0.0, room, kind, 1.0).limits for kind in problem.materials]
    figures_by_material = np.array(
        [(rim.density, rim.stretch_max, rim.poisson_ratio) for rim in rims]
    )
    density, stretch, poisson_ratio = figures_by_material[material].T
    return replace(
        rims[0],
        density=density,
        inner_radius_min=np.full_like(density, room.inner_radius_min),
        height_min=np.full_like(density, room.height_min),
        # The hoop stress scales with the square of the speed, here from 1 rad/s.
        stretch_max=stretch / overspeed**2,
        poisson_ratio=poisson_ratio,
        web=np.zeros_like(density),
        # The housing's floor has a wall around the mount.
        outer_radius_min=np.maximum(mount_reach + (WALL - CLEARANCE), 0.0),
    )


def _around_bells(candidates: "Candidates", plain: RimLimits) -> RimLimits:
    """Limits of rings around the bells of their motors, derived from those of plain rims."""
    problem, material = candidates.problem, candidates.material
    bore, cuts, room = candidates.drives.seat.bell, problem.cuts, problem.envelope
    # Where a material's data are incomplete, temperature is left out, and its joint is unknown.
    thermal = np.array(
        [
            (kind.elastic_modulus, kind.thermal_expansion)
            if kind.elastic_modulus is not None and kind.thermal_expansion is not None
            else (0.0, 0.0)
            for kind in problem.materials
        ]
    )
    modulus, expansion = thermal[material].T
    widest = bell_bond_radius(
        np.maximum(bore, _LEAST_BELL),
        room.outer_radius_max,
        density=np.asarray(plain.density),
        elastic_modulus=modulus,
        poisson_ratio=np.asarray(plain.poisson_ratio),
        expansion=expansion,
        speed=candidates.drives.overspeed,
    )
    bore_min = np.maximum(room.inner_radius_min, cuts.inner_radius_min)
    return replace(
        plain,
        outer_radius_max=np.minimum(room.outer_radius_max, widest),
        inner_radius_min=bore,
        inner_radius_max=bore,
        height_max=np.where((bore >= bore_min) & (bore > 0.0), room.height_max, _NO_HEIGHT),
        height_min=np.maximum(plain.height_min, cuts.height_min),
        wall_min=np.maximum(room.wall_min, cuts.wall_min),
        cuts=cuts,
    )


def known_pairs(problem: SelectionProblem) -> NDArray[np.bool_]:
    """Whether all required data of a motor with a gear are known, shape (motors, gears)."""
    motors, gears = problem.motors, problem.gears
    # Which figures are needed depends only on this about a gear.
    kinds = {(gear.ratio <= 1.0, gear.reverses): gear for gear in gears}
    known = {
        kind: [not missing_figures(motor, gear) for motor in motors] for kind, gear in kinds.items()
    }
    columns = [known[gear.ratio <= 1.0, gear.reverses] for gear in gears]
    return np.array(columns, dtype=np.bool_).reshape(len(gears), len(motors)).T


def drives_of(
    problem: SelectionProblem, pairs: NDArray[np.intp], webs: NDArray[np.intp] | None = None
) -> Drives:
    """Drives of motors and gears whose data are known, by their indices, shape (n, 2).

    `webs`: index of each one's web, shape (n,); None: the first for all.
    """
    motors, gears = pairs.T
    web_indices = np.zeros_like(motors) if webs is None else webs
    lines: list[DriveLine] = []
    hubs: list[HubFigures[Any]] = []
    rotors: list[tuple[float, float]] = []
    # Where one drive fails, the others share its power.
    sharing = max(problem.layout.tilting - (problem.requirement.detection is not None), 1)
    speed_max = problem.wheel_speed_max or np.inf
    for (index, gear_index), web in zip(pairs.tolist(), web_indices.tolist(), strict=True):
        motor, gear = problem.motors[index], problem.gears[gear_index]
        line = drive_line(motor, gear, problem.supply.voltage)
        gain = gear.ratio * gear.efficiency * (motor.torque_constant or np.inf)
        peak = float(line.torque_limit) / gain
        power = (
            gear.efficiency * power_less_friction(problem.supply, sharing, motor, peak) / sharing
        )
        lines.append(
            replace(line, speed_max=np.minimum(line.speed_max, speed_max), power_max=power)
        )
        rotor = motor.rotor_inertia or 0.0
        rotors.append((rotor_share(rotor, gear), armature(rotor, gear)))
        hub = problem.hub(motor, gear, problem.lightenings[web])
        hubs.append(HubFigures.of(hub or NO_HUB))
    # One more row, which is left out: there may be no pairs.
    rows = slice(len(pairs))
    share, armatures = np.array([*rotors, (0.0, 0.0)]).T
    drives = Drives(
        motor=motors,
        gear=gears,
        web=web_indices,
        seat=_seats(problem, pairs),
        full_line=stacked([*lines, DriveLine(0.0, 0.0, 0.0, 0.0)]).take(rows),
        rotor_share=share[rows],
        armature=armatures[rows],
        hub=stacked([*hubs, HubFigures.of(NO_HUB)]).take(rows),
        web_density_min=np.full(len(pairs), problem.web_densities.min()),
        web_density_max=np.full(len(pairs), problem.web_densities.max()),
    )
    if not problem.web:
        return drives
    radius = np.maximum(drives.hub.radius, drives.seat.head_reach)
    heads = drives.seat.heads_rim_height + (problem.web_thickness - WEB_THICKNESS)
    height = np.maximum(drives.hub.rim_height, heads)
    return replace(drives, hub=replace(drives.hub, radius=radius, rim_height=height))


def _seats(problem: SelectionProblem, pairs: NDArray[np.intp]) -> Seat[FloatArray]:
    """Seats of the drives, computed once per motor with and without a gear, and once per gear."""
    motor_indices, of_motor = np.unique(pairs[:, 0], return_inverse=True)
    motors = [problem.motors[m] for m in motor_indices.tolist()] or problem.motors[:1]
    # One row per motor with a gear, the next for the same motor with the wheel on its shaft.
    rooms, plate, on_bell = (GearRoom(), None), problem.foot_plate, problem.on_bell
    seats_of_motors: list[Seat[Any]] = [
        _seat(motor, room, plate, on_bell=on_bell) for motor in motors for room in rooms
    ]
    gears = [problem.gears[g] for g in pairs[:, 1].tolist()]
    row = 2 * of_motor + np.array([gear.room is None for gear in gears], dtype=np.intp)
    seats = stacked(seats_of_motors).take(row)
    # A motor behind a gear is set back by the gear's depth.
    depth = np.array([0.0 if gear.room is None else gear.room.depth for gear in gears])
    offset = np.array([0.0 if gear.room is None else gear.room.offset for gear in gears])
    stages: list[MassMoments[Any]] = [gear_moments(gear, plate) for gear in problem.gears]
    geared = stacked(stages).take(pairs[:, 1])
    return replace(
        seats,
        at_floor=seats.at_floor.shifted(-depth, offset) + geared,
        behind=replace(seats.behind, depth=seats.behind.depth + depth),
    )
