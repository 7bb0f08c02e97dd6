"""What is said of a wheel in words, at the lower left."""

import math
from collections.abc import Iterator

from ocs_design.drawing.balancing import permissible_eccentricity, permissible_unbalance
from ocs_design.drawing.dimensioning import LEADING
from ocs_design.drawing.labels import plain
from ocs_design.drawing.layout import MARGIN_LEFT
from ocs_design.drawing.sheet import Item, Text, wrapped
from ocs_design.drawing.tables import BLOCK_LEFT
from ocs_design.drawing.wheel import (
    BROKEN_EDGE,
    Seat,
    WheelDrawing,
    lost_by_breaking,
    rim_inertia_error,
    seat,
)
from ocs_design.parts.wheel import Hub, Wheel

LEFT, TOP = MARGIN_LEFT + 3.0, 145.0
"""Of the first line [mm]."""

NUMBER_WIDTH = 5.0
"""Of a note's number before its text [mm]."""

RUN_OUT = 0.05
"""Of the rim to the bore [mm]."""


def notes(drawing: WheelDrawing) -> list[Item]:
    """Numbered, in lines as long as there is room; no line ends at a tilde."""
    items: list[Item] = []
    y, room = TOP, BLOCK_LEFT - LEFT - NUMBER_WIDTH - 2.0
    for number, sentence in enumerate(_sentences(drawing), start=1):
        items.append(Text((LEFT, y), f"{number}"))
        for line in wrapped(sentence, room, 2.5):
            items.append(Text((LEFT + NUMBER_WIDTH, y), line.replace("~", " ")))
            y += LEADING
    return items


def _sentences(drawing: WheelDrawing) -> Iterator[str]:
    wheel = drawing.wheel
    yield _balance(drawing)
    yield (
        f"Inertia of the rim within ±{_percent(rim_inertia_error(wheel))} over its tolerances; "
        "the motor's rotor not included."
    )
    yield _edges(wheel)
    yield _seat(wheel)
    if wheel.hub is not None:
        yield f"Run-out of the rim to the bore at most {RUN_OUT:g}."
        yield from _bolts(wheel.hub)


def _balance(drawing: WheelDrawing) -> str:
    name = f"Balance grade G~{drawing.grade:g} (ISO~21940-11)"
    if drawing.speed is None:
        return f"{name} at the highest speed in service."
    unbalance = 1e6 * permissible_unbalance(sum(drawing.masses), drawing.grade, drawing.speed)
    eccentricity = 1e6 * permissible_eccentricity(drawing.grade, drawing.speed)
    rpm = drawing.speed * 30.0 / math.pi
    return (
        f"{name} at {rpm:.0f}~rpm: residual unbalance at most {unbalance:.3g}~g~mm "
        f"(e~=~{eccentricity:.3g}~µm), in one plane."
    )


def _edges(wheel: Wheel) -> str:
    chamfer, broken = (
        wheel.rim.made_chamfer,
        f"edges without indication broken {1e3 * BROKEN_EDGE:g}",
    )
    if chamfer > 0.0 and wheel.hub is not None and wheel.hub.chamfer > 0.0:
        return (
            f"Edges of rim, hub and bore {plain(chamfer)}~×~45°, counted in mass and inertia; all "
            "others deburred."
        )
    if chamfer > 0.0:
        return f"Edges of the rim {plain(chamfer)}~×~45°; {broken}."
    mass, share = lost_by_breaking(wheel)
    lost = f"{1e3 * mass:.2g}~g and {_percent(share)} of the inertia"
    return f"{broken.capitalize()}: those of the rim are {lost}, not taken off here."


def _seat(wheel: Wheel) -> str:
    match seat(wheel):
        case Seat.FREE:
            return "Rim only: mass and inertia without the spokes and hub that it needs."
        case Seat.ONE_PIECE:
            return "Rim, web and hub turned from one piece."
        case Seat.FITTED:
            return f"Rim {Seat.FITTED.value} on the web, bonded with retaining compound."


def _bolts(hub: Hub) -> Iterator[str]:
    if hub.bolts is None:
        yield "Bolt circle not in the catalogue: drill to the motor."


def _percent(part: float) -> str:
    return f"{100.0 * part:.2g} %"
