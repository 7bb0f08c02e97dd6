"""Containment of a bursting rim: the energy of its fragments, and the steel ring that stops them.

A bursting rotor is assumed to break into three equal fragments: among equal fragments, thirds carry
the most translational energy to within 1 %. That energy must be stopped; the spin of a fragment
about its own centre of mass is dissipated against the wall.

The wall follows the formula of the Ballistic Research Laboratory for plates of mild steel (R. C.
Gwaltney, Missile Generation and Protection in Light-Water-Cooled Power Reactor Plants,
ORNL-NSIC-22, 1968; BC-TOP-9A, Design of Structures for Missile Impact, Bechtel, 1974): a blunt hard
missile of energy E [ft lbf] and diameter D [in] just perforates the thickness T [in],

    T = E^(2/3) / (672 D),        and 1.25 T is built.

The formula comes from tests of missiles against large plates. They do not cover a narrow ring, its
joint and its mounting, so a ring of this thickness is a good starting point for tests, and does not
make it safe to stand nearby.
"""

from dataclasses import dataclass
from math import ceil, pi, sin, sqrt

from ocs_design.actuation.fasteners import STEEL
from ocs_design.catalogue.materials import material
from ocs_design.parts.moments import cylinder_mass

PIECES = 3
"""Number of equal fragments of a bursting rim."""

FOOT, INCH, POUND_FORCE = 0.3048, 0.0254, 4.4482216152605
"""Foot [m], inch [m] and pound-force [N]: exact, international yard and pound agreement of 1959."""

BRL_CONSTANT = 672.0
"""Constant of the formula above, with ft lbf and in."""

STEP = 1e-4
"""Step of the wall thickness of rings as built [m]."""

BUILT_WALL_FACTOR = 1.25
"""Thickness as built, over the thickness just perforated (BC-TOP-9A)."""

STEEL_STRENGTH, ALUMINIUM_STRENGTH = 360e6, 310e6
"""Tensile strengths [Pa]: least of S235 (EN 10025-2), typical of 6061-T6 (ASM)."""


RING_STEEL = "mild steel (S235)"
"""Material of guard rings."""

OUTSIDE_UNDER, WALL_OVER, HEIGHT_UNDER = 0.2e-3, 0.1e-3, 0.3e-3
"""Tolerances of a guard ring [m]: outside diameter below, wall above and height below nominal by
that at most. It goes into its drum, does not lift the lid, and stays 1.5 mm off the rim even if it
is bonded against one side."""


@dataclass(frozen=True)
class Fragment:
    """A third of a wheel that has burst.

    Attributes:
        mass: [kg].
        speed: of its centre of mass when it separates [m/s].
        diameter: of a circle with the area of the rim's cross-section, the face whose impact does
            most damage [m].
    """

    mass: float
    speed: float
    diameter: float

    @property
    def energy(self) -> float:
        """Translational energy [J]."""
        return 0.5 * self.mass * self.speed**2


def fragment_of(
    *,
    inner_radius: float,
    outer_radius: float,
    height: float,
    rim_mass: float,
    web_mass: float,
    wheel_speed: float,
) -> Fragment:
    """Fragment: a third of a wheel.

    A sector of half angle a between the radii r and R has its centre of mass at
    `(2/3) (R^3 - r^3) / (R^2 - r^2) sin(a) / a`. The web is treated as a plain disc in the rim's
    bore, which puts the hub's mass farther out than it is.

    Args:
        inner_radius, outer_radius, height: of the rim [m].
        rim_mass, web_mass: [kg].
        wheel_speed: at which it bursts [rad/s].
    """
    half = pi / PIECES
    rim_arm = 2.0 / 3.0 * (outer_radius**3 - inner_radius**3) / (outer_radius**2 - inner_radius**2)
    web_arm = 2.0 / 3.0 * inner_radius
    whole = rim_mass + web_mass
    arm = (rim_mass * rim_arm + web_mass * web_arm) / whole * sin(half) / half
    area = (outer_radius - inner_radius) * height
    return Fragment(whole / PIECES, arm * wheel_speed, 2.0 * sqrt(area / pi))


def steel_wall(energy: float, diameter: float) -> float:
    """Thickness of mild steel to build against a missile [m]; see the module docstring.

    Args:
        energy: of the missile [J].
        diameter: of the missile [m].
    """
    perforated: float = (energy / (FOOT * POUND_FORCE)) ** (2.0 / 3.0) / (
        BRL_CONSTANT * diameter / INCH
    )
    return BUILT_WALL_FACTOR * perforated * INCH


@dataclass(frozen=True)
class Containment:
    """Rings in the housing, from its floor to its lid, that would contain a bursting wheel.

    Attributes:
        fragment: to be contained at top speed.
        inner_radius, height: of either ring [m].
        steel, aluminium: wall of a ring of mild steel or of 6061-T6 [m].
    """

    fragment: Fragment
    inner_radius: float
    height: float
    steel: float
    aluminium: float

    @classmethod
    def of(cls, fragment: Fragment, inner_radius: float, height: float) -> "Containment":
        """Rings of that inner radius and height [m]."""
        steel = steel_wall(fragment.energy, fragment.diameter)
        # There are no tests of aluminium: the energy to shear a plug is proportional to strength
        # times thickness squared (A. C. Hagg, G. O. Sankey, The Containment of Disk Burst Fragments
        # by Cylindrical Shells, J. Eng. Power 96(2), 1974).
        aluminium = steel * sqrt(STEEL_STRENGTH / ALUMINIUM_STRENGTH)
        return cls(fragment, inner_radius, height, steel, aluminium)

    @property
    def masses(self) -> tuple[float, float]:
        """Mass of the steel ring and of the aluminium ring, both as built [kg]."""
        light = material("aluminium-6061-t6").density
        walls = (stepped(self.steel), STEEL), (stepped(self.aluminium), light)
        steel, aluminium = (
            cylinder_mass(self.inner_radius, self.inner_radius + wall, self.height, density)
            for wall, density in walls
        )
        return steel, aluminium

    @property
    def built_wall(self) -> float:
        """Wall of the steel ring as built [m]."""
        return stepped(self.steel)


def stepped(wall: float) -> float:
    """A wall thickness rounded up to the next tenth of a millimetre [m]."""
    return ceil(wall / STEP - 1e-9) * STEP
