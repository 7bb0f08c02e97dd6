"""Joined rings of constant thickness that spin: stresses, displacements, holes in a web.

The solution is exact (Budynas and Nisbett, Shigley's Mechanical Engineering Design, 10th ed.,
sections 3-14 to 3-16; Timoshenko and Goodier, Theory of Elasticity, 3rd ed., section 32). In plane
stress, at the speed w, each ring has

    u         = A r + B / r - (1 - nu^2) rho w^2 r^3 / (8 E)
    sigma_r   = E A / (1 - nu) - E B / ((1 + nu) r^2) - (3 + nu) / 8 rho w^2 r^2
    sigma_phi = E A / (1 - nu) + E B / ((1 + nu) r^2) - (1 + 3 nu) / 8 rho w^2 r^2,

zero radial stress on the innermost and the outermost edge and, where two rings meet, equal forces
t sigma_r and displacements that differ by the interference. A one-piece wheel is three rings, hub,
web and rim, without interference; a shrunk-on rim is the last ring, with interference. A web with
holes is softer there, and its stress is divided by the share of material left in a section through
their middles (the ligament efficiency of a tube plate, (p - d) / p, ASME VIII-1, UG-53).
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from math import pi, sin

import numpy as np

from ocs_design.common.arrays import FloatArray

_POINTS = 33
"""Number of radii of each ring at which stress is evaluated, including both edges."""

_BANDS = 16
"""Number of rings that model the holes of a web."""


@dataclass(frozen=True)
class Ring:
    """A ring of constant thickness.

    Attributes:
        inner, outer: radii [m]; inner 0: a full disc.
        thickness: along the axis [m].
        density: [kg/m^3]. elastic_modulus: [Pa]. poisson_ratio: of its material.
    """

    inner: float
    outer: float
    thickness: float
    density: float
    elastic_modulus: float
    poisson_ratio: float

    def _rows(self, radius: float | FloatArray) -> tuple[FloatArray, FloatArray]:
        """Factors of A and B in the displacement and in the radial stress, shape (2, ...)."""
        r, of_b = np.asarray(radius, dtype=np.float64), 1.0 if self.inner > 0.0 else 0.0
        modulus, nu = self.elastic_modulus, self.poisson_ratio
        # A full disc has no B, whose factor would be infinite in the middle.
        safe = np.where(r > 0.0, r, 1.0)
        moved = np.stack([r, of_b / safe])
        stressed = np.stack(
            [modulus / (1.0 - nu) + 0.0 * r, -of_b * modulus / (1.0 + nu) / safe**2]
        )
        return moved, stressed

    def _rotation_terms(self, speed: float, radius: float | FloatArray) -> tuple[FloatArray, ...]:
        """Displacement, radial and hoop stress due to speed alone."""
        load, nu, r = self.density * speed**2, self.poisson_ratio, np.asarray(radius)
        return (
            -(1.0 - nu**2) * load * r**3 / (8.0 * self.elastic_modulus),
            -(3.0 + nu) / 8.0 * load * r**2,
            -(1.0 + 3.0 * nu) / 8.0 * load * r**2,
        )


@dataclass(frozen=True, eq=False)
class TurningRings:
    """Joined spinning rings, from the axis outwards.

    Attributes:
        rings: each begins where the previous one ends.
        speed: [rad/s].
        constants: A and B of each ring, shape (n, 2).
    """

    rings: tuple[Ring, ...]
    speed: float
    constants: FloatArray

    @classmethod
    def of(
        cls, rings: Sequence[Ring], speed: float, interferences: Sequence[float] | None = None
    ) -> "TurningRings":
        """Solve for the constants.

        Args:
            rings: from the axis outwards.
            speed: [rad/s].
            interferences: radial interference of each joint, from the axis outwards [m]; None: 0.
        """
        count = len(rings)
        gaps = [0.0] * (count - 1) if interferences is None else list(interferences)
        matrix, right = np.zeros((2 * count, 2 * count)), np.zeros(2 * count)
        first, last = rings[0], rings[-1]
        if first.inner > 0.0:
            matrix[0, :2] = first._rows(first.inner)[1]
            right[0] = -first._rotation_terms(speed, first.inner)[1]
        else:
            matrix[0, 1] = 1.0
        matrix[-1, -2:] = last._rows(last.outer)[1]
        right[-1] = -last._rotation_terms(speed, last.outer)[1]
        for at, (inside, around) in enumerate(pairwise(rings)):
            r, row, column = inside.outer, 2 * at + 1, 2 * at
            (moved, pulled), (moved_out, pulled_out) = inside._rows(r), around._rows(r)
            own, other = inside._rotation_terms(speed, r), around._rotation_terms(speed, r)
            t, t_out = inside.thickness, around.thickness
            matrix[row, column : column + 4] = [*-moved, *moved_out]
            right[row] = gaps[at] + float(own[0] - other[0])
            matrix[row + 1, column : column + 4] = [*(-t * pulled), *(t_out * pulled_out)]
            right[row + 1] = float(t * own[1] - t_out * other[1])
        # Displacements are nine orders of magnitude below stresses.
        scale = np.abs(matrix).max(axis=1)
        columns = np.abs(matrix / scale[:, None]).max(axis=0)
        constants = np.linalg.solve(matrix / scale[:, None] / columns, right / scale) / columns
        return cls(tuple(rings), speed, constants.reshape(count, 2))

    def displacement(self, ring: int, radius: float) -> float:
        """Radial displacement of one ring at a radius [m]."""
        own_ring = self.rings[ring]
        moved = own_ring._rows(radius)[0]
        return float(self.constants[ring] @ moved + own_ring._rotation_terms(self.speed, radius)[0])

    def stresses(self, ring: int, radius: float | FloatArray) -> tuple[FloatArray, FloatArray]:
        """Radial and hoop stress in one ring [Pa]."""
        own_ring, (a, b) = self.rings[ring], self.constants[ring]
        of_a, of_b = own_ring._rows(radius)[1]
        spun = own_ring._rotation_terms(self.speed, radius)
        return np.asarray(a * of_a + b * of_b + spun[1]), np.asarray(a * of_a - b * of_b + spun[2])

    def pressure(self, joint: int) -> float:
        """Pressure on the edge of a joint's inner ring [Pa]; negative: the joint is in tension."""
        return -float(self.stresses(joint, self.rings[joint].outer)[0])

    def peak(self, ring: int) -> float:
        """Largest von Mises stress of one ring [Pa]."""
        own_ring = self.rings[ring]
        radial, hoop = self.stresses(ring, np.linspace(own_ring.inner, own_ring.outer, _POINTS))
        return float(np.sqrt(radial**2 - radial * hoop + hoop**2).max())

    def peak_at_hole(self, ring: int, radius: float) -> float:
        """Largest stress at the edge of a small hole at a radius: |3 s_1 - s_2| (Kirsch) [Pa]."""
        radial, hoop = (float(stress) for stress in self.stresses(ring, radius))
        return max(abs(3.0 * hoop - radial), abs(3.0 * radial - hoop))


def ligament_efficiencies(web: Ring, count: int, circle: float, hole: float) -> tuple[float, float]:
    """Shares of a section left by holes in a ring: from one to the next, and along a radius.

    Args:
        web: with the holes. count: of holes.
        circle: radius of the circle of their middles [m]. hole: radius of each [m].
    """
    pitch, width = 2.0 * circle * sin(pi / count), web.outer - web.inner
    return 1.0 - 2.0 * hole / pitch, 1.0 - 2.0 * hole / width


def holed_peaks(
    rings: Sequence[Ring], speed: float, count: int, circle: float, hole: float
) -> tuple[float, float, float]:
    """Upper estimates of the largest stress in a hub, a web with holes and a rim [Pa].

    The band of the web with the holes is modelled as rings whose stiffness and density are scaled
    by the share of material at their radii: assuming axisymmetric displacements makes any body too
    stiff. Radial stress on the circle is carried between the holes, the web's mean hoop stress
    beside them: each is divided by its ligament efficiency e, and multiplied by 2 + e^3 at the edge
    of a hole, as in a strip with a central hole (Heywood; Pilkey, Peterson's Stress Concentration
    Factors, 3rd ed., section 4.3). The rim's stress is at least that without any web.

    Args:
        rings: hub, web and rim. speed: [rad/s].
        count, circle, hole: see `ligament_efficiencies`.
    """
    hub, web, rim = rings
    edges = np.linspace(circle - hole, circle + hole, _BANDS + 1)
    middles = (edges[:-1] + edges[1:]) / 2.0
    cosines = (middles**2 + circle**2 - hole**2) / (2.0 * middles * circle)
    shares = 1.0 - count * np.arccos(cosines) / pi
    thick, rho, modulus, nu = web.thickness, web.density, web.elastic_modulus, web.poisson_ratio
    bands = [
        Ring(inner, outer, thick, share * rho, share * modulus, nu)
        for (inner, outer), share in zip(pairwise(edges.tolist()), shares.tolist(), strict=True)
    ]
    inside = replace(web, outer=circle - hole)
    around = replace(web, inner=circle + hole)
    turning = TurningRings.of((hub, inside, *bands, around, rim), speed)
    pulled, stretched = float(turning.stresses(2 + _BANDS // 2, circle)[0]), 0.0
    for row, ring in enumerate(turning.rings[1:-1], start=1):
        hoop = turning.stresses(row, np.linspace(ring.inner, ring.outer, _POINTS))[1]
        stretched += float(hoop.mean()) * (ring.outer - ring.inner)
    stretched /= web.outer - web.inner
    between, beside = ligament_efficiencies(web, count, circle, hole)
    at_holes = (2.0 + between**3) / between * pulled, (2.0 + beside**3) / beside * stretched
    plain = turning.peak(1), turning.peak(len(bands) + 2)
    around_web = max(turning.peak(len(bands) + 3), TurningRings.of((rim,), speed).peak(0))
    return turning.peak(0), max(*at_holes, *plain), around_web
