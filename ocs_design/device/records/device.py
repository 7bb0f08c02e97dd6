"""The device in its place, its margins and what keeps it from being built."""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from ocs_design.actuation.drive import Drive
from ocs_design.actuation.supply import Supply
from ocs_design.common.arrays import Matrix, Vector
from ocs_design.common.records import recorded
from ocs_design.device.device import NO_CARRIER, Device, Flywheel, Module
from ocs_design.device.layout import Layout, LayoutName
from ocs_design.parts.carrier_plate import CarrierPlate
from ocs_design.parts.pedestal import Pedestal
from ocs_design.parts.printed import PLATE_THICKNESS
from ocs_design.parts.solids import Carrier


@dataclass(frozen=True, kw_only=True)
class ModuleRecord:
    """Axis and position of one module, in B."""

    name: str
    axis: Vector
    position: Vector


@dataclass(frozen=True)
class Clearance:
    """The part that a module is nearest to.

    Attributes:
        part: name of a body of the robot, or of the other wheel.
        distance: between the surfaces, negative if they overlap [m].
    """

    part: str
    distance: float


@dataclass(frozen=True, kw_only=True)
class ReachRecord:
    """Limb that could hit the device (`robot.clearance.Reach`)."""

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
    """The device, with what its feet stand on.

    `mass_total` is of the whole device, with plate or pedestals [kg]; `total_...` of robot and
    braked device.
    `center_of_mass` is of the device alone, in B; None in files of older versions.
    `fitting` is what is left to do by hand: see `export.assembly_notes`. `layout` is how the axes
    lie, and `incidence` its angle: of a pair the axes are at plus and minus that.
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

    def device(self, supply: Supply | None = None) -> Device:
        """The device that was designed, to the last digit; `supply` is what feeds it."""
        modules = (
            Module(each.name, np.array(each.axis), np.array(each.position)) for each in self.modules
        )
        return recorded(Device, self, modules=tuple(modules), supply=supply, layout=self.axes)

    @property
    def axes(self) -> Layout:
        """Layout of the modules' axes."""
        axes = (each.axis for each in self.modules)
        return Layout(self.layout, tuple(axes) if self.layout is LayoutName.BY_HAND else ())


@dataclass(frozen=True)
class Margin:
    """What is asked of one part against what it stands.

    Attributes:
        name: of the quantity; one name is one kind of margin.
        demand: largest that is asked, never negative.
        capacity: what the part stands; None: no limit, or none known, and `note` says which.
        unit: of both, SI.
        margin: capacity over demand: below 1 it is exceeded; None: no limit, or nothing asked.
        scenario: name of the maneuver that asks it; empty if none does.
        note: what the figures rest on, one sentence; empty if there is nothing to say.
    """

    name: str
    demand: float
    capacity: float | None
    unit: str
    margin: float | None = field(default=None, init=False)
    scenario: str = ""
    note: str = ""

    def __post_init__(self) -> None:
        capacity, asked = self.capacity, self.demand
        # A figure that is set is written, also where it is none.
        margin = None if capacity is None or asked == 0.0 else capacity / asked
        object.__setattr__(self, "margin", margin)

    @property
    def strain(self) -> tuple[float, float]:
        """Grows with what is asked, and with its share of the capacity first."""
        return (0.0 if self.margin is None else 1.0 / self.margin, self.demand)


@dataclass(frozen=True, kw_only=True)
class OpenPoint:
    """What keeps a device from being built, and the cure."""

    what: str
    cure: str


@dataclass(frozen=True, kw_only=True)
class Buildable:
    """Whether the device can be built as it stands; None where that cannot be told."""

    yes: bool | None
    open: tuple[OpenPoint, ...] = ()
