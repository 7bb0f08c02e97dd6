"""Robot and device as functions of the device's figures, as CasADi symbols."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol, cast

import casadi as ca
import numpy as np

from ocs_design.sizing.co_design.problem import CoDesignProblem
from ocs_design.sizing.cylinder import cylinder_mass
from ocs_design.sizing.housing import (
    housing_axial_inertia,
    housing_height,
    housing_mass,
    housing_outer_radius,
    housing_transverse_inertia,
)
from ocs_design.sizing.optimal_control.plant import Plant, moments
from ocs_design.sizing.rim_closed_form import BORE_SHARE
from ocs_design.sizing.web import wheel_body


class _Wheel(Protocol):
    """A body of revolution of symbols."""

    mass: ca.SX
    axial_inertia: ca.SX
    transverse_inertia: ca.SX


@dataclass(frozen=True, eq=False)
class FreeDevice:
    """The figures of one module as symbols, see `DeviceShape`, of a given problem."""

    problem: CoDesignProblem
    inner_radius: ca.SX
    outer_radius: ca.SX
    height: ca.SX

    @property
    def rim_mass(self) -> ca.SX:
        """Of one rim [kg]."""
        return _of_symbols(cylinder_mass)(*self._rim)

    @property
    def module_mass(self) -> ca.SX:
        """Of one module in all [kg]."""
        shell = _of_symbols(housing_mass)(self.outer_radius, self.height)
        return self._wheel.mass + shell + self.problem.drive.mass

    @property
    def spin_inertia(self) -> ca.SX:
        """h, rotor included [kg m^2]."""
        return self._wheel.axial_inertia + self.problem.selected.rotor_share

    def inertia(self, incidence: ca.SX) -> ca.SX:
        """Of robot and device, braked: xx, yy, zz, xy, xz, yz [kg m^2], (6, 1).

        Both modules act as one body of twice the mass between them, and two bodies at a distance
        act on their common centre as the reduced mass (parallel axes).
        """
        robot, mass = self.problem.selection.robot, 2.0 * self.module_mass
        x, y, z = self._center()
        apart = ca.vertcat(x - robot.com[0], -robot.com[1], z - robot.com[2])
        reduced = robot.mass * mass / (robot.mass + mass)
        axial, across = self._own_inertia()
        sine, cosine = ca.sin(incidence), ca.cos(incidence)
        spread = 2.0 * (axial - across)
        turned = ca.vertcat(sine**2, cosine**2, 0, 0, 0, 0) * spread
        square = mass * y**2
        sideways = ca.vertcat(square, 0, square, 0, 0, 0)
        round_ball = ca.vertcat(1, 1, 1, 0, 0, 0) * (2.0 * across)
        return (
            ca.SX(moments(robot.inertia)) + reduced * _point(apart) + sideways + round_ball + turned
        )

    def plant(self, incidence: ca.SX) -> Plant:
        """The gyrostat with its wheels at an incidence [rad]."""
        return Plant(
            inertia=self.inertia(incidence),
            sine=ca.sin(incidence),
            cosine=ca.cos(incidence),
            spin_inertia=self.spin_inertia,
            armature=ca.SX(self.problem.selected.armature),
        )

    def excess(self) -> ca.SX:
        """What must not be positive for the rim to be within its limits, scaled, (m, 1)."""
        limits, inner, outer = self.problem.limits, self.inner_radius, self.outer_radius
        nu = limits.poisson_ratio
        stretch = (3.0 + nu) * outer**2 + (1.0 - nu) * inner**2
        wall = (limits.wall_min - (outer - inner)) / limits.outer_radius_max
        bore = (BORE_SHARE * outer - inner) / limits.outer_radius_max
        rows = [wall, bore]
        if np.isfinite(limits.mass_max):
            rows.append(self.rim_mass / limits.mass_max - 1.0)
        if np.isfinite(limits.stretch_max):
            rows.append(stretch / limits.stretch_max - 1.0)
        return ca.vertcat(*rows)

    @property
    def _wheel(self) -> "_Wheel":
        """See `wheel_body`."""
        form = cast(Callable[..., _Wheel], wheel_body)
        return form(*self._rim, self.problem.selected.hub)

    @property
    def _rim(self) -> tuple[ca.SX, ca.SX, ca.SX, float]:
        density = self.problem.selected.material.density
        return self.inner_radius, self.outer_radius, self.height, density

    def _center(self) -> tuple[ca.SX, ca.SX, ca.SX]:
        across = _of_symbols(housing_outer_radius)(self.outer_radius)
        tall = _of_symbols(housing_height)(self.height)
        left = cast(
            Callable[[ca.SX, ca.SX], tuple[ca.SX, ca.SX, ca.SX]], self.problem.selection.place.left
        )
        x, y, z = left(across, tall)
        return ca.SX(x), ca.SX(y), ca.SX(z)

    def _own_inertia(self) -> tuple[ca.SX, ca.SX]:
        """Of one module about its axis and across it, braked [kg m^2]."""
        outer, tall, drive = self.outer_radius, self.height, self.problem.drive
        wheel = self._wheel
        shell = _of_symbols(housing_axial_inertia)(outer, tall)
        shell_across = _of_symbols(housing_transverse_inertia)(outer, tall)
        return (
            wheel.axial_inertia + shell + drive.axial_inertia,
            wheel.transverse_inertia + shell_across + drive.transverse_inertia,
        )


def _of_symbols(form: Callable[..., object]) -> Callable[..., ca.SX]:
    """A closed form that is built of operators alone, and is declared for numbers only."""
    return cast(Callable[..., ca.SX], form)


def _point(offset: ca.SX) -> ca.SX:
    """xx, yy, zz, xy, xz, yz of a unit mass."""
    x, y, z = ca.vertsplit(offset)
    return ca.vertcat(y**2 + z**2, x**2 + z**2, x**2 + y**2, -x * y, -x * z, -y * z)
