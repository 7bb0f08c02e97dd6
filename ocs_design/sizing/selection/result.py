"""Result of a selection: the lightest devices, and why the other motors were rejected."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from enum import StrEnum
from typing import Any, TypeVar

import numpy as np

from ocs_design.actuation.drive import DriveLine
from ocs_design.actuation.motor import Gear, Motor
from ocs_design.catalogue.materials import Material
from ocs_design.common.arrays import FloatArray
from ocs_design.device.layout import PAIR, Layout
from ocs_design.device.records.selection import TaskDemand
from ocs_design.parts.carrier_plate import CarrierPlate
from ocs_design.parts.moments import Carrier
from ocs_design.parts.motor_mount import mount_of
from ocs_design.parts.pedestal import Pedestal
from ocs_design.parts.printed import PLATE_THICKNESS
from ocs_design.parts.rim import Hub, RimCuts, wheel_body
from ocs_design.requirement.froude import Envelope
from ocs_design.robot.mass import MassProperties
from ocs_design.sizing.bound.rim_problem import (
    RimLimits,
    RimProblem,
    bond_figures,
    limits_on_bell,
    limits_with_mount,
    limits_with_web,
    stretch_beside_holes,
)
from ocs_design.sizing.selection.problem import SelectionProblem


@dataclass(frozen=True, eq=False)
class Candidate:
    """A whole device: two equal modules on the robot.

    Attributes:
        motor, gear, material: chosen.
        incidence: of the wheel axes [rad].
        spin_inertia: of each wheel, the rotor's share included [kg m^2].
        rotor_share: s N J_r of it. armature: what the motor accelerates beyond it [kg m^2].
        inner_radius, outer_radius, height: of the rim [m].
        hub: in the middle of a wheel's web; None: massless spokes.
        cuts: off its rim.
        rim_mass: of one module [kg]. web_mass: with the hub.
        carrier: what stands still of one module: motor, gear, housing and foot.
        line: of the drive at the wheel, nothing held back.
        overspeed: at which the hoop stress is limited [rad/s].
        total: robot and all modules, braked, in B.
        centers: of the wheels in B [m], shape (n, 3).
        demands: of all parts of the requirement; empty where nobody looked at them.
        binding: limits that hold the mass up, as named in the specification; "housing" where a
            larger rim would be lighter, but its housing heavier.
        residual: relative change of the spin inertia in one more iteration of the fixed point.
        iterations: taken.
        web_material: of web and hub; None: of one piece with the rim.
        plate: that it stands on; None: the trunk itself, or not looked for yet.
        guard_wall: of the steel rings in the housings [m]; 0: none.
        foot_plate: thickness of the feet's plates [m].
        layout: of the modules.
        pedestals: under feet that lean; empty: none, or not looked for yet.
    """

    motor: Motor
    gear: Gear
    material: Material
    incidence: float
    spin_inertia: float
    rotor_share: float
    armature: float
    inner_radius: float
    outer_radius: float
    height: float
    hub: Hub | None
    cuts: RimCuts
    rim_mass: float
    web_mass: float
    carrier: Carrier
    line: DriveLine
    overspeed: float
    total: MassProperties
    centers: FloatArray
    demands: tuple[TaskDemand, ...]
    binding: tuple[str, ...]
    residual: float
    iterations: int
    web_material: Material | None = None
    plate: CarrierPlate | None = None
    guard_wall: float = 0.0
    foot_plate: float = PLATE_THICKNESS
    layout: Layout = PAIR
    pedestals: tuple[Pedestal, ...] = ()
    on_bell: bool = False

    @property
    def web_density(self) -> float | None:
        """Density of web and hub [kg/m^3]; None: of one piece with the rim."""
        return None if self.web_material is None else self.web_material.density

    @property
    def hub_share(self) -> float:
        """Part of the spin inertia that is the hub's [kg m^2]."""
        if self.hub is None:
            return 0.0
        return self.hub.axial_inertia(self.web_density or self.material.density)

    @property
    def mass(self) -> float:
        """Mass of all modules and of what is under them [kg]."""
        return self.modules_mass + self.plate_mass

    @property
    def modules_mass(self) -> float:
        """Mass of all modules: wheels, motors, gears, housings and feet [kg]."""
        return len(self.layout) * (self.wheel_mass + self.carrier.mass)

    @property
    def plate_mass(self) -> float:
        """Mass of plate and pedestals; 0 without any [kg]."""
        plate = 0.0 if self.plate is None else self.plate.mass
        return plate + sum(each.mass for each in self.pedestals)

    @property
    def printed_mass(self) -> float:
        """Mass of one housing with its foot, what holds the motor, and all screws [kg]."""
        bought = (self.motor.mass or 0.0) + self.motor.controller_mass + self.gear.mass
        return self.carrier.mass - bought

    def limits(self, room: Envelope) -> RimLimits:
        """Limits of its rim, scalars, in the room that is specified."""
        alone = RimProblem(self.spin_inertia, room, self.material, self.overspeed).limits
        mount = mount_of(self.motor, self.gear.room, self.foot_plate, on_bell=self.on_bell)
        mounted = limits_with_mount(alone, mount.holes.reach)
        mounted = replace(mounted, height_max=min(room.height_max, mount.rim_height_max))
        if mount.bell is not None:
            bore, speed = np.asarray(mount.bell.bore), np.asarray(self.overspeed)
            bonded = np.array(bond_figures(self.material))
            return limits_on_bell(mounted, bore, speed, bonded, self.cuts)
        if self.hub is None:
            return mounted
        reach = max(self.hub.radius, mount.head_reach)
        return limits_with_web(
            mounted,
            reach,
            self.cuts,
            self.web_density,
            self.hub.rim_height_min,
            lightened=self.hub.lightened,
            lightened_bore=self.hub.bore_min,
            stretch_left=stretch_beside_holes(self.hub.lightened_stress, room.stress_safety),
        )

    @property
    def wheel_mass(self) -> float:
        """Mass of one wheel: rim, web and hub [kg]."""
        return self.rim_mass + self.web_mass

    @property
    def wheel(self) -> Carrier:
        """One wheel, without what turns in the motor."""
        size = (self.inner_radius, self.outer_radius, self.height)
        return wheel_body(
            *size, self.material.density, self.hub, cuts=self.cuts, web_density=self.web_density
        )

    @property
    def binding_maneuver(self) -> str:
        """Maneuver that asks for the most; "" where the smallest rim or a stated one has more."""
        most = max(self.demands, key=lambda demand: demand.spin_inertia, default=None)
        if most is None or most.spin_inertia < self.spin_inertia * (1.0 - 1e-6):
            return ""
        return most.source


def of_parts(problem: SelectionProblem, *devices: Candidate) -> SelectionProblem:
    """The problem with motor, gear, material and web of each device alone to choose from."""
    hubs = [device.hub for device in devices]
    return replace(
        problem,
        motors=tuple(device.motor for device in devices),
        gears=tuple(device.gear for device in devices),
        materials=tuple(device.material for device in devices),
        lightenings=tuple(0 if hub is None else hub.lightening for hub in hubs),
    )


SAME_MASS = 1e-5
"""Relative difference of two masses that is none: materials of one density make devices of one mass
but for rounding, which differs from processor to processor."""

Entry = TypeVar("Entry")


def lightest_first(
    entries: Iterable[Entry], mass: Callable[[Entry], float], preference: Callable[[Entry], Any]
) -> list[Entry]:
    """Entries by mass; of those that are equally heavy, the preferred ones first.

    Args:
        entries: any.
        mass: of an entry [kg].
        preference: sorts entries whose masses differ by less than `SAME_MASS`, smallest first.
    """
    alike, ordered = list[Entry](), list[Entry]()
    for entry in sorted(entries, key=mass):
        if alike and mass(entry) > mass(alike[0]) * (1.0 + SAME_MASS):
            ordered += sorted(alike, key=preference)
            alike = []
        alike.append(entry)
    return ordered + sorted(alike, key=preference)


def devices_by_mass(devices: Iterable[Candidate], room: Envelope) -> list[Candidate]:
    """Devices in the room for their rims, lightest first; of equally heavy ones, the safest.

    That is the one whose bond allows the wider ring, where it has one, then that of the material
    which yields last.
    """

    def preference(device: Candidate) -> tuple[float, float, str, str, str]:
        widest = float(np.max(device.limits(room).outer_radius_max))
        names = (device.motor.name, device.gear.name, device.material.name)
        return -widest, -(device.material.yield_strength or 0.0), *names

    return lightest_first(devices, lambda device: device.mass, preference)


class Reason(StrEnum):
    """Why a motor has no place among the lightest devices.

    Attributes:
        FIGURES: its source lacks what the choice needs.
        HEAVIER: it can do it, or may be able to, but its device is heavier than those listed.
        TORQUE: too weak, whatever the wheel. SPEED: too slow, whatever the wheel.
        ENVELOPE: the wheel that it needs has no room. MASS: that wheel is heavier than allowed.
        STRESS: that wheel would burst.
        INCIDENCE: the stated one leaves an axis out of reach.
        OWN_WEIGHT: it could turn the robot alone, but not with the device on it.
    """

    FIGURES = "missing figures"
    HEAVIER = "heavier"
    TORQUE = "torque"
    SPEED = "speed"
    ENVELOPE = "envelope"
    MASS = "mass"
    STRESS = "stress"
    INCIDENCE = "incidence"
    OWN_WEIGHT = "own weight"


@dataclass(frozen=True)
class Rejection:
    """Why a motor was rejected.

    Attributes:
        motor: its name.
        reason: the first thing in the way of its most promising combination.
        detail: the same with figures.
        shortfall: by how much it fails: time with the largest wheel that fits over the time given,
            or wheel needed over the largest, whichever is less, over 1, or what the least radius
            around the motor makes of it; inf if not known.
        needed: spin inertia of the smallest wheel that would do [kg m^2]; None: none would, however
            large, or it is not known.
        largest: of the largest wheel that fits, its rotor included [kg m^2]; None: not looked at.
    """

    motor: str
    reason: Reason
    detail: str
    shortfall: float
    needed: float | None = None
    largest: float | None = None


@dataclass(frozen=True, eq=False)
class Selection:
    """The lightest devices.

    Attributes:
        ranking: the ten lightest that differ in motor, gear or material, and the lightest of each
            of the five best motors, lightest first.
        rejections: one for each motor that has no place in it, in the order of the problem.
        candidates: combinations of motor, gear, material and 5 deg of incidence that were decided;
            without those whose figures do not suffice.
    """

    ranking: tuple[Candidate, ...]
    rejections: tuple[Rejection, ...]
    candidates: int

    @property
    def best(self) -> Candidate:
        """The lightest."""
        return self.ranking[0]
