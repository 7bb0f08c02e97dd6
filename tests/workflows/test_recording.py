"""Records of requirement, device and selection for `design.json`."""

import numpy as np
import pytest
from designed_devices import MOTOR, design_with_motor, record_of

from ocs_design.device.layout import heading_drift
from ocs_design.workflows.recording import HOUSING_ASSUMPTION, record_selection


@pytest.fixture(scope="module", params=["none", MOTOR])
def recorded(request):
    task, sizing = design_with_motor(request.param)
    return task, sizing, record_of(task, sizing)


def test_the_required_inertia_is_the_largest_momentum_at_the_highest_speed(recorded):
    _, sizing, design = recorded
    requirement = design.requirement
    roll = max(demand.momentum[0] for demand in sizing.sized.demands)
    pitch = max(demand.momentum[1] for demand in sizing.sized.demands)
    required, speed = requirement.required_inertia, requirement.wheel_speed_max
    assert required.roll * speed == pytest.approx(roll, rel=1e-12)
    assert required.pitch * speed == pytest.approx(pitch, rel=1e-12)


def test_a_housing_is_assumed_only_where_there_is_one(recorded):
    _, sizing, design = recorded
    has_housing = sizing.device.carrier.mass > 0.0
    assert (HOUSING_ASSUMPTION in design.requirement.assumptions) is has_housing
    assert (design.selection is not None) is has_housing


def test_records_of_maneuvers_have_their_parameters(recorded):
    task, _, design = recorded
    maneuvers = task.resolved.requirement.maneuvers
    assert [record.name for record in design.requirement.maneuvers] == [
        maneuver.name for maneuver in maneuvers
    ]
    for record, maneuver in zip(design.requirement.maneuvers, maneuvers, strict=True):
        assert record.kind == type(maneuver).__name__.lower()
        assert not {"name", "gravity", "incidence"} & set(record.parameters)
        for name, value in record.parameters.items():
            assert getattr(maneuver, name) == value


def test_the_heading_drift_follows_from_the_products_of_inertia(recorded):
    ocs = recorded[2].ocs
    assert ocs.heading_drift == pytest.approx(heading_drift(np.array(ocs.total_inertia)))


@pytest.fixture(scope="module")
def chosen():
    return design_with_motor()[1]


@pytest.fixture(scope="module")
def record(chosen):
    return record_selection(chosen.choice)


def test_the_first_entry_is_the_device(chosen, record):
    first, device = record.ranking[0], chosen.device
    assert (first.motor, first.gear, first.gear_ratio) == (MOTOR, "direct", 1.0)
    assert first.material == device.flywheel.material
    assert first.mass == pytest.approx(device.mass, rel=1e-12)
    bought = device.motor.mass + device.motor.controller_mass
    assert first.motors_mass == pytest.approx(2.0 * bought, rel=1e-12)
    assert first.spin_inertia == pytest.approx(device.flywheel.spin_inertia, rel=1e-9)
    assert (first.outer_radius, first.height) == (
        device.flywheel.outer_radius,
        device.flywheel.height,
    )


def test_the_binding_task_has_the_largest_spin_inertia(record):
    binding = max(record.tasks, key=lambda task: task.spin_inertia)
    assert record.binding_maneuver == binding.source
    assert binding.spin_inertia == pytest.approx(record.ranking[0].spin_inertia, rel=1e-6)
    assert binding.time_needed == pytest.approx(binding.time_given, rel=1e-6)


def test_supply_and_reserve_are_those_of_the_selection(chosen, record):
    assert (record.bus_voltage, record.reserve) == (24.0, 0.95)
    # One motor without gear, each material of known strength, one incidence.
    assert record.candidates == len(chosen.choice.problem.materials)
