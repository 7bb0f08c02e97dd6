"""Records of the device in its place, its margins and its open points."""

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

    def device(self, supply: Supply | None = None) -> Device:
        """The device exactly as designed; `supply` is its supply."""
        modules = (
            Module(module.name, np.array(module.axis), np.array(module.position))
            for module in self.modules
        )
        return recorded(Device, self, modules=tuple(modules), supply=supply, layout=self.axes)

    @property
    def axes(self) -> Layout:
        """Layout of the modules' axes."""
        axes = (module.axis for module in self.modules)
        return Layout(self.layout, tuple(axes) if self.layout is LayoutName.BY_HAND else ())


@dataclass(frozen=True)
class Margin:
    """Demand on one part against its capacity.

    Attributes:
        name: of the quantity; each name is one kind of margin.
        demand: largest demand, never negative.
        capacity: of the part; None: no limit, or an unknown one; `note` says which.
        unit: of both, SI.
        margin: capacity over demand, exceeded below 1; None: no limit or no demand.
        scenario: name of the maneuver with the largest demand; empty if none.
        note: basis of the figures, one sentence; may be empty.
    """

    name: str
    demand: float
    capacity: float | None
    unit: str
    margin: float | None = field(default=None, init=False)
    scenario: str = ""
    note: str = ""

    def __post_init__(self) -> None:
        capacity, demand = self.capacity, self.demand
        # A field that is set is written to the file, even if None.
        margin = None if capacity is None or demand == 0.0 else capacity / demand
        object.__setattr__(self, "margin", margin)

    @property
    def sort_key(self) -> tuple[float, float]:
        """Sort key: demand as a fraction of the capacity, then demand."""
        return (0.0 if self.margin is None else 1.0 / self.margin, self.demand)


@dataclass(frozen=True, kw_only=True)
class OpenPoint:
    """An obstacle to building a device, and the cure."""

    what: str
    cure: str


@dataclass(frozen=True, kw_only=True)
class Buildable:
    """Whether the device can be built as designed; None where that is unknown."""

    yes: bool | None
    open: tuple[OpenPoint, ...] = ()
