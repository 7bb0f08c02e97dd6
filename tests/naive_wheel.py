"""A wheel as solid cylinders less their cavities: for checks of the selection."""

from dataclasses import dataclass
from math import pi

import numpy as np

from ocs_design.sizing.web import WEB_DENSITY, WEB_THICKNESS


@dataclass(frozen=True)
class Rims:
    """Hollow cylinders of one density: outer and inner radius and height [m], shape (n,)."""

    outer: np.ndarray
    inner: np.ndarray
    height: np.ndarray
    density: float

    def take(self, rows):
        return Rims(self.outer[rows], self.inner[rows], self.height[rows], self.density)

    @property
    def body(self):
        whole = solid(self.outer, self.height, self.density)
        return whole - solid(self.inner, self.height, self.density)

    @property
    def web(self):
        return solid(self.inner, WEB_THICKNESS, WEB_DENSITY)


def solid(radius, height, density):
    """Mass, inertia about the axis and across it of a solid cylinder, shape (3, n)."""
    mass = density * pi * radius**2 * height
    return np.stack([mass, mass * radius**2 / 2.0, mass * (3.0 * radius**2 + height**2) / 12.0])


def hub_body(hub):
    """Beyond the web that it stands in, less its bore and its bolts' holes, one by one."""
    boss = solid(hub.radius, hub.height, WEB_DENSITY) - solid(
        hub.radius, WEB_THICKNESS, WEB_DENSITY
    )
    body = boss - solid(hub.bore_radius, hub.height, WEB_DENSITY)
    for bolt in range(hub.bolts):
        mass, axial, across = solid(hub.bolt_hole_radius, hub.height, WEB_DENSITY)
        angle = 2.0 * pi * bolt / hub.bolts
        off = mass * hub.bolt_circle_radius**2
        body = body - np.array([mass, axial + off, across + off * np.sin(angle) ** 2])
    return body


def wheel_of(chosen):
    """Mass, inertia about the axis and across it of a selected wheel, without its rotor."""
    size = (chosen.outer_radius, chosen.inner_radius, chosen.height)
    rims = Rims(*size, chosen.material.density)
    return rims.body if chosen.hub is None else rims.body + rims.web + hub_body(chosen.hub)
