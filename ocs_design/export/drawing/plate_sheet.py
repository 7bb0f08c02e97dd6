"""Drawing of the plate under the feet, and of the mast that carries it: A4 sheets, first angle.

The plate is shown from above, forward up, with a table of its holes, and below that from its edge.
The mast is shown from the left and from behind. All positions are relative to the middle of the
plate's underside.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from ocs_design.actuation.fasteners import screw
from ocs_design.common.arrays import FloatArray
from ocs_design.device.device import Device
from ocs_design.device.joints import foot_screws
from ocs_design.export.drawing import sheet
from ocs_design.export.drawing.sheet import Anchor, Circle, Item, Lettering, Line, Point, Polyline
from ocs_design.export.drawing.title_block import (
    Entries,
    complete_sheet,
    device_hash,
    title_of,
)
from ocs_design.export.drawing.wheel import in_mm
from ocs_design.parts.carrier_plate import CarrierPlate, Mast, mast_part, plate_part
from ocs_design.parts.dog_bone import directions
from ocs_design.parts.outline import flat_outline

LEFT, TOP, RIGHT, _ = sheet.FRAME_BOX

_TABLE = 62.0
"""Width of the table of holes [mm]."""

_VIEW: sheet.Box = (LEFT + 30.0, TOP + 8.0, RIGHT - _TABLE - 12.0, 122.0)
"""Box of the plate's outline, with room for its dimensions around it [mm]."""

_MAST_VIEW: sheet.Box = (LEFT + 34.0, TOP + 8.0, RIGHT - 60.0, 118.0)

_ROW = 5.0
"""Height of a row of the table of holes [mm]."""

_NAME_INSIDE = 5.0
"""Radius on the sheet above which a hole's name is placed inside it [mm]."""

_CLEARANCE = 0.25
"""Clearance of hole names from lines [mm]."""

_STEP = 0.2
"""Distance between points along lines, to keep names clear of them [mm]."""

_LEAST_UNTAPPED = 2.0e-3
"""Thickness that a plate must have beyond the least depth of its threads, to leave it untapped [m].
"""

_CROSS = 2.0
"""Length of centre lines beyond a hole [mm]."""

_VIEW_DISTANCE = 40.0
"""Distance between two views [mm]."""


def plate_sheets(device: Device, robot: str, refused: str = "") -> list[list[Item]]:
    """Sheets of the different plates and of their mast; none without a plate.

    `robot` is the robot's name; `refused` is as in `WheelDrawing`.
    """
    plate = device.plate
    if plate is None:
        return []
    engaged = max(foot_screws(device, module).engagement for module in device.modules)
    drawn = []
    for indices in plate.kinds:
        sample = plate.single_plates[indices[0]]
        middles = [plate.single_plates[at].position[:2] for at in indices]
        scale, view = _top_view(sample)
        entries = Entries(
            title=_title(plate, indices),
            robot=robot,
            scale=scale,
            material=plate.material,
            mass=plate_part(sample).mass(),
            figure=("Thickness", f"{in_mm(plate.thickness)} (EN 485-4)"),
            texture="as rolled, edges Ra 6.3 (ISO 21920)",
            identity=device_hash(device),
        )
        drawn.append((view, _plate_notes(sample, middles, engaged), entries))
    if (mast := plate.mast) is not None:
        scale, view = _mast_views(plate, mast)
        entries = Entries(
            title="Mast behind the trunk",
            robot=robot,
            scale=scale,
            material=plate.material,
            mass=mast_part(plate, mast).mass(),
            figure=("Square tube", f"{in_mm(mast.side)} x {in_mm(mast.wall)} (EN 755-8)"),
            texture="as drawn (extruded)",
            identity=device_hash(device),
        )
        drawn.append((view, _mast_notes(plate, mast), entries))
    return [
        complete_sheet(view, notes, replace(entries, sheet=f"{number} / {len(drawn)}"), refused)
        for number, (view, notes, entries) in enumerate(drawn, start=1)
    ]


def _title(plate: CarrierPlate, indices: Sequence[int]) -> str:
    """Title of a sheet: its plates by their place on the robot, and their number."""
    if len(indices) == len(plate.rows):
        return title_of("Plate under the feet", len(indices))
    front_first = sorted(range(len(plate.rows)), key=lambda index: -plate.rows[index])
    places = sorted(front_first.index(index) + 1 for index in indices)
    if len(plate.rows) == 2:
        return f"{'Front' if places == [1] else 'Rear'} plate under the feet"
    return f"Plate {', '.join(map(str, places))} of {len(plate.rows)} from the front"


class Hole(NamedTuple):
    """A hole of the plate: name on the sheet, size as text, diameter and position [m]."""

    name: str
    size: str
    diameter: float
    at: Point


def _holes(plate: CarrierPlate) -> list[Hole]:
    """Holes of one plate, the threads for the feet first: those are A."""
    clearance, window = plate.screw.clearance_hole, 2.0 * plate.window
    windows = (plate.across * directions(plate.arms)).tolist() if window > 0.0 else ()
    kinds = (
        (plate.foot_thread, screw(plate.foot_thread).tapping_drill, plate.feet),
        (f"Ø{in_mm(clearance)}", clearance, plate.trunk),
        (f"Ø{in_mm(window)}", window, windows),
    )
    lettered = zip("ABC", (kind for kind in kinds if kind[2]), strict=False)
    return [
        Hole(f"{letter}{number}", size, diameter, (x, y))
        for letter, (size, diameter, places) in lettered
        for number, (x, y) in enumerate(places, start=1)
    ]


def _top_view(plate: CarrierPlate) -> tuple[sheet.Scale, list[Item]]:
    """The plate from above with its dimensions, its edge below, and the table of holes."""
    corners = flat_outline(plate.shape.outline())
    low, high = corners.min(axis=0), corners.max(axis=0)
    left, top, right, bottom = _VIEW
    length, width, thickness = plate.sizes
    scale = sheet.largest_scale((width, right - left), (length + thickness, bottom - top - 20.0))
    offset = scale(float(low[1] + high[1])) / 2.0
    middle = (left + right) / 2.0 + offset, top + 8.0 + scale(float(high[0]))

    def place(x: float, y: float) -> Point:
        """Point of the plate on the sheet: forward is up, left is left."""
        return middle[0] - scale(y), middle[1] - scale(x)

    corners_on_sheet = [place(float(x), float(y)) for x, y in corners]
    items: list[Item] = [Polyline((*corners_on_sheet, corners_on_sheet[0]), sheet.OUTLINE)]
    holes = [(hole.name, place(*hole.at), scale(hole.diameter) / 2.0) for hole in _holes(plate)]
    for _, at, radius in holes:
        items += [Circle(at, radius), *sheet.centre_lines(at, radius + _CROSS)]
    edge_left, edge_right = (place(0.0, float(y))[0] for y in (high[1], low[1]))
    upper, lower = place(float(high[0]), 0.0)[1], place(float(low[0]), 0.0)[1]
    items += [
        Line((edge_left - 3.0, middle[1]), (edge_right + 3.0, middle[1]), sheet.CENTRE),
        Line((middle[0], upper - 3.0), (middle[0], lower + 3.0), sheet.CENTRE),
        sheet.arrow((middle[0], upper - 3.0), (0.0, -1.0)),
        Lettering((middle[0] + 2.0, upper - 2.0), "x, forward", 1.8),
        sheet.arrow((edge_left - 3.0, middle[1]), (-1.0, 0.0)),
        Lettering((edge_left - 4.0, middle[1] - 2.0), "y, left", 1.8, Anchor.END),
        *_height_dimension(in_mm(length), edge_right, (upper, lower)),
    ]
    occupied = [_points(item) for item in items]
    for name, at, radius in holes:
        label = _hole_name(name, at, radius, np.concatenate(occupied))
        items.append(label)
        occupied.append(_points(label))
    # The edge seen from the front, below the plate in first-angle projection.
    edge_top = lower + 14.0
    edge_bottom = edge_top + scale(thickness)
    items += sheet.outline(sheet.rectangle(edge_left, edge_top, edge_right, edge_bottom))
    items += _height_dimension(in_mm(thickness), edge_right, (edge_top, edge_bottom))
    y = edge_bottom + 7.0
    items += [sheet.extension_line(x, edge_bottom, y) for x in (edge_left, edge_right)]
    items += sheet.horizontal_dimension(in_mm(width), left=edge_left, right=edge_right, y=y)
    return scale, [*items, *_hole_table(plate)]


def _points(item: Item) -> FloatArray:
    """Points along the lines of an item, or in the box of a text, `_STEP` apart [mm], shape (n, 2).

    They are dense enough that no line crosses a name unnoticed.
    """
    match item:
        case Circle((x, y), radius):
            count = math.ceil(2.0 * math.pi * radius / _STEP)
            angles = np.linspace(0.0, 2.0 * np.pi, count, endpoint=False)
            return np.column_stack([x + radius * np.cos(angles), y + radius * np.sin(angles)])
        case Line(start, end):
            corners: Sequence[Point] = (start, end)
        case Polyline(points):
            corners = points
        case sheet.Area(points):
            corners = (*points, points[0])
        case Lettering():
            x, y = item.start
            across, down = item.width, item.height
            if item.upright:
                across, down, x, y = item.height, item.width, x - item.height, y + item.height
            grid = np.meshgrid(
                np.linspace(x, x + across, math.ceil(across / _STEP) + 1),
                np.linspace(y - down, y, math.ceil(down / _STEP) + 1),
            )
            return np.column_stack([axis.ravel() for axis in grid])
    sides = [
        np.linspace(start, end, math.ceil(math.dist(start, end) / _STEP) + 1)
        for start, end in pairwise(corners)
    ]
    return np.concatenate(sides)


def _hole_name(name: str, at: Point, radius: float, taken: FloatArray) -> Lettering:
    """Name of a hole, beside it where it covers least of all else, or inside a large hole.

    Args:
        name, at, radius: name, position and radius of the hole [mm].
        taken: points of all lines and texts [mm], shape (n, 2).
    """
    near = 1.0 if radius > _NAME_INSIDE else radius + 0.8
    label = Lettering(at, name, 1.8)
    best, least = label, math.inf
    for farther in (0.0, 1.0, 2.0):
        aside, level = near + farther, radius + _CROSS + 0.8 + farther
        # Around the hole, counted from its middle to the middle of the name: in the quadrants of
        # its centre lines, then beyond their ends.
        diagonal = aside + label.width / 2.0, aside + label.height / 2.0
        ends = (level + label.width / 2.0, 0.0), (0.0, level + label.height / 2.0)
        offsets = [(side * diagonal[0], up * diagonal[1]) for up in (-1, 1) for side in (1, -1)]
        if radius <= _NAME_INSIDE:
            offsets += [(side * x, side * y) for x, y in ends for side in (1, -1)]
        for across, down in offsets:
            corner = at[0] + across - label.width / 2.0, at[1] + down + label.height / 2.0
            low = np.array([corner[0], corner[1] - label.height]) - _CLEARANCE
            high = np.array([corner[0] + label.width, corner[1]]) + _CLEARANCE
            covered = int(((taken >= low) & (taken <= high)).all(axis=1).sum())
            if covered < least:
                best, least = replace(label, place=corner), covered
    return best


def _hole_table(plate: CarrierPlate) -> Iterator[Item]:
    """Table of the holes, with positions from the middle."""
    x, y = RIGHT - _TABLE, TOP + 8.0
    columns = (x, x + 11.0, x + 27.0, x + 45.0)
    rows = [("Hole", "Size", "x", "y")]
    rows += [
        (hole.name, hole.size, f"{1e3 * hole.at[0]:.2f}", f"{1e3 * hole.at[1]:.2f}")
        for hole in _holes(plate)
    ]
    for row in rows:
        for column, cell in zip(columns, row, strict=True):
            yield Lettering((column, y), cell)
        y += _ROW
        yield Line((x, y - 3.6), (RIGHT - 4.0, y - 3.6), sheet.THIN)


def _plate_notes(
    plate: CarrierPlate, middles: list[tuple[float, float]], engaged: float
) -> Iterator[str]:
    """Notes on a plate, or on equal plates with their middles there in the base frame [m].

    The feet's screws engage its threads over the length `engaged` [m].
    """
    # Two turns more than the screws reach.
    tapped = 1e-3 * math.ceil(1e3 * (engaged + 2.0 * screw(plate.foot_thread).pitch) - 1e-6)
    threads = f"threads {plate.foot_thread} right through"
    if plate.thickness - tapped > _LEAST_UNTAPPED:
        threads = (
            f"drilled right through, with threads {plate.foot_thread} at least {in_mm(tapped)} "
            "deep from above"
        )
    yield (
        f"Holes A are {threads}, for the feet's screws; places of holes ±0.1 from the axes, x "
        "forward and y to the left."
    )
    crosses = " and ".join(
        f"({in_mm(round(x, 5) + 0.0)}, {in_mm(round(y, 5) + 0.0)})" for x, y in middles
    )
    yield f"On the robot the axes cross at x, y = {crosses} of the base frame."
    ends = f"Ends R~{in_mm(plate.radius)} around their windows' middles"
    if plate.window == 0.0:
        ends = f"Ends R~{in_mm(plate.radius)}, {in_mm(plate.across)} from the middle of the plate"
    arms = "neck" if plate.arms == 2 else f"{plate.arms} arms, evenly around,"
    shape = plate.shape
    yield (
        f"{ends}; {arms} {in_mm(2.0 * plate.neck)} wide, R~{in_mm(shape.fillet)} where they meet."
        if plate.neck < plate.radius
        else f"{ends}, sides straight between them."
    )
    yield "All edges broken 0.2. Milled, or cut by water jet and drilled: flat within 0.2."
    if plate.mast is None and any(plate.sleeves):
        lengths = ", ".join(
            dict.fromkeys(in_mm(length) for length in plate.sleeves if length > 0.0)
        )
        yield (
            f"Sleeves Ø{in_mm(2.0 * plate.sleeve_radius)} × {in_mm(plate.sleeve_wall)} of the same "
            f"material go under it, {lengths} long: cad/assembly.pdf says which goes where."
        )


def _mast_views(plate: CarrierPlate, mast: Mast) -> tuple[sheet.Scale, list[Item]]:
    """The mast seen from the left, with forward to the left, and seen from behind."""
    half_side, arm_end = mast.side / 2.0, -plate.neck
    length, height = mast.face + mast.off - arm_end, mast.high - mast.low
    left, top, right, bottom = _MAST_VIEW
    scale = sheet.largest_scale(
        (length + mast.side, right - left - _VIEW_DISTANCE), (height, bottom - top - 12.0)
    )
    start = left + scale(mast.face + mast.off)
    top_y = top + 4.0

    def side(x: float, z: float) -> Point:
        """Point of the view from the left: forward is on the left."""
        return start - scale(x), top_y + scale(mast.high - z)

    behind = left + scale(length) + _VIEW_DISTANCE + scale(half_side)

    def back(y: float, z: float) -> Point:
        """Point of the view from behind: left is left."""
        return behind - scale(y), top_y + scale(mast.high - z)

    items = _rectangle_between(side(mast.face, mast.high), side(mast.back, mast.low))
    items += _rectangle_between(back(half_side, mast.high), back(-half_side, mast.low))
    for level in plate.heights:
        items += _rectangle_between(side(mast.back, level), side(arm_end, level - mast.side))
        items += _rectangle_between(back(half_side, level), back(-half_side, level - mast.side))
    low, block_high = plate.block
    if plate.relief is not None:
        # Its outline is the foremost contour.
        outermost = zip(plate.relief.heights.max(axis=0).tolist(), plate.relief.y, strict=True)
        form = [side(mast.face + thick, float(z)) for thick, z in outermost]
        lower, upper = side(mast.face, low), side(mast.face, block_high)
        items.append(Polyline((lower, *form, upper, lower), sheet.OUTLINE))
    elif mast.spacer > 0.0:
        items += _rectangle_between(side(mast.face + mast.spacer, block_high), side(mast.face, low))
    radius = scale(plate.screw.clearance_hole) / 2.0
    for y, z in plate.trunk:
        items += [Circle(back(y, z), radius), *sheet.centre_lines(back(y, z), radius + 2.0)]
    for z in sorted({z for _, z in plate.trunk}):
        (front_x, level_y), (rear_x, _) = side(mast.face + mast.off, z), side(mast.back, z)
        items.append(Line((front_x - 3.0, level_y), (rear_x + 3.0, level_y), sheet.CENTRE))
    # Heights of ends and holes above the underside of the lowest plate.
    labels_x = back(-half_side, 0.0)[0]
    marks = {mast.high, mast.low, *plate.heights, *(z for _, z in plate.trunk)}
    label_rows: list[float] = []
    for z in sorted(marks, reverse=True):
        at = back(0.0, z)[1]
        row = max(at, label_rows[-1] + 4.0) if label_rows else at
        label_rows.append(row)
        items += [
            Line((labels_x + 1.0, at), (labels_x + 8.0, at)),
            Line((labels_x + 8.0, at), (labels_x + 11.0, row)),
            Lettering((labels_x + 12.0, row + 1.0), f"z = {1e3 * z:.2f}", 2.5),
        ]
    y = back(0.0, mast.low)[1] + 8.0
    front, rear = side(mast.face, mast.low)[0], side(arm_end, 0.0)[0]
    items += [sheet.extension_line(front, back(0.0, mast.low)[1], y)]
    items += [sheet.extension_line(rear, side(0.0, min(plate.heights) - mast.side)[1], y)]
    items += sheet.horizontal_dimension(in_mm(mast.face - arm_end), left=front, right=rear, y=y)
    hole_columns = sorted({round(y, 9) for y, _ in plate.trunk})
    columns = [back(column, 0.0)[0] for column in hole_columns]
    items += [sheet.extension_line(column, back(0.0, mast.low)[1], y) for column in columns]
    label, right_end = in_mm(hole_columns[-1] - hole_columns[0]), columns[0]
    items += sheet.horizontal_dimension(
        label, left=columns[-1], right=right_end, y=y, text_x=right_end + 8.0
    )
    for middle, words in (((front + rear) / 2.0, "from the left"), (behind, "from behind")):
        items.append(Lettering((middle, top_y - 4.0), words, 2.5, Anchor.MIDDLE))
    return scale, items


def _mast_notes(plate: CarrierPlate, mast: Mast) -> Iterator[str]:
    arms = "one arm" if len(plate.heights) == 1 else f"{len(plate.heights)} arms"
    yield (
        f"An upright of {in_mm(mast.high - mast.low)} and {arms} of "
        f"{in_mm(mast.back + plate.neck)}, welded all around with filler 5356 (EN~ISO~18273). "
        "Heights z are from the underside of the lowest plate."
    )
    yield (
        "A plate lies on each arm, the rear side of its neck flush with the arm's end, its middle "
        "above the arm's, and is welded on along both sides."
    )
    yield (
        f"Holes Ø{in_mm(plate.screw.clearance_hole)} through both walls of the upright, ±0.1; in "
        f"each, between the walls, a sleeve Ø{in_mm(2.0 * plate.sleeve_radius)} × "
        f"{in_mm(plate.sleeve_wall)}, {in_mm(mast.bore)} long."
    )
    low, high = plate.block
    if mast.formed:
        thin, thick = in_mm(min(map(min, mast.formed))), in_mm(mast.off)
        yield (
            f"A block of {in_mm(mast.side)} × {in_mm(high - low)}, {thin} to {thick} thick, milled "
            "to cad/block.stl or block.step, its front shaped to the trunk, is welded before "
            f"the upright from z = {1e3 * low:.2f} up, and drilled with it."
        )
    elif mast.spacer > 0.0:
        yield (
            f"A block of {in_mm(mast.spacer)} × {in_mm(mast.side)} × {in_mm(high - low)} is welded "
            "before the upright, around the holes, and drilled with it."
        )
    yield (
        "Square within 0.5 over the arm's length; edges broken 0.2. Its strength is taken as "
        "that beside a weld (EN~1999-1-1)."
    )


def _rectangle_between(corner: Point, other: Point) -> list[Item]:
    (x0, y0), (x1, y1) = corner, other
    return sheet.outline(sheet.rectangle(min(x0, x1), min(y0, y1), max(x0, x1), max(y0, y1)))


def _height_dimension(label: str, outline_x: float, ends: tuple[float, float]) -> Iterator[Item]:
    """Height dimension to the right of an outline: upper and lower end [mm]."""
    upper, lower = ends
    x = outline_x + 9.0
    yield from (Line((outline_x + 0.75, y), (x + 1.5, y)) for y in ends)
    if sheet.fits_inside(label, lower - upper):
        middle, half = (upper + lower) / 2.0, (lower - upper) / 2.0
        yield from sheet.vertical_dimension(label, x=x, middle=middle, half=half, outline_x=x)
        return
    yield from (
        Line((x, upper - 2.0 * sheet.ARROW), (x, lower + 2.0 * sheet.ARROW)),
        sheet.arrow((x, upper), (0.0, 1.0)),
        sheet.arrow((x, lower), (0.0, -1.0)),
        Lettering((x + 1.5, upper - sheet.ARROW), label),
    )
