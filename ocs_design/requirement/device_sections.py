"""Sections of a specification about the device: wheels, motors and their supply.

Each field is a key, as in `sections`.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from ocs_design.actuation.motor import DIRECT
from ocs_design.common.units import Dimension
from ocs_design.requirement import values, vocabulary
from ocs_design.requirement.keys import keyed


@dataclass(frozen=True, kw_only=True)
class OcsSection:
    """`[ocs]`: layout, position and mass limit of the device [rad, m, kg]."""

    layout: str | None = keyed(
        values.Choice((*vocabulary.LAYOUTS, vocabulary.ALL_LAYOUTS)),
        "arrangement of the wheels' axes",
        why="double-pair, triple-pair: four and six wheels on a pair's axes; single: on pitch; "
        "triad: three in the horizontal plane; orthogonal: x, y, z; pyramid: four. Only "
        "pairs and pyramid have an angle.",
        assumed=vocabulary.PAIR,
    )
    axes: tuple[float, ...] | None = keyed(
        values.Quantities(Dimension.RATIO, vocabulary.OF_WHEELS),
        "directions of the wheels' axes by hand, in place of a layout: x, y, z of each",
        why="Vectors of any length, one per wheel; replaces layout.",
        default="those of the layout",
        example="[0, 1, 0, 1, 0, 0]",
    )
    alpha: float | None = keyed(
        values.INCIDENCE,
        "incidence of a pair's axes, or elevation of a pyramid's",
        why="If you already have mounts for one angle.",
        default="by the criterion below",
        example='"40 deg"',
    )
    alpha_criterion: str | None = keyed(
        values.Choice(vocabulary.CRITERIA),
        "how the incidence is chosen",
        why="equal-rate, the paper's: equal change of rate about both axes; lightest: least mass.",
        assumed=vocabulary.EQUAL_RATE,
    )
    position: tuple[float, ...] | None = keyed(
        values.Quantities(Dimension.LENGTH, vocabulary.OF_WHEELS),
        "centre of a pair's left wheel on the trunk: x, y, z; of other layouts, of each wheel",
        why="In the trunk's frame; a pair's right wheel is mirrored in y.",
        default="searched, clear of the robot's parts",
        example='["0 mm", "50 mm", "70 mm"]',
    )
    mass_max: float | None = keyed(
        values.MASS,
        "largest mass of the device, all modules",
        why="What the robot can carry: if the lightest device is heavier, there is no result.",
        default="not limited",
        example='"1 kg"',
    )
    lighter_by: float | None = keyed(
        values.MASS,
        "report which changes would save this mass",
        why="Each change is a complete sizing: it takes a minute.",
        default="not reported",
        example='"90 g"',
    )
    co_design: bool | None = keyed(
        values.true_or_false,
        "whether to optimize all dimensions together with the maneuvers, in 3-D",
        why="0 to 0.8 % lighter on the robots tried; takes some seconds more.",
        assumed=False,
    )
    guard: str | None = keyed(
        values.Choice(vocabulary.GUARDS),
        "what the housings protect from: touching, or also a bursting wheel",
        why="containing: a mild-steel ring in each housing that stops a third of the rim at top "
        "speed, by a formula that has not been tested on such rings.",
        assumed=vocabulary.FINGERS,
    )
    wheel: str | None = keyed(
        values.Choice(vocabulary.CONSTRUCTIONS),
        "a rim on a disc that sits on the motor, or a ring bonded around the motor's bell",
        why="ring: bonded around the bell of an outrunner, as on Mini Wheelbot; a flat module, "
        "heavier where a wide wheel is best.",
        assumed=vocabulary.DISC,
    )

    @property
    def acts_about_vertical(self) -> bool:
        """Whether the wheels act about all three axes of the trunk."""
        if self.axes is not None:
            return bool(np.linalg.matrix_rank(np.reshape(self.axes, (-1, 3))) == 3)
        return self.layout == vocabulary.ORTHOGONAL or (
            self.layout == vocabulary.PYRAMID and self.alpha != 0.0
        )

    @property
    def tilting(self) -> int:
        """How many axes across the vertical the wheels act about."""
        if not self.axes:
            return 1 if self.layout == "single" else 2
        return int(np.linalg.matrix_rank(np.reshape(self.axes, (-1, 3))[:, :2]))


@dataclass(frozen=True, kw_only=True)
class FlywheelSection:
    """`[flywheel]`: limits and material of a rim [m, kg]."""

    r_max: float | None = keyed(
        values.LENGTH,
        "largest outer radius of a rim",
        why="Of the rim alone: its housing adds 3.6 mm all round. A wider rim needs less mass.",
    )
    r_min: float | None = keyed(
        values.LENGTH,
        "smallest bore radius of a rim",
        why="Room for the motor's shaft or can inside the rim.",
    )
    h_max: float | None = keyed(
        values.LENGTH, "largest height of a rim", why="Room along the spin axis."
    )
    h_min: float | None = keyed(
        values.LENGTH,
        "smallest height of a rim",
        why="The least that your lathe or printer makes well.",
    )
    wall_min: float | None = keyed(
        values.LENGTH,
        "smallest wall, outer less bore radius",
        why="The thinnest wall that your lathe or printer makes well.",
    )
    wheel_mass_max: float | None = keyed(
        values.MASS, "largest mass of a rim", why="What the trunk can carry on each side."
    )
    material: str | None = keyed(
        values.Text((vocabulary.STEEL, vocabulary.AUTO)),
        "material of a rim, from the catalogue; steel or auto: the best of several",
        why="steel: any steel; auto: any material; or one of `ocs-design catalogue materials`.",
        assumed=vocabulary.STEEL,
    )
    web: str | None = keyed(
        values.Choice(vocabulary.WEBS),
        "what joins a rim to its motor: a disc in one piece with it, an aluminium disc that it "
        "is shrunk on, or none: massless spokes",
        why="none: the paper's massless spokes, for comparison.",
        assumed=vocabulary.DISC,
    )
    stress_safety: float | None = keyed(
        values.positive_number,
        "yield strength over hoop stress at the highest speed",
        why="Larger where a burst rim could hurt someone.",
    )
    lightening: int | None = keyed(
        values.whole_number,
        "lightening holes in a web that has room for them; 0: none",
        why="They remove two fifths of the web and leave 3 mm spokes; 0: less drilling.",
        assumed=vocabulary.LIGHTENING,
    )
    chamfer: float | None = keyed(
        values.Quantity(Dimension.LENGTH, values.Sign.NOT_NEGATIVE, vocabulary.LARGEST_CHAMFER),
        "chamfer of the edges of a wheel with a web, at 45 deg",
        why="As your workshop breaks edges; the removed mass is accounted for.",
        assumed=vocabulary.CHAMFER,
    )
    balancing_holes: int | None = keyed(
        values.whole_number,
        "balancing holes in each face of a rim with a web; 0: none",
        why="At least three, to balance the wheel with weights; its wall grows to fit them.",
        assumed=0,
    )
    balancing_hole_diameter: float | None = keyed(
        values.LENGTH,
        "diameter of each balancing hole, on the rim's middle radius",
        why="1.6 mm is the tap drill for M2.",
        assumed=vocabulary.BALANCING_DIAMETER,
    )
    balancing_hole_depth: float | None = keyed(
        values.LENGTH,
        "depth of each balancing hole, from its face",
        why="An M2 thread needs 2 mm; both faces have holes, so the rim grows too.",
        assumed=vocabulary.BALANCING_DEPTH,
    )


LIMIT_OF_KEY: Mapping[str, str] = MappingProxyType(
    {
        "r_max": "outer_radius_max",
        "r_min": "inner_radius_min",
        "h_max": "height_max",
        "h_min": "height_min",
        "wall_min": "wall_min",
        "wheel_mass_max": "mass_max",
        "stress_safety": "stress_safety",
    }
)
"""Field of `Envelope` that each key of `[flywheel]` sets."""


@dataclass(frozen=True)
class Envelope:
    """Limits of one flywheel rim, in SI.

    Attributes:
        outer_radius_max: [m]. inner_radius_min: the bore that the motor needs [m].
        height_max, height_min: along the spin axis [m].
        wall_min: of outer minus inner radius [m].
        mass_max: of one rim [kg].
        stress_safety: yield strength over the hoop stress allowed at the highest wheel speed.
    """

    outer_radius_max: float
    inner_radius_min: float
    height_max: float
    height_min: float
    wall_min: float
    mass_max: float
    stress_safety: float

    @property
    def by_key(self) -> Mapping[str, float]:
        """Each limit by its key in `[flywheel]`."""
        return {key: getattr(self, limit) for key, limit in LIMIT_OF_KEY.items()}


@dataclass(frozen=True, kw_only=True)
class MotorSection:
    """`[motor]`: what drives a wheel [N m]."""

    name: str | None = keyed(
        values.several_names,
        "motors of the catalogue to choose from; auto, or none",
        option="motor",
        why="The ones you have: see `ocs-design catalogue motors`; none: the bound alone.",
        assumed=vocabulary.AUTO,
    )
    gear: str | None = keyed(
        values.Text((vocabulary.AUTO, DIRECT.name)),
        "gear from the catalogue, direct (none), or auto",
        why="auto: any of `ocs-design catalogue gears`; their mounting is not designed.",
        assumed=DIRECT.name,
    )
    any: bool | None = keyed(
        values.true_or_false,
        "whether motors may lack data needed to build",
        option="motors-any",
        why="true: also motors that lack data, such as threads; nothing can be built with them.",
        assumed=False,
    )
    motors: str | None = keyed(
        values.Text(),
        "file of motors to choose from, CSV or TOML",
        why="Instead of the catalogue; path relative to this file.",
        default="none",
        example='"my_motors.csv"',
    )
    with_catalogue: bool | None = keyed(
        values.true_or_false,
        "with a file of motors: whether to choose from the catalogue too",
        why="true: your file's motors and the catalogue's.",
        assumed=False,
    )
    gears: str | None = keyed(
        values.Text(),
        "file of your own gears, CSV or TOML",
        why="To choose from as well; path relative to this file.",
        default="none",
        example='"my_gears.csv"',
    )
    torque_max: float | None = keyed(
        values.WHEEL_TORQUE,
        "largest torque on a wheel",
        why="The limit of your motor controller, at the wheel.",
        default="the motor's own",
        example='"1 N m"',
    )


@dataclass(frozen=True, kw_only=True)
class SupplySection:
    """`[supply]`: what feeds all motors, drawn or fed back, and their controllers [V, A, W, kg]."""

    voltage: float | None = keyed(
        values.SUPPLY,
        "supply voltage of all motors",
        option="bus-voltage",
        why="Your robot's battery under load, not the nominal voltage.",
    )
    current_max: float | None = keyed(
        values.Quantity(Dimension.CURRENT),
        "largest current of all motors together, drawn or fed back",
        option="bus-current",
        why="The limit of fuse, cables and battery, in both directions.",
        default="limited by power only",
        example='"40 A"',
    )
    power_max: float | None = keyed(
        values.Quantity(Dimension.POWER),
        "largest power of all motors together, drawn or fed back",
        option="bus-power",
        why="Less if the legs draw power at the same time.",
    )
    controllers: float | str | None = keyed(
        values.WordOr((vocabulary.AUTO, vocabulary.NO_CONTROLLERS), values.MASS),
        "mass of one motor controller; none: not counted",
        why="auto: estimated from the current; give the mass if you have controllers.",
        assumed=vocabulary.AUTO,
    )
