"""Motors with gears as arrays, each with its seat behind the housing's floor and its hub."""

from dataclasses import dataclass, replace
from typing import Generic

import numpy as np
from numpy.typing import NDArray

from ocs_design.actuation.drive import DriveLine
from ocs_design.common.arrays import FloatArray, Table
from ocs_design.parts.cage import Posts
from ocs_design.parts.joints import OVERSPEED
from ocs_design.parts.moments import MassMoments, Real
from ocs_design.parts.motor_mount import Behind, rim_height_min
from ocs_design.parts.rim import Hub
from ocs_design.sizing.place import Size, module_size


@dataclass(frozen=True, eq=False)
class Seat(Table, Generic[Real]):
    """Mounting of a motor behind its housing's floor, independent of the wheel.

    Attributes:
        at_floor: moments about the middle of the outside of the housing's floor, see
            `module.moments_at_floor`. at_wheel: about the wheel's middle.
        behind: extent behind the floor.
        posts: of its cage.
        reach, holes: radius of the mount's holes [m], and the mass that they remove [kg].
        height_max: largest height of a rim for which the mount leaves room [m].
        room: least rim height for which the housing is made (`MotorMount.room`) [m].
        bell: radius of the bore of a ring around the motor's bell [m]; 0: there is none.
        head_reach: radius that the heads of the screws in the housing reach [m].
        heads_rim_height: least height of a rim whose web clears them [m]; 0: any.
    """

    at_floor: MassMoments[Real]
    at_wheel: MassMoments[Real]
    behind: Behind[Real]
    posts: Posts[Real]
    reach: Real
    holes: Real
    height_max: Real
    room: Real
    bell: Real
    head_reach: Real
    heads_rim_height: Real


@dataclass(frozen=True, eq=False)
class HubFigures(Table, Generic[Real]):
    """Hub of a wheel and holes of its web, as the selection needs them.

    Attributes:
        radius: of the hub, or of the screw heads beside it [m]; 0 without a web.
        rim_height: least rim height with room for the hub's screws, and for those under the web
            [m]; 0: any.
        lightened: fraction of its web that holes remove. lightened_bore: least bore of a rim with
            room for them [m]; 0: any. lightened_stress: see `Hub`.
        volume: mass of the hub beyond its web, over its density [m^3].
        spread: its share of the spin inertia. across: its inertia about any transverse axis; both
            over its density [m^5].
    """

    radius: Real
    rim_height: Real
    lightened: Real
    lightened_bore: Real
    lightened_stress: Real
    volume: Real
    spread: Real
    across: Real

    @classmethod
    def of(cls, hub: Hub) -> "HubFigures[float]":
        """Figures of one hub."""
        beyond = hub.beyond_web(1.0)
        return HubFigures(
            radius=hub.radius,
            rim_height=rim_height_min(hub),
            lightened=hub.lightened,
            lightened_bore=hub.bore_min,
            lightened_stress=hub.lightened_stress,
            volume=beyond.mass,
            spread=beyond.axial_inertia,
            across=beyond.transverse_inertia,
        )


@dataclass(frozen=True, eq=False)
class Drives(Table):
    """Motors with gears, one per row.

    Attributes:
        motor, gear, web: indices in the problem's motors, gears and lightenings.
        seat: mounting of the motor.
        full_line: voltage line and limits at the wheel, without reserve.
        rotor_share: rotor's share of the spin inertia [kg m^2].
        armature: inertia that the motor accelerates beyond the spin inertia [kg m^2].
        hub: of the wheel.
        web_density_min, web_density_max: bounds of the density of web and hub [kg/m^3], over all
            materials of the problem until one is chosen.
    """

    motor: NDArray[np.intp]
    gear: NDArray[np.intp]
    web: NDArray[np.intp]
    seat: Seat[FloatArray]
    full_line: DriveLine
    rotor_share: FloatArray
    armature: FloatArray
    hub: HubFigures[FloatArray]
    web_density_min: FloatArray
    web_density_max: FloatArray

    def __len__(self) -> int:
        return self.motor.size

    def with_web_densities(self, density: FloatArray) -> "Drives":
        """Drives with webs and hubs of these densities [kg/m^3]."""
        return replace(self, web_density_min=density, web_density_max=density)

    @property
    def hub_mass(self) -> FloatArray:
        """Least mass of the wheel's hub beyond its web [kg]."""
        return np.minimum(*self._of_hub(self.hub.volume))

    @property
    def hub_mass_max(self) -> FloatArray:
        """Largest mass of the wheel's hub beyond its web [kg]."""
        return np.maximum(*self._of_hub(self.hub.volume))

    @property
    def hub_inertia(self) -> FloatArray:
        """Least inertia of the wheel's hub about any axis [kg m^2]."""
        return np.minimum(*self._of_hub(np.minimum(self.hub.spread, self.hub.across)))

    @property
    def mass(self) -> FloatArray:
        """Least mass of motor, gear and hub, less the mount's holes, without posts [kg]."""
        return self.seat.at_floor.mass + self.seat.at_wheel.mass + self.hub_mass

    def size(self, outer_radius: FloatArray, height: FloatArray) -> Size[FloatArray]:
        """Size of modules with rims of these outer radii, guard rings added, and heights [m]."""
        seat, plate = self.seat, self.seat.posts.foot_plate
        height = np.maximum(height, seat.room)
        return module_size(outer_radius, height, seat.behind, seat.reach, foot_plate=plate)

    @property
    def inertia_beside_rim(self) -> FloatArray:
        """Largest part of the spin inertia that rim and web need not provide [kg m^2]."""
        return self.rotor_share + np.maximum(*self._of_hub(self.hub.spread))

    def _of_hub(self, figure: FloatArray) -> tuple[FloatArray, FloatArray]:
        """A figure per density at either density; negative where the hub replaces more web."""
        return figure * self.web_density_min, figure * self.web_density_max

    @property
    def line(self) -> DriveLine:
        """Voltage lines and limits that a design may use."""
        return self.full_line.reserved()

    @property
    def top_speed(self) -> FloatArray:
        """Highest wheel speed that a design may use [rad/s]."""
        return np.asarray(self.line.top_speed)

    @property
    def overspeed(self) -> FloatArray:
        """Speed at which the hoop stress of a rim is limited [rad/s]."""
        return OVERSPEED * np.asarray(self.full_line.top_speed)
