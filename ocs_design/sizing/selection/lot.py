"""Candidates as arrays: a drive and a material each, and the modules that they come to."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ocs_design.arrays import FloatArray
from ocs_design.sizing.cylinder import cylinder_transverse_inertia
from ocs_design.sizing.housing import half_height
from ocs_design.sizing.lightest_module import lightest_module_at, roomy_module_at
from ocs_design.sizing.mass_moments import round_body
from ocs_design.sizing.module_shape import ModuleShape
from ocs_design.sizing.mount import limits_with_mount
from ocs_design.sizing.placement import module_size
from ocs_design.sizing.rim_closed_form import smallest_spin_inertia
from ocs_design.sizing.rim_problem import RimLimits, RimProblem
from ocs_design.sizing.selection.drive_table import DriveTable
from ocs_design.sizing.selection.problem import SelectionProblem
from ocs_design.sizing.selection.trunk import Modules
from ocs_design.sizing.shell import Printed, shell_moments
from ocs_design.sizing.web import WEB_THICKNESS, limits_with_web

# The smallest rim of all must not get lost to rounding.
_OFF_THE_EDGE = 1.0 + 1e-10
# [kg m^2], less than any wheel.
_NOTHING = 1e-12


@dataclass(frozen=True, eq=False)
class Lot:
    """Some candidates, one per entry.

    Attributes:
        drives: motor and gear of each.
        material: index of each.
        limits: of their rims.
    """

    drives: DriveTable
    material: NDArray[np.intp]
    limits: RimLimits

    @property
    def shell(self) -> Printed:
        """Around their wheels."""
        return Printed(self.drives.mount_reach)

    @property
    def least_spin_inertia(self) -> FloatArray:
        """With the smallest rim that the lower limits leave [kg m^2], and positive.

        A rotor that turns against its wheel may have as much momentum as the smallest rim.
        """
        least = smallest_spin_inertia(self.limits) * _OFF_THE_EDGE + self.drives.beside_rim
        return np.maximum(least, _NOTHING)

    def shapes_at(
        self, spin_inertia: FloatArray, radius: FloatArray, flatness: FloatArray
    ) -> ModuleShape:
        """The lightest that have it with their rotors [kg m^2]; see `lightest_module_at`."""
        rim = spin_inertia - self.drives.beside_rim
        shapes = roomy_module_at(rim, radius, self.limits, self.shell, flatness)
        rest = np.flatnonzero(np.isnan(shapes.mass))
        if not rest.size:
            return shapes
        some = self.take(rest)
        near = lightest_module_at(rim[rest], radius[rest], some.limits, some.shell, flatness[rest])
        return shapes.put(rest, near)

    def modules(self, spin_inertia: FloatArray, shapes: ModuleShape) -> Modules:
        """One module of each, braked."""
        drives, wheel = self.drives, spin_inertia - self.drives.rotor_share
        inner, outer, height = shapes.inner_radius, shapes.outer_radius, shapes.height
        across = cylinder_transverse_inertia(inner, outer, height, 1.0)
        across = across - self.limits.cuts.transverse_inertia(inner, outer, height, 1.0)
        across = across * self.limits.density
        # Of the web, whose mass tells its thickness: m (3 r^2 + t^2) / 12.
        web = shapes.web_mass * (3.0 * inner**2 + WEB_THICKNESS**2) / 12.0
        mass = shapes.rim_mass + shapes.web_mass + drives.hub_mass
        whole = (
            round_body(mass, wheel, across + web + drives.hub_across)
            + shell_moments(outer, height, drives.mount_reach)
            + drives.behind.shifted(-half_height(height), np.zeros_like(height))
        )
        size = module_size(
            outer, height, drives.behind_depth, drives.behind_radius, drives.mount_reach
        )
        return Modules.of(whole, size)

    def take(self, rows: NDArray[np.intp]) -> "Lot":
        """The candidates of these rows."""
        limits = replace(
            self.limits,
            density=np.asarray(self.limits.density)[rows],
            stretch_max=np.asarray(self.limits.stretch_max)[rows],
            poisson_ratio=np.asarray(self.limits.poisson_ratio)[rows],
            inner_radius_min=np.asarray(self.limits.inner_radius_min)[rows],
            height_min=np.asarray(self.limits.height_min)[rows],
            web=np.asarray(self.limits.web)[rows],
            outer_radius_min=np.asarray(self.limits.outer_radius_min)[rows],
        )
        return Lot(self.drives.take(rows), self.material[rows], limits)

    def repeated(self, times: int) -> "Lot":
        """Every candidate so many times, one after the other."""
        return self.take(np.repeat(np.arange(len(self.drives)), times))


def lot_of(problem: SelectionProblem, drives: DriveTable, material: NDArray[np.intp]) -> Lot:
    """Candidates of these drives and materials, entry by entry."""
    limits = rim_limits(problem, material, drives.overspeed, drives.hub_radius, drives.mount_reach)
    return Lot(drives, material, limits)


def rim_limits(
    problem: SelectionProblem,
    material: NDArray[np.intp],
    overspeed: FloatArray,
    hub_radius: FloatArray,
    mount_reach: FloatArray,
) -> RimLimits:
    """Limits of rims, entry by entry.

    Args:
        problem: room and materials.
        material: of each. overspeed: that it must hold at [rad/s].
        hub_radius: in its middle [m]. mount_reach: of the holes in its housing's floor [m].
    """
    envelope, materials = problem.envelope, problem.materials
    each = [RimProblem(0.0, envelope, kind, 1.0).limits for kind in materials]
    density = np.array([limits.density for limits in each])[material]
    # With a hoop stress that grows with the square of the speed, from that at 1 rad/s.
    stretch = np.array([limits.stretch_max for limits in each])[material] / overspeed**2
    alone = RimLimits(
        density=density,
        outer_radius_max=envelope.outer_radius_max,
        inner_radius_min=np.full_like(density, envelope.inner_radius_min),
        height_max=envelope.height_max,
        height_min=np.full_like(density, envelope.height_min),
        wall_min=envelope.wall_min,
        mass_max=envelope.mass_max,
        stretch_max=stretch,
        poisson_ratio=np.array([limits.poisson_ratio for limits in each])[material],
        web=np.zeros_like(density),
    )
    mounted = limits_with_mount(alone, mount_reach)
    return limits_with_web(mounted, hub_radius, problem.cuts) if problem.web else mounted
