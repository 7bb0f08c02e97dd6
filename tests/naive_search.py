"""The lightest device by brute force: every combination on a grid, then on finer grids."""

from dataclasses import dataclass
from itertools import product
from math import inf, log, pi

import numpy as np
from naive_device import (
    Drive,
    chamfer_of,
    device_mass,
    fits_envelope,
    is_buildable,
    is_complete,
    least_wall,
    margin,
)
from naive_wheel import Rims

COARSE = (31, 12, 8, 26)
FINE = (7, 13, 7, 81)
"""Number of grid points of incidence, outer radius, height and wall."""
BLOCK = 30_000
"""Candidates evaluated together."""
NARROW = 2e-4
"""Relative width of the grid at which refinement stops."""


@dataclass(frozen=True)
class Device:
    """One point of a grid: a drive, a material, the incidence [rad], R, h and R - r [m]."""

    mass: float
    drive: Drive
    material: object
    names: tuple[str, str, str]
    point: np.ndarray


def search(problem):
    """The lightest device of all combinations; None if no grid has a feasible one."""
    candidates = sorted(_coarse(problem), key=lambda device: device.mass)
    best = None
    for device in candidates:
        # A coarse grid is rarely off by a third; heavier candidates are not refined.
        if best is None or device.mass < 1.35 * best.mass:
            fine = refine(problem, device)
            best = fine if best is None or fine.mass < best.mass else best
    return best


def _coarse(problem):
    lightest = inf
    for motor, gear in product(problem.motors, problem.gears):
        if not is_complete(motor, gear):
            continue
        drive = Drive(problem, motor, gear)
        for material in problem.materials:
            names = (motor.name, gear.name, material.name)
            axes = _axes(problem, drive.height_min(material.density))
            device = _lightest(problem, drive, material, names, axes, 1.35 * lightest)
            if device is not None:
                lightest = min(lightest, device.mass)
                yield device


def _axes(problem, seat):
    """Grids of incidence, outer radius, height and wall over the whole envelope."""
    room = problem.envelope
    angles, radii, heights, walls = COARSE
    low = max(room.inner_radius_min, 1e-3) + room.wall_min
    thick = room.outer_radius_max - room.inner_radius_min
    specified = problem.incidence
    return (
        np.linspace(0.0, pi / 2.0, angles) if specified is None else np.array([specified]),
        np.linspace(low, room.outer_radius_max, radii),
        np.linspace(max(room.height_min, seat), room.height_max, heights),
        np.exp(np.linspace(log(least_wall(problem)), log(thick), walls)),
    )


def refine(problem, device):
    """The lightest device on narrowing grids around a given one."""
    widths = np.array([0.08, 0.12, 0.2, 0.2])
    while widths[-1] > NARROW:
        seat = device.drive.height_min(device.material.density)
        axes = _axes_around(problem, device.point, widths, seat)
        better = _lightest(
            problem, device.drive, device.material, device.names, axes, device.mass * (1.0 - 1e-9)
        )
        gained = 0.0 if better is None else 1.0 - better.mass / device.mass
        device = device if better is None else better
        if gained < 3e-5:
            widths = widths * 0.7
    return device


def _axes_around(problem, point, widths, seat):
    """Grids around a point: incidence by angles, all else by ratios, clipped to the limits."""
    room = problem.envelope
    specified = problem.incidence
    angles = np.clip(point[0] + np.linspace(-widths[0], widths[0], FINE[0]), 0.0, pi / 2.0)
    limits = ((0.0, room.outer_radius_max), (max(room.height_min, seat), room.height_max))
    limits += ((least_wall(problem), inf),)
    rest = (
        np.unique(np.clip(at * np.exp(np.linspace(-width, width, count)), *limit))
        for at, width, count, limit in zip(point[1:], widths[1:], FINE[1:], limits, strict=True)
    )
    return (np.unique(angles) if specified is None else np.array([specified]), *rest)


def _lightest(problem, drive, material, names, axes, below):
    """The lightest feasible grid point below a mass; None if there is none."""
    angles, *shape = axes
    outer, height, wall = (values.ravel() for values in np.meshgrid(*shape, indexing="ij"))
    rims = Rims(outer, outer - wall, height, material.density, chamfer_of(problem))
    mass = device_mass(drive, rims)
    buildable = (
        fits_envelope(problem, rims) & is_buildable(problem, drive, rims, material) & (mass < below)
    )
    rows = np.flatnonzero(buildable)
    rows = rows[np.argsort(mass[rows], kind="stable")]
    block = max(BLOCK // angles.size, 1)
    for start in range(0, rows.size, block):
        batch = rows[start : start + block]
        repeated = np.repeat(batch, angles.size)
        margins = margin(problem, drive, rims.take(repeated), np.tile(angles, batch.size))
        feasible = margins.reshape(batch.size, angles.size) >= 1.0
        if feasible.any():
            row = int(np.argmax(feasible.any(axis=1)))
            # Of several feasible incidences, the one with the largest margin.
            angle = angles[margins.reshape(feasible.shape)[row].argmax()]
            at = batch[row]
            point = np.array([angle, outer[at], height[at], wall[at]])
            return Device(float(mass[at]), drive, material, names, point)
    return None
