"""The problem of the selection and its result: what there is to choose from, and what was."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from enum import StrEnum
from functools import cached_property
from math import isfinite
from typing import Any, TypeVar

import numpy as np

from ocs_design.actuation.motor import Gear, Motor
from ocs_design.actuation.supply import Supply
from ocs_design.actuation.tilt_inertia import TiltInertia
from ocs_design.catalogue.materials import Material
from ocs_design.common.arrays import FloatArray, frozen
from ocs_design.common.errors import UsageError
from ocs_design.device.layout import PAIR, Layout
from ocs_design.device.records.selection import TaskDemand
from ocs_design.parts.carrier_plate import CarrierPlate
from ocs_design.parts.module import Printed, standing
from ocs_design.parts.motor_mount import MotorMount, mount_of
from ocs_design.parts.pedestal import Pedestal
from ocs_design.parts.printed import PLATE_THICKNESS
from ocs_design.parts.rim import (
    NO_CUTS,
    SHRUNK_WEB_THICKNESS,
    WEB_THICKNESS,
    Hub,
    RimCuts,
    hub_of,
)
from ocs_design.parts.solids import Carrier
from ocs_design.requirement.device_sections import Envelope
from ocs_design.requirement.kinds import slower
from ocs_design.requirement.requirement import Requirement
from ocs_design.robot.mass import MassProperties
from ocs_design.sizing.bound.rim_problem import RimLimits, check_limits
from ocs_design.sizing.driven_wheel import DrivenWheel
from ocs_design.sizing.limits import BUS_POWER, BUS_VOLTAGE, RIM_LIMITS, TIME, WHEEL_SPEED, Limit
from ocs_design.sizing.place import Place, braked, module_size


@dataclass(frozen=True, eq=False)
class SelectionProblem:
    """Find the lightest device that does everything that is required.

    Attributes:
        robot: without the modules, with the plate that they stand on, in B.
        requirement: what the device must do; its `wheel_speed_max` is not looked at here. A stated
            spin inertia is kept, and the motors must do with it what is required.
        envelope: room for one rim; its housing stands around it.
        place: of the modules, by outer radius and height of their housings.
        layout: of their axes.
        motors, gears, materials: to choose from; direct drive is the gear `DIRECT`.
        supply: of all motors; each of the wheels may take its share of the power.
        incidence: of a pair's wheel axes, or the angle of another layout [rad]; None: the best.
        wheel_speed_max: stated highest speed of a wheel [rad/s]; None: what the drive can do.
        web: whether wheels have a web and a hub; massless spokes otherwise.
        on_bell: whether they are rings around the bells of the motors, without web or gear.
        cuts: chamfers and balancing holes of wheels with a web; those without are plain rims.
        web_material: of web and hub; None: of one piece with the rim.
        lightenings: numbers of holes in a web to choose from, 0 a solid one.
        guard_wall: of the steel rings in the housings [m]; 0: none.
        foot_plate: thickness of the feet's plates [m].
        formed: whether a mast may stand by a block that has the trunk's form.
    """

    robot: MassProperties
    requirement: Requirement
    envelope: Envelope
    place: Place
    motors: Sequence[Motor]
    gears: Sequence[Gear]
    materials: Sequence[Material]
    supply: Supply
    incidence: float | None = None
    wheel_speed_max: float | None = None
    web: bool = True
    on_bell: bool = False
    cuts: RimCuts = NO_CUTS
    web_material: Material | None = None
    lightenings: Sequence[int] = (0,)
    guard_wall: float = 0.0
    foot_plate: float = PLATE_THICKNESS
    layout: Layout = PAIR
    formed: bool = False

    @property
    def web_densities(self) -> FloatArray:
        """Density of web and hub of a wheel of each material [kg/m^3]."""
        of_rims = np.array([material.density for material in self.materials])
        return (
            of_rims
            if self.web_material is None
            else np.full_like(of_rims, self.web_material.density)
        )

    @property
    def bus_voltage(self) -> float:
        """Voltage of the supply [V]."""
        return self.supply.voltage

    @property
    def web_thickness(self) -> float:
        """Thickness of their webs [m]."""
        return WEB_THICKNESS if self.web_material is None else SHRUNK_WEB_THICKNESS

    def hub(self, motor: Motor, gear: Gear, lightening: int) -> Hub | None:
        """Hub of a wheel on this motor behind this gear; None: massless spokes.

        Its web is solid where the largest rim leaves no room for so many holes.
        """
        if not self.web:
            return None
        hub = hub_of(
            motor,
            direct=gear.room is None,
            chamfer=self.cuts.chamfer,
            web_thickness=self.web_thickness,
            lightening=lightening,
        )
        wall = max(self.envelope.wall_min, self.cuts.wall_min)
        fits = hub.bore_min + wall <= self.envelope.outer_radius_max
        return hub if fits else replace(hub, lightening=0)

    def check(self) -> None:
        """Refuse a problem that cannot be solved as it is stated.

        Raises:
            UsageError: there is nothing to choose from or nothing to do, or a limit is no limit.
        """
        for name in ("motors", "gears", "materials"):
            if not getattr(self, name):
                raise UsageError(f"there are no {name} to choose from")
        asked = self.requirement
        if not any((asked.maneuvers, asked.rate_change, asked.spin_inertia)):
            raise UsageError(
                "nothing is required of the wheels",
                hint="Specify a rate change, a maneuver, or a spin inertia.",
            )
        speed = 1.0 if self.wheel_speed_max is None else self.wheel_speed_max
        for each in self.materials:
            check_limits(self.envelope, each, speed)


def limits_of(problem: SelectionProblem) -> dict[Limit, float]:
    """Values of all limits that may stand in the way [SI]."""
    speed = {} if problem.wheel_speed_max is None else {WHEEL_SPEED: problem.wheel_speed_max}
    power = {BUS_POWER: problem.supply.power} if isfinite(problem.supply.power) else {}
    return {
        **{limit: limit.value(problem.envelope) for limit in RIM_LIMITS},
        **speed,
        BUS_VOLTAGE: problem.supply.voltage,
        **power,
        TIME: 1.0,
    }


def with_limit(problem: SelectionProblem, limit: Limit, value: float) -> SelectionProblem:
    """The problem with one of its limits changed [SI]."""
    if limit is BUS_VOLTAGE:
        return replace(problem, supply=replace(problem.supply, voltage=value))
    if limit is BUS_POWER:
        # The current gives way with it, where it is the smaller limit of the two.
        supply = problem.supply
        current = max(supply.current_max, value / supply.voltage)
        return replace(problem, supply=Supply(supply.voltage, current, value))
    if limit is WHEEL_SPEED:
        return replace(problem, wheel_speed_max=value)
    if limit is TIME:
        names = {maneuver.name for maneuver in problem.requirement.maneuvers}
        return with_time(problem, value, names)
    return replace(problem, envelope=limit.replaced(problem.envelope, value))


def with_time(problem: SelectionProblem, factor: float, names: set[str]) -> SelectionProblem:
    """The problem with `factor` times the time for the maneuvers of these names."""
    requirement, height = problem.requirement, problem.requirement.standing_height
    longer = requirement.changed(
        lambda each: slower(each, factor, height) if each.name in names else each
    )
    return replace(problem, requirement=longer)


@dataclass(frozen=True, eq=False, kw_only=True)
class Candidate(DrivenWheel):
    """A whole device: equal modules on the robot, each with a driven wheel.

    Attributes:
        incidence: of the wheel axes [rad].
        spin_inertia: of each wheel, the rotor's share included [kg m^2].
        rim_mass: of one module [kg].
        overspeed: at which the hoop stress is limited [rad/s].
        limits: of its rim.
        robot, place, guard_wall, foot_plate, layout, on_bell: see `SelectionProblem`.
        demands: of all parts of the requirement; empty where nobody looked at them.
        binding: limits that hold the mass up, as named in the specification; "housing" where a
            larger rim would be lighter, but its housing heavier.
        residual: relative change of the spin inertia in one more iteration of the fixed point.
        iterations: taken.
        plate: that it stands on; None: the trunk itself, or not looked for yet.
        pedestals: under feet that lean; empty: none, or not looked for yet.
    """

    incidence: float
    spin_inertia: float
    rim_mass: float
    overspeed: float
    limits: RimLimits
    robot: MassProperties
    place: Place
    demands: tuple[TaskDemand, ...] = ()
    binding: tuple[str, ...]
    residual: float
    iterations: int
    plate: CarrierPlate | None = None
    guard_wall: float = 0.0
    foot_plate: float = PLATE_THICKNESS
    layout: Layout = PAIR
    pedestals: tuple[Pedestal, ...] = ()
    on_bell: bool = False

    @property
    def hub_share(self) -> float:
        """Part of the spin inertia that is the hub's [kg m^2]."""
        if self.hub is None:
            return 0.0
        material = self.web_material or self.material
        return self.hub.beyond_web(material.density).axial_inertia

    @property
    def mount(self) -> MotorMount:
        """How the motor is held."""
        return mount_of(self.motor, self.gear.room, self.foot_plate, on_bell=self.on_bell)

    @cached_property
    def carrier(self) -> Carrier:
        """What stands still of one module: motor, gear, housing and foot."""
        return standing(
            self.motor,
            self.gear,
            self.outer_radius,
            self.height,
            self.guard_wall,
            foot_plate=self.foot_plate,
            on_bell=self.on_bell,
        )

    @cached_property
    def centers(self) -> FloatArray:
        """Centres of the wheels in B [m], shape (n, 3)."""
        size = module_size(
            self.outer_radius + self.guard_wall,
            max(self.height, self.mount.room),
            self.mount.behind(self.motor),
            self.mount.holes.reach,
            foot_plate=self.foot_plate,
        )
        return frozen(self.place.centers(size))

    def total_at(self, robot: MassProperties, incidence: float) -> MassProperties:
        """A robot and all modules at an incidence [rad], braked, in B."""
        return braked(robot, (self.wheel, self.carrier), self.centers, incidence, self.layout)

    @cached_property
    def total(self) -> MassProperties:
        """The robot and all modules, braked, in B."""
        return self.total_at(self.robot, self.incidence)

    @property
    def shell(self) -> Printed:
        """Housing and foot around a wheel of any size."""
        reach, posts = self.mount.holes.reach, self.mount.posts
        return Printed(reach, posts, self.guard_wall, self.foot_plate, self.mount.room)

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

    @property
    def wheel_mass(self) -> float:
        """Mass of one wheel: rim, web and hub [kg]."""
        return self.rim_mass + self.web_mass

    @property
    def web_mass(self) -> float:
        """Mass of one wheel's web with its hub [kg]."""
        return self.wheel.mass - self.rim_mass

    @property
    def binding_maneuver(self) -> str:
        """Maneuver that asks for the most; "" where the smallest rim or a stated one has more.

        Of several that ask for as much, the first: no rounding decides which of them is named.
        """
        most = max((demand.spin_inertia for demand in self.demands), default=0.0)
        asked = (each.source for each in self.demands if each.spin_inertia >= most * (1.0 - 1e-9))
        return "" if most < self.spin_inertia * (1.0 - 1e-6) else next(asked, "")


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
        preference: sorts entries whose masses differ by less than `SAME_MASS`, smallest first.
    """
    alike, ordered = list[Entry](), list[Entry]()
    for entry in sorted(entries, key=mass):
        if alike and mass(entry) > mass(alike[0]) * (1.0 + SAME_MASS):
            ordered += sorted(alike, key=preference)
            alike = []
        alike.append(entry)
    return ordered + sorted(alike, key=preference)


def devices_by_mass(devices: Iterable[Candidate]) -> list[Candidate]:
    """Devices, the lightest first; of equally heavy ones, the safest.

    That is the one whose bond allows the wider ring, where it has one, then that of the material
    which yields last.
    """

    def preference(device: Candidate) -> tuple[float, float, str, str, str]:
        widest = float(device.limits.outer_radius_max)
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
            of the five best motors, lightest first; without their demands.
        candidates: combinations of motor, gear, material and 5 deg of incidence that were decided;
            without those whose figures do not suffice.
        reasons: of the `rejections`, which take some time to find.
    """

    ranking: tuple[Candidate, ...]
    candidates: int
    reasons: Callable[[], tuple[Rejection, ...]]

    @cached_property
    def rejections(self) -> tuple[Rejection, ...]:
        """One for each motor that has no place in the ranking, in the order of the problem."""
        return self.reasons()

    @property
    def best(self) -> Candidate:
        """The lightest."""
        return self.ranking[0]


def inertia_at(problem: SelectionProblem, device: Candidate, incidence: float) -> TiltInertia:
    """Inertia of robot and device, braked, with the modules turned to this incidence."""
    return TiltInertia.of(device.total_at(problem.robot, incidence).inertia)
