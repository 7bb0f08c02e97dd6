"""Facts about demand and capacity: what is asked, the margins, and which limits set the mass."""

from collections.abc import Iterator

from ocs_design.common.units import ceiled, floored
from ocs_design.device.records import OcsDesign, PriceRecord, SelectionRecord
from ocs_design.report.quantities import degrees_number, grams, quantity, rpm
from ocs_design.report.selection import best_drives, drive_name
from ocs_design.report.table import Cell, Table, Tone, Toned, columns, listed
from ocs_design.sizing.limits import LIMITS, TIME
from ocs_design.sizing.margins import (
    BUS_CURRENT,
    BUS_POWER,
    FED_BACK,
    MOTOR_TORQUE,
    WHEEL_SPEED,
    Margin,
)
from ocs_design.sizing.selection.device import (
    HOLED_STRESS,
    HOUSING,
    HUB,
    LIGHTENING_HOLES,
    MOUNT,
    WEB,
)

TIGHT = 1.05
"""A factor of capacity over demand below this is reported in the summary."""

_NOTHING = 5e-6
"""Less mass than is shown [kg]."""

_MEANING = {
    HOUSING: "A larger rim would be lighter, but its housing heavier by more.",
    MOUNT: "The screws of the motor's mount need a housing of this width.",
    HUB: "The rim's bore must clear the hub.",
    LIGHTENING_HOLES: "The web must have room for its lightening holes.",
    HOLED_STRESS: "The web must hold at its lightening holes.",
    WEB: "The rim must be taller than the web.",
}
"""Explanation of limits that stand in no specification."""

_ROOM = {"outer radius": "r_max", "height": "h_max", "rim mass": "wheel_mass_max"}
"""Margins of the rim's room, and the limits that they are margins to."""

_FIRST = (
    *(WHEEL_SPEED, MOTOR_TORQUE),
    *(BUS_CURRENT, BUS_POWER, BUS_CURRENT + FED_BACK, BUS_POWER + FED_BACK),
)
"""Margins that the first screen shows, whatever is left of them."""

MARGIN_NOTE = (
    "The worst over all maneuvers, as planned and as flown from push-off to the end, landing "
    "included. At a factor of 1 all of the capacity is used; a dash means that no limit is known."
)

_PRICE_NOTE = (
    "The mass of one rim changes by this much if an active limit is moved. Moving a limit that is "
    "not reached changes nothing."
)

_TURNS = (
    "Turns are sized for constant torque one way and then the other, at a peak rate of 2 theta / T:"
    " the least torque that does it. With more torque down to half this inertia may do: the "
    "flights show it."
)

_DRIVEN = (
    "Momenta are those of constant torque one way and then the other. The spin inertia is what the "
    "chosen drive needs: it may hold its speed for longer, and then takes less momentum."
)


def requirement_title(design: OcsDesign) -> str:
    """Heading of what is asked, with the highest speed of a wheel."""
    return f"Requirement: wheels of at most {rpm(design.requirement.wheel_speed_max)}"


def demand_table(design: OcsDesign) -> Table:
    """Momentum, spin inertia and torque that each maneuver asks for."""
    rows: list[tuple[Cell, ...]] = [
        (
            demand.source,
            degrees_number(demand.incidence),
            f"{1e3 * demand.roll_momentum:.1f}",
            f"{1e3 * demand.pitch_momentum:.1f}",
            f"{demand.spin_inertia:.3e}",
            f"{demand.torque:.3f}" if demand.torque else "-",
        )
        for demand in design.requirement.demands
    ]
    specified = design.requirement.spin_inertia_by_hand
    if specified is not None:
        rows.append(("specified", "", "", "", f"{specified:.3e}", "-"))
    heads = columns(
        "<asked by", "alpha [deg]", "roll [mN m s]", "pitch [mN m s]", "spin inertia [kg m2]",
        "least torque [N m]",
    )  # fmt: skip
    return Table(heads, tuple(rows))


def demand_note(design: OcsDesign) -> str:
    """How the demands were calculated."""
    return _TURNS if design.selection is None else _DRIVEN


def recorded_margins(design: OcsDesign) -> tuple[Margin, ...]:
    """Every margin of a design."""
    return tuple(
        Margin(each.name, each.demand, each.capacity, each.unit, each.note, each.scenario)
        for each in design.margins
    )


def margin_table(margins: tuple[Margin, ...]) -> Table:
    """Demand, capacity and factor of each margin, and the maneuver that sets it."""
    return Table(
        columns("<quantity", "demand", "capacity", "factor", "<set by"),
        tuple(
            (
                margin.name,
                quantity(margin.demand, margin.unit),
                "-" if margin.capacity is None else quantity(margin.capacity, margin.unit),
                _factor(margin.factor),
                margin.scenario,
            )
            for margin in margins
        ),
    )


def _factor(factor: float | None) -> Cell:
    if factor is None:
        return "-"
    text = floored(factor, 2)
    # What is shown as 1.00 is kept.
    return text if float(text) >= 1.0 else Toned(text, Tone.OPEN)


def margin_notes(margins: tuple[Margin, ...]) -> tuple[str, ...]:
    """What the figures of the margins rest on."""
    return tuple(f"{margin.name}: {margin.note}" for margin in margins if margin.note)


def used_up(design: OcsDesign) -> str:
    """Limits that set the mass, and capacities that are used up or nearly so, in one line."""
    active = listed(design.sizing.binding)
    tight = [
        f"{margin.name}, {ceiled(100.0 / margin.factor, 0)}%"
        + (f" ({margin.scenario})" if margin.scenario else "")
        for margin in recorded_margins(design)
        if margin.factor is not None and margin.factor < TIGHT and margin.name not in _FIRST
    ]
    parts = [f"mass set by {active}"] if active else []
    if tight:
        parts.append(f"used: {'; '.join(tight)}")
    return "; ".join(parts) or "none is reached"


def first_margins(design: OcsDesign) -> str:
    """What is used of speed, torque and supply, in one line; empty where no limits are known."""
    shown = {margin.name: margin for margin in recorded_margins(design) if margin.factor}
    return ", ".join(
        f"{name} {ceiled(100.0 / margin.factor, 0)}%"
        for name in _FIRST
        if (margin := shown.get(name)) is not None and margin.factor
    )


def alternatives_table(design: OcsDesign) -> Table:
    """What one change of the question would give each; without rows where none was looked for."""
    return Table(
        columns("<change", "mass", "<motor", "<note"),
        tuple(
            (
                each.change,
                "none does" if each.mass_total is None else grams(each.mass_total),
                each.motor,
                each.note,
            )
            for each in design.alternatives
        ),
    )


def open_points(design: OcsDesign) -> Table:
    """What keeps the device from being built, and the cure of each."""
    points = design.buildable.open
    return Table(columns("<what", "<cure"), tuple((each.what, each.cure) for each in points))


def active_limits(design: OcsDesign) -> tuple[str, str]:
    """Names of the limits that hold the mass up, and what they mean."""
    names = design.sizing.binding
    meanings = (_MEANING[name] for name in names if name in _MEANING)
    return ", ".join(names) or "none: the rim lies inside all limits", " ".join(meanings)


def saving_table(design: OcsDesign) -> Table:
    """What moving each limit changes: of a device with its drive, else of one rim."""
    selection = design.selection
    if selection is None or not selection.prices:
        return Table(
            columns("<limit", "used", "allowed", "<changes the rim's mass by"),
            tuple(_rim_limits(design)),
        )
    return Table(
        columns("<limit", "change", "mass saved"),
        tuple((LIMITS[each.limit].label, _change(each), _saved(each)) for each in selection.prices),
    )


def saving_notes(design: OcsDesign) -> str:
    """What the savings hold for."""
    selection = design.selection
    if selection is None or not selection.prices:
        return _PRICE_NOTE
    chosen, *others = best_drives(selection.ranking)
    note = (
        f"Each change is made alone, and the device sized anew with {drive_name(chosen)} and its "
        "material."
    )
    if others:
        apart = 1e3 * (others[0].mass - chosen.mass)
        note += (
            f" The next lightest drive, {drive_name(others[0])}, is {apart:.1f} g heavier: a "
            "change that makes another drive the lightest saves more than is shown here."
        )
    return note


def what_saves(selection: SelectionRecord) -> str:
    """Every change that makes the device lighter, in one line; empty where none was tried."""
    worth = sorted(filter(_is_worth, selection.prices), key=lambda price: price.mass_change)
    savings = "; ".join(f"{_changed(each)} saves {_saved(each)}" for each in worth)
    return savings or ("none alone saves mass" if selection.prices else "")


def _is_worth(price: PriceRecord) -> bool:
    return price.mass_change < -_NOTHING


def _values(price: PriceRecord) -> tuple[str, str]:
    limit = LIMITS[price.limit]
    before, after = (f"{value * limit.per_si:.4g}" for value in (price.value, price.changed))
    return before, f"{after} {limit.unit}".rstrip()


def _change(price: PriceRecord) -> str:
    if LIMITS[price.limit] is TIME:
        return f"{price.changed - price.value:+.0%}"
    return " to ".join(_values(price))


def _changed(price: PriceRecord) -> str:
    limit = LIMITS[price.limit]
    if limit is TIME:
        return f"{price.changed - price.value:.0%} more {limit.label}"
    before, after = _values(price)
    return f"{limit.label} of {after} instead of {before}"


def _saved(price: PriceRecord) -> str:
    return f"{-1e3 * price.mass_change:.2f} g" if _is_worth(price) else "nothing"


def _rim_limits(design: OcsDesign) -> Iterator[tuple[Cell, ...]]:
    """Room of the rim, from the margins; then every active limit that is none of them."""
    listed_limits = set()
    for margin in recorded_margins(design):
        name = _ROOM.get(margin.name)
        if name is not None and margin.capacity is not None:
            listed_limits.add(name)
            used, allowed = (
                quantity(each, margin.unit) for each in (margin.demand, margin.capacity)
            )
            yield f"{margin.name} ({name})", used, allowed, _rim_price(design, name)
    for name in design.sizing.binding:
        if name not in listed_limits:
            yield name, "all of it", "", _rim_price(design, name)


def _rim_price(design: OcsDesign, name: str) -> str:
    """Shadow price per unit that an engineer would change: kg per m is g per mm."""
    if name not in design.sizing.binding:
        return "0, not reached"
    price = design.sizing.shadow_prices.get(name)
    if price is None:
        return "-"
    if name in {"r_max", "r_min", "h_max", "h_min", "wall_min"}:
        return f"{price:+.2f} g per mm more"
    if name == "hoop_stress":
        return f"{price * 1e9:+.2f} g per MPa more"
    return f"{price:+.3g} kg per unit more"
