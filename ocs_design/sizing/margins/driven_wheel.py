"""One wheel with all that turns and holds it."""

from dataclasses import dataclass, replace
from functools import cached_property
from math import inf

from ocs_design.catalogue.materials import Material
from ocs_design.drive.gear import Gear
from ocs_design.drive.line import DriveLine, armature, drive_line, rotor_share
from ocs_design.drive.motor import Motor
from ocs_design.sizing.carrier import Carrier
from ocs_design.sizing.cylinder import hoop_stress
from ocs_design.sizing.rim_cuts import NO_CUTS, RimCuts
from ocs_design.sizing.selection.drive_table import OVERSPEED
from ocs_design.sizing.web import Hub, wheel_body


@dataclass(frozen=True, eq=False)
class DrivenWheel:
    """Wheel, motor, gear and supply of one module.

    Attributes:
        inner_radius, outer_radius, height: of the rim [m].
        material: of the rim.
        motor, gear: that drive it.
        bus_voltage: [V].
        wheel_speed_max: stated highest speed of the wheel [rad/s]; inf: none.
        hub: in the middle of the wheel's web; None: massless spokes.
        cuts: off the rim.
    """

    inner_radius: float
    outer_radius: float
    height: float
    material: Material
    motor: Motor
    gear: Gear
    bus_voltage: float
    wheel_speed_max: float = inf
    hub: Hub | None = None
    cuts: RimCuts = NO_CUTS

    @cached_property
    def line(self) -> DriveLine:
        """All that the motor does at the wheel, without a reserve; scalars.

        Raises:
            OcsError: the motor lacks a figure that every drive needs.
        """
        line = drive_line(self.motor, self.gear, self.bus_voltage)
        return replace(line, speed_max=min(float(line.speed_max), self.wheel_speed_max))

    @property
    def body(self) -> Carrier:
        """Rim, web and hub; what is known of the rotor's transverse inertia is nothing."""
        size = (self.inner_radius, self.outer_radius, self.height)
        return wheel_body(*size, self.material.density, self.hub, cuts=self.cuts)

    @property
    def spin_inertia(self) -> float:
        """Momentum per wheel speed, of wheel and rotor [kg m^2]."""
        return self.body.axial_inertia + rotor_share(self._rotor_inertia, self.gear)

    @property
    def moved_inertia(self) -> float:
        """What the motor accelerates, of wheel, gear and rotor [kg m^2]."""
        return self.spin_inertia + armature(self._rotor_inertia, self.gear)

    @property
    def axial_inertia(self) -> float:
        """Of wheel and rotor about its axis while they do not turn on the trunk [kg m^2]."""
        return self.body.axial_inertia + self._rotor_inertia

    @property
    def _rotor_inertia(self) -> float:
        """Counted as nothing where it is not stated."""
        return self.motor.rotor_inertia or 0.0

    @property
    def wheel_speed_reached(self) -> float:
        """No-load speed at the bus voltage, or the mechanical limit if that is lower [rad/s]."""
        return min(float(self.line.no_load_speed), float(self.line.speed_max))

    @property
    def overspeed_stress(self) -> float | None:
        """Hoop stress at `OVERSPEED` times the speed reached [Pa]; None: no Poisson's ratio."""
        if self.material.poisson_ratio is None:
            return None
        return hoop_stress(
            self.inner_radius,
            self.outer_radius,
            density=self.material.density,
            poisson_ratio=self.material.poisson_ratio,
            wheel_speed=OVERSPEED * self.wheel_speed_reached,
        )
