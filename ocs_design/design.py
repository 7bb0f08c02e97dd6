"""The one artefact: a designed orientation control system as a frozen value."""

from dataclasses import dataclass, replace

import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.drive.gear import DIRECT, GearRoom
from ocs_design.drive.mounting import Mounting
from ocs_design.requirement.maneuver import Maneuver
from ocs_design.sizing.carrier import Carrier
from ocs_design.sizing.incidence import module_axes
from ocs_design.sizing.rim_cuts import NO_CUTS, RimCuts
from ocs_design.sizing.web import Hub

NO_CARRIER = Carrier(mass=0.0, axial_inertia=0.0, transverse_inertia=0.0)
"""Of the assumed motor, which weighs nothing."""


@dataclass(frozen=True)
class Web:
    """What joins a rim to its motor, in one piece: a disc in its middle plane and a hub.

    Attributes:
        material: name in the catalogue. density: [kg/m^3].
        thickness: of the disc, which fills the rim's bore [m].
        mass: with the hub and its holes [kg].
        hub: in its middle.
    """

    material: str
    density: float
    thickness: float
    mass: float
    hub: Hub


@dataclass(frozen=True)
class Flywheel:
    """A hollow cylinder on a web that spins about its z axis.

    Attributes:
        inner_radius, outer_radius, height: of the rim [m].
        material: of the rim, name in the catalogue. density: [kg/m^3].
        mass: of the whole wheel [kg].
        spin_inertia: angular momentum about the spin axis per speed relative to the trunk, the
            motor's rotor included [kg m^2].
        transverse_inertia: of the wheel about any axis across it through its centre of mass,
            without the rotor [kg m^2].
        hoop_stress: largest, at the bore, at the highest wheel speed [Pa].
        stress_margin: yield strength over hoop stress; None if the strength is not known.
        stored_energy: at the highest wheel speed [J].
        web: None: massless spokes.
        cuts: chamfers and balancing holes of the rim.
    """

    inner_radius: float
    outer_radius: float
    height: float
    material: str
    density: float
    mass: float
    spin_inertia: float
    transverse_inertia: float
    hoop_stress: float | None
    stress_margin: float | None
    stored_energy: float
    web: Web | None = None
    cuts: RimCuts = NO_CUTS

    @property
    def rim_mass(self) -> float:
        """Of the rim alone [kg]."""
        return self.mass - (0.0 if self.web is None else self.web.mass)


SIDES = ("left", "right")
"""Of the trunk; where there is one of something for each, in this order."""


@dataclass(frozen=True, eq=False)
class Module:
    """One flywheel on the trunk.

    Attributes:
        name: of its side.
        axis: unit spin axis in B, shape (3,).
        position: of the wheel's centre of mass in B [m], shape (3,).
    """

    name: str
    axis: FloatArray
    position: FloatArray


@dataclass(frozen=True)
class Motor:
    """What drives a wheel: the voltage line, the limits and the gear, all at the wheel.

    None is what is not limited or not known; with the assumed motor that is all but its speed and,
    where one was stated, its torque.

    Attributes:
        name: in the catalogue, or "assumed".
        mass: of the motor alone, without its gear [kg].
        stall_torque: torque of the voltage line at rest [N m]; None: full torque to the top speed.
        no_load_speed: of the voltage line [rad/s].
        torque_limit: at the current limit of motor and drive, or of the gear [N m].
        rotor_inertia: what the rotor adds to the spin inertia of the wheel [kg m^2]: its own times
            the gear ratio, negative where the gear reverses.
        source: where the figures come from.
        gear: name in the catalogue, or "direct".
        gear_ratio: motor speed over wheel speed.
        gear_efficiency: of the torque, 0..1, taken as a loss both ways.
        gear_mass: [kg].
        bus_voltage: [V].
        rated_voltage: that the motor is made for [V].
        diameter, length: of its body [m].
        speed_max: mechanical, of wheel, gear and motor [rad/s].
        armature: what the motor accelerates beyond the spin inertia of the wheel, at the wheel
            [kg m^2]; 0 without a gear.
        torque_constant: of the motor itself, six-step, between two lines [N m/A].
        resistance: of the motor between two lines [ohm].
        continuous_torque: that the winding stands for good [N m].
        mounting: its shaft and threads, where the wheel sits on it without a gear and any is known.
        no_load_current: that the motor itself draws turning freely at its rated voltage [A].
        gear_room: that its gear takes; None: there is no gear.
        saturation_torque: at the wheel, above which the motor's k_t falls off [N m].
    """

    name: str
    mass: float
    stall_torque: float | None
    no_load_speed: float
    torque_limit: float | None
    rotor_inertia: float
    source: str
    gear: str = DIRECT.name
    gear_ratio: float = DIRECT.ratio
    gear_efficiency: float = DIRECT.efficiency
    gear_mass: float = DIRECT.mass
    bus_voltage: float | None = None
    speed_max: float | None = None
    armature: float = 0.0
    torque_constant: float | None = None
    resistance: float | None = None
    continuous_torque: float | None = None
    rated_voltage: float | None = None
    diameter: float | None = None
    length: float | None = None
    mounting: Mounting | None = None
    no_load_current: float | None = None
    gear_room: GearRoom | None = None
    saturation_torque: float | None = None


@dataclass(frozen=True, eq=False)
class Device:
    """The orientation control system: two equal modules and what drives them.

    Attributes:
        incidence: angle between each wheel axis and the lateral direction y [rad].
        modules: left and right.
        flywheel: of each module.
        motor: of each module.
        carrier: what of each module stands still with the trunk, in the module's own frame
            (`sizing.incidence.module_frames`).
    """

    incidence: float
    modules: tuple[Module, Module]
    flywheel: Flywheel
    motor: Motor
    carrier: Carrier = NO_CARRIER

    @property
    def mass(self) -> float:
        """Of both modules: wheels, motors, gears, housings and feet [kg]."""
        return 2.0 * (self.flywheel.mass + self.carrier.mass)

    @property
    def axes(self) -> FloatArray:
        """Spin axes as columns, the matrix C of the paper, shape (3, 2)."""
        return np.column_stack([module.axis for module in self.modules])

    def at_incidence(self, incidence: float) -> "Device":
        """The same device with its modules turned by hand, as the paper does for its back-flip."""
        axes = module_axes(incidence)
        turned = [
            replace(module, axis=axis) for module, axis in zip(self.modules, axes.T, strict=True)
        ]
        return replace(self, incidence=incidence, modules=(turned[0], turned[1]))

    def as_flown(self, maneuver: Maneuver) -> "Device":
        """At the maneuver's own incidence, if it has one."""
        return self if maneuver.incidence is None else self.at_incidence(maneuver.incidence)
