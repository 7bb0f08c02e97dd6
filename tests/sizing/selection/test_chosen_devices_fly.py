"""Selected devices pass their maneuvers in MuJoCo within their motor's limits."""

import numpy as np
import pytest
from random_cases import random_case
from subsets import slow_subset

from ocs_design.simulation.scenario import Flights, run_scenarios
from ocs_design.sizing.selection.select import select
from ocs_design.sizing.trajectory.plans import plan

FEASIBLE_SEEDS = (1, 2, 3, 4, 5, 6, 7, 8, 10, 16)


@pytest.mark.parametrize("seed", slow_subset(10, FEASIBLE_SEEDS))
def test_a_selected_device_passes_within_its_motors_limits(seed):
    case = random_case(seed)
    problem, requirement = case.problem, case.problem.requirement
    chosen = select(problem).best
    device = chosen.device
    plans = plan(case.robot.mass_properties, device, requirement.maneuvers)
    runs = run_scenarios(
        Flights(
            case.robot,
            device,
            requirement.maneuvers,
            references={
                name: planned.trajectory
                for name, planned in plans.items()
                if planned.trajectory is not None
            },
        )
    )
    for run in runs[::2]:
        assert run.passed is True, f"{run.scenario}: {run.reason}; {run.note}"
        assert np.abs(run.series.wheel_torque).max() <= device.motor.torque_limit * (1.0 + 1e-12)
