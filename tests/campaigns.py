"""Campaigns of short flights, and synthetic outcomes of flights."""

from dataclasses import fields, replace

import numpy as np
from wheels import driven_device

from ocs_design.device.layout import PAIR
from ocs_design.monte_carlo.campaign import make_campaign
from ocs_design.monte_carlo.outcomes import METRICS, Outcomes
from ocs_design.monte_carlo.uncertainty import Uncertainty, quantities
from ocs_design.requirement.froude import default_maneuvers
from ocs_design.requirement.uncertainty import Constant, UncertaintySection, spreads
from ocs_design.simulation.run import Metrics
from ocs_design.simulation.scenario import Flights

NO_UNCERTAINTY = {name: Constant(1.0 if name == "contact_friction" else 0.0) for name in spreads()}
"""Every quantity is as designed."""

NAMES = quantities(PAIR)


def short_campaign(robot, specified=None, *, device=None, seed=7, until=0.6, drop_only=False):
    """Jump and drop with the paper's wheels on a real motor, cut off soon after touchdown."""
    device, maneuvers = device or driven_device(), default_maneuvers(robot)[:2]
    campaign = make_campaign(
        Flights(robot, device, maneuvers[1:] if drop_only else maneuvers),
        can_stand=[True] if drop_only else [True, True],
        uncertainty=Uncertainty.of(specified or UncertaintySection(), robot, device),
        seed=seed,
    )
    flights = [
        replace(flight, world=replace(flight.world, duration=until)) for flight in campaign.flights
    ]
    return replace(campaign, flights=tuple(flights))


def zero_metrics(**values):
    """Metrics that are all 0 but for `values`, of a robot that ends upright."""
    zeros = {field.name: 0.0 for field in fields(Metrics)}
    return Metrics(**zeros | {"upright_at_end": True} | values)


def synthetic_outcomes(samples, scenarios=1, *, fail_from=2.0, seed=0):
    """Outcomes whose pitch at touchdown is the first quantity of the sample [rad].

    Samples off level by more than `fail_from` fail. Each depends on its own number only.
    """
    values = np.array([np.random.default_rng([seed, n]).normal(size=len(NAMES)) for n in samples])
    metrics = np.zeros((len(values), scenarios, len(METRICS)))
    metrics[:, :, METRICS.index("touchdown_pitch")] = values[:, :1]
    codes = np.where(np.abs(values[:, :1]) > fail_from, 3, 0).astype(np.int8)
    codes = np.broadcast_to(codes, (len(values), scenarios)).copy()
    return Outcomes(np.array(samples), values, metrics, codes, NAMES)


def assert_same(one, other):
    for field in fields(Outcomes):
        np.testing.assert_array_equal(getattr(one, field.name), getattr(other, field.name))
