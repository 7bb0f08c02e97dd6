"""Words that keys of a specification take, and figures that hold where nothing is stated."""

LIGHTEST = "lightest"
"""Criterion of the incidence: whatever makes the device lightest, which only a real motor tells."""

CRITERIA = (LIGHTEST, "equal-rate", "weighted", "simultaneous", "pitch-only", "roll-only")
"""How the incidence may be chosen (docs/theory.md, Incidence angle)."""

EQUAL_RATE = CRITERIA[1]
"""Criterion of the incidence where none is stated: alpha* = atan(Ixx / Iyy), as in the paper."""

PAIR, PYRAMID = "pair", "pyramid"
MORE_PAIRS = ("double-pair", "triple-pair")
"""What is tried in turn where none is stated and no pair does it."""

WHEELS = {
    "single": 1,
    PAIR: 2,
    **dict(zip(MORE_PAIRS, (4, 6), strict=True)),
    "triad": 3,
    "orthogonal": 3,
    PYRAMID: 4,
}
LAYOUTS = tuple(WHEELS)
"""How the wheels' axes may lie to each other (docs/layouts.md)."""

OF_WHEELS = tuple(3 * wheels for wheels in range(1, 7))
"""Three numbers for each of one to six wheels."""

ALL_LAYOUTS = "all"
"""Compare them instead (`size --layout all`)."""

STEEL = "steel"
"""In place of a material's name: the steel of the catalogue with which the device is lightest."""

AUTO = "auto"
"""In place of a name: the one with which the device is lightest."""

NO_CONTROLLERS = "none"
"""In place of a mass: motor controllers are not counted."""

NO_MOTOR = "none"
"""In place of a motor's name: size the wheels by the bound alone, as the paper does."""

DISC = "disc"
"""A rim's web: a thin disc with a hub, all of one piece."""

ALUMINIUM_WEB = "aluminium"
"""A thin disc of aluminium with a hub, which the rim is shrunk on."""

NO_WEB = "none"
"""In place of a web: massless spokes, as in the paper."""

FINGERS, CONTAINING = GUARDS = "fingers", "containing"
"""Guards: the printed housing alone, or a ring of mild steel in it."""

RING = "ring"
"""A wheel that is a ring around the bell of its motor, bonded on; the other one is the disc."""

CONSTRUCTIONS = (DISC, RING)

WEBS = (DISC, ALUMINIUM_WEB, NO_WEB)

LIGHTENING, LIGHTENINGS = 6, (0, 5, 6, 7, 8)
"""Holes in a web: how many, and how many there may be."""

CHAMFER, LARGEST_CHAMFER = 0.2e-3, 0.5e-3
"""Of a wheel's edges, where nothing is stated and at most [m]: broken edges as ISO 13715 has them,
and what hubs stand."""

BALANCING_DIAMETER, BALANCING_DEPTH = 1.6e-3, 1.0e-3
"""Of balancing holes, where nothing is stated [m]: the core hole of M2, and shallow, for glue."""

RELIABILITY = 0.99
"""Share of robots that shall pass, where nothing is stated."""

DRAWN = 2048
"""Robots that a reserve is worked out for, each quantity by strata (Latin hypercube)."""

NONE_STOPS, ONE_STOPS = "none", "any one motor"
SURVIVED = ("one", ONE_STOPS, NONE_STOPS)
"""Drives that may stop in flight, the last word short for the one before."""

DETECTION = 0.02
"""Until it is known that a drive has stopped, where nothing is stated [s]: four control steps, in
which a wheel that should be driven changes its speed by less than it should."""

CONTROL_PERIOD = 0.005
"""Time from one torque of the wheels to the next, where nothing is stated [s]."""

PROJECTIONS = ("pseudo-inverse", "transpose")
"""How a torque on the trunk becomes torques of the wheels (docs/theory.md, The control law)."""
