"""Plans, integrated by Basilisk's own equations of a spacecraft with wheels."""

import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from driven_wheels import EC45_LINE
from gyrostats import BACK_FLIP, DIAGONAL, FULL, body, boundary_of, drop

from ocs_design.device.layout import Layout, LayoutName
from ocs_design.requirement.turns import Catch, TurnTo
from ocs_design.sizing.trajectory.collocation import TORQUE_DEGREE
from ocs_design.sizing.trajectory.flight import FINER
from ocs_design.sizing.trajectory.gyrostat import Gyrostat
from ocs_design.sizing.trajectory.plans import INTERVALS, least_power_turn

SCRIPT = Path(__file__).parents[2] / "in_basilisk.py"
PYTHON = os.environ.get("BASILISK_PYTHON", sys.executable)
STEPS = 8
"""Steps of Basilisk per step of the fine grid, each with its mean torque."""

FORTY = np.radians(40.0)
YAW = TurnTo(name="yaw", jump_height=1.0, yaw=np.pi / 2.0, duration=2.4)
CATCH = Catch(name="catch", jump_height=0.5, rate=(0.4, 0.8, 0.1), duration=0.48, wheel_speed=50.0)
TRIAD = Layout(LayoutName.TRIAD).axes(0.0)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("maneuver", "gyrostat"),
    [
        (drop(30.0, 10.0), body(FORTY, 1.6e-4, FULL)),
        (BACK_FLIP, body(np.radians(20.0), 2e-4, FULL)),
        (YAW, body(FORTY, 1.6e-4, FULL)),
        (YAW, Gyrostat(DIAGONAL, np.eye(3), 1.6e-4)),
        (CATCH, Gyrostat(DIAGONAL, TRIAD, 1.6e-4)),
    ],
    ids=["drop", "back-flip", "yaw by two wheels", "yaw by three wheels", "catch by a triad"],
)
def test_basilisk_agrees_with_a_plan(maneuver, gyrostat):
    """Attitude within 0.1 deg, wheel speeds within 1e-6 of the fastest, at every instant."""
    command = [PYTHON, "-c", "import Basilisk"]
    if subprocess.run(command, check=False, capture_output=True).returncode:
        pytest.skip("no Basilisk (pip install bsk) in this environment or in BASILISK_PYTHON")
    start = boundary_of(maneuver)
    planned = least_power_turn(start, gyrostat, EC45_LINE)
    assert not planned.failure
    trajectory, count = planned.trajectory, FINER * STEPS
    (motion,) = planned.solution.motions
    # Means over the parts of each interval, of parabolas: Simpson's rule is exact.
    edges = np.arange(count) / count
    torques = sum(
        share * motion.torque_within(edges + part / count)
        for share, part in ((1 / 6, 0.0), (4 / 6, 0.5), (1 / 6, 1.0))
    )
    assert TORQUE_DEGREE == 2
    problem = {
        "step": start.duration / INTERVALS / count,
        "inertia": gyrostat.inertia.tolist(),
        "axes": gyrostat.axes.tolist(),
        "spin_inertia": gyrostat.spin_inertia,
        "attitude": start.attitude.tolist(),
        "rate": trajectory.rate[0].tolist(),
        "speed": trajectory.wheel_speed[0].tolist(),
        "torques": torques.tolist(),
    }
    done = subprocess.run(
        [PYTHON, SCRIPT], input=json.dumps(problem), capture_output=True, text=True, check=True
    )
    states = json.loads(done.stdout[done.stdout.index("{") :])
    speed, attitude = (np.array(states[name])[STEPS - 1 :: STEPS] for name in ("speed", "attitude"))
    largest = np.abs(trajectory.wheel_speed).max()
    np.testing.assert_allclose(speed, trajectory.wheel_speed[1:], rtol=0, atol=1e-6 * largest)
    cosine = np.abs(np.einsum("ij,ij->i", attitude, trajectory.attitude[1:]))
    assert np.degrees(2.0 * np.arccos(np.minimum(cosine, 1.0))).max() < 0.1
