"""What a design cannot do, or does in another state than it is delivered in."""

from collections.abc import Iterator

import numpy as np

from ocs_design.design_file import DemandRecord, OcsDesign
from ocs_design.report.quantities import degrees
from ocs_design.sizing.incidence import cross_momentum

SAME_ANGLE = 1e-9
"""Incidences that differ by less are equal [rad]."""

LOPSIDED = 0.2
"""Momentum of the busier wheel that no closed form counts, over that which they do: the flights of
ANYmal with an arm to one side fail at 0.63, and pass at 0.27 and less."""


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
        yield from _lopsided(demand, design)


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


def _lopsided(demand: DemandRecord, design: OcsDesign) -> Iterator[str]:
    """The turn takes momentum about an axis that it is not about."""
    asked = np.array([demand.roll_momentum, demand.pitch_momentum])
    if np.count_nonzero(asked) != 1 or demand.incidence <= SAME_ANGLE:
        return
    axis = int(np.flatnonzero(asked)[0])
    share = abs(cross_momentum(np.array(design.ocs.total_inertia))[axis])
    tangent = np.tan(demand.incidence)
    extra = share / tangent if axis else share * tangent
    if extra > LOPSIDED:
        about, across = ("pitch", "roll") if axis else ("roll", "pitch")
        angle = np.arctan(share / LOPSIDED if axis else LOPSIDED / share)
        yield (
            f"{demand.source}: robot and device are lopsided: what turns them about {about} takes "
            f"{share:.0%} of its momentum about {across} too, at {degrees(demand.incidence)} "
            f"{extra:.0%} more of the busier wheel, which the choice does not count: if its flight "
            f"fails, try --alpha {degrees(angle, 0).replace(' ', '')}, or a symmetric posture"
        )
