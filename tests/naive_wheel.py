"""A wheel as solid cylinders less their cavities: an oracle for the selection."""

from dataclasses import dataclass
from math import pi

import numpy as np

from ocs_design.parts.rim import WEB_THICKNESS


@dataclass(frozen=True)
class Rims:
    """Hollow cylinders of one density: outer and inner radius and height [m], shape (n,).

    Their edges have a chamfer of `chamfer` [m].
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
        disc = chamfered_cylinder(self.outer, -self.chamfer, self.height, self.density)
        return disc - chamfered_cylinder(self.inner, self.chamfer, self.height, self.density)

    def web(self, density, thickness=WEB_THICKNESS, hub=None):
        disc = cylinder(self.inner, thickness, density)
        if hub is None or not hub.lightening:
            return disc
        circle, radius = lightening_holes(self.inner, hub)
        mass, axial, across = cylinder(radius, thickness, density)
        off = mass * circle**2
        # Rings of three or more holes have equal moments about all axes across.
        return disc - hub.lightening * np.stack([mass, axial + off, across + off / 2.0])


def lightening_holes(bore, hub):
    """Circle and radius of the holes in a web: a share of its area, near its middle [m]."""
    share = {5: 0.35, 6: 0.4, 7: 0.4, 8: 0.35}[hub.lightening]
    square = np.maximum(share * (bore**2 - hub.radius**2), 0.0) / hub.lightening
    return np.sqrt(0.42 * (bore**2 + hub.radius**2) - square / 2.0), np.sqrt(square)


def has_room_for_holes(bore, hub):
    """Whether holes of at least 3 mm radius leave walls of at least 3 mm."""
    if not hub.lightening:
        return np.ones_like(bore, dtype=bool)
    circle, radius = lightening_holes(bore, hub)
    between = 2.0 * (circle * np.sin(pi / hub.lightening) - radius)
    left = np.minimum(np.minimum(circle - hub.radius, bore - circle) - radius, between)
    return (left >= 3e-3 * (1.0 - 1e-9)) & (radius >= 3e-3 * (1.0 - 1e-9))


def cylinder(radius, height, density):
    """Mass, inertia about the axis and across it of a solid cylinder, shape (3, n)."""
    mass = density * pi * radius**2 * height
    return np.stack([mass, mass * radius**2 / 2.0, mass * (3.0 * radius**2 + height**2) / 12.0])


def chamfered_cylinder(radius, flare, height, density):
    """A solid cylinder with 45 degree cones at both ends, where the radius grows by `flare`.

    The cones are integrated by three-point Gauss quadrature, exact for fourth powers.
    """
    long = abs(flare)
    body = cylinder(radius, height - 2.0 * long, density)
    nodes, weights = np.polynomial.legendre.leggauss(3)
    for node, weight in zip((nodes + 1.0) / 2.0, weights / 2.0, strict=True):
        at, away = radius + flare * node, height / 2.0 - long * (1.0 - node)
        mass = density * pi * at**2 * long * weight
        body = body + 2.0 * np.stack([mass, mass * at**2 / 2.0, mass * (at**2 / 4.0 + away**2)])
    return body


def hub_body(hub, density):
    """Hub outside of the web, less its bore and the holes of its bolts."""
    boss = chamfered_cylinder(hub.radius, -hub.chamfer, hub.height, density)
    boss = boss - cylinder(hub.radius, hub.web_thickness, density)
    body = boss - chamfered_cylinder(hub.bore_radius, hub.chamfer, hub.height, density)
    for bolt in range(hub.bolts):
        mass, axial, across = cylinder(hub.bolt_hole_radius, hub.height, density)
        angle = 2.0 * pi * bolt / hub.bolts
        off = mass * hub.bolt_circle_radius**2
        body = body - np.array([mass, axial + off, across + off * np.sin(angle) ** 2])
    return body


def wheel_body(chosen):
    """Mass, axial and transverse inertia of a selected wheel, without its rotor."""
    size = (chosen.outer_radius, chosen.inner_radius, chosen.height)
    rims = Rims(*size, chosen.material.density, chosen.cuts.chamfer)
    if chosen.hub is None:
        return rims.body
    density = (chosen.web_material or chosen.material).density
    web = rims.web(density, chosen.hub.web_thickness, chosen.hub)
    return rims.body + web + hub_body(chosen.hub, density)
