"""From live values to records: what `design.json` says of a requirement and of a device."""

import numpy as np
import pytest
from designed import MOTOR, as_recorded, designed

from ocs_design.workflows.recording import HOUSING_ASSUMED


@pytest.fixture(scope="module", params=["none", MOTOR])
def recorded(request):
    task, found = designed(request.param)
    design = as_recorded(task, found, seed=3)
    return task, found, design


def test_the_required_inertia_is_the_largest_momentum_at_the_highest_speed(recorded):
    _, found, design = recorded
    requirement = design.requirement
    roll = max(demand.momentum[0] for demand in found.sized.demands)
    pitch = max(demand.momentum[1] for demand in found.sized.demands)
    required, speed = requirement.required_inertia, requirement.wheel_speed_max
    assert required.roll * speed == pytest.approx(roll, rel=1e-12)
    assert required.pitch * speed == pytest.approx(pitch, rel=1e-12)


def test_a_housing_is_assumed_only_where_there_is_one(recorded):
    _, found, design = recorded
    has_housing = found.device.carrier.mass > 0.0
    assert (HOUSING_ASSUMED in design.requirement.assumptions) is has_housing
    assert (design.selection is not None) is has_housing


def test_every_maneuver_keeps_its_own_figures(recorded):
    task, _, design = recorded
    maneuvers = task.resolved.requirement.maneuvers
    assert [record.name for record in design.requirement.maneuvers] == [m.name for m in maneuvers]
    for record, maneuver in zip(design.requirement.maneuvers, maneuvers, strict=True):
        assert record.kind == type(maneuver).__name__.lower()
        assert not {"name", "gravity", "incidence"} & set(record.parameters)
        for name, value in record.parameters.items():
            assert getattr(maneuver, name) == value


def test_yaw_drifts_as_the_products_of_inertia_say(recorded):
    """Zero momentum about z: I_zx w_x + I_zy w_y + I_zz w_z = 0."""
    _, _, design = recorded
    inertia, drift = np.array(design.ocs.total_inertia), design.ocs.heading_drift
    for axis in range(2):
        rate = np.zeros(3)
        rate[axis], rate[2] = 1.0, drift[axis]
        assert (inertia @ rate)[2] == pytest.approx(0.0, abs=1e-12)


def test_nothing_flown_is_nothing_recorded(recorded):
    _, _, design = recorded
    assert (design.validation, design.ocs.clearance, design.seed) == ((), None, 3)
