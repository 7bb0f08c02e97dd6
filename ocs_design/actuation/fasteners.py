"""Metric screws, and the holes that they need."""

from dataclasses import dataclass
from enum import Enum
from math import asin, ceil, inf, isfinite, pi, sin, sqrt
from typing import Annotated, TypeAlias

from ocs_design.common.errors import PartError
from ocs_design.common.ranges import Count, Length, LengthIfAny, OneOf


@dataclass(frozen=True)
class Screw:
    """A socket head cap screw (ISO 4762) with coarse thread.

    Attributes:
        name: such as "M3".
        diameter: of the thread [m].
        clearance_hole: diameter of its clearance hole, medium fit of ISO 273 [m].
        tapping_drill: diameter of the drill for its thread, ISO 2306 [m].
        head_diameter, head_height: largest values [m].
        pitch: of the thread [m].
        key, key_depth: width across flats and least depth of its hexagon socket [m].
    """

    name: str
    diameter: float
    clearance_hole: float
    tapping_drill: float
    head_diameter: float
    head_height: float
    pitch: float
    key: float
    key_depth: float

    def length_through(self, thickness: float, depth: float = 1.0) -> float:
        """Standard length for parts of that thickness and a thread behind them [m].

        `depth`: least thread engagement in diameters: 1 suffices in aluminium and steel,
        `IN_PLASTIC` in a printed part.
        """
        least = 1e3 * (thickness + depth * self.diameter)
        long_enough = (length for length in LENGTHS if length >= least - 1e-9)
        # Sized parts never need a longer one.
        return 1e-3 * next(long_enough, 20 * ceil(least / 20.0 - 1e-9))

    @property
    def least_thread(self) -> float:
        """Thread in metal of a screw that would otherwise be cut from a longer one, at least [m].

        Three turns, an assumption: the first ones carry most.
        """
        return 3.0 * self.pitch

    @property
    def usual_length(self) -> float:
        """Longest in which it is commonly sold, ten times its diameter (ISO 4762, table 1) [m]."""
        return 10.0 * self.diameter

    def designation(self, length: float) -> str:
        """Designation of a screw of this length [m]."""
        return f"ISO 4762 {self.name} x {1e3 * length:.0f}"

    def mass(self, length: float) -> float:
        """Mass of a steel screw of this length [m], fully threaded [kg].

        Head and thread are cylinders, less the socket; the thread has its stress area (ISO 898-1,
        9.1.6.1: about the mean of its profile). The result is within about a tenth of makers'
        tables.
        """
        return self._head_mass + self._thread_mass(length)

    def centre(self, length: float) -> float:
        """Centre of mass, from under the head towards the tip [m]; the head has a socket."""
        moment = self._thread_mass(length) * length - self._head_mass * self.head_height
        return moment / (2.0 * self.mass(length))

    @property
    def stress_area(self) -> float:
        """Tensile stress area of its thread, pi / 4 (d - 0.9382 P)^2 (ISO 898-1, 9.1.6.1) [m^2]."""
        return pi / 4.0 * self.stressed_diameter**2

    @property
    def preload(self) -> float:
        """Preload of a class 8.8 screw tightened to 90 % of its yield strength [N].

        VDI 2230-1:2015, with `MU` in the thread: `0.9 R_p A_s / sqrt(1 + 3 (3/2 d_2/d_0 (P / (pi
        d_2) + 1.155 mu))^2)`, d_0 that of the stress area.
        """
        flank, area = self._pitch_diameter, self.stress_area
        twist = 1.5 * flank / self.stressed_diameter * (self.pitch / (pi * flank) + 1.155 * MU)
        return 0.9 * CLASSES[USUAL_CLASS].yields * area / sqrt(1.0 + 3.0 * twist**2)

    def torque(self, preload: float) -> float:
        """Tightening torque [N m] for a preload [N], with `MU` in the thread and under the head.

        VDI 2230-1:2015: `F (0.16 P + 0.58 d_2 mu + D_km mu / 2)`, D_km between hole and head.
        """
        under_head = (self.head_diameter + self.clearance_hole) / 4.0
        return preload * (0.16 * self.pitch + (0.58 * self._pitch_diameter + under_head) * MU)

    @property
    def head_area(self) -> float:
        """Bearing area of its head around a medium clearance hole [m^2]."""
        return pi / 4.0 * (self.head_diameter**2 - self.clearance_hole**2)

    def slot_area(self, across: float) -> float:
        """Bearing area of a head or washer over a slot as wide as a clearance hole [m^2].

        It is the disc of the head, of diameter `across` [m], less the strip of the slot.
        """
        radius, half = across / 2.0, self.clearance_hole / 2.0
        strip = 2.0 * (half * sqrt(radius**2 - half**2) + radius**2 * asin(half / radius))
        return pi * radius**2 - strip

    @property
    def _pitch_diameter(self) -> float:
        """Pitch diameter of the basic profile, ISO 724 [m]."""
        return self.diameter - 0.6495 * self.pitch

    @property
    def stressed_diameter(self) -> float:
        """Diameter of the stress area [m]."""
        return self.diameter - 0.9382 * self.pitch

    @property
    def _head_mass(self) -> float:
        head = pi / 4.0 * self.head_diameter**2 * self.head_height
        return STEEL * (head - sqrt(0.75) * self.key**2 * self.key_depth)

    def _thread_mass(self, length: float) -> float:
        return STEEL * self.stress_area * length


@dataclass(frozen=True)
class PropertyClass:
    """Strength of screws up to M16 (ISO 898-1, table 3).

    Attributes:
        proof: stress under proof load [Pa]. yields: least yield strength [Pa].
        depth: least thread engagement in aluminium, in diameters, which grows with the preload.
    """

    proof: float
    yields: float
    depth: float


USUAL_CLASS = "8.8"
"""Default property class of screws."""

CLASSES = {
    USUAL_CLASS: PropertyClass(580e6, 640e6, 1.0),
    "10.9": PropertyClass(830e6, 940e6, 1.4),
    "12.9": PropertyClass(970e6, 1100e6, 1.7),
}


class BoltedJoint(Enum):
    """Joint of a module that is made by equal screws; the value is its wording."""

    WHEEL = "wheel on rotor"
    MOTOR = "motor on housing and foot"
    MOTOR_IN_CAGE = "motor in its cage"
    CAGE = "housing and foot on cage"
    LID = "lid on drum"
    FOOT_ON_TRUNK = "foot on trunk"
    FOOT_ON_PLATE = "foot on plate"
    FOOT_ON_PEDESTAL = "foot on pedestal"
    PLATE = "plate on trunk"
    MAST = "mast on trunk"
    PEDESTAL = "pedestal on trunk"

    @property
    def of_foot(self) -> bool:
        """Whether the screws hold a foot, through its slots."""
        feet = (BoltedJoint.FOOT_ON_TRUNK, BoltedJoint.FOOT_ON_PLATE, BoltedJoint.FOOT_ON_PEDESTAL)
        return self in feet

    @property
    def of_support(self) -> bool:
        """Whether the screws hold what stands between trunk and foot."""
        return self in (BoltedJoint.PLATE, BoltedJoint.MAST, BoltedJoint.PEDESTAL)

    @property
    def in_motor(self) -> bool:
        """Whether the threads are the motor's."""
        return self in (BoltedJoint.WHEEL, BoltedJoint.MOTOR, BoltedJoint.MOTOR_IN_CAGE)

    @property
    def in_print(self) -> bool:
        """Whether the threads are tapped in a printed part."""
        return self in (BoltedJoint.CAGE, BoltedJoint.LID, BoltedJoint.FOOT_ON_PEDESTAL)

    @property
    def on_print(self) -> bool:
        """Whether the screws go through a print and their heads press on it."""
        return self not in (BoltedJoint.WHEEL, BoltedJoint.PLATE, BoltedJoint.MAST)

    @property
    def in_trunk(self) -> bool:
        """Whether the threads are the trunk's."""
        return self.of_support or self is BoltedJoint.FOOT_ON_TRUNK


@dataclass(frozen=True)
class Fastening:
    """Equal screws of one module.

    Attributes:
        screw: type of screw. count: number of screws.
        thickness: of the parts that they go through [m].
        joint: that they make.
        depth: least thread engagement in diameters.
        strength: their property class.
        engagement_min: least in the part they are screwed into, where its maker gives one [m].
        engagement_max: largest there [m]: longer ones are shortened; inf: any.
        piece: name of the piece that they hold, if its joint is made in several shapes.
        several_lengths: whether the joint also has screws of other lengths.
    """

    screw: Screw
    count: int
    thickness: float
    joint: BoltedJoint
    depth: float = 1.0
    strength: str = USUAL_CLASS
    engagement_min: float = 0.0
    engagement_max: float = inf
    piece: str = ""
    several_lengths: bool = False

    @property
    def designation(self) -> str:
        """Designation of the screw, with its class if not the default."""
        strength = "" if self.strength == USUAL_CLASS else f" - {self.strength}"
        return self.screw.designation(self.length) + strength

    @property
    def length(self) -> float:
        """Length of each screw under its head [m]."""
        depth = max(self.depth, self.engagement_min / self.screw.diameter)
        return self.screw.length_through(self.thickness, depth)

    @property
    def engagement(self) -> float:
        """Length of each that is in the part they are screwed into, once shortened [m]."""
        return min(self.length - self.thickness, self.engagement_max)

    @property
    def shortened(self) -> float | None:
        """Length to which each is cut [m]; None: it fits as it is bought."""
        longest = self.thickness + self.engagement_max
        return longest if self.length > longest else None

    @property
    def name(self) -> str:
        """Wording of the joint."""
        if self.piece:
            return f"{self.piece.replace('_', ' ')} on trunk"
        return self.joint.value

    @property
    def purpose(self) -> str:
        """Wording of the joint, with any caution."""
        text, cut_to = self.name, self.shortened
        if self.several_lengths:
            text += f", {1e3 * self.length:.0f} mm long"
        if self.joint.in_print:
            text += ", which is tapped"
        elif self.joint.in_trunk:
            text += "; longer if the trunk's thread starts deeper"
        elif self.joint.in_motor:
            text += "; check the depth of the motor's thread"
            if self.engagement_min > 0.0:
                text += (
                    f", its maker specifies {1e3 * self.engagement_min:.4g} to "
                    f"{1e3 * self.engagement_max:.4g} mm"
                )
            elif isfinite(self.engagement_max):
                text += f", a CAD model has {1e3 * (self.engagement_max + OFF_BOTTOM):.4g} mm"
            if cut_to is not None:
                text += f": shorten them to {1e3 * cut_to:.3g} mm"
        elif cut_to is not None:
            text += f"; cut to {1e3 * cut_to:.1f} mm, or they reach the trunk"
        return text

    @property
    def mass(self) -> float:
        """Mass of all screws [kg]."""
        return self.count * self.screw.mass(self.length)

    @property
    def centre(self) -> float:
        """Centre of mass of each screw, from under its head towards its tip [m]."""
        return self.screw.centre(self.length)


OFF_BOTTOM = 0.5e-3
"""Room that is left between a screw's tip and the bottom of its hole in a motor [m]."""

LIGAMENT = 1.0e-3
"""Least material between holes, from holes to edges, and between their bottoms [m]."""

IN_PLASTIC = 2.0
"""Least thread engagement in a printed part, in diameters."""

STEEL = 7850.0
"""Density of steel [kg/m^3]."""

MU = 0.12
"""Friction coefficient of plain or zinc-plated screws, lightly oiled (VDI 2230-1, table A5, class
B: 0.08 to 0.16)."""

LENGTHS = (4, 5, 6, 8, 10, 12, 16, *range(20, 71, 5), *range(80, 161, 10), *range(180, 301, 20))
"""Standard lengths from 4 mm up [mm]: ISO 4762:2004, table 1."""


def longest_within(length_max: float) -> float:
    """Longest standard length that is at most that [m]; 0: none."""
    return max(
        (1e-3 * length for length in LENGTHS if length <= 1e3 * length_max + 1e-9), default=0.0
    )


SCREWS = (
    Screw("M2", 2.0e-3, 2.4e-3, 1.6e-3, 3.8e-3, 2.0e-3, 0.4e-3, 1.5e-3, 1.0e-3),
    Screw("M2.5", 2.5e-3, 2.9e-3, 2.05e-3, 4.5e-3, 2.5e-3, 0.45e-3, 2.0e-3, 1.1e-3),
    Screw("M3", 3.0e-3, 3.4e-3, 2.5e-3, 5.5e-3, 3.0e-3, 0.5e-3, 2.5e-3, 1.3e-3),
    Screw("M4", 4.0e-3, 4.5e-3, 3.3e-3, 7.0e-3, 4.0e-3, 0.7e-3, 3.0e-3, 2.0e-3),
    Screw("M5", 5.0e-3, 5.5e-3, 4.2e-3, 8.5e-3, 5.0e-3, 0.8e-3, 4.0e-3, 2.5e-3),
    Screw("M6", 6.0e-3, 6.6e-3, 5.0e-3, 10.0e-3, 6.0e-3, 1.0e-3, 5.0e-3, 3.0e-3),
    Screw("M8", 8.0e-3, 9.0e-3, 6.8e-3, 13.0e-3, 8.0e-3, 1.25e-3, 6.0e-3, 4.0e-3),
)
"""Clearance holes: ISO 273:1979, medium; drills: ISO 2306:1972; heads and
sockets: ISO 4762:2004; pitches: ISO 262."""

SCREW_NAMES = tuple(known.name for known in SCREWS)

ThreadName: TypeAlias = Annotated[str, OneOf(SCREW_NAMES)]
ScrewClass: TypeAlias = Annotated[str, OneOf(tuple(CLASSES))]


def screw(name: str) -> Screw:
    """The screw of a name such as "M3"."""
    for known in SCREWS:
        if known.name == name:
            return known
    raise PartError(f"no screw is called {name!r}", hint="there are " + ", ".join(SCREW_NAMES))


@dataclass(frozen=True)
class BoltCircle:
    """Threads around a motor's axis, evenly spaced.

    Attributes:
        diameter: of the circle [m].
        bolts: number of threads.
        thread: of each, such as "M3".
        screws: property class of their screws.
        depth, depth_max: least and largest depth of engagement that the maker allows [m].
        drawn: depth of the threads in a model that is not the maker's [m]; None: none is known.
    """

    diameter: Length
    bolts: Count
    thread: ThreadName
    screws: ScrewClass = USUAL_CLASS
    depth: LengthIfAny | None = None
    depth_max: LengthIfAny | None = None
    drawn: LengthIfAny | None = None

    def __str__(self) -> str:
        """Text such as `4 x M3 on 25 mm`."""
        return f"{self.bolts} x {self.thread} on {1e3 * self.diameter:.4g} mm"

    @property
    def deepest(self) -> float:
        """Largest engagement of its screws [m]: the maker's, else as a model draws; inf: unknown.

        `OFF_BOTTOM` is left below the tips in what a model draws.
        """
        if self.depth_max is not None:
            return self.depth_max
        return inf if self.drawn is None else self.drawn - OFF_BOTTOM

    @property
    def preload_share(self) -> float:
        """Share of its screws' preload that the thread holds: as its depth over the one needed."""
        needed = CLASSES[self.screws].depth * screw(self.thread).diameter
        return min(1.0, self.deepest / needed)

    @property
    def radius(self) -> float:
        """Radius of the circle [m]."""
        return self.diameter / 2.0

    @property
    def hole_radius(self) -> float:
        """Radius of the holes that the screws pass through, ISO 273 medium [m]."""
        return screw(self.thread).clearance_hole / 2.0

    @property
    def inside(self) -> float:
        """Radius to the inner edge of the holes [m]."""
        return self.radius - self.hole_radius

    @property
    def reach(self) -> float:
        """Radius to the outer edge of the holes [m]."""
        return self.radius + self.hole_radius

    @property
    def spacing(self) -> float:
        """Material between neighbouring holes [m]."""
        return 2.0 * (self.radius * sin(pi / self.bolts) - self.hole_radius)
