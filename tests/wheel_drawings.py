"""Random wheels to draw, and checks of their drawing sheets."""

import math
from dataclasses import replace
from itertools import combinations

from hypothesis import assume
from hypothesis import strategies as st

from ocs_design.common.errors import PartError
from ocs_design.export.drawing.sheet import FRAME_BOX, Circle, Lettering, Line
from ocs_design.export.drawing.wheel import WheelDrawing
from ocs_design.parts.rim import HoleRing, Hub, RimCuts
from ocs_design.parts.wheel import Rim, Web, Wheel

MADE_FOR = {"robot": "solo12", "identity": "9f3c0a1b2d4e"}


def web(material, density, thickness, hub, holes=None):
    """A web of unspecified mass."""
    return Web(material, density, thickness, math.nan, hub, holes)


WEB = web("EN AW-6082", 2700.0, 0.0015, Hub(0.012, 0.008, 0.004, 4, 0.008, 0.0017))

FLAT = WheelDrawing(
    wheel=Wheel(Rim(0.0392, 0.0413, 0.00305, "stainless-304", 8000.0, RimCuts(0.3e-3)), WEB),
    speed=750.0,
    **MADE_FOR,
)
"""A thin rim on a web with a motor's bolt circle."""

HOLED = WheelDrawing(
    wheel=Wheel(
        Rim(0.03, 0.04, 0.01, "EN AW-6082", 2700.0, RimCuts(0.0012, 12, 0.0015, 0.003)),
        web(
            "EN AW-6082",
            2700.0,
            0.0015,
            Hub(0.010, 0.012, 0.003, 3, 0.0065, 0.0016),
            HoleRing(6, 0.020, 0.006),
        ),
    ),
    speed=None,
    **MADE_FOR,
)
"""One piece, with every kind of hole."""


REFUSED = (
    "NOT buildable as it stands. The feet hang in the air beside the trunk, by up to 41 mm; choose "
    "a place on the trunk's back (--position), or leave it to the program."
)
"""First note on the sheet of a device that cannot be built."""

CROWDED = replace(
    FLAT,
    wheel=Wheel(
        Rim(0.5, 1.0, 1.0, "steel", 1000.0),
        web("EN AW-6082", 2700.0, 0.5, Hub(0.25, 1.0, 0.0)),
    ),
    refused=REFUSED,
)
"""A drawing with more notes than fit."""


@st.composite
def rings(draw, inner, outer, *, midway=False):
    """Rings of holes, 1 mm from the edges and from each other; None where they do not fit."""
    room = outer - inner - 0.0021
    if room < 0.0002 or draw(st.booleans()):
        return None
    hole = draw(st.floats(0.1, 0.45)) * room
    radius = draw(st.floats(inner + 0.001 + hole, outer - 0.001 - hole))
    if midway:
        radius = (inner + outer) / 2.0
    count_max = math.pi / math.asin(min(1.0, (hole + 0.0006) / radius))
    return HoleRing(draw(st.integers(1, min(12, max(1, int(count_max))))), radius, hole)


@st.composite
def webs(draw, rim):
    radius = rim.inner_radius * draw(st.floats(0.15, 0.8))
    bore = radius * draw(st.floats(0.1, 0.8) | st.just(0.0))
    bolts = draw(rings(bore, radius))
    sizes = () if bolts is None else (bolts.count, bolts.circle_radius, bolts.hole_radius)
    return web(
        draw(st.sampled_from(["EN AW-6082", "steel", "x" * 90])),
        2700.0,
        rim.height * draw(st.floats(0.05, 0.5)),
        Hub(radius, rim.height * draw(st.floats(0.5, 4.0)), bore, *sizes),
        draw(rings(radius, rim.inner_radius)),
    )


@st.composite
def rims(draw):
    """Rims from watch to mill size, from foil to roller."""
    outer = 10.0 ** draw(st.floats(-3.0, 0.7))
    inner = outer * draw(st.floats(0.07, 0.97) | st.just(0.0))
    height = outer * 10.0 ** draw(st.floats(-1.5, 0.5))
    holes = draw(rings(inner, outer, midway=True))
    sizes = () if holes is None else (holes.count, holes.hole_radius, 0.2 * height)
    return Rim(
        inner,
        outer,
        height,
        draw(st.sampled_from(["steel", "tungsten-alloy-class-4", "w" * 80])),
        draw(st.floats(1000.0, 20000.0)),
        RimCuts(draw(st.sampled_from([0.0, 0.0003, 0.01])), *sizes),
    )


@st.composite
def drawings(draw):
    """Drawings of any wheel that can be made."""
    rim = draw(rims())
    has_web = rim.inner_radius > 0.2 * rim.outer_radius and draw(st.booleans())
    try:
        wheel = Wheel(rim, draw(webs(rim)) if has_web else None)
    except PartError:
        assume(False)
    return WheelDrawing(
        wheel=wheel,
        robot=draw(st.sampled_from(["solo12", "a" * 300, '<&">', "机器人", "R2-D2 \\)("])),
        identity="9f3c0a1b2d4e",
        speed=draw(st.none() | st.floats(1.0, 1e4)),
        refused=draw(st.sampled_from(["", REFUSED])),
    )


def box_of(text):
    """Rectangle that a text covers: Helvetica's brackets are 0.740 high and 0.212 deep."""
    (x, y), above, below = text.start, 0.740 * text.size, 0.212 * text.size
    if text.upright:
        return (x - above, y - text.width, x + below, y)
    return (x, y - above, x + text.width, y + below)


def texts(items):
    return [item for item in items if isinstance(item, Lettering) and item.text]


def check_words(page):
    """All texts are within the frame and none overlaps another by more than 0.3 mm."""
    left, top, right, bottom = FRAME_BOX
    boxes = list(map(box_of, texts(page)))
    for x1, y1, x2, y2 in boxes:
        assert left <= x1 < x2 <= right
        assert top <= y1 < y2 <= bottom
    for a, b in combinations(boxes, 2):
        assert a[2] <= b[0] or b[2] <= a[0] or a[3] <= b[1] + 0.3 or b[3] <= a[1] + 0.3, (a, b)


def assert_refused(page):
    """The verdict is the topmost text, and the first note gives the reason."""
    highest = min(texts(page), key=lambda item: box_of(item)[1])
    assert highest.text.startswith("NOT buildable as it stands")
    assert REFUSED in " ".join(item.text for item in texts(page))


def overlap(one, other):
    """Whether two boxes share more than an edge."""
    return all(max(one[i], other[i]) < min(one[i + 2], other[i + 2]) - 1e-9 for i in range(2))


def covers(item, box):
    """Whether a line or a circle runs through a box."""
    if isinstance(item, Line):
        return _clipped(item.start, item.end, box)
    if isinstance(item, Circle):
        return _ring_meets(item, box)
    return False


def _clipped(start, end, box):
    """Whether a part of the segment is within the box, by Liang and Barsky's clipping."""
    first, last = 0.0, 1.0
    for i in range(2):
        length = end[i] - start[i]
        if length == 0.0:
            if not box[i] < start[i] < box[i + 2]:
                return False
            continue
        near, far = sorted(((box[i] - start[i]) / length, (box[i + 2] - start[i]) / length))
        first, last = max(first, near), min(last, far)
    return first < last


def _ring_meets(circle, box):
    x, y = circle.center
    near = [max(box[i] - c, 0.0, c - box[i + 2]) for i, c in enumerate((x, y))]
    far = [max(c - box[i], box[i + 2] - c) for i, c in enumerate((x, y))]
    return math.hypot(*near) < circle.radius < math.hypot(*far)
