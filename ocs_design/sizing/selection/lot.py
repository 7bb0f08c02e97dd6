"""Candidates as arrays: a drive and a material each, and the modules that they come to."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ocs_design.arrays import FloatArray
from ocs_design.catalogue.materials import Material
from ocs_design.requirement.envelope import Envelope
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
from ocs_design.sizing.selection.trunk import Modules

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
        least = smallest_spin_inertia(self.limits) * _OFF_THE_EDGE + self.drives.rotor_share
        return np.maximum(least, _NOTHING)

    def shapes(self, spin_inertia: FloatArray) -> ModuleShape:
        """The lightest rims and housings that together with the rotors have it [kg m^2]."""
        return lightest_module(spin_inertia - self.drives.rotor_share, self.limits)

    def shapes_at(
        self, spin_inertia: FloatArray, radius: FloatArray, flatness: FloatArray
    ) -> ModuleShape:
        """The lightest ones of these outer radii [m]; see `lightest_module_at`."""
        rim = spin_inertia - self.drives.rotor_share
        return lightest_module_at(rim, radius, self.limits, flatness)

    def modules(self, spin_inertia: FloatArray, shapes: ModuleShape) -> Modules:
        """One module of each, braked."""
        drives, rim = self.drives, spin_inertia - self.drives.rotor_share
        inner, outer, height = shapes.inner_radius, shapes.outer_radius, shapes.height
        across = cylinder_transverse_inertia(inner, outer, height, 1.0) * self.limits.density
        return Modules(
            mass=drives.mass + shapes.mass,
            axial_inertia=drives.axial_inertia + rim + housing_axial_inertia(outer, height),
            transverse_inertia=drives.transverse_inertia
            + across
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
        )
        return Lot(self.drives.take(rows), self.material[rows], limits)

    def repeated(self, times: int) -> "Lot":
        """Every candidate so many times, one after the other."""
        return self.take(np.repeat(np.arange(len(self.drives)), times))


def lot_of(
    drives: DriveTable,
    material: NDArray[np.intp],
    materials: Sequence[Material],
    envelope: Envelope,
) -> Lot:
    """Candidates of these drives and materials, entry by entry."""
    return Lot(drives, material, rim_limits(envelope, materials, material, drives.overspeed))


def rim_limits(
    envelope: Envelope,
    materials: Sequence[Material],
    material: NDArray[np.intp],
    overspeed: FloatArray,
) -> RimLimits:
    """Limits of rims of these materials at these speeds [rad/s], entry by entry."""
    each = [RimProblem(0.0, envelope, kind, 1.0).limits for kind in materials]
    density = np.array([limits.density for limits in each])[material]
    # With a hoop stress that grows with the square of the speed, from that at 1 rad/s.
    stretch = np.array([limits.stretch_max for limits in each])[material] / overspeed**2
    return RimLimits(
        density=density,
        outer_radius_max=envelope.outer_radius_max,
        inner_radius_min=envelope.inner_radius_min,
        height_max=envelope.height_max,
        height_min=envelope.height_min,
        wall_min=envelope.wall_min,
        mass_max=envelope.mass_max,
        stretch_max=stretch,
        poisson_ratio=np.array([limits.poisson_ratio for limits in each])[material],
    )
