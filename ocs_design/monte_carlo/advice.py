"""What would mend a scenario that fails, where a maneuver's own statement is the cause."""

from math import cos, sin

import numpy as np

from ocs_design.monte_carlo.outcomes import FAULTS, Outcomes
from ocs_design.requirement.maneuver import Maneuver
from ocs_design.simulation.verdict import LANDING_TOLERANCE, Fault

_BLIND = 1e-3
"""Share of its momentum with which a device reaches an axis that it as good as does not."""


def advice(outcomes: Outcomes, maneuver: Maneuver, number: int) -> str:
    """How to land level about an axis that the modules, as they are set by hand, do not turn.

    Whatever rate the robot leaves the ground with about such an axis it keeps until it lands.

    Args:
        outcomes: of n samples. maneuver: of scenario `number`.

    Returns:
        One sentence; empty if no sample fails for that.
    """
    axis = _blind_axis(maneuver)
    if not axis:
        return ""
    landed_off = outcomes.codes[:, number] == 1 + FAULTS.index(Fault.LANDING)
    error = np.abs(outcomes.metric(f"touchdown_{axis}")[:, number])
    count = np.count_nonzero(landed_off & (error > LANDING_TOLERANCE))
    if not count:
        return ""
    return (
        f"{count} land off level in {axis}, which modules in line do not turn: without "
        f"`incidence` in its [[maneuver]] they stay as they are designed, and do"
    )


def _blind_axis(maneuver: Maneuver) -> str:
    """Which axis modules that are turned by hand leave alone; empty if none."""
    if maneuver.incidence is None:
        return ""
    if abs(sin(maneuver.incidence)) < _BLIND:
        return "roll"
    return "pitch" if abs(cos(maneuver.incidence)) < _BLIND else ""
