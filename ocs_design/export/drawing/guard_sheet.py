"""Drawing of the guard ring in a housing: an A4 sheet with section and front view, first angle."""

import math
from collections.abc import Iterator

from ocs_design.actuation.fasteners import STEEL
from ocs_design.common.units import rpm, significant
from ocs_design.device.device import Device
from ocs_design.device.joints import burst_of
from ocs_design.export.drawing import sheet
from ocs_design.export.drawing.sheet import Anchor, Circle, Item, Lettering, Line
from ocs_design.export.drawing.title_block import Entries, complete_sheet, device_hash, title_of
from ocs_design.export.drawing.views import (
    CHAMFER_ASIDE,
    CHAMFER_BELOW,
    FIRST_COLUMN,
    PAST_ARROWS,
    RIM_WIDTH_DISTANCE,
    SheetLayout,
    lay_out,
)
from ocs_design.export.drawing.wheel import in_mm
from ocs_design.parts.guard import (
    HEIGHT_UNDER,
    OUTSIDE_UNDER,
    RING_STEEL,
    STEEL_STRENGTH,
    WALL_OVER,
)
from ocs_design.parts.housing import Housing, guard_ring
from ocs_design.parts.printed import GUARD_GAP
from ocs_design.parts.wheel import Rim, Wheel

_THIN_FACE = 1.2
"""Thickness on the sheet below which a cut face is black instead of hatched (ISO 128-3) [mm]."""


def guard_sheet(device: Device, robot: str, refused: str = "") -> list[Item]:
    """Sheet of the guard ring, which all housings have alike; empty without one.

    `robot` is the robot's name; `refused` is as in `WheelDrawing`.
    """
    if not device.guard_wall:
        return []
    housing = device.foot.housing
    inside = housing.guard_radius
    ring = Rim(inside, inside + device.guard_wall, housing.guard_height, RING_STEEL, STEEL)
    layout = lay_out(Wheel(ring))
    entries = Entries(
        title=title_of("Guard ring", len(device.modules)),
        robot=robot,
        scale=layout.scale,
        material=RING_STEEL,
        mass=guard_ring(housing).mass(),
        figure=("Inside, for reference", f"Ø{in_mm(2.0 * inside)}"),
        texture="outside roughened for the epoxy",
        identity=device_hash(device),
    )
    views = [*_section(ring, layout), *_front(ring, layout)]
    return complete_sheet(views, _notes(device, housing, ring), entries, refused)


def _section(ring: Rim, layout: SheetLayout) -> Iterator[Item]:
    """The ring cut along its axis, with outside, height and wall."""
    (x, y), scale = layout.section, layout.scale
    half, edge, bore = (
        scale(length) for length in (ring.height / 2.0, ring.outer_radius, ring.inner_radius)
    )
    for near, far in ((y - edge, y - bore), (y + bore, y + edge)):
        corners = sheet.rectangle(x - half, near, x + half, far)
        if edge - bore < _THIN_FACE:
            yield sheet.Area(corners)
        else:
            yield from (*sheet.outline(corners), *sheet.hatching(corners))
    # Its ends behind the cutting plane.
    yield from sheet.outline(sheet.rectangle(x - half, y - bore, x + half, y + bore))
    yield Line((x - half - 4.0, y), (x + half + 4.0, y), sheet.CENTRE)
    yield from sheet.vertical_dimension(
        f"Ø{_limited(2.0 * ring.outer_radius, lower=OUTSIDE_UNDER)}",
        x=x - half - FIRST_COLUMN,
        middle=y,
        half=edge,
        outline_x=x - half,
    )
    above = y - edge - RIM_WIDTH_DISTANCE
    yield from (sheet.extension_line(end, y - edge, above) for end in (x - half, x + half))
    yield from sheet.horizontal_dimension(
        _limited(ring.height, lower=HEIGHT_UNDER),
        left=x - half,
        right=x + half,
        y=above,
        text_x=x + half + PAST_ARROWS,
    )
    wall = f"wall {_limited(ring.outer_radius - ring.inner_radius, upper=WALL_OVER)}"
    shelf = (x + half + CHAMFER_ASIDE, y + edge + CHAMFER_BELOW)
    yield from sheet.leader([wall], (x + half / 2.0, y + (edge + bore) / 2.0), 0.0, shelf)
    yield Lettering((x, above - 7.0), "A–A", 5.0, Anchor.MIDDLE)


def _front(ring: Rim, layout: SheetLayout) -> Iterator[Item]:
    """The ring seen along its axis, with the cutting plane."""
    (x, y), edge = layout.front, layout.scale(ring.outer_radius)
    for radius in (ring.outer_radius, ring.inner_radius):
        yield Circle((x, y), layout.scale(radius))
    yield from sheet.centre_lines((x, y), edge + 3.0)
    for down in (False, True):
        yield from sheet.viewing_arrow(x=x, edge=y + edge if down else y - edge, down=down)


def _limited(size: float, *, lower: float = 0.0, upper: float = 0.0) -> str:
    """Label of a size with its deviations, of which one is 0 [mm], as `19.3 (0/-0.3)`."""
    limits = f"0/-{1e3 * lower:g}" if lower else f"0/+{1e3 * upper:g}"
    return f"{in_mm(size)} ({limits})"


def _notes(device: Device, housing: Housing[float], ring: Rim) -> Iterator[str]:
    wall, bore = device.guard_wall, in_mm(2.0 * housing.inner_radius)
    speed = device.motor.top_speed
    if math.isfinite(speed):
        energy = significant(burst_of(device).fragment.energy, 2)
        yield (
            f"A third of the wheel, if it bursts at {rpm(speed)}, has {energy}~J; "
            "cad/assembly.pdf says under Safety what the ring holds."
        )
    yield (
        f"Mild steel with a tensile strength of at least {1e-6 * STEEL_STRENGTH:.0f}~MPa, as S235 "
        f"has and cold-rolled DC01 need not have. No wall below {in_mm(wall)} anywhere."
    )
    middle = math.pi * (ring.inner_radius + ring.outer_radius)
    yield (
        f"Turned from tube, or bent from strip {in_mm(wall)}~×~{in_mm(ring.height)}, "
        f"{1e3 * middle:.1f} long, and butt-welded through the whole wall (ISO~5817, level B), the "
        "seam flush inside and outside."
    )
    least, most = 2.0 * GUARD_GAP, 2.0 * GUARD_GAP + OUTSIDE_UNDER
    yield (
        f"It is bonded into a printed drum of Ø{bore}. Print that first: if it measures otherwise, "
        f"the outside is {in_mm(least)} to {in_mm(most)} narrower than it."
    )
    yield "Never higher than the drum is deep, or it holds the lid off. Edges broken 0.2."
