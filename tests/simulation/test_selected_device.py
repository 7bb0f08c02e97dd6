"""What a selection chooses, assembled and flown with its motor's limits."""

import numpy as np
import pytest
from wheels import braked_inertia, paper_maneuvers

from ocs_design.actuation.motor import DIRECT, Gear
from ocs_design.actuation.supply import Supply
from ocs_design.catalogue.materials import material
from ocs_design.catalogue.motors import motor
from ocs_design.requirement.froude import default_envelope, standing_height
from ocs_design.requirement.requirement import Requirement
from ocs_design.simulation.scenario import run_scenarios
from ocs_design.simulation.scene import Wheels
from ocs_design.simulation.world_builder import WorldBuilder
from ocs_design.sizing.assembly import assemble_selected
from ocs_design.sizing.placement import place_on_top
from ocs_design.sizing.selection.problem import SelectionProblem
from ocs_design.sizing.selection.select import select
from ocs_design.sizing.trajectory.plans import reference

BELT = Gear("belt", 1.2, 0.95, 0.01, 1e-6, np.inf, np.inf, np.inf, reverses=False, source="test")
CHOICES = {
    "direct": (("AT2814 KV1050", "MN4010 KV580"), DIRECT, 24.0),
    "belt": (("EC 45 flat 70 W 411812",), BELT, 48.0),
}


@pytest.fixture(scope="module", params=CHOICES)
def selected(request, solo12):
    """The lightest device, and its bus voltage."""
    names, gear, voltage = CHOICES[request.param]
    requirement = Requirement(
        maneuvers=paper_maneuvers(solo12),
        rate_change=None,
        wheel_speed_max=1000.0,
        spin_inertia=None,
        standing_height=standing_height(solo12),
    )
    problem = SelectionProblem(
        solo12.mass_properties,
        requirement,
        default_envelope(solo12),
        place_on_top(solo12),
        [motor(name) for name in names],
        [gear],
        [material("steel-4140-normalized")],
        Supply(voltage),
    )
    return select(problem).best, voltage


def test_the_device_is_the_one_that_was_selected(selected, solo12):
    chosen, voltage = selected
    device = assemble_selected(chosen, Supply(voltage))
    assert device.mass == pytest.approx(chosen.mass, rel=1e-12)
    assert device.flywheel.spin_inertia == pytest.approx(chosen.spin_inertia, rel=1e-9)
    assert device.motor.armature == pytest.approx(chosen.armature, abs=1e-15)
    whole = braked_inertia(solo12, device)
    assert whole.mass == pytest.approx(chosen.total.mass, rel=1e-12)
    np.testing.assert_allclose(whole.com, chosen.total.com, rtol=0, atol=1e-12)
    np.testing.assert_allclose(whole.inertia, chosen.total.inertia, rtol=0, atol=1e-12)


def test_it_passes_all_three_experiments_and_asks_no_more_than_it_has(selected, solo12):
    chosen, voltage = selected
    device = assemble_selected(chosen, Supply(voltage))
    runs = run_scenarios(solo12, device, paper_maneuvers(solo12))
    assert [run.passed for run in runs] == [True, False] * 3, [run.reason for run in runs]
    drive = device.motor
    slope = drive.no_load_speed / drive.stall_torque
    for run in runs[::2]:
        flight = run.series.contact == 0
        speed, torque = run.series.wheel_speed[flight], run.series.wheel_torque[flight]
        assert np.abs(torque).max() <= drive.torque_limit
        assert np.abs(speed + slope * torque).max() <= drive.no_load_speed * (1.0 + 1e-12)
        assert np.abs(speed[torque * speed > 0.0]).max() <= drive.speed_max


def test_planned_by_optimal_control_a_drop_lands_level(selected, solo12):
    """Within a fifth of a degree: without a plan, direct drive comes down 3.5 deg off."""
    chosen, voltage = selected
    device, drop = assemble_selected(chosen, Supply(voltage)), paper_maneuvers(solo12)[1]
    body = WorldBuilder(solo12, device).flight(drop, Wheels.ACTIVE).body
    plan = reference(body, chosen.line, drop, standing_height(solo12)).trajectory
    run = run_scenarios(solo12, device, [drop], references={drop.name: plan})[0]
    assert run.passed is True, run.reason
    assert abs(run.metrics.touchdown_pitch) < np.radians(0.2)
    assert abs(run.metrics.touchdown_roll) < np.radians(0.2)
