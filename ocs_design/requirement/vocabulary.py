"""Words that keys of a specification accept, and default figures."""

LIGHTEST = "lightest"
"""Criterion for the incidence: the lightest device, which takes a real motor to find."""

CRITERIA = (LIGHTEST, "equal-rate", "weighted", "simultaneous", "pitch-only", "roll-only")
"""How the incidence may be chosen (docs/theory.md, Incidence angle)."""

EQUAL_RATE = CRITERIA[1]
"""Default criterion for the incidence: alpha* = atan(Ixx / Iyy), as in the paper."""

PAIR, ORTHOGONAL, PYRAMID = "pair", "orthogonal", "pyramid"
MORE_PAIRS = ("double-pair", "triple-pair")
"""Layouts tried in turn when none is specified and no pair is feasible."""

WHEELS = {
    "single": 1,
    PAIR: 2,
    **dict(zip(MORE_PAIRS, (4, 6), strict=True)),
    "triad": 3,
    ORTHOGONAL: 3,
    PYRAMID: 4,
}
LAYOUTS = tuple(WHEELS)
"""Arrangements of the wheels' axes (docs/layouts.md)."""

OF_WHEELS = tuple(3 * wheels for wheels in range(1, 7))
"""Lengths of a row that has three numbers for each of one to six wheels."""

ALL_LAYOUTS = "all"
"""Value of the layout that compares all of them (`size --layout all`)."""

STEEL = "steel"
"""In place of a material's name: the catalogue steel that gives the lightest device."""

AUTO = "auto"
"""In place of a name: the one that gives the lightest device."""

NO_CONTROLLERS = "none"
"""In place of a mass: motor controllers are not counted."""

NO_MOTOR = "none"
"""In place of a motor's name: size the wheels by the bound alone, as in the paper."""

DISC = "disc"
"""Web of a rim: a thin disc with a hub, in one piece with the rim."""

ALUMINIUM_WEB = "aluminium"
"""Web of a rim: a thin aluminium disc with a hub, onto which the rim is shrunk."""

NO_WEB = "none"
"""In place of a web: massless spokes, as in the paper."""

FINGERS, CONTAINING = GUARDS = "fingers", "containing"
"""Guards: the printed housing alone, or with a mild-steel ring inside it."""

RING = "ring"
"""Wheel that is a ring bonded around the bell of its motor, as opposed to a disc."""

CONSTRUCTIONS = (DISC, RING)

WEBS = (DISC, ALUMINIUM_WEB, NO_WEB)

LIGHTENING, LIGHTENINGS = 6, (0, 5, 6, 7, 8)
"""Lightening holes in a web: default number, and the numbers allowed."""

CHAMFER, LARGEST_CHAMFER = 0.2e-3, 0.5e-3
"""Chamfer of a wheel's edges, by default and at most [m]: broken edges as in ISO 13715, and the
limit that hubs set."""

BALANCING_DIAMETER, BALANCING_DEPTH = 1.6e-3, 1.0e-3
"""Default size of balancing holes [m]: the tap drill for M2, and shallow, for glue."""

RELIABILITY = 0.99
"""Default share of robots that must pass."""

SAMPLES_DRAWN = 2048
"""Number of robots sampled to compute a reserve, stratified in each quantity (Latin hypercube)."""

NONE_STOPS, ONE_STOPS = "none", "any one motor"
SURVIVED = ("one", ONE_STOPS, NONE_STOPS)
"""Drives whose failure in flight must be survived; `one` abbreviates `any one motor`."""

DETECTION = 0.02
"""Default time until a failed drive is detected [s]: four control steps, in which the speed of a
driven wheel changes by less than it should."""

CONTROL_PERIOD = 0.005
"""Default control period: time between two torque commands to the wheels [s]."""

CONTROL_STEP = 1e-3
"""Control periods are multiples of it [s]: flights hold a torque for whole steps of physics."""


def is_whole_steps(period: float) -> bool:
    """Whether a control period [s] is a multiple of `CONTROL_STEP`."""
    steps = period / CONTROL_STEP
    return steps > 0.5 and abs(steps - round(steps)) < 1e-6


PROJECTIONS = ("pseudo-inverse", "transpose")
"""Ways to distribute a torque on the trunk to the wheels (docs/theory.md, The control law)."""
