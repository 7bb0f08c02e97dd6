"""Sample wheels and parts with every kind of feature."""

import numpy as np

from ocs_design.actuation.fasteners import BoltCircle, screw
from ocs_design.common.frames import Placement
from ocs_design.parts.cage import Cage, cage_part
from ocs_design.parts.foot import Foot, foot_part
from ocs_design.parts.housing import Housing, housing_parts
from ocs_design.parts.printed import MountHoles
from ocs_design.parts.rim import HoleRing, Hub, RimCuts
from ocs_design.parts.shapes import ArcSlot, Disc, Rectangle
from ocs_design.parts.solids import Part, Prism, hollow_cylinder
from ocs_design.parts.wheel import Rim, Web, Wheel, wheel_parts

STEEL, ALUMINIUM = 7860.0, 2700.0

RIM = Rim(0.022, 0.03, 0.01, "steel", STEEL, RimCuts(0.3e-3, 12, 0.001, 0.002))

WEB = Web(
    material="aluminium",
    density=ALUMINIUM,
    thickness=1.5e-3,
    mass=8.9e-3,
    hub=Hub(0.010, 0.006, 0.002, 4, 0.006, 0.00145, chamfer=2e-4),
    holes=HoleRing(6, 0.016, 0.003),
)

TWO_PIECES = Wheel(RIM, WEB)
ONE_PIECE = Wheel(Rim(0.022, 0.03, 0.01, "aluminium", ALUMINIUM, RimCuts(0.3e-3)), WEB)
RIM_ALONE = Wheel(Rim(0.022, 0.03, 0.01, "steel", STEEL, RimCuts(0.3e-3)))
DISC = Wheel(Rim(0.0, 0.03, 0.01, "steel", STEEL))

ACROSS = Placement(np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]]), np.zeros(3))
"""Placement whose z axis points along -y of the part."""

SLOTTED = Part(
    "slotted",
    1270.0,
    (
        Prism(Disc(0.03), 0.0, 0.004),
        Prism(Rectangle(-0.01, 0.01, 0.004, 0.03), -0.002, 0.002, ACROSS),
    ),
    (
        Prism(ArcSlot(0.024, 0.0034, 0.3, 0.3 + np.pi / 2), 0.0, 0.004),
        Prism(ArcSlot(0.024, 0.0034, 3.4, 3.4 + np.pi / 2), 0.0, 0.004),
        Prism(Disc(0.0012, (0.0, -0.016)), 0.002, 0.004, count=5),
        Prism(Disc(0.004, (0.0, 0.02)), -0.002, 0.002, ACROSS),
    ),
)
"""A base with an upright plate: arcs, blind holes and a solid across the others."""

TUBE = Part("tube", 1000.0, (hollow_cylinder(0.01, 0.02, -0.01, 0.03),))

HOUSING = Housing(
    0.03,
    0.01,
    MountHoles(0.004, BoltCircle(0.0346, 3, "M3")),
    screw("M2"),
)
FOOT = Foot(HOUSING)

CAGE = Cage(0.018, 0.036, MountHoles(0.0075, BoltCircle(0.025, 4, "M3")), 0.0015, 0.006)

PARTS = {
    part.name: part
    for part in (
        *wheel_parts(TWO_PIECES),
        *wheel_parts(ONE_PIECE),
        *(Part("disc", part.density, part.joined) for part in wheel_parts(DISC)),
        *housing_parts(HOUSING),
        foot_part(FOOT),
        cage_part(CAGE),
        SLOTTED,
        TUBE,
    )
}
