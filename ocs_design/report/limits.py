"""Facts about demand and capacity: demands, margins, and the limits that set the mass."""

from collections.abc import Sequence
from dataclasses import replace

from ocs_design.common.units import ceiled, floored, significant
from ocs_design.common.wording import (
    degrees,
    degrees_number,
    grams,
    inertia_number,
    listed,
    quantity,
)
from ocs_design.device.records.design import OcsDesign
from ocs_design.device.records.flights import Margin
from ocs_design.device.records.selection import SAVES_NOTHING, ReserveRecord
from ocs_design.report.selection import best_drives, drive_name
from ocs_design.report.table import Cell, CellTable, Rows, Tone, Toned, columns
from ocs_design.sizing.lightest_module import (
    BELL,
    BOND,
    CUT_HEIGHT,
    CUT_WALL,
    HOLED_STRESS,
    HOUSING,
    HUB,
    LIGHTENING_HOLES,
    MOUNT,
    WEB,
)
from ocs_design.sizing.limits import LIMITS, TIME
from ocs_design.sizing.margins import RMS_CURRENT

_LEAST_SHARE = 0.005
"""Smallest share of the reserve that is shown."""

_NEGLIGIBLE_MASS = 5e-6
"""Mass that the report shows as 0 [kg]."""

LIMIT_MEANINGS = {
    HOUSING: "A larger rim would be lighter, but its housing would gain more than the rim saves.",
    MOUNT: "The screws of the motor's mount need a housing of this width.",
    BELL: "The motor's bell and the glue gap set the ring's bore, and the bell limits its height.",
    BOND: "The bond on the motor's bell cannot hold a wider ring.",
    HUB: "The rim's bore must clear the hub.",
    LIGHTENING_HOLES: "The web must have room for its lightening holes.",
    HOLED_STRESS: "The web must withstand the stress at its lightening holes.",
    WEB: "The rim must be taller than the web.",
    CUT_HEIGHT: "The rim must be tall enough for its chamfers and balancing holes.",
    CUT_WALL: "The rim's wall must be thick enough for its chamfers and balancing holes.",
}
"""Explanation of limits that the user cannot set."""

_EXCEEDED_PERCENT = 105
"""Utilization [%] above which a capacity is exceeded by more than the error of its figures."""

_RIM_LIMITS = {"outer radius": "r_max", "height": "h_max", "rim mass": "wheel_mass_max"}
"""Margins of the rim's envelope, and the limits that they refer to."""

_RARELY_CHANGED = (
    *("Maneuvers", "Incidence", "Reserve", "Rim mass", "Stress"),
    *("Wheel", "Web", "Edges", "Housing", "Controllers", "Gear"),
)
"""Assumptions that few users would change, by name."""

MARGIN_NOTE = (
    "The worst over all maneuvers, as planned and as flown from push-off to the end, landing "
    "included. At a factor of 1 all of the capacity is used; a dash means that no limit is known."
)

BOUND_NOTE = (
    "The paper prints I_r d / (d + gamma); its own momentum balance gives I_r d / (gamma - d). "
    "I_r is the robot's inertia, d the change of its rate, gamma the wheel's speed. The bound is "
    "necessary but never sufficient: it ignores torque, angle and time."
)
"""Note shown with the paper's lower bound."""

_PRICE_NOTE = (
    "The mass of one rim changes by this much if an active limit is moved. Moving an inactive "
    "limit changes nothing."
)

NOTE_WITHOUT_MOTORS = (
    "Turns are sized for constant torque one way and then the other, at a peak rate of 2 theta / T:"
    " this needs the least torque. With more torque, as little as half this inertia may suffice; "
    "the flights decide."
)
"""Note on demands of wheels without motors."""

NOTE_ON_DRIVE = (
    "Momenta are those of constant torque one way and then the other. The spin inertia is what the "
    "chosen drive needs: if it holds its speed for a while, it needs less momentum."
)
"""Note on demands of a chosen drive."""


def demand_table(design: OcsDesign) -> CellTable:
    """Momentum, spin inertia and torque that each maneuver needs."""
    table = CellTable.of(
        design.requirement.demands,
        {
            "<required by": lambda demand: demand.source,
            "alpha [deg]": lambda demand: degrees_number(demand.incidence),
            "roll [mN m s]": lambda demand: f"{1e3 * demand.roll_momentum:.1f}",
            "pitch [mN m s]": lambda demand: f"{1e3 * demand.pitch_momentum:.1f}",
            "spin inertia [kg mm2]": lambda demand: inertia_number(demand.spin_inertia),
            "least torque [N m]": lambda demand: f"{demand.torque:.3f}" if demand.torque else "-",
        },
    )
    specified = design.requirement.spin_inertia_by_hand
    if specified is None:
        return table
    by_hand = ("specified", "", "", "", inertia_number(specified), "-")
    return replace(table, rows=(*table.rows, by_hand))


def margin_table(margins: tuple[Margin, ...]) -> CellTable:
    """Demand, capacity and factor of each margin, and the maneuver that sets it."""

    def factor(margin: Margin) -> Cell:
        """Capacity over demand; a margin that is shown as 1.00 is met."""
        text = "-" if margin.margin is None else floored(margin.margin, 2)
        return text if text == "-" or float(text) >= 1.0 else Toned(text, Tone.OPEN)

    return CellTable.of(
        margins,
        {
            "<quantity": lambda margin: margin.name,
            "demand": lambda margin: quantity(margin.demand, margin.unit),
            "capacity": lambda margin: (
                "-" if margin.capacity is None else quantity(margin.capacity, margin.unit)
            ),
            "factor": factor,
            "<set by": lambda margin: margin.scenario,
        },
    )


def margin_notes(margins: tuple[Margin, ...]) -> tuple[str, ...]:
    """Basis of the figures of the margins."""
    return tuple(f"{margin.name}: {margin.note}" for margin in margins if margin.note)


def utilizations(design: OcsDesign) -> Rows:
    """Utilization of each limit in per cent, the highest first, and the names of the limits."""
    by_utilization: dict[tuple[int, str], list[Margin]] = {}
    for margin in design.margins:
        if margin.margin is not None and not _exceeds_continuous_rating(margin):
            percent = int(ceiled(100.0 / margin.margin, 0))
            by_utilization.setdefault((percent, margin.scenario), []).append(margin)
    rows = []
    for (percent, scenario), margins in sorted(
        by_utilization.items(), key=lambda item: -item[0][0]
    ):
        # The maneuver, and the remedy where the capacity is exceeded.
        notes = [margin.note for margin in margins] if percent > _EXCEEDED_PERCENT else []
        text = "; ".join(filter(None, [scenario, *notes]))
        names = listed([margin.name for margin in margins])
        rows.append((f"{percent:>3}%", f"{names} ({text})" if text else names))
    return tuple(rows)


def _exceeds_continuous_rating(margin: Margin) -> bool:
    """Whether this is a current above the motor's continuous rating, which requires a pause."""
    return margin.name == RMS_CURRENT and margin.margin is not None and margin.margin < 1.0


def pause_remark(design: OcsDesign) -> str:
    """Currents above the motor's continuous rating, and the pauses they require; empty if none."""
    return "; ".join(
        f"{quantity(margin.demand, margin.unit)} rms in {margin.scenario} "
        f"(continuous rating {quantity(margin.capacity or 0.0, margin.unit)}), {margin.note}"
        for margin in design.margins
        if _exceeds_continuous_rating(margin)
    )


def assumption_rows(sentences: Sequence[str]) -> Rows:
    """Assumptions that an engineer may want to change, by name."""
    named = (sentence.partition(": ") for sentence in sentences)
    return tuple(
        (name[0].lower() + name[1:], value.rstrip("."))
        for name, colon, value in named
        if colon and name not in _RARELY_CHANGED
    )


def saving_changes(design: OcsDesign) -> Rows:
    """Changes of the specification that save mass, largest first, and what else they change."""
    mass, motor = design.ocs.mass_total, design.ocs.motor.name
    savings = [
        (alternative.mass_total - mass, alternative)
        for alternative in design.alternatives
        if alternative.mass_total is not None and alternative.mass_total < mass - _NEGLIGIBLE_MASS
    ]
    rows = []
    for change, alternative in sorted(savings, key=lambda item: item[0]):
        other_motor = alternative.motor if alternative.motor != motor else ""
        texts = filter(None, [alternative.change, other_motor, alternative.note])
        rows.append((f"-{grams(-change)}", "; ".join(texts)))
    return tuple(rows)


def alternatives_table(design: OcsDesign) -> CellTable:
    """Result of each single change of the specification, except those that save nothing."""
    return CellTable.of(
        (other for other in design.alternatives if other.note != SAVES_NOTHING),
        {
            "<change": lambda other: other.change,
            "mass": lambda other: (
                "no device" if other.mass_total is None else grams(other.mass_total)
            ),
            "<motor": lambda other: other.motor,
            "<note": lambda other: other.note,
        },
    )


def useless_changes_note(design: OcsDesign) -> str:
    """Sentence on the changes that save nothing; empty if all save mass."""
    useless = [other.change for other in design.alternatives if other.note == SAVES_NOTHING]
    return f"These save nothing: {'; '.join(useless)}." if useless else ""


def lighter_table(design: OcsDesign) -> CellTable:
    """Changes that would each make the device lighter by the requested mass."""
    changes = () if design.lighter is None else design.lighter.changes
    rows = tuple((other.change, grams(other.mass_total or 0.0), other.motor) for other in changes)
    return CellTable(columns("<any one of these suffices", "mass", "<motor"), rows)


def driving_maneuver_text(design: OcsDesign) -> str:
    """Maneuver that drives the mass, to follow "driven by"; empty if it is not known."""
    driving = design.owed
    if driving is None:
        return ""
    if not driving.maneuver:
        return "no single maneuver; dropping any one of them saves nothing"
    if driving.mass_without is None:
        return f"{driving.maneuver}, the only maneuver"
    return f"{driving.maneuver} (without it {grams(driving.mass_without)})"


def open_points(design: OcsDesign) -> CellTable:
    """Points that keep the device from being built, each with its cure."""
    points = design.buildable.open
    return CellTable(columns("<what", "<cure"), tuple((point.what, point.cure) for point in points))


def active_limit_names(design: OcsDesign) -> list[str]:
    """Limits that set the mass: keys of the specification verbatim, others in words."""
    keys = {limit.label for limit in LIMITS.values()}
    return [name if name in keys else name.replace("_", " ") for name in design.sizing.binding]


def active_limits(design: OcsDesign) -> tuple[str, str]:
    """Names of the limits that set the mass, and their explanations."""
    meanings = (LIMIT_MEANINGS[name] for name in design.sizing.binding if name in LIMIT_MEANINGS)
    names = ", ".join(active_limit_names(design))
    return names or "none: the rim is within all limits", " ".join(meanings)


def saving_table(design: OcsDesign) -> CellTable:
    """Mass saved by moving each limit, for a device with its drive, else for one rim."""
    selection = design.selection
    if selection is None or not selection.prices:
        # The rim's envelope, from the margins; then every other active limit.
        active = {}
        for margin in design.margins:
            name = _RIM_LIMITS.get(margin.name)
            if name is not None and margin.capacity is not None:
                used, allowed = (
                    quantity(value, margin.unit) for value in (margin.demand, margin.capacity)
                )
                active[name] = (f"{margin.name} ({name})", used, allowed)
        for name in design.sizing.binding:
            active.setdefault(name, (name, "all of it", ""))
        return CellTable(
            columns("<limit", "used", "allowed", "<changes the rim's mass by"),
            tuple((*texts, rim_price(design, name)) for name, texts in active.items()),
        )
    rows = []
    for price in selection.prices:
        limit = LIMITS[price.limit]
        change = f"{price.changed - price.value:+.0%}"
        if limit is not TIME:
            values = (price.value, price.changed)
            before, after = (significant(value * limit.per_si, 4) for value in values)
            change = f"{before} to {after} {limit.unit}".rstrip()
        saved = -price.mass_change
        rows.append(
            (limit.label, change, f"{1e3 * saved:.2f} g" if saved > _NEGLIGIBLE_MASS else "nothing")
        )
    return CellTable(columns("<limit", "change", "mass saved"), tuple(rows))


def saving_notes(design: OcsDesign) -> str:
    """Conditions under which the savings hold."""
    selection = design.selection
    if selection is None or not selection.prices:
        return _PRICE_NOTE
    chosen, *others = best_drives(selection.ranking)
    note = (
        f"Each limit is changed alone, and the device resized with {drive_name(chosen)} and its "
        "material."
    )
    if others:
        difference = 1e3 * (others[0].mass - chosen.mass)
        note += (
            f" The next lightest drive, {drive_name(others[0])}, is {difference:.1f} g heavier: a "
            "change that makes another drive the lightest saves more than is shown here."
        )
    return note


def reserve_table(reserve: ReserveRecord) -> CellTable:
    """Share of each uncertain quantity in the reserve, and the mass that knowing it would save."""
    return CellTable.of(
        (cost for cost in reserve.costs if cost.share >= _LEAST_SHARE),
        {
            "<key of [reality]": lambda cost: cost.key,
            "share of the reserve": lambda cost: f"{100.0 * cost.share:.0f} %",
            "saved if known exactly": lambda cost: grams(max(cost.mass, 0.0)),
        },
    )


def reserve_note(reserve: ReserveRecord, mass: float) -> str:
    """Size of the reserve, its cost, and the mass as a function of the reliability."""
    factors = ", ".join(
        f"{maneuver.maneuver} {maneuver.needed:.2f}"
        + (f" with a roll of {degrees(maneuver.undone)}/s at lift-off" if maneuver.undone else "")
        for maneuver in reserve.maneuvers
    )
    masses, curve = [device_mass for _, device_mass in reserve.curve], ""
    if masses and max(masses) - min(masses) < _NEGLIGIBLE_MASS:
        curve = f"No extra mass up to {100.0 * reserve.curve[-1][0]:g} %."
    elif masses:
        texts = (f"{grams(least)} for {100.0 * level:g} %" for level, least in reserve.curve)
        curve = f"With the same motor and material the device weighs {', '.join(texts)}."
    return (
        f"To cover {100.0 * reserve.reliability:g} % of robots, the demands are multiplied by: "
        f"{factors}; the nominal device covers factors up to 1. The closed forms predict that "
        f"{100.0 * reserve.predicted:.1f} % pass; the reserve costs "
        f"{grams(max(mass - reserve.nominal, 0.0))}. {curve}"
    )


def rim_price(design: OcsDesign, name: str) -> str:
    """Shadow price per practical unit: kg per m is g per mm."""
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
