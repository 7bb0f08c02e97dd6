"""What the selection chooses from, and for what."""

from collections.abc import Sequence
from dataclasses import dataclass

from ocs_design.catalogue.materials import Material
from ocs_design.drive.gear import DIRECT, Gear
from ocs_design.drive.motor import Motor
from ocs_design.requirement.envelope import Envelope
from ocs_design.requirement.requirement import Requirement
from ocs_design.robot.mass_properties import MassProperties
from ocs_design.sizing.placement import Place
from ocs_design.sizing.rim_cuts import NO_CUTS, RimCuts
from ocs_design.sizing.web import Hub, hub_of


@dataclass(frozen=True, eq=False)
class SelectionProblem:
    """Find the lightest device that does everything that is required.

    Attributes:
        robot: without the device, in B.
        requirement: what the device must do; its `wheel_speed_max` is not looked at here. A stated
            spin inertia is kept, and the motors must do with it what is required.
        envelope: room for one rim; its housing stands around it.
        place: of the modules, by outer radius and height of their housings.
        motors, gears, materials: to choose from; direct drive is the gear `DIRECT`.
        bus_voltage: of the motors' supply [V].
        incidence: of the wheel axes [rad]; None: the best.
        wheel_speed_max: stated highest speed of a wheel [rad/s]; None: what the drive can do.
        web: whether wheels have a web and a hub; massless spokes otherwise.
        cuts: chamfers and balancing holes of wheels with a web; those without are plain rims.
    """

    robot: MassProperties
    requirement: Requirement
    envelope: Envelope
    place: Place
    motors: Sequence[Motor]
    gears: Sequence[Gear]
    materials: Sequence[Material]
    bus_voltage: float
    incidence: float | None = None
    wheel_speed_max: float | None = None
    web: bool = True
    cuts: RimCuts = NO_CUTS

    def hub(self, motor: Motor, gear: Gear) -> Hub | None:
        """Of a wheel on this motor behind this gear; None: massless spokes."""
        if not self.web:
            return None
        return hub_of(motor, direct=gear == DIRECT, chamfer=self.cuts.chamfer)
