"""Records of the device in its place."""

from collections.abc import Mapping
from dataclasses import dataclass

from ocs_design.actuation.drive import Drive
from ocs_design.common.arrays import Matrix, Vector
from ocs_design.device.layout import Layout, LayoutName
from ocs_design.parts.carrier_plate import CarrierPlate
from ocs_design.parts.pedestal import Pedestal
from ocs_design.parts.printed import PLATE_THICKNESS
from ocs_design.parts.solids import NO_CARRIER, Carrier
from ocs_design.parts.wheel import Flywheel


@dataclass(frozen=True, kw_only=True)
class ModuleRecord:
    """Axis and position of one module, in B."""

    name: str
    axis: Vector
    position: Vector


@dataclass(frozen=True)
class Clearance:
    """Clearance of a module to the nearest part.

    Attributes:
        part: name of a body of the robot, or of the other wheel.
        distance: between the surfaces, negative if they overlap [m].
    """

    part: str
    distance: float


@dataclass(frozen=True, kw_only=True)
class ReachRecord:
    """A limb that could hit the device (`robot.clearance.Reach`)."""

    part: str
    joints: Mapping[str, float]


@dataclass(frozen=True, kw_only=True)
class MountingRecord:
    """How the device sits on its robot (`sizing.mounting.DeviceMounting`)."""

    landing: Clearance | None
    reachable: tuple[ReachRecord, ...]
    com_shift: Vector
    inertia_change: Vector


@dataclass(frozen=True, kw_only=True)
class OcsRecord:
    """The device, with the supports of its feet.

    `mass_total` is of the whole device, with plate or pedestals [kg]; `total_...` of robot and
    braked device. `center_of_mass` is of the device alone, in B; None in files of older versions.
    `fitting` lists work left to do by hand: see `export.assembly_notes`. `layout` is the
    arrangement of the axes, and `incidence` its angle: the axes of a pair are at plus and minus
    that.
    """

    incidence: float
    incidence_criterion: str
    incidence_by_criterion: Mapping[str, float]
    incidence_by_criterion_robot_alone: Mapping[str, float]
    heading_drift: tuple[float, float]
    spin_inertia: float
    mass_total: float
    total_mass: float
    total_inertia: Matrix
    total_com: Vector
    modules: tuple[ModuleRecord, ...]
    clearance: Clearance | None
    flywheel: Flywheel
    motor: Drive
    carrier: Carrier = NO_CARRIER
    plate: CarrierPlate | None = None
    pedestals: tuple[Pedestal, ...] = ()
    guard_wall: float = 0.0
    foot_plate: float = PLATE_THICKNESS
    on_bell: bool = False
    center_of_mass: Vector | None = None
    warnings: tuple[str, ...] = ()
    fitting: tuple[str, ...] = ()
    mounting: MountingRecord | None = None
    layout: LayoutName = LayoutName.PAIR

    @property
    def axes(self) -> Layout:
        """Layout of the modules' axes."""
        axes = (module.axis for module in self.modules)
        return Layout(self.layout, tuple(axes) if self.layout is LayoutName.BY_HAND else ())
