"""A wheel of real material with the motor, the gear and the supply that drive it."""

from dataclasses import dataclass
from functools import cached_property

from ocs_design.actuation.drive import Drive, DriveLine
from ocs_design.actuation.motor import Gear, Motor
from ocs_design.actuation.supply import Supply
from ocs_design.catalogue.materials import Material
from ocs_design.parts.joints import OVERSPEED
from ocs_design.parts.rim import NO_CUTS, Hub, RimCuts, wheel_body
from ocs_design.parts.solids import Carrier
from ocs_design.parts.wheel import Flywheel


@dataclass(frozen=True, eq=False, kw_only=True)
class DrivenWheel:
    """Wheel, motor, gear and supply of one module.

    Attributes:
        inner_radius, outer_radius, height: of the rim [m].
        material: of the rim.
        motor, gear: motor and gear that drive it.
        line: voltage line of the drive at the wheel, without reserve, up to a specified top
            speed.
        supply: of all motors.
        hub: in the middle of the wheel's web; None: massless spokes.
        cuts: off the rim.
        web_material: of web and hub; None: of one piece with the rim.
    """

    inner_radius: float
    outer_radius: float
    height: float
    material: Material
    motor: Motor
    gear: Gear
    line: DriveLine
    supply: Supply
    hub: Hub | None = None
    cuts: RimCuts = NO_CUTS
    web_material: Material | None = None

    @cached_property
    def wheel(self) -> Carrier:
        """Rim, web and hub, without the rotor, whose transverse inertia no source gives."""
        size = (self.inner_radius, self.outer_radius, self.height)
        web = None if self.web_material is None else self.web_material.density
        return wheel_body(*size, self.material.density, self.hub, cuts=self.cuts, web_density=web)

    @cached_property
    def drive(self) -> Drive:
        """Motor behind its gear at the supply's voltage."""
        return Drive.of(self.motor, self.gear, self.supply.voltage, self.line)

    @property
    def rotor_inertia(self) -> float:
        """Inertia of the motor's rotor [kg m^2]; 0 where it is not stated."""
        return self.motor.rotor_inertia or 0.0

    @cached_property
    def flywheel(self) -> Flywheel:
        """The wheel as it is made, with the rotor's share, at the drive's top speed."""
        return Flywheel.of(
            (self.inner_radius, self.outer_radius, self.height),
            self.material,
            self.drive.top_speed,
            self.drive.rotor_inertia,
            self.hub,
            cuts=self.cuts,
            web_material=self.web_material,
        )

    @property
    def torque_constant(self) -> float:
        """Torque constant [N m/A]; a drive with a line has one."""
        assert self.motor.torque_constant is not None, "the line has it"
        return self.motor.torque_constant

    @property
    def resistance(self) -> float:
        """Line-to-line resistance [ohm]; a drive with a voltage line has one."""
        assert self.motor.resistance is not None, "the line has it"
        return self.motor.resistance

    @property
    def overspeed_stress(self) -> float | None:
        """Hoop stress at `OVERSPEED` times the top speed [Pa]; None: Poisson's ratio is unknown."""
        stress = self.flywheel.hoop_stress
        return None if stress is None else OVERSPEED**2 * stress
