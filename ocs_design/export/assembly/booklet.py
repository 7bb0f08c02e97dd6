"""`assembly.pdf`: exploded view, section, steps, screws, tests, wiring and safety on A4 sheets.

The report's assembly section shows the same tables and chapters.
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import NamedTuple

from ocs_design.actuation.fasteners import OFF_BOTTOM, BoltedJoint, Fastening
from ocs_design.actuation.motor import DIRECT
from ocs_design.catalogue.motors import drawn_threads
from ocs_design.common.units import significant
from ocs_design.device.device import Device
from ocs_design.export.assembly.content import Assembly, assembly_of
from ocs_design.export.assembly.placed import Piece
from ocs_design.export.assembly.steps import module_steps, robot_steps, tools
from ocs_design.export.assembly.trials import balance, safety, spin_test, sweep
from ocs_design.export.assembly.views import BALLOON, exploded_view, section_view
from ocs_design.export.assembly_notes import drive_notes, trunk_threads
from ocs_design.export.bill_of_materials import BillRow, bill_rows
from ocs_design.export.device_parts import BLOCK
from ocs_design.export.drawing import sheet
from ocs_design.export.drawing.sheet import Anchor, Box, Circle, Item, Lettering, Line, Polyline
from ocs_design.export.drawing.title_block import TOOL, device_hash, frame
from ocs_design.export.drawing.writers import pdf_of_pages, svg_text
from ocs_design.export.electrics import wiring
from ocs_design.export.formats import Notes, Subject
from ocs_design.parts.printed import WASHER

LEFT, TOP, RIGHT, BOTTOM = sheet.FRAME_BOX
_INSET = 4.0
"""Distance between the frame and its content [mm]."""

_TEXT, _LEADING, _AFTER = 1.9, 3.9, 1.3
"""Height of capitals, and spacing of lines and of paragraphs [mm]."""

_HEADING, _TITLE = 2.5, 3.5
"""Heights of capitals of headings and of a page's title [mm]."""

_NUMBER = 6.0
"""Width of a step's number [mm]."""

_GUTTER = 8.0
"""Distance between columns [mm]."""

EXPLODED_BOX: Box = (LEFT + 2.0, TOP + 11.0, RIGHT - 2.0, TOP + 129.0)
"""Place of the exploded view on its sheet [mm]."""

_SECTION_BOX: Box = (LEFT + 2.0, TOP + 14.0, LEFT + 124.0, BOTTOM - 14.0)

_BONDING_BOX: Box = (_SECTION_BOX[0], BOTTOM - 74.0, *_SECTION_BOX[2:])
"""Place of the section of ring, motor and fixture below that of the module [mm]."""


_LABELS = {
    "hub": "web with hub",
    "gear_2": "gear, at the motor",
    "drum": "housing, drum",
    "lid": "housing, lid",
    "cage": "cage of the motor",
    "guard": "guard ring",
    "plate": "plate under the feet",
    "mast": "mast behind the trunk",
    BLOCK: "block between mast and trunk",
    "sleeves": "sleeves around the trunk's screws",
    "ring_fixture": "bonding fixture for a ring",
}


class PieceRow(NamedTuple):
    """A piece, or a set of equal screws, with its number in the pictures.

    Attributes:
        number: number in the pictures. quantity: in the whole device. name: readable name.
        made: how and of what it is made, or "bought".
        file: file to make it from; empty if there is none.
    """

    number: int
    quantity: int
    name: str
    made: str
    file: str


class ScrewRow(NamedTuple):
    """Set of equal screws: number in the pictures, designation, and tightening torque."""

    number: int
    quantity: int
    designation: str
    purpose: str
    engagement: str
    torque: str
    rule: str


@dataclass(frozen=True)
class Chapter:
    """Sentences under a heading; if `numbered`, they are steps counted from `first`."""

    title: str
    texts: tuple[str, ...]
    numbered: bool = False
    first: int = 1


def write(subject: Subject, folder: Path) -> Notes:
    """Write `assembly.pdf`."""
    assembly = assembly_of(subject)
    title = f"Assembly of the orientation control system for {assembly.name}"
    content = pdf_of_pages(assembly_pages(assembly), title, compressed=True)
    (folder / "assembly.pdf").write_bytes(content)
    return ()


def assembly_pages(assembly: Assembly) -> list[list[Item]]:
    """Sheets of the booklet."""
    # The exploded view, and below it the numbered pieces.
    view, scale = _exploded(assembly)
    first = [*view, *_scale("One module pulled apart", scale, EXPLODED_BOX)]
    for line, text in enumerate(_refused_lines(assembly)):
        first.append(Lettering((LEFT + _INSET, TOP + 15.0 + line * _LEADING), text, _HEADING))
    cells = [tuple(map(str, row)) for row in piece_rows(assembly)]
    top = EXPLODED_BOX[3] + 3.0
    width = (RIGHT - LEFT - 2.0 * _INSET - _GUTTER) / 2.0
    widths = (6.0, 8.0, 40.0, 0.0, 29.0)
    header = ("No.", "Qty", "Piece (of the whole device)", "Made", "File in cad/")

    def halves(count: int) -> tuple[list[Item], float]:
        """The first `count` rows on the left, the others on the right, and their end [mm]."""
        left, right = LEFT + _INSET, LEFT + _INSET + width + _GUTTER
        one, end = _table(header, cells[:count], widths, (left, top, left + width))
        other, other_end = _table(header, cells[count:], widths, (right, top, right + width))
        return one + other, max(end, other_end)

    first += min(map(halves, range(len(cells), 0, -1)), key=lambda both: both[1])[0]
    bodies = [first, *_text_pages(assembly, chapters(assembly))]
    identity = f"design {device_hash(assembly.device)} · {TOOL}"
    verdict = ": NOT buildable as it stands" if assembly.refused else ""
    title, y = sheet.truncated(f"Assembly, {assembly.name}{verdict}", 150.0, _TITLE), TOP + 7.0
    pages: list[list[Item]] = []
    for number, body in enumerate(bodies, start=1):
        place = f"{identity} · sheet {number} / {len(bodies)}"
        heading: list[Item] = [
            Lettering((LEFT + _INSET, y), title, _TITLE),
            Lettering((RIGHT - _INSET, y), place, _TEXT, Anchor.END),
            Line((LEFT, TOP + 10.0), (RIGHT, TOP + 10.0)),
        ]
        pages.append([*frame(), *heading, *body])
    return pages


@lru_cache(maxsize=1)
def _exploded(assembly: Assembly) -> tuple[list[Item], sheet.Scale]:
    """The exploded view, drawn once for paper and for the report."""
    left, top, right, bottom = EXPLODED_BOX
    if assembly.refused:
        top += _LEADING * (1 + len(_refused_lines(assembly)))
    box = _above_caption((left, top, right, bottom))
    return exploded_view(assembly.pieces, assembly.numbers, box)


def _refused_lines(assembly: Assembly) -> list[str]:
    """Lines across the first sheet on why the device cannot be built; empty if it can."""
    return sheet.wrapped(assembly.refused, RIGHT - LEFT - 2.0 * _INSET, _HEADING)


def pictures(assembly: Assembly) -> Iterator[str]:
    """The exploded view, then the sections, each as its own SVG for web pages."""
    items, _ = _exploded(assembly)
    yield svg_text(items, "Exploded view of one module", _around(items))
    for items, _, what, _ in _sections(assembly):
        yield svg_text(items, what, _around(items))


def _sections(assembly: Assembly) -> Iterator[tuple[list[Item], sheet.Scale, str, Box]]:
    """Sections of a module and of a ring in its fixture: lines, scale, caption and box."""
    numbers, box = assembly.numbers, _SECTION_BOX
    if assembly.bonding:
        box, room = (*box[:3], _BONDING_BOX[1] - 6.0), _above_caption(_BONDING_BOX)
        caption = "Ring and bell of the motor in their fixture, cut along their axis"
        yield *section_view(assembly.bonding, numbers, room, standing=True), caption, _BONDING_BOX
    view = section_view(assembly.pieces, numbers, _above_caption(box))
    yield *view, "One module cut along its axis", box


def _above_caption(box: Box) -> Box:
    """Space for a view and its numbers above the caption [mm]."""
    left, top, right, bottom = box
    return left, top, right, bottom - _LEADING


def _around(items: Iterable[Item]) -> Box:
    """Box of the lines and numbers, with a margin [mm]."""
    points = [point for item in items if isinstance(item, Polyline) for point in item.points]
    points += [item.center for item in items if isinstance(item, Circle)]
    across, down = zip(*points, strict=True)
    margin = BALLOON + 2.0
    return (min(across) - margin, min(down) - margin, max(across) + margin, max(down) + margin)


def _text_pages(assembly: Assembly, texts: Sequence[Chapter]) -> list[list[Item]]:
    """Text in columns: beside the section, then below the table of screws, then full pages."""
    items: list[Item] = []
    for view, scale, what, box in _sections(assembly):
        items += [*view, *_scale(what, scale, box)]
    rows = [tuple(map(str, row)) for row in screw_rows(assembly)]
    header = ("No.", "Qty", "Screw", "What it holds", "Thread engaged", "Torque", "Set by")
    widths = (6.0, 8.0, 28.0, 0.0, 26.0, 18.0, 78.0)
    across = (LEFT + _INSET, TOP + 14.0, RIGHT - _INSET)
    table, bottom = _table(header, rows, widths, across) if rows else ([], TOP + 15.0)
    pages = [items, table]
    columns = [(0, (_SECTION_BOX[2] + _GUTTER, TOP + 15.0, RIGHT - _INSET, BOTTOM - 3.0))]
    columns += [(1, column) for column in _halves(bottom + 6.0)]
    current = columns.pop(0)
    y = current[1][1]
    # Headings, and paragraphs with a number or dash before them.
    blocks: list[tuple[str, str]] = []
    for chapter in texts:
        blocks.append(("", chapter.title))
        blocks += [
            (str(number) if chapter.numbered else "–", text)
            for number, text in enumerate(chapter.texts, chapter.first)
        ]
    for (number, text), (_, following) in zip(blocks, [*blocks[1:], ("", "")], strict=True):
        lines = _lines(number, text, current)
        need = _LEADING * len(lines)
        if not number:
            # A heading must not be the last line of a column.
            need += _LEADING * len(_lines("–", following, current)) + 2.0 * _AFTER
        if y + need - _LEADING > current[1][3]:
            if not columns:
                columns = [(len(pages), column) for column in _halves(TOP + 15.0)]
                pages.append([])
            current = columns.pop(0)
            y = current[1][1]
            lines = _lines(number, text, current)
        page, (left, top, *_) = current
        if number:
            pages[page].append(Lettering((left, y), number, _TEXT))
            left += _NUMBER
        elif y > top:
            y += _AFTER
        for line in lines:
            pages[page].append(Lettering((left, y), line, _TEXT if number else _HEADING))
            y += _LEADING
        y += _AFTER
    return pages


def _lines(number: str, text: str, column: tuple[int, Box]) -> list[str]:
    """Lines of a paragraph in a column; a heading, which has no number, is one line."""
    left, _, right, _ = column[1]
    return sheet.wrapped(text, right - left - _NUMBER, _TEXT) if number else [text]


def _halves(top: float) -> list[Box]:
    """Two columns of a page below the height `top` [mm]."""
    middle = (LEFT + RIGHT) / 2.0
    return [
        (LEFT + _INSET, top, middle - _GUTTER / 2.0, BOTTOM - 3.0),
        (middle + _GUTTER / 2.0, top, RIGHT - _INSET, BOTTOM - 3.0),
    ]


def _scale(what: str, scale: sheet.Scale, box: Box) -> Iterator[Item]:
    yield Lettering((box[0] + 2.0, box[3] - 1.0), f"{what}, {scale}", _TEXT)


def _table(
    header: Sequence[str],
    rows: Iterable[Sequence[str]],
    widths: Sequence[float],
    box: tuple[float, float, float],
) -> tuple[list[Item], float]:
    """Rows of wrapped cells between thin lines, and the height where they end.

    `widths` are those of the columns [mm], 0 for the remaining width; `box` is the left, top and
    right edge [mm].
    """
    left, y, right = box
    remaining = right - left - sum(widths)
    column_widths = [width or remaining for width in widths]
    items: list[Item] = []
    for number, row in enumerate((header, *rows)):
        x, most = left, 1
        for cell, width in zip(row, column_widths, strict=True):
            texts = sheet.wrapped(cell, width - 1.5, _TEXT)
            for place, text in enumerate(texts):
                items.append(Lettering((x, y + 3.0 + place * 3.1), text, _TEXT))
            x, most = x + width, max(most, len(texts))
        y += 3.1 * most + 1.5
        items.append(Line((left, y), (right, y), sheet.THIN))
        if number == 0:
            items.append(Line((left, y + 0.3), (right, y + 0.3), sheet.THIN))
    return items, y


def _made(device: Device, name: str, bill: Sequence[BillRow]) -> tuple[str, str]:
    """How a piece is made, and the file for it."""
    motor = device.motor
    if name == "motor":
        return f"bought: {motor.full_name}", ""
    if name.startswith("gear"):
        return f"bought: {motor.gear}" if motor.gear != DIRECT.name else "bought", ""
    of_housing = name in ("drum", "lid", "foot", "cage")
    if of_housing or name.startswith(("pedestal", "ring_fixture")):
        return "printed, PETG", f"{'housing_' if of_housing else ''}{name}.stl"
    row = next(entry for entry in bill if entry.piece == name)
    if name == "guard":
        return f"{row.material}, {row.stock}", "guard_ring.pdf"
    cut = {"plate": "plate.pdf", "mast": "plate.pdf", "sleeves": "", BLOCK: "block.stl"}
    if name in cut:
        way = "milled" if name == BLOCK else "cut"
        return f"{way} from {row.material}, {row.stock}", cut[name]
    return f"turned from {row.stock}, {row.material}", "wheel.pdf"


def piece_rows(assembly: Assembly) -> Iterator[PieceRow]:
    """Pieces and screws in the order of their numbers."""
    bill = bill_rows(assembly.device)
    pieces = {piece.key: piece for piece in (*assembly.pieces, *assembly.bonding)}
    for key, piece in pieces.items():
        number, count = assembly.numbers[key], _count(assembly, piece)
        if isinstance(key, Fastening):
            what = key.designation
            if assembly.screws[key].washers:
                what += f", washers {WASHER}"
            yield PieceRow(number, count, f"screw, {key.name}", f"bought: {what}", "")
        else:
            label = _LABELS.get(key, key.replace("_", " "))
            method, file = _made(assembly.device, key, bill)
            yield PieceRow(number, count, label, method, file)


def screw_rows(assembly: Assembly) -> Iterator[ScrewRow]:
    """Screws with their torques."""
    for piece in assembly.pieces:
        if (fastening := piece.fastening) is not None:
            tight, number = assembly.screws[fastening], assembly.numbers[fastening]
            diameters = tight.engagement / fastening.screw.diameter
            yield ScrewRow(
                number=number,
                quantity=_count(assembly, piece),
                designation=fastening.designation,
                purpose=f"{fastening.purpose}{tight.with_washers}",
                engagement=f"{1e3 * tight.engagement:.1f} mm ({diameters:.1f} d)",
                torque=f"{significant(tight.torque, 2)} N m",
                rule=tight.rule,
            )


def _count(assembly: Assembly, piece: Piece) -> int:
    """Number of this piece in the device."""
    modules = 1 if piece.shared else piece.modules or len(assembly.device.modules)
    return modules * (piece.count if piece.fastening is None else piece.fastening.count)


def _motor_threads(assembly: Assembly) -> Iterator[str]:
    """Known depth of the motor's threads, and the reach of the screws into them."""
    tightened_screws = [
        screws for fastening, screws in assembly.screws.items() if fastening.joint.in_motor
    ]
    if not tightened_screws:
        return
    reach = " and ".join(
        f"{1e3 * screws.engagement:.1f} mm ({screws.fastening.name})" for screws in tightened_screws
    )
    motor, model_text = assembly.device.motor, ""
    model = drawn_threads(motor.name, motor.source)
    specified = all(screws.fastening.engagement_min > 0.0 for screws in tightened_screws)
    if model is not None and not specified:
        on_wheel = (screws.fastening.joint is BoltedJoint.WHEEL for screws in tightened_screws)
        depths = [model.rotor if rotor else model.stator for rotor in on_wheel]
        model_text = (
            f" For {model.model}, whose threads the catalogue assumes for this motor, a CAD model "
            f"shows {' and '.join(f'{1e3 * depth:.1f} mm' for depth in depths)}: its modeller's "
            "figures, not the maker's."
        )
        both = zip(tightened_screws, depths, strict=True)
        fits = all(screws.engagement <= depth - OFF_BOTTOM + 1e-9 for screws, depth in both)
        # Designs of older versions did not count them.
        model_text += (
            " The screws fit it." if fits else " If it is right, these screws are too long."
        )
    known = "its maker's figures are in the table of screws" if specified else "no maker states it"
    yield (
        "Measure the depth of the motor's threads before you put screws into them: "
        f"{known}. The screws of this design reach {reach} into it.{model_text} A screw that is "
        "too long cuts into the winding; use a shorter one, or washers, so that its tip stays "
        "0.5 mm off the bottom, and reduce its torque in proportion to the thread lost."
    )


def chapters(assembly: Assembly) -> tuple[Chapter, ...]:
    """All text, in the order of the work."""
    notes = dict.fromkeys((*drive_notes(assembly.device), *assembly.fitting))
    before = []
    if assembly.refused:
        # The trunk is not drilled before the places of the holes are final.
        threads = trunk_threads(assembly.device)
        notes = dict.fromkeys(note for note in notes if not note.startswith(threads))
        before.append(assembly.refused)
    before += [
        "Read the safety notes at the end before anything turns.",
        *(f"{note[:1].upper()}{note[1:]}." for note in notes),
    ]
    before += _motor_threads(assembly)
    before.append(f"Tools: {', '.join(tools(assembly))}.")
    per_module, on_robot = tuple(module_steps(assembly)), tuple(robot_steps(assembly))
    all_chapters = (
        Chapter("Before you start", tuple(before)),
        Chapter("Steps, for each module", per_module, True),
        Chapter("Steps, once for the robot", on_robot, True, first=len(per_module) + 1),
        Chapter("Balance", tuple(balance(assembly))),
        Chapter("Spin test, before anything goes on the robot", tuple(spin_test(assembly)), True),
        Chapter("Sweep, on the robot before its first flight", tuple(sweep(assembly)), True),
        Chapter("Wiring", tuple(wiring(assembly.device, assembly.margins))),
        Chapter("Safety", tuple(safety(assembly))),
    )
    return tuple(chapter for chapter in all_chapters if chapter.texts)
