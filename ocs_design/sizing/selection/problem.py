"""The problem of the selection, with what there is to choose from, and its result."""

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
from ocs_design.device.device import Device, braked, modules_at
from ocs_design.device.layout import PAIR, Layout
from ocs_design.device.records.selection import TaskDemand
from ocs_design.parts.module import Printed, carrier_of
from ocs_design.parts.motor_mount import MotorMount, hub_of, mount_of
from ocs_design.parts.printed import PLATE_THICKNESS
from ocs_design.parts.rim import NO_CUTS, SHRUNK_WEB_THICKNESS, WEB_THICKNESS, Hub, RimCuts
from ocs_design.parts.solids import Carrier
from ocs_design.requirement.device_sections import Envelope
from ocs_design.requirement.requirement import Requirement
from ocs_design.robot.mass import MassProperties
from ocs_design.sizing.bound.rim_problem import RimLimits, check_limits
from ocs_design.sizing.driven_wheel import DrivenWheel
from ocs_design.sizing.limits import BUS_VOLTAGE, RIM_LIMITS, SUPPLY_POWER, TIME, TOP_SPEED, Limit
from ocs_design.sizing.place import Place, module_size


@dataclass(frozen=True, eq=False)
class SelectionProblem:
    """Problem of finding the lightest device that meets the whole requirement.

    Attributes:
        robot: without the modules, with the plate that they stand on, in B.
        requirement: what the device must do; its `wheel_speed_max` is ignored here. A specified
            spin inertia is kept, and the motors must meet the rest with it.
        envelope: room for one rim; its housing stands around it.
        place: of the modules, by outer radius and height of their housings.
        layout: of their axes.
        motors, gears, materials: to choose from; direct drive is the gear `DIRECT`.
        supply: of all motors; each wheel may use its share of the power.
        incidence: of a pair's wheel axes, or the angle of another layout [rad]; None: the best.
        wheel_speed_max: specified highest speed of a wheel [rad/s]; None: the drive's own limit.
        web: whether wheels have a web and a hub; massless spokes otherwise.
        on_bell: whether they are rings around the bells of the motors, without web or gear.
        cuts: chamfers and balancing holes of wheels with a web; those without are plain rims.
        web_material: of web and hub; None: in one piece with the rim.
        lightenings: numbers of holes in a web to choose from, 0 for a solid one.
        guard_wall: wall thickness of the steel rings in the housings [m]; 0: none.
        foot_plate: thickness of the feet's plates [m].
        least_web: least thickness of webs, if the default is too thin for a landing [m].
        formed: whether a mast may stand on a block shaped to the trunk.
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
    least_web: float = 0.0
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
    def web_thickness(self) -> float:
        """Thickness of their webs [m]."""
        usual = WEB_THICKNESS if self.web_material is None else SHRUNK_WEB_THICKNESS
        return max(usual, self.least_web)

    def hub(self, motor: Motor, gear: Gear, lightening: int) -> Hub | None:
        """Hub of a wheel on this motor with this gear; None: massless spokes.

        Its web is solid where the largest rim leaves no room for that many holes.
        """
        if not self.web:
            return None
        hub = hub_of(
            motor.mounting if gear.room is None else None,
            motor.diameter,
            chamfer=self.cuts.chamfer,
            web_thickness=self.web_thickness,
            lightening=lightening,
        )
        wall = max(self.envelope.wall_min, self.cuts.wall_min)
        fits = hub.bore_min + wall <= self.envelope.outer_radius_max
        return hub if fits else replace(hub, lightening=0)

    def check(self) -> None:
        """Refuse an invalid problem.

        Raises:
            UsageError: there is nothing to choose from or nothing to do, or a limit is invalid.
        """
        for name in ("motors", "gears", "materials"):
            if not getattr(self, name):
                raise UsageError(f"there are no {name} to choose from")
        requirement = self.requirement
        if not any((requirement.maneuvers, requirement.rate_change, requirement.spin_inertia)):
            raise UsageError(
                "nothing is required of the wheels",
                hint="Specify a rate change, a maneuver, or a spin inertia.",
            )
        speed = 1.0 if self.wheel_speed_max is None else self.wheel_speed_max
        for material in self.materials:
            check_limits(self.envelope, material, speed)


def limits_of(problem: SelectionProblem) -> dict[Limit, float]:
    """Values of all limits that may be active [SI]."""
    speed = {} if problem.wheel_speed_max is None else {TOP_SPEED: problem.wheel_speed_max}
    power = {SUPPLY_POWER: problem.supply.power} if isfinite(problem.supply.power) else {}
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
    if limit is SUPPLY_POWER:
        # The current limit is raised with it, where it is the tighter of the two.
        supply = problem.supply
        current = max(supply.current_max, value / supply.voltage)
        return replace(problem, supply=Supply(supply.voltage, current, value))
    if limit is TOP_SPEED:
        return replace(problem, wheel_speed_max=value)
    if limit is TIME:
        names = {maneuver.name for maneuver in problem.requirement.maneuvers}
        return with_time(problem, value, names)
    return replace(problem, envelope=limit.replaced(problem.envelope, value))


def with_time(problem: SelectionProblem, factor: float, names: set[str]) -> SelectionProblem:
    """The problem with `factor` times the time for the maneuvers of these names."""
    longer = problem.requirement.changed(
        lambda maneuver: maneuver.slower(factor) if maneuver.name in names else maneuver
    )
    return replace(problem, requirement=longer)


@dataclass(frozen=True, eq=False, kw_only=True)
class Candidate(DrivenWheel):
    """A whole device: equal modules on the robot, each with a driven wheel.

    Attributes:
        incidence: of the wheel axes [rad].
        spin_inertia: of each wheel, the rotor's share included [kg m^2].
        limits: of its rim.
        problem: that it solves.
        demands: of all parts of the requirement; empty until computed.
        binding: active limits, as named in the specification; "housing" where a larger rim would be
            lighter, but its housing heavier.
        residual: relative change of the spin inertia in one more iteration of the fixed point.
        iterations: number of iterations.
        plate_mass: of plate or pedestals under its feet [kg]; 0: none, or not determined yet.
    """

    incidence: float
    spin_inertia: float
    limits: RimLimits
    problem: SelectionProblem
    demands: tuple[TaskDemand, ...] = ()
    binding: tuple[str, ...]
    residual: float
    iterations: int
    plate_mass: float = 0.0

    @property
    def layout(self) -> Layout:
        """Layout of the modules' axes."""
        return self.problem.layout

    @cached_property
    def device(self) -> Device:
        """The modules as they were selected, on the trunk itself."""
        problem = self.problem
        return Device(
            self.incidence,
            modules_at(self.centers, self.incidence, problem.layout),
            self.flywheel,
            self.drive,
            self.carrier,
            layout=problem.layout,
            supply=self.supply.explicit,
            guard_wall=problem.guard_wall,
            foot_plate=problem.foot_plate,
            on_bell=problem.on_bell,
        )

    @property
    def hub_share(self) -> float:
        """Part of the spin inertia that is the hub's [kg m^2]."""
        if self.hub is None:
            return 0.0
        material = self.web_material or self.material
        return self.hub.beyond_web(material.density).axial_inertia

    @property
    def mount(self) -> MotorMount:
        """Mount of the motor."""
        problem = self.problem
        return mount_of(self.motor, self.gear.room, problem.foot_plate, on_bell=problem.on_bell)

    @cached_property
    def carrier(self) -> Carrier:
        """Stationary part of one module: motor, gear, housing and foot."""
        return carrier_of(
            self.motor,
            self.gear,
            self.outer_radius,
            self.height,
            self.problem.guard_wall,
            foot_plate=self.problem.foot_plate,
            on_bell=self.problem.on_bell,
        )

    @cached_property
    def centers(self) -> FloatArray:
        """Centres of the wheels in B [m], shape (n, 3)."""
        size = module_size(
            self.outer_radius + self.problem.guard_wall,
            max(self.height, self.mount.room),
            self.mount.behind(self.motor),
            self.mount.holes.reach,
            foot_plate=self.problem.foot_plate,
        )
        return frozen(self.problem.place.centers(size))

    def total_at(self, robot: MassProperties, incidence: float) -> MassProperties:
        """A robot and all modules at an incidence [rad], braked, in B."""
        return braked(robot, (self.wheel, self.carrier), self.centers, incidence, self.layout)

    @cached_property
    def total(self) -> MassProperties:
        """The robot and all modules, braked, in B."""
        return self.total_at(self.problem.robot, self.incidence)

    @property
    def shell(self) -> Printed:
        """Housing and foot around a wheel of any size."""
        mount, problem = self.mount, self.problem
        reach, posts, room = mount.holes.reach, mount.posts, mount.room
        return Printed(reach, posts, problem.guard_wall, problem.foot_plate, room)

    @property
    def mass(self) -> float:
        """Mass of all modules with their plate or pedestals [kg]."""
        return self.modules_mass + self.plate_mass

    @property
    def modules_mass(self) -> float:
        """Mass of all modules: wheels, motors, gears, housings and feet [kg]."""
        return len(self.layout) * (self.wheel_mass + self.carrier.mass)

    @property
    def printed_mass(self) -> float:
        """Mass of one housing with its foot, the motor's mount, and all screws [kg]."""
        bought = (self.motor.mass or 0.0) + self.motor.controller_mass + self.gear.mass
        return self.carrier.mass - bought

    @property
    def wheel_mass(self) -> float:
        """Mass of one wheel: rim, web and hub [kg]."""
        return self.wheel.mass

    @property
    def binding_maneuver(self) -> str:
        """Maneuver that requires the most; "" where the smallest or a specified rim has more.

        Among equals the first, so that rounding does not decide.
        """
        largest = max((demand.spin_inertia for demand in self.demands), default=0.0)
        drivers = (
            demand.source
            for demand in self.demands
            if demand.spin_inertia >= largest * (1.0 - 1e-9)
        )
        return "" if largest < self.spin_inertia * (1.0 - 1e-6) else next(drivers, "")


def of_parts(problem: SelectionProblem, *devices: Candidate) -> SelectionProblem:
    """The problem with only these devices' motors, gears, materials and webs to choose from."""
    hubs = [device.hub for device in devices]
    return replace(
        problem,
        motors=tuple(device.motor for device in devices),
        gears=tuple(device.gear for device in devices),
        materials=tuple(device.material for device in devices),
        lightenings=tuple(0 if hub is None else hub.lightening for hub in hubs),
    )


SAME_MASS = 1e-5
"""Relative difference of two masses that count as equal: materials of equal density give equal
masses except for rounding, which differs between processors."""

Entry = TypeVar("Entry")


def lightest_first(
    entries: Iterable[Entry], mass: Callable[[Entry], float], preference: Callable[[Entry], Any]
) -> list[Entry]:
    """Entries by mass; among equally heavy ones, the preferred first.

    Args:
        preference: sorts entries whose masses differ by less than `SAME_MASS`, smallest first.
    """
    equal, ordered = list[Entry](), list[Entry]()
    for entry in sorted(entries, key=mass):
        if equal and mass(entry) > mass(equal[0]) * (1.0 + SAME_MASS):
            ordered += sorted(equal, key=preference)
            equal = []
        equal.append(entry)
    return ordered + sorted(equal, key=preference)


def devices_by_mass(devices: Iterable[Candidate]) -> list[Candidate]:
    """Devices, the lightest first; among equally heavy ones, the safest.

    That is the one whose bond, if any, allows the wider ring, then the one of the stronger
    material.
    """

    def preference(device: Candidate) -> tuple[float, float, str, str, str]:
        widest = float(device.limits.outer_radius_max)
        names = (device.motor.name, device.gear.name, device.material.name)
        return -widest, -(device.material.yield_strength or 0.0), *names

    return lightest_first(devices, lambda device: device.mass, preference)


class Reason(StrEnum):
    """Why a motor is not among the lightest devices.

    Attributes:
        FIGURES: its source lacks data that the choice needs.
        HEAVIER: it is feasible, or may be, but its device is heavier than those listed.
        TORQUE: too weak, whatever the wheel. SPEED: too slow, whatever the wheel.
        ENVELOPE: the wheel that it needs does not fit. MASS: that wheel is heavier than allowed.
        STRESS: that wheel would burst.
        INCIDENCE: the specified one leaves an axis uncontrolled.
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
        reason: the first obstacle for its most promising combination.
        detail: the same with figures.
        shortfall: factor by which it fails: time needed with the largest wheel that fits over the
            time given, or wheel needed over the largest, whichever is smaller, in excess of 1, or
            that due to the least radius around the motor; inf if unknown.
        needed: spin inertia of the smallest wheel that would do [kg m^2]; None: no wheel would, or
            unknown.
        largest: spin inertia of the largest wheel that fits, with its rotor [kg m^2]; None: not
            computed.
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
        candidates: number of combinations of motor, gear, material and 5 deg of incidence that were
            decided, without those whose data are incomplete.
        reasons: computes the `rejections`, which takes some time.
    """

    ranking: tuple[Candidate, ...]
    candidates: int
    reasons: Callable[[], tuple[Rejection, ...]]

    @cached_property
    def rejections(self) -> tuple[Rejection, ...]:
        """One for each motor that is not in the ranking, in the order of the problem."""
        return self.reasons()

    @property
    def best(self) -> Candidate:
        """The lightest device."""
        return self.ranking[0]


def inertia_at(problem: SelectionProblem, device: Candidate, incidence: float) -> TiltInertia:
    """Inertia of robot and device, braked, with the modules turned to this incidence."""
    return TiltInertia.of(device.total_at(problem.robot, incidence).inertia)
