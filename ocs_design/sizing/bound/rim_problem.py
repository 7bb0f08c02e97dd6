"""The lightest hollow cylinder of a given spin inertia: its limits, and the closed form.

With the spin inertia I met with equality, write P = 2 I / (pi rho h_max), Q = 2 I / (pi rho h_min).
The mass is m = 2 I / (R^2 + r^2), the height follows from R^4 - r^4 = 2 I / (pi rho h), and the
limits are

    R <= R_max                                       r >= r_min
    r <= (R^4 - P)^(1/4)            (h_max)          R^4 - r^4 <= Q        (h_min)
    r <= R - t                      (wall)           R^2 + r^2 >= 2 I / m_max
    (3 + nu) R^2 + (1 - nu) r^2 <= S                 (hoop stress, S = 4 sigma / (rho w^2))

The best bore at a given R is the largest, r(R), the smallest of the three upper limits on r. Two of
them increase with R (h_max and wall), so R^2 + r^2 increases with R as long as one of these is the
smallest. Once the hoop stress is, R^2 + r^2 = S / (1 - nu) - 2 (1 + nu) / (1 - nu) R^2 decreases.
The best R is therefore the larger of the two crossings with the hoop stress

    h_max: (3 + nu) a + (1 - nu) sqrt(a^2 - P) = S,  a = R^2
    wall:  (3 + nu) R^2 + (1 - nu) (R - t)^2 = S,

unless R_max or h_min stops it earlier. The latter forbids only walls so thick that even h_min gives
too much inertia: along r = R - t the difference R^4 - r^4 increases with R and meets Q at
4 t c^3 + t^3 c = Q, c = R - t / 2 (a cubic with one real root). So

    R = min(R_max, max(crossings), h_min on the wall),   r = min(h_max, wall at R),

a vertex where two limits meet: r_max or hoop_stress with h_max or wall_min, or h_min with wall_min.
If this r is below r_min, or below 1 % of R and thus not a bore, no other R helps: a smaller one
lowers r(R), a larger one is forbidden or lowers it too. If the mass is above m_max, no rim is
lighter. So the vertex decides feasibility.
"""

from dataclasses import dataclass, replace
from math import inf
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ocs_design.actuation.fasteners import LIGAMENT
from ocs_design.catalogue.materials import Material
from ocs_design.common.arrays import FloatArray, Table
from ocs_design.common.errors import UsageError
from ocs_design.parts.rim import (
    NO_CUTS,
    SHOULDER,
    SHRUNK_WEB_THICKNESS,
    STEP,
    WEB_THICKNESS,
    RimCuts,
    hoop_weights,
    spread_left,
)
from ocs_design.requirement.device_sections import Envelope
from ocs_design.sizing.limits import Limit


@dataclass(frozen=True, eq=False)
class RimLimits(Table):
    """Limits of a rim as plain numbers: scalars, or arrays that broadcast.

    Attributes:
        density: [kg/m^3].
        outer_radius_max, inner_radius_min, height_max, height_min, wall_min: [m].
        mass_max: [kg].
        stretch_max: largest (3 + nu) R^2 + (1 - nu) r^2 that the allowed hoop stress admits, which
            is 4 sigma / (rho w^2) [m^2]; inf: not limited.
        poisson_ratio: nu; unused where the hoop stress is not limited.
        web: thickness of a disc of the rim's material that has the web's spin inertia and fills
            the bore [m]; 0: massless spokes.
        outer_radius_min: least outer radius with room for a motor's mount [m]; 0: any.
        cuts: chamfers and holes, the same for all; the other limits leave room for them.
        web_weight: ratio of the web's mass to that of the disc; below 1 with lightening holes.
        lightened_bore: least bore with room for those [m]; 0: none. `inner_radius_min` includes it.
        stretch_left: fraction of the stretch that they leave; `stretch_max` includes it.
        inner_radius_max: [m]; equal to `inner_radius_min` for a ring around a bell; inf: any.
    """

    density: float | FloatArray
    outer_radius_max: float | FloatArray
    inner_radius_min: float | FloatArray
    height_max: float | FloatArray
    height_min: float | FloatArray
    wall_min: float | FloatArray
    mass_max: float | FloatArray
    stretch_max: float | FloatArray
    poisson_ratio: float | FloatArray
    web: float | FloatArray = 0.0
    outer_radius_min: float | FloatArray = 0.0
    cuts: RimCuts = NO_CUTS
    web_weight: float | FloatArray = 1.0
    lightened_bore: float | FloatArray = 0.0
    stretch_left: float | FloatArray = 1.0
    inner_radius_max: float | FloatArray = inf

    @property
    def heavy_web(self) -> float | FloatArray:
        """Thickness of a disc of the rim's material that weighs as much as the web [m]."""
        return self.web * self.web_weight

    @property
    def hoop_weights(self) -> tuple[FloatArray, FloatArray]:
        """Weights p of R^2 and n of r^2 in the stretch that `stretch_max` bounds."""
        return hoop_weights(np.asarray(self.poisson_ratio, dtype=np.float64))


@dataclass(frozen=True)
class RimProblem:
    """Find the lightest rim of this spin inertia, met with equality.

    Attributes:
        spin_inertia: of one wheel [kg m^2].
        envelope: limits of its dimensions. material: its material.
        wheel_speed: highest speed, at which the hoop stress is limited [rad/s].
    """

    spin_inertia: float
    envelope: Envelope
    material: Material
    wheel_speed: float

    def with_limit(self, limit: Limit, value: float) -> "RimProblem":
        """The problem with one of its limits changed [SI]."""
        return replace(self, envelope=limit.replaced(self.envelope, value))

    @property
    def hoop_stress_max(self) -> float:
        """Yield strength over the safety factor [Pa]; inf if the material's data are unknown."""
        strength, safety = self.material.yield_strength, self.envelope.stress_safety
        if strength is None or self.material.poisson_ratio is None:
            return float("inf")
        return strength / safety

    @property
    def stretch_max(self) -> float:
        """Largest stretch (`RimLimits`) [m^2]."""
        return 4.0 * self.hoop_stress_max / (self.material.density * self.wheel_speed**2)

    @property
    def limits(self) -> RimLimits:
        """Limits as plain numbers."""
        room = self.envelope
        return RimLimits(
            density=self.material.density,
            outer_radius_max=room.outer_radius_max,
            inner_radius_min=room.inner_radius_min,
            height_max=room.height_max,
            height_min=room.height_min,
            wall_min=room.wall_min,
            mass_max=room.mass_max,
            stretch_max=self.stretch_max,
            poisson_ratio=self.material.poisson_ratio or 0.0,
        )


def limits_with_web(
    limits: RimLimits,
    hub_radius: float | FloatArray,
    cuts: RimCuts = NO_CUTS,
    web_density: float | FloatArray | None = None,
    rim_height_min: float | FloatArray = 0.0,
    *,
    web_thickness: float | None = None,
    lightened: float | FloatArray = 0.0,
    lightened_bore: float | FloatArray = 0.0,
    stretch_left: float | FloatArray = 1.0,
) -> RimLimits:
    """Limits of rims around a web with a hub.

    The rims are taller than the web and leave room for their cuts. Shrunk-on rims have a shoulder
    and are taller than a web of equal mass would be in their own material.

    Args:
        limits: of the rims alone. hub_radius: [m].
        web_density: of web and hub [kg/m^3]; None: in one piece with the rim.
        rim_height_min: least height with room for the hub's screws (`rim_height_min`) [m].
        web_thickness: [m]; None: the default.
        lightened: fraction of the web that holes remove (`Hub.lightened`).
        lightened_bore: least bore with room for them (`Hub.bore_min`) [m].
        stretch_left: fraction of the allowed hoop stress at which the holes do not yield.
    """
    spread = spread_left(np.asarray(lightened, dtype=np.float64))
    if web_thickness is None:
        web_thickness = WEB_THICKNESS if web_density is None else SHRUNK_WEB_THICKNESS
    web = np.full_like(np.asarray(limits.density, dtype=np.float64), web_thickness)
    seated = np.maximum(web_thickness + 2.0 * cuts.chamfer + STEP, cuts.height_min)
    if web_density is not None:
        web = web_thickness * web_density / np.asarray(limits.density)
        seated = np.maximum(seated, np.maximum(web_thickness, web) + SHOULDER)
    around = np.maximum(hub_radius + LIGAMENT, lightened_bore)
    return replace(
        limits,
        inner_radius_min=np.maximum(
            np.maximum(limits.inner_radius_min, cuts.inner_radius_min), around
        ),
        height_min=np.maximum(np.maximum(limits.height_min, seated), rim_height_min),
        wall_min=np.maximum(limits.wall_min, cuts.wall_min),
        web=web * spread,
        cuts=cuts,
        web_weight=(1.0 - lightened) / spread,
        lightened_bore=lightened_bore,
        stretch_max=limits.stretch_max * stretch_left,
        stretch_left=stretch_left,
    )


def stretch_beside_holes(stress: float | FloatArray, stress_safety: float) -> float | FloatArray:
    """Fraction of the allowed hoop stress at which holes in the web yield; at most 1.

    Args:
        stress: ratio of the stress at the holes to the hoop stress (`Hub.lightened_stress`).
        stress_safety: yield strength over the allowed hoop stress.
    """
    return stress_safety / np.maximum(stress, stress_safety)


def check_limits(envelope: Envelope, material: Material, wheel_speed: float) -> None:
    """Refuse invalid limits.

    Raises:
        UsageError: a number is not positive where it must be, or not finite.
    """
    _require_positive("wheel_speed_max", wheel_speed)
    _require_positive("the density", material.density)
    for name in ("outer_radius_max", "height_max", "stress_safety"):
        _require_positive(name, getattr(envelope, name))
    for name in ("inner_radius_min", "height_min", "wall_min", "mass_max"):
        value = getattr(envelope, name)
        # An infinite mass means no limit; NaN is invalid.
        if not value >= 0.0:
            raise UsageError(f"{name} is {value:g}; it must not be negative")


def _require_positive(name: str, value: float) -> None:
    if not 0.0 < value < float("inf"):
        raise UsageError(f"{name} is {value:g}; it must be positive and finite")


# Tolerance that keeps limits which meet in one point compatible after rounding.
_ROUNDING = 1e-12

BORE_SHARE = 0.01
"""Least ratio of a rim's bore to its outer radius: a rim is not a disc. As a bore closes, the
shadow prices grow without bound, and no solver can compute them."""


class RimShape(NamedTuple):
    """Hollow cylinders; NaN where no rim meets the limits.

    Attributes:
        inner_radius, outer_radius, height: [m], all of one shape.
        mass: [kg].
    """

    inner_radius: FloatArray
    outer_radius: FloatArray
    height: FloatArray
    mass: FloatArray


def lightest_rim(spin_inertia: ArrayLike, limits: RimLimits) -> RimShape:
    """The lightest rim of each spin inertia [kg m^2] within limits; see the module's docstring."""
    inertia = np.asarray(spin_inertia, dtype=np.float64)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        tall = 2.0 * inertia / (np.pi * limits.density * limits.height_max)
        flat = np.divide(2.0 * inertia, np.pi * limits.density * np.asarray(limits.height_min))
        # Radius beyond which the hoop stress costs more bore than the radius gains, written so that
        # an unlimited stress (inf) gives inf.
        (p, n), stretch, wall = limits.hoop_weights, np.asarray(limits.stretch_max), limits.wall_min
        root = np.sqrt(np.maximum(1.0 - (p**2 - n**2) * tall / stretch**2, 0.0))
        by_height = (stretch + n**2 * tall / stretch) / (p + n * root)
        discriminant = np.maximum((p + n) * stretch - n * p * wall**2, 0.0)
        by_stress = np.maximum(np.sqrt(by_height), (n * wall + np.sqrt(discriminant)) / (p + n))
        widest = np.minimum(limits.outer_radius_max, by_stress)
        outer = np.minimum(widest, flat_wall_radius(flat, wall))
        bore_by_height = np.maximum(outer**4 - tall, 0.0) ** 0.25
        bore_by_wall = outer - limits.wall_min
        inner = np.minimum(bore_by_height, bore_by_wall)
        spread = np.where(
            bore_by_height < bore_by_wall, tall, (outer**2 - inner**2) * (outer**2 + inner**2)
        )
        height = 2.0 * inertia / (np.pi * limits.density * spread)
        mass = 2.0 * inertia / (outer**2 + inner**2)
        # The limits that did not define the vertex. For the hoop stress it is enough that it leaves
        # any bore: up to the crossing, r(R) is below its line, and a crossing beyond S = (3 + nu)
        # R^2 belongs to the negative root.
        slack = 1.0 + _ROUNDING
        fits = (
            (tall <= flat * slack)
            & (inner * slack >= limits.inner_radius_min)
            & (inner * slack >= BORE_SHARE * outer)
            & (mass <= limits.mass_max * slack)
            & (p * outer**2 <= limits.stretch_max * slack)
        )
    values = np.broadcast_arrays(inner, outer, height, mass)
    return RimShape(*(np.where(fits, value, np.nan) for value in values))


OFF_THE_EDGE = 1.0 + 1e-10
"""Factor that keeps the smallest possible rim from being lost to rounding."""


def smallest_rim_inertia(limits: RimLimits) -> FloatArray:
    """Spin inertia of the narrowest, thinnest and flattest rim within the lower limits [kg m^2].

    Its web is included, its cuts are not.
    """
    bore = np.maximum(limits.inner_radius_min, limits.wall_min * BORE_SHARE / (1.0 - BORE_SHARE))
    bore = np.maximum(bore, np.asarray(limits.outer_radius_min) - limits.wall_min)
    outer = bore + limits.wall_min
    full = limits.height_min * (outer**4 - bore**4) + limits.web * bore**4
    full = full - limits.cuts.spread(bore, outer)
    return np.asarray(np.pi * limits.density * full / 2.0, dtype=np.float64)


def largest_spin_inertia(limits: RimLimits) -> FloatArray:
    """Largest spin inertia of any rim within the limits [kg m^2]; 0 where none has room.

    An upper bound, with the web: the smaller of the inertias of a rim as wide and tall as envelope
    and hoop stress allow around the least bore, and of one with all its mass at the largest radius,
    with a web to the same radius.
    """
    web, bore = np.asarray(limits.web), np.asarray(limits.inner_radius_min)
    p, n = limits.hoop_weights
    per_height = np.pi * np.asarray(limits.density) / 2.0
    stretched = np.maximum(limits.stretch_max - n * bore**2, 0.0) / p
    outer = np.minimum(limits.outer_radius_max, np.sqrt(stretched))
    tall = np.asarray(limits.height_max)
    solid = per_height * (tall * (outer**4 - bore**4) + np.minimum(web, tall) * bore**4)
    heavy = np.asarray(limits.mass_max) * outer**2 + per_height * web * outer**4
    around = np.maximum(bore + limits.wall_min, limits.outer_radius_min)
    slack = 1.0 + _ROUNDING
    fits = (around <= outer * slack) & (np.asarray(limits.height_min) <= tall * slack)
    return np.asarray(np.where(fits, np.minimum(solid, heavy), 0.0), dtype=np.float64)


def flat_wall_radius(flat: FloatArray, wall: float | FloatArray) -> FloatArray:
    """Outer radius at which a rim of the least wall and the least height has this inertia [m].

    The real root of c^3 + t^2/4 c = Q / (4 t) by the hyperbolic sine.
    """
    thickness = np.asarray(wall)
    argument = np.sqrt(27.0) * flat / thickness**4
    middle = thickness / np.sqrt(3.0) * np.sinh(np.arcsinh(argument) / 3.0)
    radius: FloatArray = np.where(thickness > 0.0, middle + thickness / 2.0, np.inf)
    return radius
