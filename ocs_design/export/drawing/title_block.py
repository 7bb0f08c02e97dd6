"""Frame, title block, list of parts and notes of a wheel's drawing (ISO 5457, ISO 7200)."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from ocs_design.device import joints
from ocs_design.export.drawing.dimensioning import LEADING
from ocs_design.export.drawing.sheet import (
    CENTRE,
    FRAME,
    FRAME_BOX,
    HEIGHT,
    MARGIN,
    MARGIN_LEFT,
    THIN,
    WIDTH,
    Circle,
    Item,
    Line,
    Scale,
    Text,
    fitted,
    outline,
    rectangle,
    wrapped,
)
from ocs_design.export.drawing.wheel import (
    BROKEN_EDGE,
    Seat,
    WheelDrawing,
    inside_corners,
    lost_by_breaking,
    plain,
    rim_inertia_error,
    seat,
)
from ocs_design.parts.bell import GLUE_GAP
from ocs_design.parts.joints import GRADE

_, _, RIGHT, BOTTOM = FRAME_BOX
BLOCK_WIDTH, ROW_HEIGHT, ROWS = 180.0, 9.0, 4
"""Size of the title block [mm]; its width is the standard's."""

BLOCK_LEFT, BLOCK_TOP = RIGHT - BLOCK_WIDTH, BOTTOM - ROWS * ROW_HEIGHT

PARTS_ROW = 5.5
"""Height of a row of the list of parts, which grows upwards from the title block [mm]."""

_PARTS_COLUMNS = (0.0, 12.0, 62.0, 150.0, BLOCK_WIDTH)
"""Edges of the columns item, name, material and mass [mm]."""

NOTES_LEFT, NOTES_TOP = MARGIN_LEFT + 3.0, 145.0
"""Place of the notes' first line [mm]."""

NUMBER_WIDTH = 5.0
"""Width of a note's number before its text [mm]."""

RUN_OUT = 1e3 * joints.RUN_OUT
"""Permissible run-out of the rim to the bore [mm]."""


def frame() -> list[Item]:
    """Frame around the drawing, with a mark at the middle of each side."""
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


@dataclass(frozen=True)
class Entries:
    """What the title block of any part says.

    Attributes:
        title: of the part. robot: that it is made for. scale: of the views.
        material: name. mass: of one [kg]. figure: another of its figures, caption and value.
        texture: of its surfaces. tool, identity: see `WheelDrawing`. sheet: number and count.
    """

    title: str
    robot: str
    scale: Scale
    material: str
    mass: float
    figure: tuple[str, str]
    texture: str
    tool: str
    identity: str
    sheet: str = "1 / 1"


def title_block(entries: Entries) -> list[Item]:
    """Fields row by row, and the symbol of first-angle projection.

    Checker and date are written by hand.
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
            (32.0, "Mass", f"{1e3 * entries.mass:.4g} g", 2.5),
            (58.0, *entries.figure, 2.5),
            (26.0, "Dimensions", "all in mm", 2.5),
        ),
        (
            (40.0, "General tolerances", "ISO 2768-mK", 2.5),
            (64.0, "Surface texture", entries.texture, 2.5),
            (50.0, "Drawn by", entries.tool, 2.5),
            (26.0, "Sheet", f"{entries.sheet}, A4", 2.5),
        ),
        (
            (104.0, "Design", entries.identity, 2.5),
            (40.0, "Checked by", "", 2.5),
            (36.0, "Date", "", 2.5),
        ),
    )
    items = outline(rectangle(BLOCK_LEFT, BLOCK_TOP, RIGHT, BOTTOM), FRAME)
    for row, cells in enumerate(rows):
        left, top = BLOCK_LEFT, BLOCK_TOP + row * ROW_HEIGHT
        for width, caption, value, height in cells:
            items += outline(rectangle(left, top, left + width, top + ROW_HEIGHT), THIN)
            room = width - 3.0
            items.append(Text((left + 1.5, top + 2.9), fitted(caption, room, 1.8), 1.8))
            items.append(Text((left + 1.5, top + 7.5), fitted(value, room, height), height))
            left += width
    # A truncated cone in first-angle projection: its side, and right of it its small end.
    x, y = BLOCK_LEFT + 167.0, BLOCK_TOP + 4.5
    cone = ((x - 9.0, y - 1.5), (x - 2.0, y - 3.0), (x - 2.0, y + 3.0), (x - 9.0, y + 1.5))
    return [
        *items,
        *outline(cone),
        Circle((x + 5.0, y), 3.0),
        Circle((x + 5.0, y), 1.5),
        Line((x - 10.0, y), (x + 9.0, y), CENTRE),
        Line((x + 5.0, y - 4.0), (x + 5.0, y + 4.0), CENTRE),
    ]


def wheel_entries(drawing: WheelDrawing, scale: Scale) -> Entries:
    """Entries of a wheel's sheet."""
    fitted_on = seat(drawing.wheel) is Seat.FITTED
    inertia = f"{1e6 * drawing.mass_properties.inertia[2, 2]:.4g} kg mm²"
    return Entries(
        "OCS flywheel",
        drawing.robot,
        scale,
        "see list of parts" if fitted_on else drawing.wheel.rim.material,
        sum(drawing.masses),
        ("Spin inertia about the axis", inertia),
        "Ra 3.2, bore Ra 1.6 (ISO 21920)",
        drawing.tool,
        drawing.identity,
    )


def parts_list(drawing: WheelDrawing) -> list[Item]:
    """List of rim and web where they are two parts; empty otherwise."""
    wheel = drawing.wheel
    if wheel.hub is None or seat(wheel) is not Seat.FITTED:
        return []
    rim_mass, hub_mass = drawing.masses
    rows = (
        ("2", "Web with hub", wheel.hub.material, f"{1e3 * hub_mass:.4g} g"),
        ("1", "Rim", wheel.rim.material, f"{1e3 * rim_mass:.4g} g"),
        ("Item", "Name", "Material", "Mass"),
    )
    items: list[Item] = []
    for place, values in enumerate(rows, start=1):
        top = BLOCK_TOP - place * PARTS_ROW
        for value, start, end in zip(values, _PARTS_COLUMNS, _PARTS_COLUMNS[1:], strict=False):
            left, right = BLOCK_LEFT + start, BLOCK_LEFT + end
            items += outline(rectangle(left, top, right, top + PARTS_ROW), THIN)
            items.append(Text((left + 1.5, top + 4.0), fitted(value, right - left - 3.0, 2.5)))
    return items


def notes(drawing: WheelDrawing) -> list[Item]:
    """Numbered notes at the lower left, wrapped to the room; no line ends at a tilde.

    Those that end above the title block and the list of parts are as wide as the sheet. Where
    they would run out of the frame, lines are nearer to each other.
    """
    block = min([BLOCK_TOP, *(x.start[1] for x in parts_list(drawing) if isinstance(x, Line))])
    return numbered(list(_sentences(drawing)), block)


def numbered(sentences: Sequence[str], block: float = BLOCK_TOP) -> list[Item]:
    """Numbered sentences at the lower left, as `notes` has them; `block` is its top [mm]."""
    leading = LEADING
    while True:
        items: list[Item] = []
        y, left = NOTES_TOP, NOTES_LEFT + NUMBER_WIDTH
        for number, sentence in enumerate(sentences, start=1):
            items.append(Text((NOTES_LEFT, y), f"{number}"))
            lines = wrapped(sentence, RIGHT - left - 2.0, 2.5)
            if y + (len(lines) - 1) * leading + 2.0 > block:
                lines = wrapped(sentence, BLOCK_LEFT - left - 2.0, 2.5)
            for line in lines:
                items.append(Text((left, y), line.replace("~", " ")))
                y += leading
        if y - leading + 2.0 < FRAME_BOX[3]:
            return items
        leading *= 0.95


def _sentences(drawing: WheelDrawing) -> Iterator[str]:
    wheel = drawing.wheel
    balance = f"Balance grade G~{GRADE:g} (ISO~21940-11)"
    if drawing.speed is None:
        yield f"{balance} at the highest speed in service."
    else:
        mass, rpm = sum(drawing.masses), drawing.speed * 30.0 / math.pi
        eccentricity = 1e6 * joints.permissible_eccentricity(drawing.speed)
        unbalance = mass * eccentricity
        yield (
            f"{balance} at {rpm:,.0f}~rpm: residual unbalance at most {unbalance:.3g}~g~mm "
            f"(e~=~{eccentricity:.3g}~µm), in one plane. Done on the motor: cad/assembly.pdf."
        )
    yield (
        f"Inertia of the rim within ±{_percent(rim_inertia_error(wheel))} over its tolerances; "
        "the motor's rotor not included."
    )
    chamfer, broken = (
        wheel.rim.made_chamfer,
        f"edges without indication broken {1e3 * BROKEN_EDGE:g}",
    )
    if chamfer > 0.0 and wheel.hub is not None and wheel.hub.chamfer > 0.0:
        yield (
            f"Edges of rim, hub and bore {plain(chamfer)}~×~45°, counted in mass and inertia; all "
            "others deburred."
        )
    elif chamfer > 0.0:
        yield f"Edges of the rim {plain(chamfer)}~×~45°; {broken}."
    else:
        mass, share = lost_by_breaking(wheel)
        lost = f"{1e3 * mass:.2g}~g and {_percent(share)} of the inertia"
        yield f"{broken.capitalize()}: those of the rim are {lost}, not taken off here."
    if drawing.yield_strength is not None:
        yield (
            f"Material with a yield strength of at least {drawing.yield_strength / 1e6:.0f}~MPa, "
            "as it was sized with."
        )
    run_out = f"Run-out of the rim, around and on its faces, to the bore at most {RUN_OUT:g}."
    if drawing.bonded:
        gap = plain(2.0 * GLUE_GAP)
        size = plain(2.0 * (wheel.rim.inner_radius - GLUE_GAP))
        yield (
            f"Bonded around the motor's bell: bore it {gap} wider than the bell, which is measured "
            f"first; the bore drawn is that for Ø{size}."
        )
        yield run_out
        return
    fit = "which is not computed"
    if drawing.interference is not None:
        least, most = (f"{1e3 * each:.3f}" for each in drawing.interference)
        fit = f"its bore {least} to {most} narrower than the web"
    yield {
        Seat.FREE: "Rim only: mass and inertia without the spokes and hub that it needs.",
        Seat.ONE_PIECE: "Rim, web and hub turned from one bar, web and hub in the rim's middle.",
        Seat.FITTED: f"Rim shrunk on the web, {fit}.",
    }[seat(wheel)]
    hub = wheel.hub
    if hub is not None:
        radius, share = inside_corners(wheel)
        if radius > 0.0:
            yield f"Inside corners at most R~{plain(radius)} (+{_percent(share)} of inertia)."
        yield run_out
        if hub.bolts is None and drawing.on_shaft:
            yield "No bolt circle: bonded on the motor's shaft."
        elif not drawing.on_shaft:
            yield "Bore: a pilot hole and the datum; open it where the rotor has a boss."


def _percent(part: float) -> str:
    return f"{100.0 * part:.2g}~%"
