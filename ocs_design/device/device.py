"""The designed orientation control system, as frozen values."""

from dataclasses import dataclass, replace

import numpy as np

from ocs_design.actuation.drive import Drive
from ocs_design.actuation.supply import Supply
from ocs_design.common.arrays import FloatArray
from ocs_design.common.ranges import Distance, Length, LengthIfAny, NotNegative, Positive, Signed
from ocs_design.common.units import format_quantity
from ocs_design.device.layout import PAIR, Layout, outward_sign, standing_frames
from ocs_design.parts.carrier_plate import CarrierPlate
from ocs_design.parts.pedestal import Pedestal
from ocs_design.parts.printed import PLATE_THICKNESS
from ocs_design.parts.rim import NO_CUTS, RimCuts
from ocs_design.parts.solids import Carrier
from ocs_design.parts.wheel import Rim, Web, Wheel
from ocs_design.requirement.maneuver import Maneuver
from ocs_design.robot.mass import MassProperties, combine

NO_CARRIER = Carrier(mass=0.0, axial_inertia=0.0, transverse_inertia=0.0)
"""Carrier of the assumed motor, which is massless."""


@dataclass(frozen=True)
class Flywheel:
    """A hollow cylinder on a web that spins about its z axis.

    Attributes:
        inner_radius, outer_radius, height: of the rim [m].
        material: of the rim, name in the catalogue. density: [kg/m^3].
        mass: of the whole wheel [kg].
        spin_inertia: angular momentum about the spin axis per speed relative to the trunk,
            including the motor's rotor [kg m^2].
        transverse_inertia: of the wheel about any transverse axis through its centre of mass,
            without the rotor [kg m^2].
        hoop_stress: largest, at the bore, at the highest wheel speed [Pa].
        stress_margin: yield strength over hoop stress; None if the strength is unknown.
        stored_energy: at the highest wheel speed [J].
        web: web and hub; None: massless spokes, or a ring around the motor's bell.
        cuts: chamfers and balancing holes of the rim.
    """

    inner_radius: LengthIfAny
    outer_radius: Length
    height: Length
    material: str
    density: Positive
    mass: Positive
    spin_inertia: Positive
    transverse_inertia: NotNegative
    hoop_stress: NotNegative | None
    stress_margin: Signed | None
    stored_energy: NotNegative
    web: Web | None = None
    cuts: RimCuts = NO_CUTS

    @property
    def shape(self) -> Wheel:
        """The wheel as made.

        Raises:
            PartError: it cannot be made.
        """
        size = self.inner_radius, self.outer_radius, self.height
        return Wheel(Rim(*size, self.material, self.density, self.cuts), self.web)

    @property
    def rim_mass(self) -> float:
        """Mass of the rim alone [kg]."""
        return self.mass - (0.0 if self.web is None else self.web.mass)


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

    @property
    def supports(self) -> tuple[CarrierPlate | Pedestal, ...]:
        """Parts between the feet and the trunk: plate and pedestals."""
        return (*(() if self.plate is None else (self.plate,)), *self.pedestals)

    def with_supports(self, robot: MassProperties) -> MassProperties:
        """Mass properties of a robot with plate or pedestals on it, in B."""
        supports = [support.mass_properties() for support in self.supports]
        return combine([robot, *supports]) if supports else robot

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
        return braked(self.with_supports(robot), bodies, centers, self.incidence, self.layout)

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
