"""What a design cannot do, or does in another state than it is delivered in."""

from collections.abc import Iterator

from ocs_design.design_file import DemandRecord, OcsDesign
from ocs_design.report.quantities import degrees

SAME_ANGLE = 1e-9
"""Incidences that differ by less are equal [rad]."""


def doubts(design: OcsDesign) -> Iterator[str]:
    """What the design cannot do, or does in another state than it is delivered in."""
    limit, stated = design.ocs.motor.torque_limit, design.requirement.spin_inertia_by_hand
    for demand in design.requirement.demands:
        if limit is not None and demand.torque > limit:
            yield (
                f"{demand.source}: needs at least {demand.torque:.3g} N m a wheel, more than the "
                f"{limit:.3g} N m allowed: no wheel, however large, makes this turn in time"
            )
        if stated is not None and demand.spin_inertia > stated:
            yield f"{demand.source}: asks for more spin inertia than the {stated:.3e} kg m2 stated"
        yield from _turned_by_hand(demand, design)


def turned_by_hand(design: OcsDesign) -> Iterator[str]:
    """Maneuvers for which somebody has to turn the modules."""
    for demand in design.requirement.demands:
        yield from _turned_by_hand(demand, design)


def _turned_by_hand(demand: DemandRecord, design: OcsDesign) -> Iterator[str]:
    if abs(demand.incidence - design.ocs.incidence) > SAME_ANGLE:
        yield (
            f"{demand.source}: sized and flown with both modules turned by hand to "
            f"{degrees(demand.incidence)}, not at the {degrees(design.ocs.incidence)} that "
            "the files have"
        )
