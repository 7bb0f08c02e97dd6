"""Robot and device as functions of the device's figures, as CasADi symbols."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Protocol, cast

import casadi as ca
import numpy as np

from ocs_design.sizing.co_design.problem import CoDesignProblem
from ocs_design.sizing.cylinder import cylinder_mass
from ocs_design.sizing.housing import half_height
from ocs_design.sizing.mass_moments import MassMoments, round_body
from ocs_design.sizing.motor_mount import mount_of
from ocs_design.sizing.optimal_control.plant import Plant, moments
from ocs_design.sizing.placement import Size, motor_size
from ocs_design.sizing.rim_closed_form import BORE_SHARE
from ocs_design.sizing.shell import shell_moments
from ocs_design.sizing.standing import behind_floor
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
        cut = _of_symbols(self.problem.selected.cuts.mass)
        inner, outer, _, density = self._rim
        return _of_symbols(cylinder_mass)(*self._rim) - cut(inner, outer, density)

    @property
    def module_mass(self) -> ca.SX:
        """Of one module in all [kg]."""
        return ca.SX(self._module.mass)

    @property
    def spin_inertia(self) -> ca.SX:
        """h, rotor included [kg m^2]."""
        return self._wheel.axial_inertia + self.problem.selected.rotor_share

    def inertia(self, incidence: ca.SX) -> ca.SX:
        """Of robot and device, braked: xx, yy, zz, xy, xz, yz [kg m^2], (6, 1).

        Both modules act as one body of twice the mass between them, and two bodies at a distance
        act on their common centre as the reduced mass (parallel axes).
        """
        robot, module = self.problem.selection.robot, self._module
        sine, cosine = ca.sin(incidence), ca.cos(incidence)
        one, mass = module.mass, 2.0 * module.mass
        along, up = module.y / one, module.z / one
        x, y, z = self._center()
        apart = ca.vertcat(x + along * sine - robot.com[0], -robot.com[1], z + up - robot.com[2])
        reduced = robot.mass * mass / (robot.mass + mass)
        sideways = mass * (y + along * cosine) ** 2
        spread = ca.vertcat(sideways, 0, sideways, 0, 0, 0)
        own = 2.0 * _turned(module, along, up, sine, cosine)
        alone = ca.SX(moments(robot.inertia))
        return ca.SX(alone + reduced * _point(apart) + spread + own)

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
        chosen = self.problem.selected
        return form(*self._rim, chosen.hub, cuts=chosen.cuts)

    @property
    def _rim(self) -> tuple[ca.SX, ca.SX, ca.SX, float]:
        density = self.problem.selected.material.density
        return self.inner_radius, self.outer_radius, self.height, density

    @property
    def _module(self) -> MassMoments[Any]:
        """All of one module about its wheel's centre, braked."""
        chosen, wheel = self.problem.selected, self._wheel
        mount = mount_of(chosen.motor, chosen.gear.room)
        behind = behind_floor(chosen.motor, chosen.gear, mount)
        shell = cast(Callable[..., MassMoments[Any]], shell_moments)
        half = _of_symbols(half_height)(self.height)
        turning = cast(Callable[..., MassMoments[Any]], round_body)
        spun = turning(wheel.mass, wheel.axial_inertia, wheel.transverse_inertia)
        standing = shell(self.outer_radius, self.height, mount.holes.reach)
        return spun + standing + cast(MassMoments[Any], behind).shifted(-half, ca.SX(0))

    def _center(self) -> tuple[ca.SX, ca.SX, ca.SX]:
        size = cast(Callable[..., Size[Any]], motor_size)
        chosen = self.problem.selected
        room = size(chosen.motor, chosen.gear.room, self.outer_radius, self.height)
        x, y, z = self.problem.selection.place.left(room)
        return ca.SX(x), ca.SX(y), ca.SX(z)


def _turned(module: MassMoments[Any], along: ca.SX, up: ca.SX, sine: ca.SX, cosine: ca.SX) -> ca.SX:
    """Mean of both modules' inertia about their own centres of mass in B, xx to yz."""
    axis, upright = module.yy - module.mass * along**2, module.zz - module.mass * up**2
    product = module.yz - module.mass * along * up
    forward = module.xx * cosine**2 + axis * sine**2
    sideways = module.xx * sine**2 + axis * cosine**2
    rows = (sideways + upright, forward + upright, forward + sideways, 0, -product * sine, 0)
    return ca.SX(ca.vertcat(*rows))


def _of_symbols(form: Callable[..., object]) -> Callable[..., ca.SX]:
    """A closed form that is built of operators alone, and is declared for numbers only."""
    return cast(Callable[..., ca.SX], form)


def _point(offset: ca.SX) -> ca.SX:
    """xx, yy, zz, xy, xz, yz of a unit mass."""
    x, y, z = ca.vertsplit(offset)
    return ca.vertcat(y**2 + z**2, x**2 + z**2, x**2 + y**2, -x * y, -x * z, -y * z)
