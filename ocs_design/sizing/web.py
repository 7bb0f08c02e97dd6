"""What joins a rim to its motor: a thin web and a hub, turned from one piece of aluminium.

The web is a disc in the wheel's middle plane that fills the rim's bore, the hub a cylinder around
the axis with a bore and bolt holes, both symmetric to that plane. Functions of the rim's bore r [m]
take scalars or arrays and are built of operators alone, for CasADi's symbols too.
"""

from dataclasses import dataclass, replace
from math import pi
from typing import TypeVar

import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.drive.motor import Motor
from ocs_design.drive.mounting import Mounting
from ocs_design.sizing.carrier import Carrier
from ocs_design.sizing.cylinder import (
    cylinder_mass,
    cylinder_spin_inertia,
    cylinder_transverse_inertia,
)
from ocs_design.sizing.rim_cuts import LIGAMENT, NO_CUTS, RimCuts
from ocs_design.sizing.rim_problem import RimLimits

WEB_THICKNESS = 1.5e-3
"""[m]: thinner ones sing on the lathe, and weigh little less."""

WEB_MATERIAL = "aluminium-6061-t6"
"""In the catalogue of materials."""

WEB_DENSITY = 2710.0
"""Of that [kg/m^3]: Hibbeler, Mechanics of Materials, Appendix C."""

SHOULDER = 0.5e-3
"""By how much a rim is taller than its web, at least [m]: it is seated on its edge."""

SEAT = 0.1e-3
"""By how much a rim's bore between its chamfers is longer than its web is thick, at least [m]."""

HUB_HEIGHT = 5.0e-3
"""[m]: a grub screw of M2 with its thread on either side, or the heads of bolts below flush."""

HUB_WALL = 2.0e-3
"""Around bore and bolts, at least [m]: room for the thread of a grub screw of M2."""

PILOT_BORE = 3.0e-3
"""Diameter where the motor's shaft is not in the catalogue, at most [m]: to be opened to fit."""

Real = TypeVar("Real", float, FloatArray)


@dataclass(frozen=True)
class Hub:
    """A cylinder in the web's middle with a bore and a ring of through holes.

    Attributes:
        radius, height: [m].
        bore_radius: [m].
        bolts: how many; 0: the motor's are not in the catalogue.
        bolt_circle_radius, bolt_hole_radius: [m]; 0 without bolts.
        chamfer: of the cylinder's edges and of its bore's, at 45 degrees [m].
    """

    radius: float
    height: float
    bore_radius: float
    bolts: int = 0
    bolt_circle_radius: float = 0.0
    bolt_hole_radius: float = 0.0
    chamfer: float = 0.0

    @property
    def mass(self) -> float:
        """Beyond that of a web without holes [kg]."""
        holes = self.bore_radius**2 + self.bolts * self.bolt_hole_radius**2
        beyond = self.radius**2 * (self.height - WEB_THICKNESS)
        edges = self._edges.mass(self.bore_radius, self.radius, WEB_DENSITY)
        return WEB_DENSITY * pi * (beyond - holes * self.height) - edges

    @property
    def axial_inertia(self) -> float:
        """About the axis, beyond that of a web without holes [kg m^2]."""
        bolt = self.bolt_hole_radius**2
        bolts = self.bolts * bolt * (bolt / 2.0 + self.bolt_circle_radius**2)
        beyond = self.radius**4 / 2.0 * (self.height - WEB_THICKNESS)
        edges = self._edges.axial_inertia(self.bore_radius, self.radius, WEB_DENSITY)
        return (
            WEB_DENSITY * pi * (beyond - (self.bore_radius**4 / 2.0 + bolts) * self.height) - edges
        )

    @property
    def transverse_inertia(self) -> float:
        """Across the axis, beyond that of a web without holes [kg m^2].

        Three and more holes in a ring have the same about every axis across it.
        """
        bolt = _across(self.bolt_hole_radius, self.height)
        bolt += pi * self.bolt_hole_radius**2 * self.height * self.bolt_circle_radius**2 / 2.0
        solid = _across(self.radius, self.height) - _across(self.radius, WEB_THICKNESS)
        holes = _across(self.bore_radius, self.height) + self.bolts * bolt
        size = (self.bore_radius, self.radius, self.height)
        return WEB_DENSITY * (solid - holes) - self._edges.transverse_inertia(*size, WEB_DENSITY)

    @property
    def _edges(self) -> RimCuts:
        """A hub with its bore is a hollow cylinder as a rim is."""
        return RimCuts(self.chamfer)


NO_HUB = Hub(radius=0.0, height=0.0, bore_radius=0.0)
"""Of massless spokes: it weighs nothing."""


def hub_of(motor: Motor, *, direct: bool = True, chamfer: float = 0.0) -> Hub:
    """Of a wheel on this motor, with the bore of its shaft and holes for its screws.

    Where the catalogue has no shaft it has a pilot bore; where it has no screws it is as wide as
    the bolt circles that motors of that diameter have. Behind a gear, not
    `direct`, it has neither. Its edges have that chamfer [m].
    """
    mounting = (motor.mounting if direct else None) or Mounting()
    rotor, bore = mounting.rotor, _bore_radius(mounting)
    if rotor is None:
        wide = 5.5e-3 + 0.15 * (motor.diameter or 0.03)
        return Hub(max(wide, bore + HUB_WALL), HUB_HEIGHT, bore, chamfer=chamfer)
    return Hub(
        radius=rotor.reach + HUB_WALL,
        height=HUB_HEIGHT,
        bore_radius=bore,
        bolts=rotor.bolts,
        bolt_circle_radius=rotor.radius,
        bolt_hole_radius=rotor.hole_radius,
        chamfer=chamfer,
    )


def wheel_body(
    inner_radius: float,
    outer_radius: float,
    height: float,
    density: float,
    hub: Hub | None,
    *,
    cuts: RimCuts = NO_CUTS,
) -> Carrier:
    """A rim with its web and hub; None: with massless spokes. Without what turns in the motor.

    Args:
        inner_radius, outer_radius, height, density: of the rim [m, kg/m^3].
        hub: in the middle of its web.
        cuts: off the rim.
    """
    rim = (inner_radius, outer_radius, height, density)
    mass = cylinder_mass(*rim) - cuts.mass(inner_radius, outer_radius, density)
    axial = cylinder_spin_inertia(*rim) - cuts.axial_inertia(inner_radius, outer_radius, density)
    transverse = cylinder_transverse_inertia(*rim) - cuts.transverse_inertia(*rim)
    if hub is None:
        return Carrier(mass, axial, transverse)
    return Carrier(
        mass=mass + web_mass(inner_radius) + hub.mass,
        axial_inertia=axial + web_axial_inertia(inner_radius) + hub.axial_inertia,
        transverse_inertia=transverse
        + web_transverse_inertia(inner_radius)
        + hub.transverse_inertia,
    )


def limits_with_web(
    limits: RimLimits, hub_radius: float | FloatArray, cuts: RimCuts = NO_CUTS
) -> RimLimits:
    """Limits of rims that are seated on a web around a hub of that radius [m].

    They are taller than the web, and than as much of it if it were of their own material, and
    leave room for what is cut off them.
    """
    web = WEB_THICKNESS * WEB_DENSITY / np.asarray(limits.density)
    seated = np.maximum(np.maximum(WEB_THICKNESS, web) + SHOULDER, cuts.height_min)
    seated = np.maximum(seated, WEB_THICKNESS + 2.0 * cuts.chamfer + SEAT)
    return replace(
        limits,
        inner_radius_min=np.maximum(
            np.maximum(limits.inner_radius_min, cuts.inner_radius_min), hub_radius + LIGAMENT
        ),
        height_min=np.maximum(limits.height_min, seated),
        wall_min=np.maximum(limits.wall_min, cuts.wall_min),
        web=web,
        cuts=cuts,
    )


def web_mass(bore: Real) -> Real:
    """Of the disc in a rim of bore radius r, without hub and holes [kg]."""
    return pi * WEB_DENSITY * WEB_THICKNESS * bore**2


def web_axial_inertia(bore: Real) -> Real:
    """About the axis: m r^2 / 2 [kg m^2]."""
    return web_mass(bore) * bore**2 / 2.0


def web_transverse_inertia(bore: Real) -> Real:
    """Across the axis: m (3 r^2 + t^2) / 12 [kg m^2]."""
    return web_mass(bore) * (3.0 * bore**2 + WEB_THICKNESS**2) / 12.0


def _bore_radius(mounting: Mounting) -> float:
    """Of the shaft; else of a pilot bore, narrow enough to stay clear of the screws [m]."""
    if mounting.shaft_diameter is not None:
        return mounting.shaft_diameter / 2.0
    pilot = PILOT_BORE / 2.0
    return pilot if mounting.rotor is None else min(pilot, mounting.rotor.inside - LIGAMENT)


def _across(radius: float, height: float) -> float:
    """Of a cylinder of density 1 [m^5]."""
    return pi * radius**2 * height * (3.0 * radius**2 + height**2) / 12.0
