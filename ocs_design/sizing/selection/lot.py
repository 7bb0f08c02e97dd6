"""Candidates as arrays: a drive and a material each, and the modules that they come to."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ocs_design.arrays import FloatArray
from ocs_design.sizing.cylinder import cylinder_transverse_inertia
from ocs_design.sizing.housing import (
    housing_axial_inertia,
    housing_height,
    housing_outer_radius,
    housing_transverse_inertia,
)
from ocs_design.sizing.lightest_module import ModuleShape, lightest_module, lightest_module_at
from ocs_design.sizing.rim_closed_form import smallest_spin_inertia
from ocs_design.sizing.rim_problem import RimLimits, RimProblem
from ocs_design.sizing.selection.drive_table import DriveTable
from ocs_design.sizing.selection.problem import SelectionProblem
from ocs_design.sizing.selection.trunk import Modules
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
    def least_spin_inertia(self) -> FloatArray:
        """With the smallest rim that the lower limits leave [kg m^2], and positive.

        A rotor that turns against its wheel may have as much momentum as the smallest rim.
        """
        least = smallest_spin_inertia(self.limits) * _OFF_THE_EDGE + self.drives.beside_rim
        return np.maximum(least, _NOTHING)

    def shapes(self, spin_inertia: FloatArray) -> ModuleShape:
        """The lightest wheels and housings that together with the rotors have it [kg m^2]."""
        return lightest_module(spin_inertia - self.drives.beside_rim, self.limits)

    def shapes_at(
        self, spin_inertia: FloatArray, radius: FloatArray, flatness: FloatArray
    ) -> ModuleShape:
        """The lightest ones of these outer radii [m]; see `lightest_module_at`."""
        rim = spin_inertia - self.drives.beside_rim
        return lightest_module_at(rim, radius, self.limits, flatness)

    def modules(self, spin_inertia: FloatArray, shapes: ModuleShape) -> Modules:
        """One module of each, braked."""
        drives, wheel = self.drives, spin_inertia - self.drives.rotor_share
        inner, outer, height = shapes.inner_radius, shapes.outer_radius, shapes.height
        across = cylinder_transverse_inertia(inner, outer, height, 1.0) * self.limits.density
        # Of the web, whose mass tells its thickness: m (3 r^2 + t^2) / 12.
        web = shapes.web_mass * (3.0 * inner**2 + WEB_THICKNESS**2) / 12.0
        return Modules(
            mass=drives.mass + shapes.mass,
            axial_inertia=drives.axial_inertia + wheel + housing_axial_inertia(outer, height),
            transverse_inertia=drives.transverse_inertia
            + across
            + web
            + housing_transverse_inertia(outer, height),
            outer_radius=housing_outer_radius(outer),
            height=housing_height(height),
        )

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
        )
        return Lot(self.drives.take(rows), self.material[rows], limits)

    def repeated(self, times: int) -> "Lot":
        """Every candidate so many times, one after the other."""
        return self.take(np.repeat(np.arange(len(self.drives)), times))


def lot_of(problem: SelectionProblem, drives: DriveTable, material: NDArray[np.intp]) -> Lot:
    """Candidates of these drives and materials, entry by entry."""
    limits = rim_limits(problem, material, drives.overspeed, drives.hub_radius)
    return Lot(drives, material, limits)


def rim_limits(
    problem: SelectionProblem,
    material: NDArray[np.intp],
    overspeed: FloatArray,
    hub_radius: FloatArray,
) -> RimLimits:
    """Limits of rims of these materials at these speeds [rad/s] around hubs [m], entry by entry."""
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
    return limits_with_web(alone, hub_radius) if problem.web else alone
