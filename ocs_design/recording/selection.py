"""From a choice of motor, gear and material to its record."""

from ocs_design.designing import Choice
from ocs_design.drive.line import RESERVE
from ocs_design.selection_record import (
    CoDesignRecord,
    PriceRecord,
    RankedRecord,
    RejectionRecord,
    SelectionRecord,
)
from ocs_design.sizing.selection.prices import Price, mass_prices
from ocs_design.sizing.selection.result import Candidate, Rejection


def record_selection(choice: Choice) -> SelectionRecord:
    """How the device came to be."""
    return SelectionRecord(
        bus_voltage=choice.problem.bus_voltage,
        reserve=RESERVE,
        candidates=choice.selection.candidates,
        binding_maneuver=choice.chosen.binding_maneuver,
        binding=choice.chosen.binding,
        tasks=choice.chosen.demands,
        ranking=tuple(_ranked(entry) for entry in choice.selection.ranking),
        rejections=tuple(_rejection(entry) for entry in choice.selection.rejections),
        co_design=_co_design(choice),
        prices=tuple(map(_price, mass_prices(choice.problem, choice.selection.best))),
    )


def _ranked(entry: Candidate) -> RankedRecord:
    return RankedRecord(
        motor=entry.motor.name,
        gear=entry.gear.name,
        gear_ratio=entry.gear.ratio,
        material=entry.material.name,
        incidence=entry.incidence,
        mass=entry.mass,
        wheels_mass=2.0 * entry.wheel_mass,
        motors_mass=2.0 * (entry.motor.mass or 0.0),
        gears_mass=2.0 * entry.gear.mass,
        housings_mass=2.0 * entry.printed_mass,
        spin_inertia=entry.spin_inertia,
        outer_radius=entry.outer_radius,
        height=entry.height,
    )


def _price(price: Price) -> PriceRecord:
    return PriceRecord(
        limit=price.limit.name,
        value=price.value,
        changed=price.changed,
        mass_change=price.mass_change,
    )


def _rejection(entry: Rejection) -> RejectionRecord:
    return RejectionRecord(motor=entry.motor, reason=str(entry.reason), detail=entry.detail)


def _co_design(choice: Choice) -> CoDesignRecord | None:
    found = choice.co_design
    if found is None:
        return None
    return CoDesignRecord(
        adopted=found.adopted,
        status=found.status,
        iterations=found.iterations,
        mass=found.found_mass,
        selected_mass=found.selected_mass,
        violation=found.fine_violation,
        remark=found.note,
    )
