"""The outline of a carrier plate: discs under the feet, and necks from its middle to them."""

from dataclasses import dataclass
from math import acos, asin, pi, sin, sqrt, tan

import numpy as np
from numpy.typing import NDArray

from ocs_design.common.arrays import FloatArray
from ocs_design.parts.moments import MassMoments
from ocs_design.parts.outline import Outline
from ocs_design.parts.shapes import flat

FILLET = 10.0e-3
"""Largest fillet radius between neck and discs [m]: fits a milling cutter, and avoids a notch."""


def directions(arms: int) -> FloatArray:
    """Unit vectors along evenly spaced arms, the first one to the left, shape (n, 2)."""
    angles = 2.0 * pi * np.arange(arms) / arms
    # Rounded, so that the sine of half a turn leaves no rounding errors in files.
    return np.round(np.stack([-np.sin(angles), np.cos(angles)], axis=1), 15) + 0.0


@dataclass(frozen=True)
class DogBone:
    """Discs evenly around a middle, with a neck from there to each, filleted where they meet.

    Two discs have one neck between them, along y. With a neck as wide as the discs the shape is a
    rectangle with half a disc at each end.

    Attributes:
        radius: of the discs [m].
        half_length: from the middle to any end; the first disc is along y [m].
        neck: half of a neck's width, at most the radius [m].
        x: of its middle [m].
        arms: number of discs, two or more.
    """

    radius: float
    half_length: float
    neck: float
    x: float = 0.0
    arms: int = 2

    @property
    def across(self) -> float:
        """Distance of any disc's middle from that of the shape [m]."""
        return self.half_length - self.radius

    @property
    def hub(self) -> float:
        """Distance along an arm at which its sides meet those of the next arms [m]; 0 for two."""
        return 0.0 if self.arms == 2 else self.neck / tan(pi / self.arms)

    @property
    def fits(self) -> bool:
        """Whether the discs are clear of each other and of the hub."""
        return min(self.across * sin(pi / self.arms), self.across - self.hub) >= self.radius

    @property
    def fillet(self) -> float:
        """Radius of the fillet, limited by the length of the neck [m]."""
        beyond = self.radius - self.neck
        if beyond <= 0.0:
            return FILLET
        room = (self.across - self.hub) ** 2 - self.radius**2 + self.neck**2
        return min(FILLET, 0.95 * room / (2.0 * beyond))

    @property
    def straight(self) -> float:
        """Distance from the middle at which the neck's straight sides end [m]."""
        reach, out = self.radius + self.fillet, self.neck + self.fillet
        return self.across - sqrt(max(0.0, reach**2 - out**2))

    @property
    def meets(self) -> tuple[float, float]:
        """Point where a fillet meets its disc, x and y [m]."""
        share = self.radius / (self.radius + self.fillet)
        out = self.neck + self.fillet
        return share * out, self.across - share * (self.across - self.straight)

    @property
    def area(self) -> float:
        """Area [m^2]."""
        return self.moments.mass

    @property
    def moments(self) -> MassMoments[float]:
        """Moments about the origin, of unit density, from those of half an arm.

        int x dy, int x^3 / 3 dy and int x y^2 dy along the hub, x = w y / h, along the neck, x = w,
        along the fillet, x = w + f - q(s) with s = y - y_0, and along the disc, x = q(s) with s =
        y - c; see `_on_circle`.
        """
        w, f, r, c, low = self.neck, self.fillet, self.radius, self.across, self.straight
        _, top = self.meets
        h = self.hub
        area, cubes, second = w * (low - h / 2.0), w**3 * (low - 0.75 * h), w * low**3 / 3.0
        second -= w * h**3 / 12.0
        # The fillet: distance of its tangent, minus a circle.
        a, end = w + f, top - low
        one, cube, about = _on_circle(f, 0.0, end, low)
        area += a * end - one
        cubes += a**3 * end - 3.0 * a**2 * one - cube
        cubes += 3.0 * a * (f**2 * end - end**3 / 3.0)
        second += a * ((low + end) ** 3 - low**3) / 3.0 - about
        one, cube, about = _on_circle(r, top - c, r, c)
        area, cubes, second = area + one, cubes + cube, second + about
        around = flat(2.0 * area, 2.0 / 3.0 * cubes, 2.0 * second).around(self.arms)
        return around.moved(self.x, 0.0, 0.0)

    def outline(self) -> Outline:
        """The necks' sides, and the discs between their fillets."""
        (x, y), low, middle = self.meets, self.straight, np.array([self.x, 0.0])
        # The right side of the first arm, seen from the middle, then its disc to the left side.
        right, bulges = [[self.neck, low]], [1.0]
        if self.neck < self.radius:
            angle = acos((self.neck + self.fillet) / (self.radius + self.fillet))
            inward, around = -tan(angle / 4.0), tan((pi + 2.0 * angle) / 4.0)
            right, bulges = [[self.neck, low], [x, y]], [inward, around, inward]
        arm, bulges = [*right, *([-off, along] for off, along in reversed(right))], [*bulges, 0.0]
        if self.arms > 2:
            # The corner shared with the next arm.
            arm, bulges = [*arm, [-self.neck, self.hub]], [*bulges, 0.0]
        corners = [
            np.array(arm) @ np.array([[along, -off], [off, along]])
            for off, along in directions(self.arms)
        ]
        return Outline(np.concatenate(corners) + middle, np.array(bulges * self.arms))

    def holds(self, points: FloatArray) -> NDArray[np.bool_]:
        """Whether points, x and y of shape (n, 2) [m], are within it, shape (n,)."""
        inside = np.zeros(len(points), dtype=bool)
        for off, along in directions(self.arms):
            out, aside = np.array([[off, along], [along, -off]]) @ (points - [self.x, 0.0]).T
            inside |= (out >= 0.0) & (np.abs(aside) <= self.half_width(out))
        return inside

    def half_width(self, across: FloatArray) -> FloatArray:
        """Half its width at distances along y from its middle, 0 beyond its ends [m]."""
        off, f = np.abs(across), self.fillet
        _, top = self.meets
        within = np.clip(off - self.straight, 0.0, f)
        rounded = self.neck + f - np.sqrt(f**2 - within**2)
        disc = np.sqrt(np.maximum(0.0, self.radius**2 - (off - self.across) ** 2))
        return np.asarray(np.where(off < top, rounded, disc))


def _on_circle(r: float, low: float, high: float, offset: float) -> tuple[float, float, float]:
    """Integrals over s of q, q^3 and (s + offset)^2 q with q(s) = sqrt(r^2 - s^2) [m^2, m^4].

    That of q is (s q + r^2 asin(s/r)) / 2; of q^3, s q^3 / 4 plus 3/4 r^2 times that of q; of s q,
    -q^3 / 3; of s^2 q, -s q^3 / 4 plus r^2 / 4 times that of q.
    """
    p, q = (sqrt(max(0.0, r**2 - s**2)) for s in (low, high))
    one = (high * q + r**2 * asin(high / r)) / 2.0 - (low * p + r**2 * asin(low / r)) / 2.0
    first, fourth = -(q**3) / 3.0 + p**3 / 3.0, high * q**3 / 4.0 - low * p**3 / 4.0
    square = -fourth + r**2 / 4.0 * one
    return one, fourth + 0.75 * r**2 * one, square + 2.0 * offset * first + offset**2 * one
