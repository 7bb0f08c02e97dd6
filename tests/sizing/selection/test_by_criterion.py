"""Selection with the incidence by a criterion, where no device wins or is feasible at its own."""

from dataclasses import replace

import pytest
from random_cases import random_case

from ocs_design.common.errors import Infeasible
from ocs_design.device.layout import Criterion
from ocs_design.sizing.selection import select as selecting
from ocs_design.sizing.selection.problem import Reason
from ocs_design.sizing.selection.select import select, select_by


def test_a_refusal_names_all_motors_where_none_is_feasible():
    """At the criterion's incidence not even the lightest device is feasible."""
    problem = replace(random_case(15).problem, incidence=None)
    with pytest.raises(Infeasible, match=f"None of {len(problem.motors)} motors"):
        select_by(problem, Criterion.WEIGHTED)


@pytest.mark.slow
def test_where_no_device_wins_at_its_own_incidence_the_lightest_there_leads(monkeypatch):
    """Two devices, each the lightest at the other's incidence only."""
    problem = replace(random_case(4).problem, incidence=None)
    base = select(replace(problem, incidence=0.5)).best
    angles, masses = {"a": 0.4, "b": 0.6}, {"a": 0.10, "b": 0.12}

    def device(name, incidence):
        """A device heavier than the base, by 0.05 kg less away from its own incidence."""
        is_away = abs(incidence - angles[name]) > 1e-6
        excess = (masses[name] - 0.05 * is_away) / 2.0
        motor = replace(base.motor, name=name, mass=base.motor.mass + excess)
        return replace(base, motor=motor, incidence=incidence)

    def choose(problem):
        """All devices of a problem, lightest first."""
        names = {motor.name for motor in problem.motors} & set(angles) or set(angles)
        devices = (device(name, problem.incidence) for name in names)
        ranking = tuple(sorted(devices, key=lambda device: device.mass))
        return replace(lightest, ranking=ranking, reasons=tuple)

    def own_incidence(problem, winner, criterion):
        """As the criterion would have it; what wins first, neither of both, leads to a's."""
        if winner.motor.name not in angles:
            return angles["a"], None
        angle = angles[winner.motor.name]
        return angle, device(winner.motor.name, angle)

    lightest = select(replace(problem, incidence=0.5))
    monkeypatch.setattr(selecting, "select", choose)
    monkeypatch.setattr(selecting, "at_own_incidence", own_incidence)
    selection = select_by(problem, Criterion.EQUAL_RATE)
    assert (selection.best.motor.name, selection.best.incidence) == ("a", 0.4)
    assert selection.best.mass == pytest.approx(base.mass + 0.10)
    (other,) = selection.rejections
    assert (other.motor, other.reason) == ("b", Reason.INCIDENCE)
