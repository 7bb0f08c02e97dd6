"""The designed orientation control system, as frozen values."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ocs_design.actuation.drive import Drive
from ocs_design.actuation.motor import DIRECT
from ocs_design.actuation.supply import Supply
from ocs_design.common.arrays import FloatArray
from ocs_design.common.ranges import Distance, Length, Signed
from ocs_design.common.records import recorded
from ocs_design.common.units import format_quantity
from ocs_design.device.layout import PAIR, Layout, outward_sign, standing_frames
from ocs_design.device.records.device import OcsRecord
from ocs_design.parts.carrier_plate import CarrierPlate
from ocs_design.parts.foot import Foot, FootHold
from ocs_design.parts.housing import Housing, housing_outer_radius
from ocs_design.parts.motor_mount import DriveSolid, MotorMount, drive_cylinders, mount_of
from ocs_design.parts.pedestal import Pedestal
from ocs_design.parts.printed import LID_SCREW, PLATE_THICKNESS, WALL
from ocs_design.parts.solids import NO_CARRIER, Carrier
from ocs_design.parts.wheel import Flywheel
from ocs_design.requirement.maneuver import Maneuver
from ocs_design.robot.mass import MassProperties, combine


@dataclass(frozen=True, eq=False)
class Module:
    """One flywheel on the trunk.

    Attributes:
        name: of its side, or its number (`Layout.names`).
        axis: unit spin axis in B, shape (3,).
        position: of the wheel's centre of mass in B [m], shape (3,).
    """

    name: str
    axis: FloatArray
    position: FloatArray

    @property
    def frame(self) -> FloatArray:
        """Attitude in B, with y along the wheel's axis away from the motor, shape (3, 3)."""
        return standing_frames(outward_sign(self.name) * self.axis)


def modules_at(centers: FloatArray, incidence: float, layout: Layout = PAIR) -> tuple[Module, ...]:
    """Modules with the centres of their wheels in B [m], shape (n, 3), at an incidence [rad]."""
    placed = zip(layout.names, layout.axes(incidence).T, centers, strict=True)
    return tuple(Module(name, axis, center) for name, axis, center in placed)


def with_supports(
    robot: MassProperties, supports: Sequence[CarrierPlate | Pedestal]
) -> MassProperties:
    """Mass properties of a robot with plate or pedestals on it, in B."""
    bodies = [support.mass_properties() for support in supports]
    return combine([robot, *bodies]) if bodies else robot


def braked(
    robot: MassProperties,
    bodies: tuple[Carrier, ...],
    centers: FloatArray,
    incidence: float,
    layout: Layout = PAIR,
) -> MassProperties:
    """Robot and all modules as one rigid body in B, wheels braked.

    Args:
        robot: without the modules.
        bodies: rigid bodies of one module, in its own frame (`Layout.frames`).
        centers: of the wheels in B [m], shape (n, 3).
        incidence: of their axes, or the layout's angle [rad].
        layout: of the modules.
    """
    parts = [robot]
    for center, attitude in zip(centers, layout.frames(incidence), strict=True):
        parts += [body.mass_properties().moved(attitude, center) for body in bodies]
    return combine(parts)


@dataclass(frozen=True, eq=False)
class Device:
    """The orientation control system: equal modules with their drives and mounts.

    Attributes:
        incidence: for pairs, between each wheel axis and the lateral direction y; otherwise the
            angle of the layout (`Layout.axes`) [rad].
        modules: in the layout's order; a pair's are left and right.
        flywheel: of each module.
        motor: of each module.
        carrier: stationary part of each module, in the module's own frame (`Module.frame`).
        supply: of all motors; None: unknown.
        plate: that the feet stand on; None: they stand on the trunk.
        guard_wall: wall thickness of the mild steel ring in each housing [m]; 0: none.
        foot_plate: thickness of the feet's plates [m].
        layout: arrangement of the axes.
        pedestals: under tilted feet; empty: none are tilted, or no pedestal can be held.
        on_bell: whether each wheel is a ring around the bell of its motor.
    """

    incidence: Signed
    modules: tuple[Module, ...]
    flywheel: Flywheel
    motor: Drive
    carrier: Carrier = NO_CARRIER
    supply: Supply | None = None
    plate: CarrierPlate | None = None
    guard_wall: Distance = 0.0
    foot_plate: Length = PLATE_THICKNESS
    layout: Layout = PAIR
    pedestals: tuple[Pedestal, ...] = ()
    on_bell: bool = False

    @classmethod
    def of_record(cls, record: OcsRecord, supply: Supply | None = None) -> "Device":
        """The device exactly as designed; `supply` is its supply."""
        modules = (
            Module(module.name, np.array(module.axis), np.array(module.position))
            for module in record.modules
        )
        return recorded(cls, record, modules=tuple(modules), supply=supply, layout=record.axes)

    @property
    def mass(self) -> float:
        """Mass of all modules (wheels, motors, gears, housings and feet) and of `supports` [kg]."""
        return len(self.modules) * self.module_mass + sum(support.mass for support in self.supports)

    @property
    def module_mass(self) -> float:
        """Mass of one module [kg]."""
        return self.flywheel.mass + self.carrier.mass

    @property
    def wheels_alone(self) -> bool:
        """Whether it consists only of wheels, without drives and mounts."""
        return self.carrier.mass == 0.0

    @cached_property
    def mount(self) -> MotorMount:
        """Mount of the motor, as far as it is known and fits the housing's floor."""
        motor, wheel, plate = self.motor, self.flywheel, self.foot_plate
        mount = mount_of(motor, motor.gear_room, plate, on_bell=self.on_bell).around(wheel.height)
        floor_radius = housing_outer_radius(wheel.outer_radius) - 2.0 * WALL
        return mount if mount.holes.reach <= floor_radius else MotorMount(foot_plate=plate)

    @cached_property
    def foot(self) -> Foot:
        """Foot of one module, with the housing on it, also around a motor in a ring."""
        wheel, mount = self.flywheel, self.mount
        height = max(wheel.height, mount.room)
        housing = Housing(wheel.outer_radius, height, mount.holes, LID_SCREW, self.guard_wall)
        return Foot(housing, self.foot_plate)

    @cached_property
    def foot_hold(self) -> FootHold:
        """Hold of each foot; it tilts about the edge of its plate if that is within its own."""
        foot, plate = self.foot, self.plate
        edge = foot.base_radius if plate is None else min(foot.base_radius, plate.radius)
        return FootHold.of(foot, self.module_mass, edge)

    @cached_property
    def drive_solids(self) -> tuple[DriveSolid, ...]:
        """Gear, motor and cage as far as their sizes are known, behind the foot's plate."""
        motor, rim_height = self.motor, self.foot.housing.rim_height
        solids = drive_cylinders(motor, motor.gear_room, self.mount, rim_height)
        # Files of older versions lack the motor's position behind a gear.
        unknown = motor.gear != DIRECT.name and motor.gear_room is None
        return tuple(solid for solid in solids if not (unknown and solid.name == "motor"))

    @property
    def supports(self) -> tuple[CarrierPlate | Pedestal, ...]:
        """Parts between the feet and the trunk: plate and pedestals."""
        return (*(() if self.plate is None else (self.plate,)), *self.pedestals)

    def on(self, robot: MassProperties, *, free: bool = False) -> MassProperties:
        """A robot with this device as one rigid body in B, wheels braked.

        Wheels that spin freely keep the momentum of wheel and rotor about their axis, whatever the
        trunk does (docs/theory.md, The robot with its wheels: a gyrostat); the carrier's inertia
        includes the rotor's.

        Args:
            robot: without the device.
            free: whether the wheels spin freely.
        """
        wheel = self.flywheel
        axial = (0.0 if free else wheel.spin_inertia) - self.motor.rotor_inertia
        bodies = Carrier(wheel.mass, axial, wheel.transverse_inertia), self.carrier
        centers = np.stack([module.position for module in self.modules])
        return braked(
            with_supports(robot, self.supports), bodies, centers, self.incidence, self.layout
        )

    @property
    def axes(self) -> FloatArray:
        """Spin axes as columns, for a pair the matrix C of the paper, shape (3, n)."""
        return np.column_stack([module.axis for module in self.modules])

    def at_incidence(self, incidence: float) -> "Device":
        """Device with its modules turned by hand, as the paper does for its back-flip."""
        axes = self.layout.axes(incidence)
        turned = (
            replace(module, axis=axis) for module, axis in zip(self.modules, axes.T, strict=True)
        )
        return replace(self, incidence=incidence, modules=tuple(turned))

    def as_flown(self, maneuver: Maneuver) -> "Device":
        """Device at the maneuver's own incidence, if it has one."""
        return self if maneuver.incidence is None else self.at_incidence(maneuver.incidence)

    def __repr__(self) -> str:
        rim = self.flywheel
        radius, height = (format_quantity(x, "mm") for x in (rim.outer_radius, rim.height))
        return (
            f"<Device of {len(self.modules)} wheels: {format_quantity(self.mass, 'g')}, incidence "
            f"{format_quantity(self.incidence, 'deg')}, {self.motor.name}, rims of {rim.material}, "
            f"R {radius}, h {height}>"
        )
