"""A wheel as solid cylinders less their cavities: for checks of the selection."""

from dataclasses import dataclass
from math import pi

import numpy as np

from ocs_design.parts.rim import WEB_THICKNESS


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

    def web(self, density, thickness=WEB_THICKNESS, hub=None):
        disc = solid(self.inner, thickness, density)
        if hub is None or not hub.lightening:
            return disc
        circle, radius = lightening(self.inner, hub)
        mass, axial, across = solid(radius, thickness, density)
        off = mass * circle**2
        # Three and more in a ring have half of their distances' squares about any axis across.
        return disc - hub.lightening * np.stack([mass, axial + off, across + off / 2.0])


def lightening(bore, hub):
    """Circle and radius of the holes in a web: a share of its area, about in its middle [m]."""
    share = {5: 0.35, 6: 0.4, 7: 0.4, 8: 0.35}[hub.lightening]
    square = np.maximum(share * (bore**2 - hub.radius**2), 0.0) / hub.lightening
    return np.sqrt(0.42 * (bore**2 + hub.radius**2) - square / 2.0), np.sqrt(square)


def spokes(bore, hub):
    """Whether 3 mm are left around holes of 3 mm radius and more."""
    if not hub.lightening:
        return np.ones_like(bore, dtype=bool)
    circle, radius = lightening(bore, hub)
    between = 2.0 * (circle * np.sin(pi / hub.lightening) - radius)
    left = np.minimum(np.minimum(circle - hub.radius, bore - circle) - radius, between)
    return (left >= 3e-3 * (1.0 - 1e-9)) & (radius >= 3e-3 * (1.0 - 1e-9))


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


def hub_body(hub, density):
    """Beyond the web that it stands in, less its bore and its bolts' holes, one by one."""
    boss = turned(hub.radius, -hub.chamfer, hub.height, density)
    boss = boss - solid(hub.radius, hub.web_thickness, density)
    body = boss - turned(hub.bore_radius, hub.chamfer, hub.height, density)
    for bolt in range(hub.bolts):
        mass, axial, across = solid(hub.bolt_hole_radius, hub.height, density)
        angle = 2.0 * pi * bolt / hub.bolts
        off = mass * hub.bolt_circle_radius**2
        body = body - np.array([mass, axial + off, across + off * np.sin(angle) ** 2])
    return body


def wheel_of(chosen):
    """Mass, inertia about the axis and across it of a selected wheel, without its rotor."""
    size = (chosen.outer_radius, chosen.inner_radius, chosen.height)
    rims = Rims(*size, chosen.material.density, chosen.cuts.chamfer)
    if chosen.hub is None:
        return rims.body
    density = (chosen.web_material or chosen.material).density
    web = rims.web(density, chosen.hub.web_thickness, chosen.hub)
    return rims.body + web + hub_body(chosen.hub, density)
