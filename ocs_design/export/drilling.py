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
from ocs_design.export.device_parts import foot_holes, trunk_holes
from ocs_design.export.drawing import sheet
from ocs_design.export.drawing.sheet import Area, Circle, Item, Lettering, Line, Point, Polyline
from ocs_design.export.drawing.title_block import device_hash
from ocs_design.export.formats import Subject
from ocs_design.parts.carrier_plate import steepest
from ocs_design.parts.module import part_name
from ocs_design.parts.outline import flat_outline
from ocs_design.parts.printed import TRUNK_SCREW
from ocs_design.robot.manual import origin_by_hand

SHEET = (15.0, 15.0, sheet.WIDTH - 15.0, sheet.HEIGHT - 30.0)
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
        holes: positions of the holes to drill in the trunk [mm].
        marks: holes with their coordinates, and the frame's axes [mm].
        around: feet and plate [mm].
        words: instructions, line by line.
        refused: that the device cannot be built, and why; then no hole may be drilled.
    """

    holes: tuple[Point, ...]
    marks: tuple[Item, ...]
    around: tuple[Item, ...]
    words: tuple[str, ...]
    refused: str

    @property
    def items(self) -> tuple[Item, ...]:
        """All items of the drawing [mm]."""
        return *self.marks, *self.around

    @property
    def verdict(self) -> list[str]:
        """Lines across the sheet on why the device cannot be built; empty if it can."""
        return sheet.wrapped(self.refused, SHEET[2] - SHEET[0], _VERDICT)


def drilling_of(subject: Subject) -> Drilling | None:
    """The template of a device on its trunk; None for wheels without feet."""
    device = subject.device
    if device.wheels_alone:
        return None
    plate, foot, standing = device.plate, device.foot, foot_holes(device)
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
    radius, ahead = MILLIMETRES * thread.tapping_drill / 2.0, 3.0 * CROSS
    marks: list[Item] = [*sheet.centre_lines((0.0, 0.0), ahead)]
    marks.append(sheet.arrow((ahead, 0.0), (1.0, 0.0)))
    marks.append(Lettering((ahead, -1.0), "forward" if mast is None else "up", 2.5))
    for hole in holes:
        x, y = hole
        at = Lettering((x + radius, y - radius - 1.0), f"{x:.1f}, {y:.1f}", 1.8)
        marks += [Circle(hole, radius), *sheet.centre_lines(hole, radius + CROSS), at]
    items: list[Item] = []
    for module in on_trunk if mast is None else ():
        (middle,) = _millimetres([(float(module.position[0]), float(module.position[1]))])
        base = MILLIMETRES * foot.base_radius
        name = Lettering((middle[0] + base / 2.0, middle[1]), part_name("foot", module.name), 2.5)
        items += [Circle(middle, base, sheet.THIN), *sheet.centre_lines(middle, CROSS), name]
    for pedestal in device.pedestals:
        side = pedestal.width / 2.0
        near_end, far_end = -pedestal.flange, pedestal.length + pedestal.flange
        around = *sheet.rectangle(-side, near_end, side, far_end), (0.0, pedestal.length / 2.0)
        *rim, inside = _millimetres(pedestal.in_base(around))
        items.append(Polyline((*rim, rim[0]), sheet.THIN))
        items.append(Lettering(inside, part_name("pedestal", pedestal.module), 2.5))
    if plate is not None and mast is not None:
        low, high = (MILLIMETRES * (plate.position[2] + end) for end in (mast.low, mast.high))
        half = MILLIMETRES * mast.side / 2.0
        ends = (low, -half), (high, -half), (high, half), (low, half)
        items.append(Polyline((*ends, ends[0]), sheet.THIN))
    elif plate is not None:
        for shape in plate.shapes:
            corners = _millimetres((flat_outline(shape.outline()) + plate.position[:2]).tolist())
            items.append(Polyline((*corners, corners[0]), sheet.THIN))
        items += [Circle(foot_hole, radius, sheet.THIN) for foot_hole in _millimetres(feet)]
    stands = {
        "feet": standing and mast is None,
        "pedestals": device.pedestals,
        "plate with its threads": plate is not None and mast is None,
        "mast": mast is not None,
    }
    thin = " and ".join(name for name, there in stands.items() if there)
    words = tuple(_instructions(subject, thread, len(holes), (min(reach), max(reach)), thin))
    return Drilling(holes, tuple(marks), tuple(items), words, subject.refused)


def _instructions(
    subject: Subject, screw: Screw, count: int, reach: tuple[float, float], thin: str
) -> Iterator[str]:
    """Instructions for drilling a number of holes, line by line.

    Args:
        subject: with the device. screw, count: of the holes. thin: words on what thin lines are.
        reach: smallest and largest reach of the screws into the trunk [m].
    """
    plate, name = subject.device.plate, subject.name
    frame = f"coordinates in mm in the frame of {subject.base.trunk}"
    if subject.base.com is not None:
        frame += f", whose origin is {origin_by_hand(subject.base.com)}"
    if plate is not None and plate.mast is not None:
        frame += ", z and y: its back, seen from behind"
    thin += f". Design {device_hash(subject.device)}."
    if subject.refused:
        yield (
            f"{name}: drill nothing by this sheet. The device cannot be built as it "
            "stands, and the cure may move its holes, or they lie off the trunk."
        )
        crosses = f"At the crosses it would have {count} holes for {screw.name}"
        yield f"{crosses}; {frame}. Thin lines: {thin}"
        return
    yield (
        f"{name}: drill {count} holes of {MILLIMETRES * screw.tapping_drill:.3g} mm at the "
        f"crosses, and tap {screw.name}; {frame}."
    )
    if plate is not None and plate.relief is not None and steepest(plate) > 0.0:
        yield (
            "Drill through the mast's block, held where it fits, in bushes: along the screws, "
            f"up to {format_quantity(steepest(plate), 'deg', digits=2)} off square. On curved "
            "surfaces paper is inaccurate."
        )
    ends = dict.fromkeys(f"{MILLIMETRES * length:.1f}" for length in reach)
    # One pitch more than the screws' reach.
    thread = round_outwards(reach[1] + screw.pitch, upwards=True, digits=2)
    deep, blind = (
        format_quantity(depth, "mm", digits=2) for depth in (thread, thread + screw.diameter)
    )
    yield (
        f"The screws go {' to '.join(ends)} mm into the trunk: thread at least {deep} deep, "
        f"the hole through the wall or {blind} deep. First check what is behind the wall."
    )
    yield (
        f"In a wall thinner than {MILLIMETRES * screw.diameter:.3g} mm, a print or "
        f"carbon: drill {MILLIMETRES * screw.clearance_hole:.3g} mm through, nuts and "
        "washers behind, screws longer by both and by the wall."
    )
    yield f"The trunk is assumed to be aluminium: robot files do not say. Thin lines: {thin}"


def _millimetres(places: Iterable[Point] | list[list[float]]) -> tuple[Point, ...]:
    return tuple((MILLIMETRES * x, MILLIMETRES * y) for x, y in places)


def pages(drilling: Drilling) -> Iterator[list[Item]]:
    """Sheets from left to right and from front to back.

    If one sheet is too small, feet and plate are shown only near the holes.
    """
    left, top, right, bottom = SHEET
    top += sheet.LEADING * len(drilling.verdict)
    margins = (
        *((0.0, 0.0, sheet.WIDTH, top), (0.0, 0.0, left, sheet.HEIGHT)),
        *((right, 0.0, sheet.WIDTH, sheet.HEIGHT), (0.0, bottom, sheet.WIDTH, sheet.HEIGHT)),
    )
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
                    Area(sheet.rectangle(x, y - item.height, x + item.width, y), white=True)
                    for item in marks
                    if isinstance(item, Lettering)
                    for x, y in [item.start]
                ),
                *marks,
                # Hides what is beyond the frame: it continues on another sheet, or is cropped.
                *(Area(sheet.rectangle(*margin), white=True) for margin in margins),
                *sheet.outline(sheet.rectangle(left, top, right, bottom), sheet.THIN),
                *_words(drilling, number, across * along),
            ]


def _words(drilling: Drilling, number: int, count: int) -> Iterator[Item]:
    left, top, _, bottom = SHEET
    for line, text in enumerate(drilling.verdict):
        yield Lettering((left, top + line * sheet.LEADING), text, _VERDICT)
    words = [
        *drilling.words,
        "Print at 100 %, without fitting it to the page, and measure the 50 mm.",
    ]
    if count > 1:
        words[-1] += f" Sheet {number} of {count}: cut along the frame and join edge to edge."
    for line, text in enumerate(words):
        yield Lettering((left + CHECK + 5.0, bottom + (line + 1) * sheet.LEADING), text, 2.2)
    y = bottom + 3.0 * sheet.LEADING
    end = left + CHECK
    yield from sheet.horizontal_dimension("", left=left, right=end, y=y, text_x=end)
    yield Lettering((left + CHECK / 2.0 - 5.0, y - 1.0), f"{CHECK:.0f} mm")
    for x in (left, end):
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
