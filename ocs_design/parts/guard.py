"""What holds a rim that bursts: the energy of its pieces, and the steel band that stops them.

A rotor that bursts is taken to part into three equal pieces: of all equal pieces thirds carry the
most energy of translation but for 1 %. What must be stopped is that energy; the spin of a piece
about its own centre of mass wears off on the wall.

The wall follows the formula of the Ballistic Research Laboratory for plates of mild steel (R. C.
Gwaltney, Missile Generation and Protection in Light-Water-Cooled Power Reactor Plants,
ORNL-NSIC-22, 1968; BC-TOP-9A, Design of Structures for Missile Impact, Bechtel, 1974): a blunt hard
missile of the energy E [ft lbf] and the diameter D [in] just perforates the thickness T [in],

    T = E^(2/3) / (672 D),        and 1.25 T is built.

It rests on tests of missiles against large plates. A narrow band, its joint and its fixture are
outside of that, so a band of this wall is a good guess to be tested, and no licence to stand by.
"""

from dataclasses import dataclass
from math import ceil, pi, sin, sqrt

from ocs_design.actuation.fasteners import STEEL
from ocs_design.catalogue.materials import material
from ocs_design.parts.moments import cylinder_mass
from ocs_design.parts.printed import CLEARANCE, GUARD_GAP

PIECES = 3
"""Equal parts that a rim bursts into."""

FOOT, INCH, POUND_FORCE = 0.3048, 0.0254, 4.4482216152605
"""[m], [m], [N]: exact, international yard and pound agreement of 1959."""

BRL = 672.0
"""Constant of the formula above, with ft lbf and in."""

STEP = 1e-4
"""Step of the walls of rings that are built [m]."""

BUILT = 1.25
"""Thickness that is built over the one that is just perforated (BC-TOP-9A)."""

STEEL_STRENGTH, ALUMINIUM_STRENGTH = 360e6, 310e6
"""Tensile strengths [Pa]: least of S235 (EN 10025-2), typical of 6061-T6 (ASM)."""


@dataclass(frozen=True)
class Fragment:
    """A third of a wheel that has burst.

    Attributes:
        mass: [kg].
        speed: of its centre of mass when it parts [m/s].
        diameter: of the circle with the area of the rim's cross-section, with which the piece
            strikes where it does most harm [m].
    """

    mass: float
    speed: float
    diameter: float

    @property
    def energy(self) -> float:
        """Energy of translation [J]."""
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
    """The third of a wheel that flies off.

    A sector of half angle a between the radii r and R has its centre of mass at
    `(2/3) (R^3 - r^3) / (R^2 - r^2) sin(a) / a`. The web is taken as a plain disc in the rim's
    bore, which counts its hub farther out than it is.

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
    """Thickness of mild steel to build against a missile [m]; see the module's text.

    Args:
        energy: of the missile [J].
        diameter: of the missile [m].
    """
    perforated: float = (energy / (FOOT * POUND_FORCE)) ** (2.0 / 3.0) / (BRL * diameter / INCH)
    return BUILT * perforated * INCH


@dataclass(frozen=True)
class Containment:
    """Rings in the housing, from its floor to its lid, that would hold a wheel that bursts.

    Attributes:
        fragment: that must be held at top speed.
        inner_radius, height: of either ring [m].
        steel, aluminium: its wall, of mild steel or of 6061-T6 [m].
    """

    fragment: Fragment
    inner_radius: float
    height: float
    steel: float
    aluminium: float

    @classmethod
    def of(cls, fragment: Fragment, outer_radius: float, height: float) -> "Containment":
        """Rings around a rim of that outer radius and height [m]."""
        steel = steel_wall(fragment.energy, fragment.diameter)
        # No tests are behind aluminium: the energy to shear a plug goes with strength times
        # thickness squared (A. C. Hagg, G. O. Sankey, The Containment of Disk Burst Fragments by
        # Cylindrical Shells, J. Eng. Power 96(2), 1974).
        aluminium = steel * sqrt(STEEL_STRENGTH / ALUMINIUM_STRENGTH)
        room = outer_radius + CLEARANCE - GUARD_GAP, height + 2.0 * CLEARANCE
        return cls(fragment, *room, steel, aluminium)

    @property
    def masses(self) -> tuple[float, float]:
        """Mass of the ring of steel, and of that of aluminium, as thick as they are built [kg]."""
        light = material("aluminium-6061-t6").density
        walls = (stepped(self.steel), STEEL), (stepped(self.aluminium), light)
        steel, aluminium = (
            cylinder_mass(self.inner_radius, self.inner_radius + wall, self.height, density)
            for wall, density in walls
        )
        return steel, aluminium

    @property
    def built_wall(self) -> float:
        """Wall of the steel ring that is built [m]."""
        return stepped(self.steel)


def stepped(wall: float) -> float:
    """A wall up to the next tenth of a millimetre [m]."""
    return ceil(wall / STEP - 1e-9) * STEP
