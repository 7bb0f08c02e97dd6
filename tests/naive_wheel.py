"""A wheel as solid cylinders less their cavities: for checks of the selection."""

from dataclasses import dataclass
from math import pi

import numpy as np

from ocs_design.parts.rim import WEB_DENSITY, WEB_THICKNESS


@dataclass(frozen=True)
class Rims:
    """Hollow cylinders of one density: outer and inner radius and height [m], shape (n,).

    With their edges broken by `chamfer` [m].
    """

    outer: np.ndarray
    inner: np.ndarray
    height: np.ndarray
    density: float
    chamfer: float = 0.0

    def take(self, rows):
        sizes = (self.outer[rows], self.inner[rows], self.height[rows])
        return Rims(*sizes, self.density, self.chamfer)

    @property
    def body(self):
        whole = turned(self.outer, -self.chamfer, self.height, self.density)
        return whole - turned(self.inner, self.chamfer, self.height, self.density)

    @property
    def web(self):
        return solid(self.inner, WEB_THICKNESS, WEB_DENSITY)


def solid(radius, height, density):
    """Mass, inertia about the axis and across it of a solid cylinder, shape (3, n)."""
    mass = density * pi * radius**2 * height
    return np.stack([mass, mass * radius**2 / 2.0, mass * (3.0 * radius**2 + height**2) / 12.0])


def turned(radius, flare, height, density):
    """A solid cylinder with a cone at either end, as long as the radius there grows by `flare`.

    The cones slice by slice, at three points of Gauss each, which are exact for fourth powers.
    """
    long = abs(flare)
    body = solid(radius, height - 2.0 * long, density)
    nodes, weights = np.polynomial.legendre.leggauss(3)
    for node, weight in zip((nodes + 1.0) / 2.0, weights / 2.0, strict=True):
        at, away = radius + flare * node, height / 2.0 - long * (1.0 - node)
        mass = density * pi * at**2 * long * weight
        body = body + 2.0 * np.stack([mass, mass * at**2 / 2.0, mass * (at**2 / 4.0 + away**2)])
    return body


def hub_body(hub):
    """Beyond the web that it stands in, less its bore and its bolts' holes, one by one."""
    boss = turned(hub.radius, -hub.chamfer, hub.height, WEB_DENSITY)
    boss = boss - solid(hub.radius, WEB_THICKNESS, WEB_DENSITY)
    body = boss - turned(hub.bore_radius, hub.chamfer, hub.height, WEB_DENSITY)
    for bolt in range(hub.bolts):
        mass, axial, across = solid(hub.bolt_hole_radius, hub.height, WEB_DENSITY)
        angle = 2.0 * pi * bolt / hub.bolts
        off = mass * hub.bolt_circle_radius**2
        body = body - np.array([mass, axial + off, across + off * np.sin(angle) ** 2])
    return body


def wheel_of(chosen):
    """Mass, inertia about the axis and across it of a selected wheel, without its rotor."""
    size = (chosen.outer_radius, chosen.inner_radius, chosen.height)
    rims = Rims(*size, chosen.material.density, chosen.cuts.chamfer)
    return rims.body if chosen.hub is None else rims.body + rims.web + hub_body(chosen.hub)
