"""Frame, title block and numbered notes of a sheet (ISO 5457, ISO 7200)."""

import hashlib
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import msgspec

from ocs_design import __version__
from ocs_design.common.units import significant
from ocs_design.device.device import Device
from ocs_design.export.drawing import sheet
from ocs_design.export.drawing.sheet import Anchor, Circle, Item, Lettering, Line, Scale

_, TOP, RIGHT, BOTTOM = sheet.FRAME_BOX
BLOCK_WIDTH, ROW_HEIGHT, ROWS = 180.0, 9.0, 4
"""Size of the title block [mm]; its width is the standard's."""

BLOCK_LEFT, BLOCK_TOP = RIGHT - BLOCK_WIDTH, BOTTOM - ROWS * ROW_HEIGHT

NOTES_LEFT, NOTES_TOP = sheet.MARGIN_LEFT + 3.0, 145.0
"""Position of the notes' first line [mm]."""

NOTE_HEIGHT, SMALL_NOTE_HEIGHT = 2.5, 1.8
"""Heights of the notes' lettering, usual and if there are too many notes [mm] (ISO 3098)."""

TIGHTEST_LEADING = 1.35
"""Line spacing, relative to the height of capitals, at which brackets almost touch."""

NUMBER_WIDTH = 5.0
"""Width of a note's number before its text [mm]."""

_MOST_REFUSAL_TEXT = 420
"""Maximum length of the note on why the device cannot be built: three lines across the sheet."""

TOOL = f"ocs-design {__version__}"
"""Program and version that made a sheet."""

DIGITS = 12
"""Length of the hash that identifies the design of a sheet."""


def device_hash(device: Device) -> str:
    """Hash of everything drawn, from the values of `design.json`: equal for equal parts.

    It covers wheel, motor, carrier, guard, feet and their supports, and the incidence.
    """
    parts = (
        *(device.flywheel, device.motor, device.carrier, device.guard_wall, device.foot_plate),
        *(device.plate, device.pedestals, device.incidence),
    )
    # NumPy numbers are encoded like the plain numbers that are read back; keys have no order.
    content = msgspec.json.encode(parts, enc_hook=float, order="sorted")
    return hashlib.sha256(content).hexdigest()[:DIGITS]


def title_of(part: str, count: int) -> str:
    """Title of the sheet of a part, with the number of them to make if there are several."""
    return f"{part}, {count} off" if count > 1 else part


def frame() -> list[Item]:
    """Frame around the drawing, with a mark at the middle of each side."""
    left, top, right, bottom = sheet.FRAME_BOX
    middle_x, middle_y = sheet.WIDTH / 2.0, sheet.HEIGHT / 2.0
    marks = [
        ((middle_x, 0.0), (middle_x, sheet.MARGIN)),
        ((middle_x, sheet.HEIGHT), (middle_x, sheet.HEIGHT - sheet.MARGIN)),
        ((0.0, middle_y), (sheet.MARGIN_LEFT, middle_y)),
        ((sheet.WIDTH, middle_y), (sheet.WIDTH - sheet.MARGIN, middle_y)),
    ]
    return [
        *sheet.outline(sheet.rectangle(left, top, right, bottom), sheet.FRAME),
        *(Line(start, end, sheet.FRAME) for start, end in marks),
    ]


@dataclass(frozen=True)
class Entries:
    """Entries of the title block of any part.

    Attributes:
        title: name of the part. robot: robot that it is made for. scale: scale of the views.
        material: name. mass: mass of one [kg]. figure: a further figure, as caption and value.
        texture: surface texture. identity: see `WheelDrawing`. sheet: number and count.
    """

    title: str
    robot: str
    scale: Scale
    material: str
    mass: float
    figure: tuple[str, str]
    texture: str
    identity: str
    sheet: str = "1 / 1"


def complete_sheet(
    views: Iterable[Item],
    notes: Iterable[str],
    entries: Entries,
    refused: str,
    *,
    parts: Sequence[Item] = (),
) -> list[Item]:
    """Frame, views, numbered notes, list of parts and title block.

    `refused` says that the device cannot be built, and why; empty if it can. It is shown at the top
    of the sheet, and the first note gives as much of the reason as fits.
    """
    items, sentences = [*frame(), *views], [*notes]
    if refused:
        warning = "NOT buildable as it stands: make nothing from this sheet, note 1 says why"
        items.append(Lettering((RIGHT - 4.0, TOP + 4.1), warning, 3.0, Anchor.END))
        if len(refused) > _MOST_REFUSAL_TEXT:
            points = refused[:_MOST_REFUSAL_TEXT].rpartition(". ")[0]
            refused = f"{points}. cad/assembly.pdf has all open points."
        sentences.insert(0, refused)
    # Notes above the title block and the list of parts are as wide as the sheet.
    blocks_top = min([BLOCK_TOP, *(part.start[1] for part in parts if isinstance(part, Line))])
    return [*items, *_numbered(sentences, blocks_top), *parts, *_title_block(entries)]


def _title_block(entries: Entries) -> list[Item]:
    """Fields row by row, and the symbol of first-angle projection.

    Checker and date are filled in by hand.
    """
    rows = (
        (
            (64.0, "Title", entries.title, 3.5),
            (64.0, "Robot", entries.robot, 3.5),
            (26.0, "Scale", str(entries.scale), 3.5),
            (26.0, "", "", 2.5),
        ),
        (
            (64.0, "Material", entries.material, 2.5),
            (32.0, "Mass", f"{significant(1e3 * entries.mass, 4)} g", 2.5),
            (58.0, *entries.figure, 2.5),
            (26.0, "Dimensions", "all in mm", 2.5),
        ),
        (
            (40.0, "General tolerances", "ISO 2768-mK", 2.5),
            (64.0, "Surface texture", entries.texture, 2.5),
            (50.0, "Drawn by", TOOL, 2.5),
            (26.0, "Sheet", f"{entries.sheet}, A4", 2.5),
        ),
        (
            (104.0, "Design", entries.identity, 2.5),
            (40.0, "Checked by", "", 2.5),
            (36.0, "Date", "", 2.5),
        ),
    )
    items = sheet.outline(sheet.rectangle(BLOCK_LEFT, BLOCK_TOP, RIGHT, BOTTOM), sheet.FRAME)
    for row, cells in enumerate(rows):
        left, top = BLOCK_LEFT, BLOCK_TOP + row * ROW_HEIGHT
        for width, caption, value, height in cells:
            cell = sheet.rectangle(left, top, left + width, top + ROW_HEIGHT)
            items += sheet.outline(cell, sheet.THIN)
            for text, size, down in ((caption, 1.8, 2.9), (value, height, 7.5)):
                shown = sheet.truncated(text, width - 3.0, size)
                items.append(Lettering((left + 1.5, top + down), shown, size))
            left += width
    # A truncated cone in first-angle projection: its side, and to the right its small end.
    x, y = BLOCK_LEFT + 167.0, BLOCK_TOP + 4.5
    cone = ((x - 9.0, y - 1.5), (x - 2.0, y - 3.0), (x - 2.0, y + 3.0), (x - 9.0, y + 1.5))
    return [
        *items,
        *sheet.outline(cone),
        Circle((x + 5.0, y), 3.0),
        Circle((x + 5.0, y), 1.5),
        Line((x - 10.0, y), (x + 9.0, y), sheet.CENTRE),
        Line((x + 5.0, y - 4.0), (x + 5.0, y + 4.0), sheet.CENTRE),
    ]


def _numbered(sentences: Sequence[str], blocks_top: float) -> list[Item]:
    """Numbered notes at the lower left, wrapped to the space; no line ends at a tilde.

    Notes that end above `blocks_top`, the top of the neighbouring blocks [mm], are as wide as the
    sheet. If they would leave the frame, the line spacing is reduced, and the lettering before
    lines would touch.
    """
    height, leading = NOTE_HEIGHT, sheet.LEADING
    while True:
        items: list[Item] = []
        y, left = NOTES_TOP, NOTES_LEFT + NUMBER_WIDTH
        for number, sentence in enumerate(sentences, start=1):
            items.append(Lettering((NOTES_LEFT, y), f"{number}", height))
            lines = sheet.wrapped(sentence, RIGHT - left - 2.0, height)
            if y + (len(lines) - 1) * leading + 2.0 > blocks_top:
                lines = sheet.wrapped(sentence, BLOCK_LEFT - left - 2.0, height)
            for line in lines:
                items.append(Lettering((left, y), line.replace("~", " "), height))
                y += leading
        if y - leading + 2.0 < sheet.FRAME_BOX[3]:
            return items
        leading *= 0.95
        if height == NOTE_HEIGHT and leading < TIGHTEST_LEADING * height:
            height, leading = SMALL_NOTE_HEIGHT, sheet.LEADING * SMALL_NOTE_HEIGHT / NOTE_HEIGHT
