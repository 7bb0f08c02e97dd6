"""Frame, title block and list of parts (ISO 5457, ISO 7200)."""

from collections.abc import Iterator
from dataclasses import dataclass

from ocs_design.drawing.layout import FRAME_BOX, MARGIN, MARGIN_LEFT, Layout
from ocs_design.drawing.sheet import (
    CENTRE,
    FRAME,
    HEIGHT,
    THIN,
    WIDTH,
    Circle,
    Item,
    Line,
    Text,
    fitted,
    outline,
    rectangle,
)
from ocs_design.drawing.wheel import Seat, WheelDrawing, seat

_, _, RIGHT, BOTTOM = FRAME_BOX
BLOCK_WIDTH, ROW_HEIGHT, ROWS = 180.0, 9.0, 4
"""Of the title block [mm]; its width is the standard's."""

BLOCK_LEFT, BLOCK_TOP = RIGHT - BLOCK_WIDTH, BOTTOM - ROWS * ROW_HEIGHT

PARTS_ROW = 5.5
"""Of the list of parts, which grows upwards from the title block [mm]."""

_PARTS_COLUMNS = (0.0, 12.0, 62.0, 150.0, BLOCK_WIDTH)
"""Item, name, material, mass."""


@dataclass(frozen=True)
class Cell:
    """A field of the title block.

    Attributes:
        row: from the top. left, width: in the block [mm].
        caption, value: what it says.
        height: of the value's letters [mm].
    """

    row: int
    left: float
    width: float
    caption: str
    value: str
    height: float = 2.5


def frame() -> list[Item]:
    """Around the drawing, with the marks at the middle of each side."""
    left, top, right, bottom = FRAME_BOX
    across, down = WIDTH / 2.0, HEIGHT / 2.0
    marks = [
        ((across, 0.0), (across, MARGIN)),
        ((across, HEIGHT), (across, HEIGHT - MARGIN)),
        ((0.0, down), (MARGIN_LEFT, down)),
        ((WIDTH, down), (WIDTH - MARGIN, down)),
    ]
    return [
        *outline(rectangle(left, top, right, bottom), FRAME),
        *(Line(start, end, FRAME) for start, end in marks),
    ]


def title_block(drawing: WheelDrawing, layout: Layout) -> list[Item]:
    """All fields, and the symbol of first-angle projection."""
    box = rectangle(BLOCK_LEFT, BLOCK_TOP, RIGHT, BOTTOM)
    cells = [item for cell in _cells(drawing, layout) for item in _cell(cell)]
    return [*outline(box, FRAME), *cells, *_projection(BLOCK_LEFT + 167.0, BLOCK_TOP + 4.5)]


def _cells(drawing: WheelDrawing, layout: Layout) -> tuple[Cell, ...]:
    """Row by row. Who checks it, and when, is written by hand."""
    return (
        Cell(0, 0.0, 64.0, "Title", "OCS flywheel", 3.5),
        Cell(0, 64.0, 64.0, "Robot", drawing.robot, 3.5),
        Cell(0, 128.0, 26.0, "Scale", str(layout.scale), 3.5),
        Cell(0, 154.0, 26.0, "", ""),
        Cell(1, 0.0, 64.0, "Material", _materials(drawing)),
        Cell(1, 64.0, 32.0, "Mass", f"{1e3 * sum(drawing.masses):.4g} g"),
        Cell(1, 96.0, 58.0, "Spin inertia about the axis", _inertia(drawing)),
        Cell(1, 154.0, 26.0, "Dimensions", "all in mm"),
        Cell(2, 0.0, 40.0, "General tolerances", "ISO 2768-mK"),
        Cell(2, 40.0, 64.0, "Surface texture", "Ra 3.2, bore Ra 1.6 (ISO 21920)"),
        Cell(2, 104.0, 50.0, "Drawn by", drawing.tool),
        Cell(2, 154.0, 26.0, "Sheet", "1 / 1, A4"),
        Cell(3, 0.0, 104.0, "Design", drawing.identity),
        Cell(3, 104.0, 40.0, "Checked by", ""),
        Cell(3, 144.0, 36.0, "Date", ""),
    )


def _materials(drawing: WheelDrawing) -> str:
    wheel = drawing.wheel
    return "see list of parts" if seat(wheel) is Seat.FITTED else wheel.rim.material


def _inertia(drawing: WheelDrawing) -> str:
    return f"{1e6 * drawing.mass_properties.inertia[2, 2]:.4g} kg mm²"


def _cell(cell: Cell) -> Iterator[Item]:
    left, top = BLOCK_LEFT + cell.left, BLOCK_TOP + cell.row * ROW_HEIGHT
    yield from outline(rectangle(left, top, left + cell.width, top + ROW_HEIGHT), THIN)
    room = cell.width - 3.0
    yield Text((left + 1.5, top + 2.9), fitted(cell.caption, room, 1.8), 1.8)
    yield Text((left + 1.5, top + 7.5), fitted(cell.value, room, cell.height), cell.height)


def _projection(x: float, y: float) -> list[Item]:
    """A truncated cone in first-angle projection: its side, and right of it its small end."""
    cone = ((x - 9.0, y - 1.5), (x - 2.0, y - 3.0), (x - 2.0, y + 3.0), (x - 9.0, y + 1.5))
    return [
        *outline(cone),
        Circle((x + 5.0, y), 3.0),
        Circle((x + 5.0, y), 1.5),
        Line((x - 10.0, y), (x + 9.0, y), CENTRE),
        Line((x + 5.0, y - 4.0), (x + 5.0, y + 4.0), CENTRE),
    ]


def parts_list(drawing: WheelDrawing) -> list[Item]:
    """Rim and web where they are two parts; nothing else."""
    wheel = drawing.wheel
    if wheel.hub is None or seat(wheel) is not Seat.FITTED:
        return []
    rim_mass, hub_mass = drawing.masses
    rows = (
        ("2", "Web with hub", wheel.hub.material, f"{1e3 * hub_mass:.4g} g"),
        ("1", "Rim", wheel.rim.material, f"{1e3 * rim_mass:.4g} g"),
        ("Item", "Name", "Material", "Mass"),
    )
    return [item for place, row in enumerate(rows, start=1) for item in _parts_row(place, row)]


def _parts_row(place: int, values: tuple[str, ...]) -> Iterator[Item]:
    top = BLOCK_TOP - place * PARTS_ROW
    for value, start, end in zip(values, _PARTS_COLUMNS, _PARTS_COLUMNS[1:], strict=False):
        left, right = BLOCK_LEFT + start, BLOCK_LEFT + end
        yield from outline(rectangle(left, top, right, top + PARTS_ROW), THIN)
        yield Text((left + 1.5, top + 4.0), fitted(value, right - left - 3.0, 2.5))
