"""How a choice comes into `design.json`: every figure of it, none of it invented."""

import pytest
from designed import MOTOR, designed

from ocs_design.workflows.recording import record_selection


@pytest.fixture(scope="module")
def chosen():
    return designed()[1]


@pytest.fixture(scope="module")
def record(chosen):
    return record_selection(chosen.choice)


def test_the_first_is_the_device(chosen, record):
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


def test_what_binds_is_the_task_that_asks_for_the_most(record):
    most = max(record.tasks, key=lambda task: task.spin_inertia)
    assert record.binding_maneuver == most.source
    assert most.spin_inertia == pytest.approx(record.ranking[0].spin_inertia, rel=1e-6)
    assert most.time_needed == pytest.approx(most.time_given, rel=1e-6)


def test_supply_and_reserve_are_those_of_the_choice(chosen, record):
    assert (record.bus_voltage, record.reserve) == (24.0, 0.95)
    # One motor, no gear, each material whose strength is known, one incidence.
    assert record.candidates == len(chosen.choice.problem.materials)


def test_without_co_design_there_is_none(record):
    assert record.co_design is None
