"""A campaign of short flights, for tests."""

from dataclasses import replace

from wheels import driven_device

from ocs_design.monte_carlo.campaign import make_campaign
from ocs_design.monte_carlo.uncertainty import Uncertainty
from ocs_design.requirement.froude import default_maneuvers
from ocs_design.requirement.uncertainty import Constant, UncertaintySection, spreads
from ocs_design.simulation.scenario import Flights

NOTHING = {name: Constant(1.0 if name == "contact_friction" else 0.0) for name in spreads()}
"""A world that is as designed."""


def short_campaign(robot, stated=None, *, device=None, seed=7, until=0.6, drop_only=False):
    """Jump and drop of the paper's wheels on a real motor, cut off soon after touchdown."""
    device, maneuvers = device or driven_device(), default_maneuvers(robot)[:2]
    campaign = make_campaign(
        Flights(robot, device, maneuvers[1:] if drop_only else maneuvers),
        can_stand=[True] if drop_only else [True, True],
        uncertainty=Uncertainty.of(stated or UncertaintySection(), robot, device),
        seed=seed,
    )
    flights = [
        replace(flight, world=replace(flight.world, duration=until)) for flight in campaign.flights
    ]
    return replace(campaign, flights=tuple(flights))
