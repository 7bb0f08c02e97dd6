"""Motors behind gears as arrays, each with its place behind the housing's floor and its hub."""

from dataclasses import dataclass, replace
from typing import Generic

import numpy as np
from numpy.typing import NDArray

from ocs_design.actuation.drive import DriveLine
from ocs_design.common.arrays import FloatArray, Table
from ocs_design.parts.cage import Posts
from ocs_design.parts.joints import OVERSPEED
from ocs_design.parts.moments import MassMoments, Real
from ocs_design.parts.motor_mount import Behind
from ocs_design.sizing.place import Size, module_size


@dataclass(frozen=True, eq=False)
class Seat(Table, Generic[Real]):
    """Place of a motor behind its floor, whatever the wheel.

    Attributes:
        by_floor: moments about the middle of the outside of the housing's floor, see
            `module.by_floor`. by_wheel: about the wheel's middle, see `module.by_wheel`.
        behind: how far back it reaches.
        posts: of its cage.
        reach, holes: radius of the mount's holes [m], and the mass that they take [kg].
        height_max: of a rim that the mount leaves room for [m].
        room: least height of a rim that the housing is made for (`MotorMount.room`) [m].
        bell: radius of the bore of a ring around the motor's bell [m]; 0: there is none.
        head_reach: of the screws in the housing [m].
    """

    by_floor: MassMoments[Real]
    by_wheel: MassMoments[Real]
    behind: Behind[Real]
    posts: Posts[Real]
    reach: Real
    holes: Real
    height_max: Real
    room: Real
    bell: Real
    head_reach: Real


@dataclass(frozen=True, eq=False)
class Drives(Table):
    """Motors behind gears, one per row.

    Attributes:
        motor, gear, web: indices in the problem's motors, gears and lightenings.
        seat: place of the motor.
        whole: voltage line and limits at the wheel, nothing held back.
        rotor_share: of the spin inertia [kg m^2].
        armature: what the motor accelerates beyond the spin inertia [kg m^2].
        hub_volume: mass of the wheel's hub, over its density [m^3].
        hub_radius: of that, or of the screws' heads beside it [m]; 0 without a web.
        rim_height: least one that leaves room for the hub's screws [m]; 0: any.
        lightened: share of its web that holes take. lightened_bore: least one of a rim with room
            for them [m]; 0: any. lightened_stress: see `Hub`.
        hub_spread: of the spin inertia. hub_across: about any axis across; both over its density
            [m^5].
        web_least, web_most: density of web and hub, which is any of the problem's as long as no
            material is chosen [kg/m^3].
    """

    motor: NDArray[np.intp]
    gear: NDArray[np.intp]
    web: NDArray[np.intp]
    seat: Seat[FloatArray]
    whole: DriveLine
    rotor_share: FloatArray
    armature: FloatArray
    hub_volume: FloatArray
    hub_radius: FloatArray
    rim_height: FloatArray
    lightened: FloatArray
    lightened_bore: FloatArray
    lightened_stress: FloatArray
    hub_spread: FloatArray
    hub_across: FloatArray
    web_least: FloatArray
    web_most: FloatArray

    def __len__(self) -> int:
        return self.motor.size

    def of_webs(self, density: FloatArray) -> "Drives":
        """Drives with webs and hubs of these densities [kg/m^3]."""
        return replace(self, web_least=density, web_most=density)

    @property
    def hub_mass(self) -> FloatArray:
        """Mass of the wheel's hub beyond its web, at the least [kg]."""
        return np.minimum(*self._of_hub(self.hub_volume))

    @property
    def hub_mass_most(self) -> FloatArray:
        """Mass of the wheel's hub beyond its web, at the most [kg]."""
        return np.maximum(*self._of_hub(self.hub_volume))

    @property
    def hub_inertia(self) -> FloatArray:
        """Inertia of the wheel's hub about any axis, at the least [kg m^2]."""
        return np.minimum(*self._of_hub(np.minimum(self.hub_spread, self.hub_across)))

    @property
    def mass(self) -> FloatArray:
        """Mass of motor, gear and hub, less the mount's holes, without posts, at the least [kg]."""
        return self.seat.by_floor.mass + self.seat.by_wheel.mass + self.hub_mass

    def size(self, outer_radius: FloatArray, height: FloatArray) -> Size[FloatArray]:
        """Size of modules with rims of these outer radii, guard rings added, and heights [m]."""
        seat, plate = self.seat, self.seat.posts.foot_plate
        height = np.maximum(height, seat.room)
        return module_size(outer_radius, height, seat.behind, seat.reach, foot_plate=plate)

    @property
    def beside_rim(self) -> FloatArray:
        """Part of the spin inertia that rim and web need not have, at the most [kg m^2]."""
        return self.rotor_share + np.maximum(*self._of_hub(self.hub_spread))

    def _of_hub(self, figure: FloatArray) -> tuple[FloatArray, FloatArray]:
        """A figure per density at either. A hub of a wide bore has less than the web beneath it."""
        return figure * self.web_least, figure * self.web_most

    @property
    def line(self) -> DriveLine:
        """Voltage lines and limits that a design may use."""
        return self.whole.reserved()

    @property
    def top_speed(self) -> FloatArray:
        """Speed of the wheel that a design may use [rad/s]."""
        return np.asarray(self.line.top_speed)

    @property
    def overspeed(self) -> FloatArray:
        """Speed at which the hoop stress of a rim is limited [rad/s]."""
        return OVERSPEED * np.asarray(self.whole.top_speed)
