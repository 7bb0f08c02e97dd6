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
from ocs_design.robot.probe import Reach


@dataclass(frozen=True, kw_only=True)
class ModuleRecord:
    """Axis and position of one module.

    Attributes:
        name: `left` and `right` of a pair, otherwise `1`, `2` and so on.
        axis: about which its wheel turns, a unit vector in B.
        position: of the wheel's centre in B [m].
    """

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
class MountingRecord:
    """How the device sits on its robot (`sizing.mounting.DeviceMounting`).

    Attributes:
        landing: clearance to parts that move relative to the trunk, while the legs give way as in
            landings; None if there are none.
        reachable: limbs that could hit a module somewhere within their joint limits.
        com_shift: shift of the centre of mass by the device, in B [m].
        inertia_change: change of Ixx, Iyy and Izz about the centre of mass, relative to the robot's
            own.
    """

    landing: Clearance | None
    reachable: tuple[Reach, ...]
    com_shift: Vector
    inertia_change: Vector


@dataclass(frozen=True, kw_only=True)
class OcsRecord:
    """The device, with the supports of its feet.

    Attributes:
        incidence: angle of the layout [rad]; the axes of a pair are at plus and minus that.
        incidence_criterion: by which it was chosen.
        incidence_by_criterion: under each criterion, for robot and device [rad].
        incidence_by_criterion_robot_alone: the same for the robot alone.
        heading_drift: yaw that a turn in roll, and one in pitch, brings about by the products of
            inertia, over the angle of that turn.
        spin_inertia: of one wheel with its rotor [kg m^2].
        mass_total: of the whole device, with plate or pedestals [kg].
        total_mass: of robot and device [kg]. total_com: their centre of mass in B [m].
        total_inertia: of robot and braked device about it, in B [kg m^2].
        modules: one for each wheel, all alike.
        clearance: to the nearest part in the posture; None if the robot has no geometry.
        flywheel: of each module. motor: of each, with its gear, at the supply's voltage.
        carrier: stationary parts of each module: motor, gear, controller, housing, foot.
        plate: under the feet; None: the feet stand on the trunk.
        pedestals: under leaning feet.
        guard_wall: wall of the steel ring in each housing [m]; 0: none.
        foot_plate: thickness of the feet's plates [m].
        on_bell: whether the wheels are rings around the motors' bells.
        center_of_mass: of the device alone, in B [m]; None in files of older versions.
        warnings: one sentence each.
        fitting: work left to do by hand, one sentence each (`export.assembly_notes`).
        mounting: how it sits on the robot.
        layout: arrangement of the axes.
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
