"""Drilling template of the trunk at full size: PDF on A4, and its drawing for DXF.

The drawing is in the design's frame B, in millimetres: x forward, y to the left. On paper forward
is up. A drawing larger than a sheet is split over several, to be joined edge to edge.
"""

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace

from ocs_design.actuation.fasteners import Screw
from ocs_design.common.units import MILLIMETRES, format_quantity, round_outwards
from ocs_design.device.joints import foot_screws
from ocs_design.device.solids import foot_of
from ocs_design.export.device_parts import foot_holes, trunk_holes
from ocs_design.export.drawing.sheet import (
    HEIGHT,
    LEADING,
    THIN,
    WIDTH,
    Area,
    Circle,
    Item,
    Lettering,
    Line,
    Point,
    Polyline,
    arrow,
    centre_lines,
    horizontal_dimension,
    outline,
    rectangle,
    wrapped,
)
from ocs_design.export.drawing.title_block import device_hash
from ocs_design.export.formats import Subject
from ocs_design.parts.carrier_plate import steepest
from ocs_design.parts.module import part_name
from ocs_design.parts.outline import flat_outline
from ocs_design.parts.printed import TRUNK_SCREW
from ocs_design.robot.manual import origin_by_hand

SHEET = (15.0, 15.0, WIDTH - 15.0, HEIGHT - 30.0)
"""Left, top, right and bottom of the drawing area [mm]: within reach of printers, words below."""

CHECK = 50.0
"""Length to measure on the print [mm]."""

_VERDICT = 2.5
"""Height of the warning not to drill [mm]."""

CROSS = 4.0
"""Length of a centre mark beyond its hole [mm]."""


@dataclass(frozen=True)
class Drilling:
    """Holes to drill in the trunk, and the outlines of the parts around them.

    Attributes:
        robot: name of the robot.
        frame: words on the frame of the coordinates.
        holes: positions of the holes to drill in the trunk [mm].
        screw: screw for these holes.
        reach: smallest and largest reach of the screws into the trunk [m].
        marks: holes with their coordinates, and the frame's axes [mm].
        around: feet and plate [mm].
        standing: words on what the thin lines are.
        upwards: whether the holes are in the trunk's back, with coordinates up and to the left;
            else in its top, forward and to the left.
        refused: that the device cannot be built, and why; then no hole may be drilled.
        tilt: largest angle of the holes off square to a round trunk, which is drilled through a
            block shaped to it [rad]; 0: the trunk is flat there.
        identity: identifier of the design, as on the other sheets.
    """

    robot: str
    frame: str
    holes: tuple[Point, ...]
    screw: Screw
    reach: tuple[float, float]
    marks: tuple[Item, ...]
    around: tuple[Item, ...]
    standing: str
    upwards: bool
    refused: str
    tilt: float
    identity: str

    @property
    def items(self) -> tuple[Item, ...]:
        """All items of the drawing [mm]."""
        return *self.marks, *self.around

    @property
    def words(self) -> tuple[str, ...]:
        """Instructions, line by line."""
        back = ", z and y: its back, seen from behind" if self.upwards else ""
        frame = f"coordinates in mm in {self.frame}{back}"
        if self.refused:
            return (
                f"{self.robot}: drill nothing by this sheet. The device cannot be built as it "
                "stands, and the cure may move its holes, or they lie off the trunk.",
                f"At the crosses it would have {len(self.holes)} holes for {self.screw.name}; "
                f"{frame}. Thin lines: {self.standing}. Design {self.identity}.",
            )
        ends = dict.fromkeys(f"{MILLIMETRES * length:.1f}" for length in self.reach)
        # One pitch more than the screws' reach.
        thread = round_outwards(self.reach[1] + self.screw.pitch, upwards=True, digits=2)
        deep, blind = (
            format_quantity(depth, "mm", digits=2)
            for depth in (thread, thread + self.screw.diameter)
        )
        jig = []
        if self.tilt > 0.0:
            jig.append(
                "Drill through the mast's block, held where it fits, in bushes: along the screws, "
                f"up to {format_quantity(self.tilt, 'deg', digits=2)} off square. On curved "
                "surfaces paper is inaccurate."
            )
        return (
            f"{self.robot}: drill {len(self.holes)} holes of "
            f"{MILLIMETRES * self.screw.tapping_drill:.3g} mm at the crosses, and tap "
            f"{self.screw.name}; {frame}.",
            *jig,
            f"The screws go {' to '.join(ends)} mm into the trunk: thread at least {deep} deep, "
            f"the hole through the wall or {blind} deep. First check what is behind the wall.",
            f"In a wall thinner than {MILLIMETRES * self.screw.diameter:.3g} mm, a print or "
            f"carbon: drill {MILLIMETRES * self.screw.clearance_hole:.3g} mm through, nuts and "
            "washers behind, screws longer by both and by the wall.",
            "The trunk is assumed to be aluminium: robot files do not say. Thin lines: "
            f"{self.standing}. Design {self.identity}.",
        )

    @property
    def verdict(self) -> list[str]:
        """Lines across the sheet on why the device cannot be built; empty if it can."""
        return wrapped(self.refused, SHEET[2] - SHEET[0], _VERDICT)


def drilling_of(subject: Subject) -> Drilling | None:
    """The template of a device on its trunk; None for wheels without feet."""
    device = subject.device
    if device.wheels_alone:
        return None
    plate, foot, standing = device.plate, foot_of(device), foot_holes(device)
    feet = [place for places in standing.values() for place in places]
    pedestals = [
        place for pedestal in device.pedestals for place in pedestal.in_base(pedestal.holes)
    ]
    if not feet and not pedestals:
        return None
    on_trunk = [module for module in device.modules if module.name in standing]
    mast = None if plate is None else plate.mast
    # Least engagement of the threads, and their depth for a screw on a short sleeve.
    if plate is None:
        holes, thread = _millimetres([*feet, *pedestals]), TRUNK_SCREW
        screws = [pedestal.base_screws for pedestal in device.pedestals]
        screws += [foot_screws(device, module) for module in on_trunk]
        reach = [screw_set.length - screw_set.thickness for screw_set in screws]
    else:
        trunk_places = trunk_holes(plate)
        holes = _millimetres(trunk_places if mast is None else [(z, y) for y, z in trunk_places])
        thread = plate.screw
        lengths_and_gaps = zip(plate.screw_lengths, plate.gaps, strict=True)
        reach = [length - plate.clamped - gap for length, gap in lengths_and_gaps]
    radius = MILLIMETRES * thread.tapping_drill / 2.0
    marks: list[Item] = [
        *centre_lines((0.0, 0.0), 3.0 * CROSS),
        arrow((3.0 * CROSS, 0.0), (1.0, 0.0)),
    ]
    marks.append(Lettering((3.0 * CROSS, -1.0), "forward" if mast is None else "up", 2.5))
    for hole in holes:
        words = Lettering(
            (hole[0] + radius, hole[1] - radius - 1.0), f"{hole[0]:.1f}, {hole[1]:.1f}", 1.8
        )
        marks += [Circle(hole, radius), *centre_lines(hole, radius + CROSS), words]
    items: list[Item] = []
    for module in on_trunk if mast is None else ():
        (middle,) = _millimetres([(float(module.position[0]), float(module.position[1]))])
        base = MILLIMETRES * foot.base_radius
        items += [Circle(middle, base, THIN), *centre_lines(middle, CROSS)]
        items.append(
            Lettering((middle[0] + base / 2.0, middle[1]), part_name("foot", module.name), 2.5)
        )
    for pedestal in device.pedestals:
        side = pedestal.width / 2.0
        near_end, far_end = -pedestal.flange, pedestal.length + pedestal.flange
        around = *rectangle(-side, near_end, side, far_end), (0.0, pedestal.length / 2.0)
        *rim, inside = _millimetres(pedestal.in_base(around))
        items.append(Polyline((*rim, rim[0]), THIN))
        items.append(Lettering(inside, part_name("pedestal", pedestal.module), 2.5))
    if plate is not None and mast is not None:
        low, high = (MILLIMETRES * (plate.position[2] + end) for end in (mast.low, mast.high))
        half = MILLIMETRES * mast.side / 2.0
        ends = (low, -half), (high, -half), (high, half), (low, half)
        items.append(Polyline((*ends, ends[0]), THIN))
    elif plate is not None:
        for shape in plate.shapes:
            corners = _millimetres((flat_outline(shape.outline()) + plate.position[:2]).tolist())
            items.append(Polyline((*corners, corners[0]), THIN))
        items += [Circle(foot_hole, radius, THIN) for foot_hole in _millimetres(feet)]
    stands = {
        "feet": standing and mast is None,
        "pedestals": device.pedestals,
        "plate with its threads": plate is not None and mast is None,
        "mast": mast is not None,
    }
    frame = f"the frame of {subject.base.trunk}"
    if subject.base.com is not None:
        frame += f", whose origin is {origin_by_hand(subject.base.com)}"
    return Drilling(
        subject.name,
        frame,
        holes,
        thread,
        (min(reach), max(reach)),
        tuple(marks),
        tuple(items),
        " and ".join(name for name, there in stands.items() if there),
        upwards=mast is not None,
        refused=subject.refused,
        tilt=0.0 if plate is None or plate.relief is None else steepest(plate),
        identity=device_hash(device),
    )


def _millimetres(places: Iterable[Point] | list[list[float]]) -> tuple[Point, ...]:
    return tuple((MILLIMETRES * x, MILLIMETRES * y) for x, y in places)


def pages(drilling: Drilling) -> Iterator[list[Item]]:
    """Sheets from left to right and from front to back.

    If one sheet is too small, feet and plate are shown only near the holes.
    """
    left, top, right, bottom = SHEET
    top += LEADING * len(drilling.verdict)
    width, height = right - left, bottom - top
    for shown in (drilling.items, drilling.marks):
        back, rightmost, front, leftmost = bounds(shown)
        across = math.ceil((leftmost - rightmost) / width)
        along = math.ceil((front - back) / height)
        if across * along == 1:
            break
    middle = (back + front) / 2.0, (rightmost + leftmost) / 2.0
    if across * along == 1:
        # Centred without its words, as far as there is space for them.
        low, right_end, high, left_end = bounds(
            item for item in shown if not isinstance(item, Lettering)
        )
        spare_x, spare_y = (height - (front - back)) / 2.0, (width - (leftmost - rightmost)) / 2.0
        aim = (low + high) / 2.0, (right_end + left_end) / 2.0
        middle = (
            min(max(aim[0], middle[0] - spare_x), middle[0] + spare_x),
            min(max(aim[1], middle[1] - spare_y), middle[1] + spare_y),
        )
    for row in range(along):
        for column in range(across):
            # Where the middle of the drawing is on this sheet.
            centre_x = (left + right) / 2.0 + (across - 1 - 2 * column) / 2.0 * width
            centre_y = (top + bottom) / 2.0 + (along - 1 - 2 * row) / 2.0 * height
            offset = centre_x + middle[1], centre_y + middle[0]
            marks = [_on_paper(item, offset) for item in drilling.marks]
            number = row * across + column + 1
            yield [
                *(_on_paper(item, offset) for item in drilling.around),
                # Thin lines end at the coordinates of a hole.
                *(
                    Area(rectangle(x, y - item.height, x + item.width, y), white=True)
                    for item in marks
                    if isinstance(item, Lettering)
                    for x, y in [item.start]
                ),
                *marks,
                # Hides what is beyond the frame: it continues on another sheet, or is cropped.
                *(
                    Area(rectangle(*margin), white=True)
                    for margin in (
                        (0.0, 0.0, WIDTH, top),
                        (0.0, 0.0, left, HEIGHT),
                        (right, 0.0, WIDTH, HEIGHT),
                        (0.0, bottom, WIDTH, HEIGHT),
                    )
                ),
                *outline(rectangle(left, top, right, bottom), THIN),
                *_words(drilling, number, across * along),
            ]


def _words(drilling: Drilling, number: int, count: int) -> Iterator[Item]:
    left, top, _, bottom = SHEET
    for line, text in enumerate(drilling.verdict):
        yield Lettering((left, top + line * LEADING), text, _VERDICT)
    words = [
        *drilling.words,
        "Print at 100 %, without fitting it to the page, and measure the 50 mm.",
    ]
    if count > 1:
        words[-1] += f" Sheet {number} of {count}: cut along the frame and join edge to edge."
    for line, text in enumerate(words):
        yield Lettering((left + CHECK + 5.0, bottom + (line + 1) * LEADING), text, 2.2)
    y = bottom + 3.0 * LEADING
    yield from horizontal_dimension("", left=left, right=left + CHECK, y=y, text_x=left + CHECK)
    yield Lettering((left + CHECK / 2.0 - 5.0, y - 1.0), f"{CHECK:.0f} mm")
    for x in (left, left + CHECK):
        yield Line((x, y - 3.0), (x, y + 3.0))


def bounds(items: Iterable[Item]) -> tuple[float, float, float, float]:
    """Least x and y, and largest x and y, of items in B [mm]."""
    points: list[Point] = []
    for item in items:
        match item:
            case Circle((x, y), radius):
                points += (x - radius, y - radius), (x + radius, y + radius)
            case Line(start, end):
                points += start, end
            case Polyline(corners) | Area(corners):
                points += corners
            case Lettering():
                # On paper text runs against y.
                x, y = item.place
                points += (x, y), (x + item.height, y - item.width)
    across, along = zip(*points, strict=True)
    return min(across), min(along), max(across), max(along)


def _on_paper(item: Item, offset: Point) -> Item:
    """The item with forward up and the frame's origin at `offset`; texts stay level."""

    def place(point: Point) -> Point:
        """Point of the trunk on the sheet [mm]."""
        return offset[0] - point[1], offset[1] - point[0]

    match item:
        case Circle():
            return replace(item, center=place(item.center))
        case Line():
            return replace(item, start=place(item.start), end=place(item.end))
        case Polyline():
            return replace(item, points=tuple(map(place, item.points)))
        case Area():
            return Area(tuple(map(place, item.corners)))
        case Lettering():
            return replace(item, place=place(item.place))
