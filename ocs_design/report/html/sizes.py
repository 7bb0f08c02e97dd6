"""The design with its tolerances and margins, and what holds its mass up."""

from collections.abc import Iterator

from ocs_design.design_file import OcsDesign
from ocs_design.drawing.labels import bore_diameter, plain, rim_diameter, toleranced
from ocs_design.drawing.tolerances import Grade
from ocs_design.drawing.wheel import rim_inertia_error
from ocs_design.export.made_wheel import made_wheel
from ocs_design.parts.wheel import Wheel
from ocs_design.report.html.elements import Markup, element, items, section, table
from ocs_design.report.margins import COLUMNS, margin_cells
from ocs_design.report.prices import COLUMNS as PRICES
from ocs_design.report.prices import price_cells, price_notes
from ocs_design.report.terminal import price_text, recorded_margins
from ocs_design.selection_record import SelectionRecord
from ocs_design.sizing.selection.binding import HOUSING, HUB, MOUNT, WEB

_MARGIN_NOTE = (
    "The worst over all maneuvers, as flown where they were flown. A factor of 1 uses everything "
    "there is; a dash means that no limit is known."
)
_PRICE_NOTE = (
    "What one module's mass changes by if a limit that it touches is moved. A limit that it does "
    "not touch costs nothing: more of it buys nothing."
)
_NOT_REACHED = "0, not reached"
_MEANT = {
    HOUSING: "A larger rim would be lighter, and its housing heavier by more.",
    MOUNT: "The screws of the motor's mount ask for so wide a housing.",
    HUB: "The rim's bore must clear the hub.",
    WEB: "The rim must be taller than the web.",
}
"""Of what holds a wheel though nobody has stated it."""

_FRONT_NOTE = "How the mass changes with room, voltage or time, motor and all, is drawn by "


def sizes_section(design: OcsDesign) -> Markup:
    """Sizes, margins and their remarks."""
    margins = recorded_margins(design)
    notes = (f"{margin.name}: {margin.note}" for margin in margins if margin.note)
    return section(
        "sizes",
        "Sizes, tolerances and margins",
        table("Wheel, as on its drawing", ("size", "mm"), _sizes(made_wheel(design.ocs.flywheel))),
        element("p", _inertia_note(design), class_="note"),
        table("Margins", COLUMNS, map(margin_cells, margins), words=(0, 4)),
        element("p", _MARGIN_NOTE, class_="note"),
        items(notes, look="note"),
    )


def limits_section(design: OcsDesign) -> Markup:
    """What binds, and what more of it would buy."""
    held = ", ".join(design.sizing.binding) or "nothing: it lies inside all limits"
    meant = (f" {_MEANT[name]}" for name in design.sizing.binding if name in _MEANT)
    selection = design.selection
    priced = selection is not None and selection.prices
    return section(
        "limits",
        "What binds, and what more would buy",
        element("p", "The shape of the wheel is held by ", element("strong", held), ".", *meant),
        *(_bought(selection) if selection is not None and priced else _worths(design)),
    )


def _bought(selection: SelectionRecord) -> Iterator[Markup]:
    """Of a device with its drive."""
    rows = map(price_cells, selection.prices)
    yield table("What one more of each limit buys", PRICES, rows)
    yield element("p", " ".join(price_notes(selection)), class_="note")
    command = element("code", "ocs-design pareto --against radius|height|voltage|time|angle")
    yield element("p", _FRONT_NOTE, command, ".", class_="note")


def _worths(design: OcsDesign) -> Iterator[Markup]:
    """Of wheels alone."""
    yield table("Limits", ("limit", "used", "allowed", "one more unit buys"), _limits(design))
    yield element("p", _PRICE_NOTE, class_="note")


def _sizes(wheel: Wheel) -> Iterator[tuple[str, str]]:
    yield "outer diameter, 2 R", rim_diameter(wheel)
    if wheel.rim.inner_radius > 0.0:
        yield "bore of the rim, 2 r", bore_diameter(wheel)
    yield "height of the rim, h", toleranced(wheel.rim.height, Grade.IT11)
    if wheel.hub is not None:
        yield "hub, diameter", f"Ø{plain(2.0 * wheel.hub.radius)}"
        yield "hub, height", plain(wheel.hub.height)


def _inertia_note(design: OcsDesign) -> str:
    error = rim_inertia_error(made_wheel(design.ocs.flywheel))
    return (
        f"Within these tolerances the rim's spin inertia stays within ±{error:.1%} "
        "(to first order)."
    )


def _limits(design: OcsDesign) -> Iterator[tuple[str, str, str, str]]:
    """Room, from the margins; then every binding limit that is none of them."""
    by_limit = {"outer radius": "r_max", "height": "h_max", "rim mass": "wheel_mass_max"}
    told = set()
    for margin in recorded_margins(design):
        name = by_limit.get(margin.name)
        if name is None:
            continue
        told.add(name)
        _, used, allowed, _, _ = margin_cells(margin)
        yield f"{margin.name} ({name})", used, allowed, _worth(design, name)
    for name in design.sizing.binding:
        if name not in told:
            yield name, "binds", "", _worth(design, name)


def _worth(design: OcsDesign, name: str) -> str:
    if name not in design.sizing.binding:
        return _NOT_REACHED
    return price_text(name, design.sizing.shadow_prices.get(name))
